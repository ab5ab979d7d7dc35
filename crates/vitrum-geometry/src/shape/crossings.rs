//! What a line and an analytic shape have in common.

/// One crossing of a line and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Where on the ray, in units of its direction; may be negative.
    pub t: f64,
    /// The face that is crossed.
    pub face: u32,
}

/// At most two crossings, the smaller `t` first. Missing ones stand at infinity, which no search ever takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossings(pub [Crossing; 2]);

/// The face of a shape that a ray starts on, and the side that it leaves to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaving {
    /// The face.
    pub face: u32,
    /// True when the ray goes to the side that the normal points away from: into a solid.
    pub behind: bool,
}

impl Crossing {
    /// No crossing.
    pub(crate) const MISSING: Self = Self { t: f64::INFINITY, face: 0 };
}

impl Crossings {
    /// The line misses, or the ray can't come back.
    pub const NONE: Self = Self([Crossing::MISSING; 2]);

    /// One crossing.
    #[inline]
    pub const fn one(t: f64, face: u32) -> Self {
        Self([Crossing { t, face }, Crossing::MISSING])
    }

    /// Two crossings, in order.
    #[inline]
    pub const fn two(near: Crossing, far: Crossing) -> Self {
        Self([near, far])
    }
}
