//! Indices of refraction that are valid by construction.

/// An absolute index of refraction: the speed of light in vacuum over the speed in the medium.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct IndexOfRefraction(pub(crate) f64);

/// A number that is no index of refraction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("an index of refraction must be between 0.001 and 1000, found {0}")]
pub struct InvalidIndex(pub f64);

impl IndexOfRefraction {
    /// Air and vacuum, which this renderer does not tell apart unless a scene declares them.
    pub const AIR: Self = Self(1.0);

    /// An absolute index.
    ///
    /// # Errors
    /// [`InvalidIndex`] outside 0.001 to 1000.
    pub fn new(n: f64) -> Result<Self, InvalidIndex> {
        if (1e-3..=1e3).contains(&n) { Ok(Self(n)) } else { Err(InvalidIndex(n)) }
    }

    /// The index of a medium whose index relative to this one is `ratio`: inside over outside.
    ///
    /// # Errors
    /// [`InvalidIndex`] when the product is out of range.
    pub fn times(self, ratio: f64) -> Result<Self, InvalidIndex> {
        Self::new(self.0 * ratio)
    }

    /// The number.
    pub const fn value(self) -> f64 {
        self.0
    }
}
