//! Media, and what two of them are to each other where they meet.
//!
//! A surface of glass divides two media, one on the side that its normal points to (outside), one on the other (inside). There are
//! two ways to say what is outside:
//!
//! - An **interface** is between just these two, wherever it stands: for people who model each cut between two media as a surface of
//!   its own.
//! - The surface of a **solid** says only what is inside. What is outside is whatever is there, and where solids overlap, the one of
//!   the highest priority fills the space: they may be modelled one by one, each larger than what is seen of it. (C. Schmidt and
//!   B. Budge, Simple Nested Dielectrics in Ray Traced Images, 2002.)

use crate::{Absorption, IndexOfRefraction};
use vitrum_bxdf::Interface;

/// What light goes through: how it refracts, and what it absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Against vacuum.
    pub index: IndexOfRefraction,
    /// Along the way.
    pub absorption: Absorption,
}

impl Medium {
    /// Air, and vacuum, which are not told apart here.
    pub const AIR: Self = Self::clear(IndexOfRefraction::AIR);

    /// One that absorbs nothing.
    pub const fn clear(index: IndexOfRefraction) -> Self {
        Self { index, absorption: Absorption::NONE }
    }
}

/// What a surface between two media is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Both media are as they are said to be.
    Interface,
    /// Around the medium inside is whatever is there; the medium outside is what surrounds everything.
    Solid {
        /// Where solids overlap, the highest fills the space.
        priority: i16,
    },
}

/// The media on both sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Media {
    /// On the side that the normal points to.
    pub outside: Medium,
    /// On the other.
    pub inside: Medium,
    /// How sure that is.
    pub boundary: Boundary,
    interface: Interface<f64>,
}

impl Media {
    /// An interface between two media.
    pub fn new(outside: Medium, inside: Medium) -> Self {
        let interface = Interface::new(outside.index.value(), inside.index.value())
            .expect("indices from 0.001 to 1000 have a ratio from 1e-6 to 1e6");
        Self { outside, inside, boundary: Boundary::Interface, interface }
    }

    /// The surface of a solid in `around`, which surrounds everything.
    pub fn solid(around: Medium, inside: Medium, priority: i16) -> Self {
        Self { boundary: Boundary::Solid { priority }, ..Self::new(around, inside) }
    }

    /// The same with another medium outside.
    #[must_use]
    pub fn within(&self, outside: Medium) -> Self {
        Self { boundary: self.boundary, ..Self::new(outside, self.inside) }
    }

    /// The pair of indices, outside above.
    pub fn interface(&self) -> &Interface<f64> {
        &self.interface
    }

    /// True where light that crosses the surface is not changed by it, and meets the same medium beyond.
    pub fn are_equal(&self) -> bool {
        self.interface.is_matched() && self.outside.absorption == self.inside.absorption
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium(n: f64) -> Medium {
        Medium::clear(IndexOfRefraction::new(n).expect("valid"))
    }

    #[test]
    fn all_indices_have_an_interface() {
        let indices = [1e-3, 1e-3 + 1e-18, 0.3, 1.0, 999.999, 1e3].map(medium);
        for outside in indices {
            for inside in indices {
                let media = Media::new(outside, inside);
                let eta = inside.index.value() / outside.index.value();
                assert!((media.interface().eta() / eta - 1.0).abs() < 1e-15);
                assert_eq!(media.are_equal(), outside == inside);
            }
        }
    }

    #[test]
    fn what_is_outside_can_change() {
        let solid = Media::solid(Medium::AIR, medium(1.5), 3);
        let in_water = solid.within(medium(1.25));
        assert_eq!(in_water.interface(), Media::new(medium(1.25), medium(1.5)).interface());
        assert_eq!((in_water.inside, in_water.boundary), (solid.inside, Boundary::Solid { priority: 3 }));
    }
}
