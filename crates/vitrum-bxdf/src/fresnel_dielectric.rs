//! Smooth glass: Fresnel's reflectance at every angle, the rest is refracted.
//!
//! | parameter | meaning |
//! |---|---|
//! | `interface` | the pair of indices above and below |
//!
//! Nothing is absorbed: reflected and transmitted shares add up to one, exactly. Absorption belongs to the medium between
//! two surfaces. Reciprocal with the factor n² that every refracting surface has. Indices that match reflect nothing and
//! change no bit of the direction (but light that runs exactly along the surface is reflected, as at every surface); those that nearly match reflect (n − 1)²/4 and a little more.
//! Source: A. Fresnel, 1823; M. Born and E. Wolf, Principles of Optics, 7th ed. 1999, section 1.5.2.

use crate::valid::debug_assert_unit;
use crate::{Density, Interface, Lobe, Real, Sample, Split, TransportMode, Vector};

/// Reflects and refracts as the Fresnel equations say.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FresnelDielectric<R: Real> {
    /// The indices on both sides.
    pub interface: Interface<R>,
}

impl<R: Real> FresnelDielectric<R> {
    /// Both children. In total internal reflection, and where indices match, there is one.
    #[inline]
    pub fn split(&self, wo: R::Vec3, mode: TransportMode) -> Split<R> {
        debug_assert_unit::<R>(wo);
        let crossing = self.interface.crossing(wo.z() >= R::zero());
        let c = wo.z().abs();
        let e_squared = crossing.e_squared(c);
        if e_squared <= R::zero() {
            return Split {
                reflected: Some(Sample::mirror(wo, R::Vec3::splat(R::one()))),
                transmitted: None,
            };
        }
        let e = e_squared.sqrt();
        let reflected = crossing.reflectance(c, e).unpolarised();
        let transmitted = R::one() - reflected;
        Split {
            reflected: (reflected > R::zero()).then(|| Sample::mirror(wo, R::Vec3::splat(reflected))),
            transmitted: (transmitted > R::zero()).then(|| Sample {
                wi: crossing.refracted(wo, e).0,
                weight: R::Vec3::splat(transmitted * mode.crossing_scale(crossing.eta)),
                pdf: Density::Discrete(R::one()),
                lobe: Lobe::SpecularTransmission,
                eta: crossing.eta,
            }),
        }
    }

    /// One child, chosen by `uc` in [0, 1) in proportion to the shares: the weight of a reflection is one.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R, mode: TransportMode) -> Option<Sample<R>> {
        let split = self.split(wo, mode);
        let reflection = split.reflected.map_or(R::zero(), |sample| sample.weight.x());
        split.choose(uc, reflection, R::one() - reflection)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn glass(above: f64, below: f64) -> FresnelDielectric<f64> {
        FresnelDielectric { interface: Interface::new(above, below).expect("valid") }
    }

    fn shares(split: &Split<f64>) -> (f64, f64) {
        let weight = |sample: &Option<Sample<f64>>| sample.map_or(0.0, |s| s.weight.x);
        (weight(&split.reflected), weight(&split.transmitted))
    }

    #[test]
    fn reflected_and_transmitted_shares_add_up_to_one() {
        for (above, below) in [(1.0, 1.5), (1.5, 1.0), (1.0, 1.0003), (1.33, 2.42), (1.0, 1000.0)] {
            for i in 0..=1000 {
                let z = f64::from(i) / 1000.0;
                let wo = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let (r, t) = shares(&glass(above, below).split(wo, TransportMode::Importance));
                assert!((r + t - 1.0).abs() <= f64::EPSILON, "{above} over {below} at {z}: {r} + {t}");
            }
        }
    }

    #[test]
    fn choosing_one_child_takes_each_in_proportion_and_weighs_it_with_one() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let (r, _) = shares(&glass(1.0, 1.5).split(wo, TransportMode::Importance));
        for (uc, lobe, pdf) in [
            (0.0, Lobe::SpecularReflection, r),
            (r - 1e-12, Lobe::SpecularReflection, r),
            (r + 1e-12, Lobe::SpecularTransmission, 1.0 - r),
            (0.999_999, Lobe::SpecularTransmission, 1.0 - r),
        ] {
            let sample = glass(1.0, 1.5).sample(wo, uc, TransportMode::Importance).expect("never absorbed");
            assert_eq!((sample.lobe, sample.pdf), (lobe, Density::Discrete(pdf)));
            assert!((sample.weight - DVec3::ONE).length() < 1e-15);
        }
    }

    #[test]
    fn what_matches_is_not_there() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let split = glass(1.33, 1.33).split(wo, TransportMode::Radiance);
        assert_eq!(split.reflected, None);
        let through = split.transmitted.expect("crosses");
        assert_eq!((through.wi, through.weight, through.eta), (-wo, DVec3::ONE, 1.0));
    }

    #[test]
    fn radiance_is_scaled_by_the_square_of_the_index_ratio_and_importance_is_not() {
        for (wo, eta) in [(DVec3::Z, 1.5), (-DVec3::Z, 1.0 / 1.5)] {
            let weight = |mode| shares(&glass(1.0, 1.5).split(wo, mode)).1;
            assert!((weight(TransportMode::Radiance) - 0.96 / (eta * eta)).abs() < 1e-15);
            assert!((weight(TransportMode::Importance) - 0.96).abs() < 1e-15);
        }
    }
}
