//! A perfectly diffuse reflector.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `reflectance` | reflected share ρ of the light, per channel | 0 ≤ ρ ≤ 1 |
//!
//! f = ρ/π where `wo` and `wi` are on the same side, else 0. Energy: ρ. Reciprocal. Both sides reflect.
//! Source: J. Lambert, Photometria, 1760.

use crate::valid::debug_assert_unit;
use crate::{Density, Lobe, Real, Sample, Vector};

/// Reflects the same radiance in every direction.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambertian<R: Real> {
    /// Reflected share, per channel, 0 to 1.
    pub reflectance: R::Vec3,
}

impl<R: Real> Lambertian<R> {
    /// f · |cos θi|, per steradian.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3) -> R::Vec3 {
        self.reflectance * self.pdf(wo, wi)
    }

    /// |cos θi| / π, per steradian, on `wo`'s side.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        debug_assert_unit::<R>(wo);
        debug_assert_unit::<R>(wi);
        if wo.z() * wi.z() > R::zero() { wi.z().abs() / R::pi() } else { R::zero() }
    }

    /// A direction on `wo`'s side with density |cos θi|/π, from a point of the unit square.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, [u, v]: [R; 2]) -> Option<Sample<R>> {
        let (sin_phi, cos_phi) = (R::from_f64(2.0) * R::pi() * v).sin_cos();
        let radius = u.sqrt();
        // A direction exactly in the tangent plane has density zero and can't be returned.
        let cos = (R::one() - u).at_least(R::zero()).sqrt();
        let wi =
            R::Vec3::new(radius * cos_phi, radius * sin_phi, if wo.z() < R::zero() { -cos } else { cos });
        let pdf = self.pdf(wo, wi);
        (pdf > R::zero()).then_some(Sample {
            wi,
            weight: self.reflectance,
            pdf: Density::SolidAngle(pdf),
            lobe: Lobe::DiffuseReflection,
            eta: R::one(),
        })
    }
}
