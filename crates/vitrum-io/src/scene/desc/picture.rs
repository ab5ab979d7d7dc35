//! Settings, output, camera and background.

use std::path::PathBuf;

use vitrum_math::{DVec3, Rgb};

use super::Name;
use crate::diagnostic::Span;

/// How the picture is computed. The default is the format's.
#[derive(Clone, Debug, PartialEq)]
pub struct Render {
    /// Width and height in pixels, 1 to 65536 each, together at most 2^28 pixels.
    pub size: [u32; 2],
    /// Samples per pixel, 1 to 1 000 000.
    pub spp: u32,
    /// A ray deeper than this is not traced, 0 to 1000; the camera ray has depth 0. None is 10 in a ray tree, and no limit for
    /// paths.
    pub max_depth: Option<u32>,
    /// Rays of ray trees that weigh less are not traced, 0 to 1.
    pub cutoff: f64,
    /// Which points of the film a pixel is the mean of.
    pub filter: Filter,
    /// Start of the random numbers.
    pub seed: u64,
    /// How light is followed; none leaves it to what the scene has.
    pub integrator: Option<Integrator>,
    /// How many rays a path follows from glass.
    pub branching: Branching,
    /// What glass does to shadow rays.
    pub shadow: Shadow,
}

/// Which points of the film a pixel is the mean of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Those of its square.
    Box,
    /// Falling to the middles of its neighbours.
    Tent,
    /// A bell over three pixels.
    BlackmanHarris,
}

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// The whole ray tree, deterministic.
    Whitted,
    /// Random paths, on all ways of light.
    Path,
}

/// How many of the rays that glass divides a path follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branching {
    /// Whichever of the others is best, part by part of the picture.
    Auto,
    /// One.
    One,
    /// All at the first hit, then one.
    First,
    /// All while they weigh enough.
    Tree,
}

/// What glass does to shadow rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadow {
    /// It blocks them.
    Opaque,
    /// It lets them through, weakened and unbent.
    Straight,
}

/// How a PNG is made of radiance. The default is the format's.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Stops, -32 to 32: radiance is multiplied by two to this power.
    pub exposure: f64,
    /// What becomes of values above white.
    pub tone: Tone,
}

/// What becomes of values above white.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// They are white.
    Clip,
    /// They are rolled off.
    Neutral,
}

/// Where the scene is seen from.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The table's header.
    pub span: Span,
    /// Metres.
    pub position: DVec3,
    /// The point in the middle of the picture, metres.
    pub target: DVec3,
    /// Where `target` stands.
    pub target_span: Span,
    /// A direction that is up in the picture, of any length, not along the line of sight.
    pub up: DVec3,
    /// How rays start.
    pub lens: Lens,
    /// The medium that it stands in; none is what is found there.
    pub medium: Option<Name>,
}

/// How camera rays start.
#[derive(Clone, Debug, PartialEq)]
pub enum Lens {
    /// From one point.
    Pinhole {
        /// Vertical field of view in degrees, between 0 and 180.
        fov: f64,
    },
    /// From a disk, towards a plane that is sharp.
    Thin {
        /// Vertical field of view in degrees, between 0 and 180.
        fov: f64,
        /// Metres, 0 or more.
        radius: f64,
        /// Distance of the sharp plane along the line of sight, metres.
        focus_distance: f64,
    },
    /// From a plane, in parallel.
    Orthographic {
        /// Metres from the bottom to the top of the picture.
        height: f64,
    },
}

/// What a ray sees that meets nothing: radiance. The default is black.
#[derive(Clone, Debug, PartialEq)]
pub enum Background {
    /// The same in every direction.
    Constant {
        /// Radiance.
        color: Rgb,
    },
    /// Linear in the y of the unit direction.
    Gradient {
        /// At y = -1.
        bottom: Rgb,
        /// At y = 1.
        top: Rgb,
    },
    /// A picture of all directions, of latitude and longitude.
    Image {
        /// A Radiance or OpenEXR file; relative to the scene file.
        file: PathBuf,
        /// Where the file stands.
        file_span: Span,
        /// Degrees about +Y, counterclockwise seen from above.
        rotation: f64,
        /// Factor of all radiance, 0 or more.
        scale: f64,
    },
}

impl Default for Background {
    fn default() -> Self {
        Self::Constant { color: Rgb::ZERO }
    }
}
