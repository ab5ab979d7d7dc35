//! What a ray sees that hits nothing.

use crate::environment::EnvironmentMap;
use std::sync::Arc;
use vitrum_math::{DVec3, Rgb};

/// The radiance that arrives from infinitely far away.
#[derive(Clone, Debug, PartialEq)]
pub enum Background {
    /// The same from everywhere.
    Constant(Rgb),
    /// Linear in the y of the direction: `bottom` from straight below, `top` from straight above.
    Gradient {
        /// Radiance from straight below.
        bottom: Rgb,
        /// Radiance from straight above.
        top: Rgb,
    },
    /// A picture of all directions. Paths ask for its light as they do for that of objects that shine.
    Environment(Arc<EnvironmentMap>),
}

impl Background {
    /// The radiance that arrives from the unit vector `direction`.
    #[inline]
    pub fn radiance(&self, direction: DVec3) -> Rgb {
        match self {
            Self::Constant(colour) => *colour,
            Self::Gradient { bottom, top } => {
                let up = (direction.y + 1.0) * 0.5;
                *bottom * (1.0 - up) + *top * up
            }
            Self::Environment(map) => map.radiance(direction),
        }
    }

    /// The largest radiance of any channel from any direction.
    pub fn brightest(&self) -> f64 {
        match self {
            Self::Constant(colour) => colour.max_element(),
            Self::Gradient { bottom, top } => bottom.max(*top).max_element(),
            Self::Environment(map) => map.brightest(),
        }
    }
}
