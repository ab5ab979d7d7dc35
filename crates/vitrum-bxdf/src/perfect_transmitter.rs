//! Glass with constant coefficients: what an introduction to ray tracing calls simple transparency.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `kr` | reflected share, per channel | 0 ≤ kr ≤ 1 |
//! | `kt` | transmitted share, per channel | 0 ≤ kt ≤ 1, kr + kt ≤ 1 |
//! | `interface` | the pair of indices above and below | |
//!
//! Off total internal reflection, `kr` goes in the mirror direction and `kt` in the refracted one; in total internal
//! reflection all light is reflected, whatever `kr` says. The shares do not depend on the angle: for that there is the
//! Fresnel dielectric. Energy: kr + kt. Reciprocal with the factor n² that every refracting surface has.
//! Source: K. Suffern, Ray Tracing from the Ground Up, 2007, chapter 27.

use crate::valid::debug_assert_unit;
use crate::{Density, Interface, Lobe, Real, Refraction, Sample, Split, TransportMode, Vector};

/// Reflects `kr` and transmits `kt`; reflects everything in total internal reflection.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerfectTransmitter<R: Real> {
    /// Reflected share, per channel, 0 to 1.
    pub kr: R::Vec3,
    /// Transmitted share, per channel, 0 to 1.
    pub kt: R::Vec3,
    /// The indices on both sides.
    pub interface: Interface<R>,
}

impl<R: Real> PerfectTransmitter<R> {
    /// Both children. A zero coefficient has none.
    #[inline]
    pub fn split(&self, wo: R::Vec3, mode: TransportMode) -> Split<R> {
        debug_assert_unit::<R>(wo);
        match self.interface.refract(wo) {
            Refraction::TotalInternalReflection => {
                Split { reflected: Some(Sample::mirror(wo, R::Vec3::splat(R::one()))), transmitted: None }
            }
            Refraction::Refracted { wt, eta, .. } => Split {
                reflected: (!self.kr.is_zero()).then(|| Sample::mirror(wo, self.kr)),
                transmitted: (!self.kt.is_zero()).then(|| Sample {
                    wi: wt,
                    weight: self.kt * mode.crossing_scale(eta),
                    pdf: Density::Discrete(R::one()),
                    lobe: Lobe::SpecularTransmission,
                    eta,
                }),
            },
        }
    }

    /// One child, chosen by `uc` in [0, 1) in proportion to the mean coefficients.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R, mode: TransportMode) -> Option<Sample<R>> {
        self.split(wo, mode).choose(uc, self.kr.mean(), self.kt.mean())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn glass() -> PerfectTransmitter<f64> {
        let interface = Interface::new(1.0, 1.5).expect("valid");
        PerfectTransmitter { kr: DVec3::splat(0.1), kt: DVec3::splat(0.9), interface }
    }

    #[test]
    fn radiance_is_scaled_by_the_square_of_the_index_ratio_and_importance_is_not() {
        for (wo, eta) in [(DVec3::Z, 1.5), (-DVec3::Z, 1.0 / 1.5)] {
            let weight = |mode| glass().split(wo, mode).transmitted.expect("crosses").weight.x;
            assert!((weight(TransportMode::Radiance) - 0.9 / (eta * eta)).abs() < 1e-15);
            assert!((weight(TransportMode::Importance) - 0.9).abs() < 1e-15);
        }
    }

    #[test]
    fn in_total_reflection_the_weight_is_one() {
        let split = glass().split(DVec3::new(0.8, 0.0, -0.6), TransportMode::Radiance);
        assert_eq!(split.reflected.expect("reflects").weight, DVec3::ONE);
        assert_eq!(split.transmitted, None);
    }

    #[test]
    fn zero_coefficients_have_no_children() {
        let clear = PerfectTransmitter { kr: DVec3::ZERO, kt: DVec3::ONE, ..glass() };
        assert_eq!(clear.split(DVec3::Z, TransportMode::Radiance).reflected, None);
        let mirror = PerfectTransmitter { kt: DVec3::ZERO, ..glass() };
        assert_eq!(mirror.split(DVec3::Z, TransportMode::Radiance).transmitted, None);
    }

    #[test]
    fn choosing_one_child_has_the_mean_of_both() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let n = 1000;
        let mean: DVec3 = (0..n)
            .filter_map(|i| {
                glass().sample(wo, (f64::from(i) + 0.5) / f64::from(n), TransportMode::Importance)
            })
            .map(|s| s.weight)
            .fold(DVec3::ZERO, |a, b| a + b)
            / f64::from(n);
        assert!((mean - DVec3::ONE).length() < 1e-12, "kr + kt = 1, found {mean:?}");
    }
}
