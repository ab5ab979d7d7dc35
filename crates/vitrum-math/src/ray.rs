//! Rays in double precision.

use crate::DVec3;

/// A half line `origin + t · direction`, `t ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts, in metres.
    pub origin: DVec3,
    /// Where it goes. Unit length in world space, so that `t` is in metres there; any length in an object's frame,
    /// so that `t` stays the same number.
    pub direction: DVec3,
}

impl Ray {
    /// A ray from `origin` along `direction`.
    #[inline]
    pub const fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction }
    }

    /// The point at distance `t`.
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// The unit vector along `v`. `v` must be finite and not zero; its length may be anything that does not overflow
/// when squared.
#[inline]
pub fn unit(v: DVec3) -> DVec3 {
    v / v.dot(v).sqrt()
}
