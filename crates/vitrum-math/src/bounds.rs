//! Axis-aligned boxes.

use crate::DVec3;

/// An axis-aligned box, corners included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing, and the identity of [`union`](Self::union).
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`; [`EMPTY`](Self::EMPTY) around none.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True when no point is inside.
    pub fn is_empty(&self) -> bool {
        !(self.min.cmple(self.max).all())
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        self.min + (self.max - self.min) * 0.5
    }

    /// The lengths of the edges.
    pub fn extent(&self) -> DVec3 {
        self.max - self.min
    }

    /// True when the boxes share at least a point.
    pub fn touches(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Its eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        core::array::from_fn(|i| {
            let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// The box grown by `margin` metres on every side.
    pub fn padded(&self, margin: f64) -> Self {
        Self { min: self.min - DVec3::splat(margin), max: self.max + DVec3::splat(margin) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_empty_box_is_the_identity_of_union() {
        let b = Bounds::around([DVec3::ZERO, DVec3::new(1.0, -2.0, 3.0)]);
        assert_eq!(Bounds::EMPTY.union(b), b);
        assert!(Bounds::EMPTY.is_empty() && !b.is_empty());
        assert_eq!(Bounds::around(b.corners()), b);
        assert_eq!(b.centre(), DVec3::new(0.5, -1.0, 1.5));
    }
}
