//! Lights.

use vitrum_math::{DVec3, Rgb};

use super::Name;
use crate::diagnostic::Span;

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The table's header.
    pub span: Span,
    /// Its name, if it has one.
    pub name: Option<Name>,
    /// What kind of light it is.
    pub kind: LightKind,
}

/// The kinds of light.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// The same on every surface.
    Ambient {
        /// W/(m² sr)
        radiance: Rgb,
    },
    /// From one point.
    Point {
        /// Metres.
        position: DVec3,
        /// W/sr; without falloff, W/m².
        intensity: Rgb,
        /// Whether it weakens with distance.
        falloff: Falloff,
        /// Whether objects stand in its way.
        shadows: bool,
    },
    /// From one point into a cone.
    Spot {
        /// Metres.
        position: DVec3,
        /// The axis, away from the light, of any length.
        direction: DVec3,
        /// Along the axis, W/sr.
        intensity: Rgb,
        /// Degrees between the axis and where the light begins to weaken.
        inner: f64,
        /// Degrees between the axis and where none is left; more than `inner`.
        outer: f64,
        /// Whether objects stand in its way.
        shadows: bool,
    },
    /// Parallel.
    Directional {
        /// Where the light travels to, of any length.
        direction: DVec3,
        /// On a surface square to it, W/m².
        irradiance: Rgb,
        /// Whether objects stand in its way.
        shadows: bool,
    },
}

/// How a point light weakens with distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// With its square.
    InverseSquare,
    /// Not at all.
    None,
}
