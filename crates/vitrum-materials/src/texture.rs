//! Colours that vary in space.

use crate::ImageTexture;
use vitrum_math::{DVec2, DVec3, Rgb};

/// A colour at each point of a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// The same everywhere.
    Constant(Rgb),
    /// Two colours in turn.
    Checker(Checker),
    /// An image.
    Image(ImageTexture),
}

/// A checkerboard, or a lattice of cubes, in world space.
///
/// | parameter | meaning | range |
/// |---|---|---|
/// | `even`, `odd` | the two colours; `even` has its corner at the origin, towards positive coordinates | |
/// | `size` | edge of a cell, metres | > 0 |
/// | `origin` | a corner of the pattern, metres | finite |
/// | `axes` | the coordinates that count: two for a floor, three for a solid | at least one |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// Colour of the cells whose coordinates sum to an even number.
    pub even: Rgb,
    /// Colour of the others.
    pub odd: Rgb,
    /// Edge of a cell, metres.
    pub size: f64,
    /// A corner of the pattern, metres.
    pub origin: DVec3,
    /// The coordinates that count.
    pub axes: Axes,
}

/// A subset of the three coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    /// The first counts.
    pub x: bool,
    /// The second counts.
    pub y: bool,
    /// The third counts.
    pub z: bool,
}

/// A place on a surface, as textures ask for it: a colour that is the same everywhere asks for nothing.
pub trait Place {
    /// The point in the world.
    fn point(&mut self) -> DVec3;
    /// Its texture coordinates.
    fn uv(&mut self) -> DVec2;
}

/// A point, and what works out its texture coordinates.
impl<F: FnMut() -> DVec2> Place for (DVec3, F) {
    #[inline(always)]
    fn point(&mut self) -> DVec3 {
        self.0
    }

    #[inline(always)]
    fn uv(&mut self) -> DVec2 {
        self.1()
    }
}

impl Texture {
    /// The colour at a place, which is asked for what is needed of it.
    #[inline]
    pub fn at(&self, place: &mut impl Place) -> Rgb {
        match self {
            Self::Constant(colour) => *colour,
            Self::Checker(checker) => checker.at(place.point()),
            Self::Image(image) => image.at(place.uv()),
        }
    }

    /// True where it is not the same everywhere.
    pub fn varies(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }

    /// The image, where it is one: it needs texture coordinates.
    pub fn image(&self) -> Option<&ImageTexture> {
        match self {
            Self::Image(image) => Some(image),
            _ => None,
        }
    }

    /// The largest value of any channel anywhere.
    pub fn brightest(&self) -> f64 {
        match self {
            Self::Constant(colour) => colour.max_element(),
            Self::Checker(checker) => checker.even.max(checker.odd).max_element(),
            Self::Image(image) => image.brightest().max_element(),
        }
    }

    /// How bright it is roughly, on the whole: zero only where it is black everywhere. A single bright texel does not make an
    /// image bright.
    pub fn brightness(&self) -> f64 {
        match self {
            Self::Image(image) => image.mean().max_element(),
            _ => self.brightest(),
        }
    }
}

impl Checker {
    #[inline]
    fn at(&self, point: DVec3) -> Rgb {
        let cell = (point - self.origin) / self.size;
        let odd = |counts: bool, x: f64| counts && floor(x) & 1 == 1;
        let is_odd = odd(self.axes.x, cell.x) ^ odd(self.axes.y, cell.y) ^ odd(self.axes.z, cell.z);
        if is_odd { self.odd } else { self.even }
    }
}

/// The largest whole number that is not above `x`; the nearest that there is for magnitudes beyond 2⁶³, where every cell is
/// much smaller than the rounding of the coordinate.
#[inline]
fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    towards_zero.saturating_sub(i64::from(x < towards_zero as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_differ_across_every_axis_that_counts() {
        let axes = Axes { x: true, y: false, z: true };
        let checker = Checker { even: Rgb::ONE, odd: Rgb::ZERO, size: 0.5, origin: DVec3::ZERO, axes };
        let at = |x: f64, y: f64, z: f64| {
            Texture::Checker(checker).at(&mut (DVec3::new(x, y, z), || -> DVec2 { unreachable!() }))
        };
        assert_eq!(at(0.1, 0.0, 0.1), Rgb::ONE);
        assert_eq!(at(-0.1, 0.0, 0.1), Rgb::ZERO);
        assert_eq!(at(0.1, 0.0, 0.6), Rgb::ZERO);
        assert_eq!(at(-0.1, 0.0, -0.1), Rgb::ONE);
        assert_eq!(at(0.1, 0.7, 0.1), Rgb::ONE, "height does not count");
    }

    #[test]
    fn floors_like_the_library() {
        for x in [-2.0, -1.5, -1.0, -1e-300, -0.0, 0.0, 0.5, 1.0, 7.999, -1e15, 123_456_789.75] {
            assert_eq!(floor(x) as f64, f64::floor(x), "{x}");
        }
        floor(f64::INFINITY);
        floor(f64::NAN);
    }
}
