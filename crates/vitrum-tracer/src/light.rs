//! Lights that no ray can hit: points, spots and directions.

use vitrum_math::{DVec3, Rgb};

/// How a point light fades with distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Falloff {
    /// As physics has it: irradiance is intensity over distance squared.
    InverseSquare,
    /// Not at all: the intensity is the irradiance at any distance. A textbook's light, not a real one.
    None,
}

/// A light that arrives from exactly one direction at each point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Shines from a point.
    Point {
        /// Where it is, metres.
        position: DVec3,
        /// Radiant intensity, W/sr per channel.
        intensity: Rgb,
        /// How it fades.
        falloff: Falloff,
        /// False for light that goes through everything.
        shadows: bool,
    },
    /// Shines from a point into a cone, at full intensity within the inner one and down to nothing at the outer one, along a
    /// smooth step of the angle's cosine.
    Spot {
        /// Where it is, metres.
        position: DVec3,
        /// Unit vector along its axis, away from it.
        axis: DVec3,
        /// Radiant intensity along the axis, W/sr per channel.
        intensity: Rgb,
        /// Cosine of the angle between the axis and the edge of the inner cone.
        cos_inner: f64,
        /// The same of the outer cone; less.
        cos_outer: f64,
        /// False for light that goes through everything.
        shadows: bool,
    },
    /// Shines from infinitely far away.
    Directional {
        /// Unit vector towards the light.
        towards: DVec3,
        /// Irradiance on a surface that faces the light, W/m² per channel.
        irradiance: Rgb,
        /// False for light that goes through everything.
        shadows: bool,
    },
}

/// Light as it arrives at a point, before anything is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Unit vector towards the light.
    pub towards: DVec3,
    /// How far away the light is, metres.
    pub distance: f64,
    /// Irradiance on a surface that faces the light.
    pub irradiance: Rgb,
}

impl Light {
    /// A vector from `point` towards the light, of any length.
    #[inline]
    pub fn offset(&self, point: DVec3) -> DVec3 {
        match *self {
            Self::Point { position, .. } | Self::Spot { position, .. } => position - point,
            Self::Directional { towards, .. } => towards,
        }
    }

    /// How far away it is, metres.
    pub fn distance_from(&self, point: DVec3) -> f64 {
        match self {
            Self::Directional { .. } => f64::INFINITY,
            _ => self.offset(point).length(),
        }
    }

    /// The light that arrives at `point`; `None` at the light itself.
    #[inline]
    pub fn arriving_at(&self, point: DVec3) -> Option<Arrival> {
        match *self {
            Self::Point { position, intensity, falloff, .. } => {
                let offset = position - point;
                let distance_squared = offset.dot(offset);
                if distance_squared == 0.0 {
                    return None;
                }
                let distance = distance_squared.sqrt();
                let irradiance = match falloff {
                    Falloff::InverseSquare => intensity / distance_squared,
                    Falloff::None => intensity,
                };
                Some(Arrival { towards: offset / distance, distance, irradiance })
            }
            Self::Spot { position, axis, intensity, cos_inner, cos_outer, .. } => {
                let offset = position - point;
                let distance_squared = offset.dot(offset);
                let distance = distance_squared.sqrt();
                let towards = offset / distance;
                let step = (-towards.dot(axis) - cos_outer) / (cos_inner - cos_outer);
                // At the light itself nothing compares.
                if step.is_nan() || step <= 0.0 {
                    return None;
                }
                let step = step.min(1.0);
                let irradiance = intensity * (step * step * (3.0 - 2.0 * step)) / distance_squared;
                Some(Arrival { towards, distance, irradiance })
            }
            Self::Directional { towards, irradiance, .. } => {
                Some(Arrival { towards, distance: f64::INFINITY, irradiance })
            }
        }
    }

    /// True when objects block it.
    pub fn casts_shadows(&self) -> bool {
        match self {
            Self::Point { shadows, .. } | Self::Spot { shadows, .. } | Self::Directional { shadows, .. } => {
                *shadows
            }
        }
    }

    /// True when it sends out nothing.
    pub fn is_dark(&self) -> bool {
        match self {
            Self::Point { intensity: colour, .. }
            | Self::Spot { intensity: colour, .. }
            | Self::Directional { irradiance: colour, .. } => *colour == Rgb::ZERO,
        }
    }
}
