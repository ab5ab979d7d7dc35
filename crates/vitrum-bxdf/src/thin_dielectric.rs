//! A thin sheet: a window pane, a soap film, a bottle's wall, as one surface.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `interface` | above the index on both sides of the sheet, below that of the sheet | |
//! | `transmittance` | share of light that a perpendicular pass through the sheet leaves, per channel | 0 to 1 |
//!
//! Light is reflected back and forth inside; with R the reflectance of one face, T = 1 − R and a the share that one pass
//! leaves, infinitely many reflections sum to R' = R + R T² a²/(1 − R² a²) and T' = T² a/(1 − R² a²). What is transmitted
//! goes straight on: a sheet without thickness shifts nothing. At an angle the pass is longer, a = transmittance^(1/cos θt).
//! Without absorption R' = 2R/(1 + R) and R' + T' = 1. Where indices match, R = 0 and T' = a. Reciprocal, alike from both
//! sides, no factor n². Incoherent: no interference colours.
//! Source: the geometric series of plane-parallel plates; M. Born and E. Wolf, Principles of Optics, 7th ed. 1999,
//! section 7.6.1, without phases.

use crate::valid::debug_assert_unit;
use crate::{Density, Interface, Lobe, Real, Sample, Split, Vector};

/// Reflects from both faces of a sheet and lets the rest go straight on.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric<R: Real> {
    /// Above: what surrounds the sheet, on both sides. Below: what it is made of.
    pub interface: Interface<R>,
    /// Share that a perpendicular pass leaves, per channel, 0 to 1.
    pub transmittance: R::Vec3,
}

impl<R: Real> ThinDielectric<R> {
    /// A sheet that absorbs nothing.
    pub fn clear(interface: Interface<R>) -> Self {
        Self { interface, transmittance: R::Vec3::splat(R::one()) }
    }

    /// The reflected and the transmitted share at this angle, per channel: `cos` is the z component of `wo`; its sign does
    /// not matter.
    #[inline]
    pub fn shares(&self, cos: R) -> (R::Vec3, R::Vec3) {
        let crossing = self.interface.crossing(true);
        let c = cos.abs();
        let e_squared = crossing.e_squared(c);
        let (zero, one) = (R::zero(), R::one());
        if e_squared <= zero {
            return (R::Vec3::splat(one), R::Vec3::splat(zero));
        }
        let e = e_squared.sqrt();
        let r = crossing.reflectance(c, e).unpolarised();
        let t = one - r;
        if self.transmittance == R::Vec3::splat(one) {
            let reflected = (r + r) / (one + r);
            return (R::Vec3::splat(reflected), R::Vec3::splat(one - reflected));
        }
        let longer = crossing.eta / e;
        let pass = self.transmittance.map(|tau| tau.powf(longer));
        // T²a/(1 − R²a²); the denominator without a difference where R and a are nearly one.
        let transmitted = pass.map(|a| {
            let rest = t * (one + r) + r * r * ((one - a) * (one + a));
            if rest > zero { t * t * a / rest } else { zero }
        });
        let reflected = transmitted.zip(pass, |through, a| (r + r * a * through).at_most(one));
        (reflected, transmitted)
    }

    /// Both children. A zero share has none.
    #[inline]
    pub fn split(&self, wo: R::Vec3) -> Split<R> {
        debug_assert_unit::<R>(wo);
        let (reflected, transmitted) = self.shares(wo.z());
        Split {
            reflected: (!reflected.is_zero()).then(|| Sample::mirror(wo, reflected)),
            transmitted: (!transmitted.is_zero()).then(|| Sample {
                wi: -wo,
                weight: transmitted,
                pdf: Density::Discrete(R::one()),
                lobe: Lobe::SpecularTransmission,
                eta: R::one(),
            }),
        }
    }

    /// One child, chosen by `uc` in [0, 1) in proportion to the mean shares.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R) -> Option<Sample<R>> {
        let split = self.split(wo);
        let share = |child: Option<Sample<R>>| child.map_or(R::zero(), |sample| sample.weight.mean());
        split.choose(uc, share(split.reflected), share(split.transmitted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn sheet(n: f64, transmittance: f64) -> ThinDielectric<f64> {
        let interface = Interface::new(1.0, n).expect("valid");
        ThinDielectric { interface, transmittance: DVec3::splat(transmittance) }
    }

    /// Follows the light face by face instead of summing the series.
    fn face_by_face(n: f64, tau: f64, cos: f64) -> (f64, f64) {
        let interface = Interface::new(1.0, n).expect("valid");
        let r = interface.reflectance(cos).unpolarised();
        let sin_t = (1.0 - cos * cos).sqrt() / n;
        let a = tau.powf(1.0 / (1.0 - sin_t * sin_t).sqrt());
        let (mut reflected, mut transmitted, mut inside) = (r, 0.0, 1.0 - r);
        for bounce in 0..4000 {
            inside *= a;
            *if bounce % 2 == 0 { &mut transmitted } else { &mut reflected } += inside * (1.0 - r);
            inside *= r;
        }
        (reflected, transmitted)
    }

    #[test]
    fn the_series_sums_what_the_faces_do() {
        for n in [0.8, 1.0, 1.0001, 1.33, 1.5, 2.42] {
            for tau in [1.0, 0.999, 0.5, 0.0] {
                for cos in [1.0, 0.9, 0.7, 0.3, 0.05] {
                    if n == 0.8 && cos < 0.61 {
                        continue; // total reflection: below
                    }
                    let (r, t) = sheet(n, tau).shares(cos);
                    let (expected_r, expected_t) = face_by_face(n, tau, cos);
                    assert!(
                        (r.x - expected_r).abs() < 1e-13 && (t.x - expected_t).abs() < 1e-13,
                        "{n} {tau} {cos}"
                    );
                }
            }
        }
        assert_eq!(sheet(0.8, 1.0).shares(0.5), (DVec3::ONE, DVec3::ZERO));
    }

    #[test]
    fn a_clear_sheet_reflects_two_r_over_one_plus_r() {
        for cos in [1.0, 0.5, 0.1, -0.5, 1e-9, 0.0] {
            let glass = sheet(1.5, 1.0);
            let one_face = glass.interface.reflectance(f64::abs(cos)).unpolarised();
            let (r, t) = glass.shares(cos);
            assert!((r.x - 2.0 * one_face / (1.0 + one_face)).abs() < 1e-15, "{cos}");
            assert!((r.x + t.x - 1.0).abs() < 1e-15, "{cos}");
        }
    }

    #[test]
    fn matched_indices_only_absorb() {
        let split = sheet(1.0, 0.25).split(DVec3::new(0.8, 0.0, 0.6));
        assert_eq!(split.reflected, None);
        let through = split.transmitted.expect("goes on");
        assert_eq!((through.wi, through.eta), (DVec3::new(-0.8, -0.0, -0.6), 1.0));
        assert!((through.weight.x - 0.25_f64.powf(1.0 / 0.6)).abs() < 1e-15);
    }

    #[test]
    fn choosing_one_child_has_the_mean_of_both() {
        let coloured = ThinDielectric { transmittance: DVec3::new(0.9, 0.5, 0.1), ..sheet(1.5, 1.0) };
        let wo = DVec3::new(0.6, 0.0, -0.8);
        let n = 100_000;
        let choices = (0..n).filter_map(|i| coloured.sample(wo, (f64::from(i) + 0.5) / f64::from(n)));
        let mean = choices.fold(DVec3::ZERO, |sum, sample| sum + sample.weight) / f64::from(n);
        let (r, t) = coloured.shares(wo.z);
        // Each of two strata is one short at most, and weights are below 2.
        assert!((mean - r - t).abs().max_element() < 4.0 / f64::from(n));
    }
}
