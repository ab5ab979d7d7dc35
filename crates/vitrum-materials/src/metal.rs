//! Metals by name: measured indices of refraction, reduced to three channels.
//!
//! | name | measured by |
//! |---|---|
//! | copper, gold, silver | P. Johnson and R. Christy, Optical Constants of the Noble Metals, 1972 |
//! | iron, nickel, titanium | P. Johnson and R. Christy, Optical Constants of Transition Metals, 1974 |
//! | aluminium | A. Rakić, Algorithm for the Determination of Intrinsic Optical Constants of Metal Films, 1995 |
//! | tungsten | J. Weaver, C. Olson and D. Lynch, Optical Properties of Crystalline Tungsten, 1975 |
//! | mercury | T. Inagaki, E. Arakawa and M. Williams, Optical Properties of Liquid Mercury, 1981 |
//! | brass (70 % copper, 30 % zinc) | M. Querry, Optical Constants, 1985 |
//! | chromium, platinum | A. Rakić and others, Optical Properties of Metallic Films, 1998 (Brendel and Bormann's model, fitted to several sources) |
//!
//! Films differ by how they were made: Johnson and Christy's chromium reflects a tenth less than
//! that chosen here, with which E. Palik's handbook (1991) agrees to 0.04.
//!
//! **From spectra to channels.** No mean of n and of k gives the colour of a metal, because reflectance is not linear in them.
//! So n and k of a channel are the pair that gives two reflectances right, both of the spectrum under illuminant D65, seen by the
//! CIE's observer of 1931 and brought to Rec.709: that at normal incidence, and the mean over all directions (weighted by the
//! cosine). There is one such pair for each. Where a colour lies outside of Rec.709, as gold does by 6 % in red, the channel is
//! bounded by the most that the metal reflects at any wavelength from 380 to 780 nm. The spectra stand in `tests/metals`, and
//! `tests/metals.rs` computes the table from them.

use crate::metal_table::{COUNT, TABLE};
use vitrum_math::Rgb;

/// A metal of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Metal(usize);

impl Metal {
    /// Their names, in alphabetical order.
    pub const NAMES: &[&str] = &names();

    /// The metal of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|metal| metal.name() == name)
    }

    /// All of them, in the order of their names.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..COUNT).map(Self)
    }

    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        TABLE[self.0].0
    }

    /// The real part of its index against vacuum.
    pub fn n(self) -> Rgb {
        Rgb::from_array(TABLE[self.0].1)
    }

    /// The imaginary part.
    pub fn k(self) -> Rgb {
        Rgb::from_array(TABLE[self.0].2)
    }
}

const fn names() -> [&'static str; COUNT] {
    let mut names = [""; COUNT];
    let mut i = 0;
    while i < COUNT {
        names[i] = TABLE[i].0;
        i += 1;
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_sorted_and_found() {
        assert!(Metal::NAMES.is_sorted());
        for (metal, name) in Metal::all().zip(Metal::NAMES) {
            assert_eq!(Metal::named(name), Some(metal));
            assert_eq!(metal.name(), *name);
        }
        assert_eq!(Metal::named("unobtainium"), None);
    }
}
