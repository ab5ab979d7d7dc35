//! Phong's highlight, in its original form and in one that keeps its energy.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `peak` | value of f in the mirror direction, per channel | ≥ 0 |
//! | `exponent` | sharpness | 1 to 1e6 |
//!
//! f = peak · max(0, r·wo)^exponent, with r the mirror direction of `wi`, where `wo` and `wi` are on the same side.
//! Reciprocal. A look, not a measurement. Two ways to choose the peak:
//!
//! - [`unnormalised`](GlossySpecular::unnormalised): peak = ks, as in textbooks. Energy at most 2π ks/(exponent + 1): the
//!   highlight of a sharp lobe stays as bright as that of a blunt one, and the reflected share falls.
//! - [`normalised`](GlossySpecular::normalised): peak = ρ (exponent + 2)/2π. Energy ρ along the normal, less elsewhere: the
//!   sharper the lobe, the brighter its highlight, until it is a mirror.
//!
//! Sources: B. Phong, Illumination for Computer Generated Pictures, 1975; K. Suffern, Ray Tracing from the Ground Up,
//! 2007, chapter 15. Normalisation and sampling of the lobe: E. Lafortune and Y. Willems, Using the Modified Phong
//! Reflectance Model for Physically Based Rendering, 1994.

use crate::valid::debug_assert_unit;
use crate::{Density, Lobe, Real, Sample, Vector};

/// A highlight around the mirror direction.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlossySpecular<R: Real> {
    /// Value of f in the mirror direction, per channel.
    pub peak: R::Vec3,
    /// Sharpness, 1 to 1e6.
    pub exponent: R,
}

impl<R: Real> GlossySpecular<R> {
    /// The textbook's highlight: `ks` is the value of f in the mirror direction, whatever the exponent.
    pub fn unnormalised(ks: R::Vec3, exponent: R) -> Self {
        Self { peak: ks, exponent }
    }

    /// A highlight that returns the share `reflectance` (0 to 1 per channel) of the light along the normal, and less at an
    /// angle.
    pub fn normalised(reflectance: R::Vec3, exponent: R) -> Self {
        let two = R::from_f64(2.0);
        Self { peak: reflectance * ((exponent + two) / (two * R::pi())), exponent }
    }

    /// cos of the angle between `wo` and the mirror direction of `wi`, raised to the exponent; zero on other sides.
    #[inline]
    fn lobe(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        debug_assert_unit::<R>(wo);
        debug_assert_unit::<R>(wi);
        let cos = wo.z() * wi.z() - wo.x() * wi.x() - wo.y() * wi.y();
        // ln c ≤ c − 1: below this bound the power is less than any positive number, and comes out as zero anyway.
        let vanishes = self.exponent * (cos - R::one()) < R::smallest_logarithm();
        if wo.z() * wi.z() <= R::zero() || cos <= R::zero() || vanishes {
            R::zero()
        } else {
            cos.powf(self.exponent)
        }
    }

    /// f · |cos θi|, per steradian.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3) -> R::Vec3 {
        self.peak * (self.lobe(wo, wi) * wi.z().abs())
    }

    /// (exponent + 1)/2π · cos^exponent around the mirror direction of `wo`, per steradian. Integrates to less than one:
    /// the part of the lobe below the surface gives no sample.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        self.lobe(wo, wi) * (self.exponent + R::one()) / (R::from_f64(2.0) * R::pi())
    }

    /// A direction around the mirror direction of `wo`, from a point of the unit square; `None` where it falls below the
    /// surface.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, [u, v]: [R; 2]) -> Option<Sample<R>> {
        let cos = (R::one() - u).powf(R::one() / (self.exponent + R::one()));
        let sin = (R::one() - cos * cos).at_least(R::zero()).sqrt();
        let (sin_phi, cos_phi) = (R::from_f64(2.0) * R::pi() * v).sin_cos();
        let (mirror, x, y) = {
            let m = R::Vec3::new(-wo.x(), -wo.y(), wo.z());
            // Duff et al., Building an Orthonormal Basis, Revisited, 2017.
            let sign = if m.z() < R::zero() { -R::one() } else { R::one() };
            let a = -R::one() / (sign + m.z());
            let b = m.x() * m.y() * a;
            let x = R::Vec3::new(R::one() + sign * m.x() * m.x() * a, sign * b, -(sign * m.x()));
            (m, x, R::Vec3::new(b, sign + m.y() * m.y() * a, -m.y()))
        };
        let wi = x * (sin * cos_phi) + y * (sin * sin_phi) + mirror * cos;
        let pdf = self.pdf(wo, wi);
        (pdf > R::zero()).then(|| Sample {
            wi,
            weight: self.eval(wo, wi) / pdf,
            pdf: Density::SolidAngle(pdf),
            lobe: Lobe::GlossyReflection,
            eta: R::one(),
        })
    }
}
