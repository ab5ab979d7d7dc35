//! Media by name. Indices are against vacuum at the helium d line (587.56 nm) or the sodium D lines (589.3 nm), at room temperature.
//!
//! | name | index | measured by |
//! |---|---|---|
//! | air, vacuum | 1 | not told apart |
//! | water | 1.333 | IAPWS, Release on the Refractive Index of Ordinary Water Substance, R9-97; absorption: R. Pope and E. Fry, Absorption Spectrum (380-700 nm) of Pure Water, 1997, table 3, at 610, 550 and 460 nm |
//! | ice | 1.309 | S. Warren and R. Brandt, Optical Constants of Ice, 2008 |
//! | ethanol, glycerol | 1.361, 1.4746 | CRC Handbook of Chemistry and Physics |
//! | soda-lime glass | 1.523 | M. Rubin, Optical Properties of Soda Lime Silica Glasses, 1985 (clear float glass) |
//! | N-BK7, N-SF11 | 1.5168, 1.7847 | SCHOTT, Optical Glass Data Sheets, 2017 |
//! | fused silica | 1.4585 | I. Malitson, Interspecimen Comparison of the Refractive Index of Fused Silica, 1965 |
//! | acrylic | 1.491 | Evonik, data sheet of PLEXIGLAS GS/XT (ISO 489) |
//! | amber | 1.54 | R. Webster, Gems, 5th ed. 1994 |
//! | sapphire | 1.768 | I. Malitson and M. Dodge, Refractive Index and Birefringence of Synthetic Sapphire, 1972 (ordinary ray) |
//! | diamond | 2.4175 | F. Peter, Über Brechungsindizes und Absorptionskonstanten des Diamanten, 1923 |
//!
//! Only water absorbs here: what colour the others have depends on what is dissolved in them.

use crate::{Absorption, IndexOfRefraction, Medium};
use vitrum_math::Rgb;

/// A medium with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedMedium {
    /// What scenes call it.
    pub name: &'static str,
    /// What it does.
    pub medium: Medium,
}

const fn clear(name: &'static str, index: f64) -> NamedMedium {
    NamedMedium { name, medium: Medium::clear(IndexOfRefraction(index)) }
}

const WATER: Medium =
    Medium { index: IndexOfRefraction(1.333), absorption: Absorption(Rgb::new(0.2644, 0.0565, 0.00979)) };

impl NamedMedium {
    /// All of them.
    pub const ALL: &[Self] = &[
        clear("air", 1.0),
        clear("vacuum", 1.0),
        Self { name: "water", medium: WATER },
        clear("ice", 1.309),
        clear("ethanol", 1.361),
        clear("glycerol", 1.4746),
        clear("soda-lime glass", 1.523),
        clear("N-BK7", 1.5168),
        clear("N-SF11", 1.7847),
        clear("fused silica", 1.4585),
        clear("acrylic", 1.491),
        clear("amber", 1.54),
        clear("sapphire", 1.768),
        clear("diamond", 2.4175),
    ];

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|medium| medium.name == name).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// W. Sellmeier's formula, n² = 1 + Σ B λ²/(λ² − C), with the coefficients that the sources of the table give; wavelengths in
    /// micrometres, resonances squared.
    fn sellmeier(terms: &[(f64, f64)], wavelength: f64) -> f64 {
        let square = wavelength * wavelength;
        (1.0 + terms.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt()
    }

    #[test]
    fn indices_are_those_of_the_published_formulas() {
        const D: f64 = 0.587_56;
        let squared = |(b, l): (f64, f64)| (b, l * l);
        let silica = [(0.696_166_3, 0.068_404_3), (0.407_942_6, 0.116_241_4), (0.897_479_4, 9.896_161)];
        let sapphire = [(1.431_349_3, 0.072_663_1), (0.650_547_13, 0.119_324_2), (5.341_402_1, 18.028_251)];
        let diamond = [(0.330_6, 0.175), (4.335_6, 0.106)];
        let bk7 =
            [(1.039_612_12, 0.006_000_698_67), (0.231_792_344, 0.020_017_914_4), (1.010_469_45, 103.560_653)];
        let sf11 =
            [(1.737_596_95, 0.013_188_707), (0.313_747_346, 0.062_306_814_2), (1.898_781_01, 155.236_29)];
        let float_glass = 1.513 - 0.003_169 * D * D + 0.003_962 / (D * D);
        let published = [
            ("fused silica", sellmeier(&silica.map(squared), D)),
            ("sapphire", sellmeier(&sapphire.map(squared), D)),
            ("diamond", sellmeier(&diamond.map(squared), 0.589_3)),
            ("N-BK7", sellmeier(&bk7, D)),
            ("N-SF11", sellmeier(&sf11, D)),
            ("soda-lime glass", float_glass),
        ];
        for (name, index) in published {
            let medium = NamedMedium::named(name).expect("it is in the table").medium;
            // The last digit of the table.
            assert!((medium.index.value() - index).abs() <= 5.1e-4, "{name}: {index}");
        }
    }

    #[test]
    fn names_are_given_once() {
        for (place, medium) in NamedMedium::ALL.iter().enumerate() {
            assert_eq!(NamedMedium::ALL.iter().position(|m| m.name == medium.name), Some(place));
            assert_eq!(IndexOfRefraction::new(medium.medium.index.value()), Ok(medium.medium.index));
        }
    }
}
