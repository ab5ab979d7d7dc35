//! Absorption in a medium: the law of Bouguer, Lambert and Beer.
//!
//! Along a distance d the share exp(−σ d) of the light is left. σ (`sigma_a`) is given per metre and channel, or by the share
//! that is left after a stated distance: σ = −ln(share)/distance.
//! Source: M. Born and E. Wolf, Principles of Optics, 7th ed. 1999, section 14.1.

use vitrum_math::Rgb;

/// How much of the light a medium absorbs: a coefficient per metre and channel, none negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Absorption(pub(crate) Rgb);

/// Numbers that describe no absorption.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidAbsorption {
    /// A coefficient that is negative or not finite.
    #[error("absorption coefficients must be 0 or more per metre, found [{}, {}, {}]", .0.x, .0.y, .0.z)]
    Coefficient(Rgb),
    /// A share outside 0 (excluded) to 1.
    #[error("transmittance must be more than 0 and at most 1, found [{}, {}, {}]", .0.x, .0.y, .0.z)]
    Transmittance(Rgb),
    /// A distance that is not positive.
    #[error("the distance that a transmittance belongs to must be more than 0 metres, found {0}")]
    Distance(f64),
}

impl Absorption {
    /// A clear medium.
    pub const NONE: Self = Self(Rgb::ZERO);

    /// From coefficients per metre.
    ///
    /// # Errors
    /// [`InvalidAbsorption::Coefficient`].
    pub fn per_metre(sigma_a: Rgb) -> Result<Self, InvalidAbsorption> {
        let valid = sigma_a.is_finite() && sigma_a.min_element() >= 0.0;
        if valid { Ok(Self(sigma_a)) } else { Err(InvalidAbsorption::Coefficient(sigma_a)) }
    }

    /// From the share that is left after `distance` metres.
    ///
    /// # Errors
    /// [`InvalidAbsorption`] for a share that is zero or above one, or a distance that is not positive.
    pub fn from_transmittance(transmittance: Rgb, distance: f64) -> Result<Self, InvalidAbsorption> {
        if !(transmittance.min_element() > 0.0 && transmittance.max_element() <= 1.0) {
            return Err(InvalidAbsorption::Transmittance(transmittance));
        }
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(InvalidAbsorption::Distance(distance));
        }
        let logarithm = |share: f64| 0.0 - libm::log(share);
        let optical =
            Rgb::new(logarithm(transmittance.x), logarithm(transmittance.y), logarithm(transmittance.z));
        Self::per_metre(optical / distance)
    }

    /// True for a clear medium.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.0 == Rgb::ZERO
    }

    /// The coefficients, per metre.
    pub const fn sigma_a(&self) -> Rgb {
        self.0
    }

    /// The share that is left after `distance` metres, which may be infinite.
    #[inline]
    pub fn transmittance(&self, distance: f64) -> Rgb {
        let left = |sigma: f64| if sigma == 0.0 { 1.0 } else { libm::exp(-(sigma * distance)) };
        Rgb::new(left(self.0.x), left(self.0.y), left(self.0.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_share_is_left_after_the_stated_distance() {
        let share = Rgb::new(0.9, 0.5, 1.0);
        let glass = Absorption::from_transmittance(share, 0.02).expect("valid");
        assert!((glass.transmittance(0.02) - share).abs().max_element() < 1e-15);
        assert!((glass.transmittance(0.04) - share * share).abs().max_element() < 1e-15);
        assert_eq!(glass.transmittance(f64::INFINITY), Rgb::new(0.0, 0.0, 1.0));
        assert_eq!(glass.transmittance(0.0), Rgb::ONE);
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(Absorption::per_metre(Rgb::new(1.0, -1e-9, 0.0)).is_err());
        assert!(Absorption::per_metre(Rgb::splat(f64::NAN)).is_err());
        assert!(Absorption::from_transmittance(Rgb::ZERO, 1.0).is_err());
        assert!(Absorption::from_transmittance(Rgb::splat(1.1), 1.0).is_err());
        assert!(Absorption::from_transmittance(Rgb::ONE, 0.0).is_err());
    }
}
