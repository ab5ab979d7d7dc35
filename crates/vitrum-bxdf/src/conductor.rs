//! Metals, smooth and rough.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `index` | n + ik of the metal over the index outside, per channel | see [`ComplexIndex`] |
//! | `roughness` | distribution of microscopic normals | [`Ggx`] |
//!
//! f = F(wo·m) D(m) G2(wo, wi)/(4 |cos θo cos θi|) with m half-way between both; smooth where [`Ggx::is_smooth`]. What is
//! not reflected is absorbed. Energy: at most F; light that is reflected more than once within the roughness is lost, at
//! roughness one up to 70 % along the surface, and not made up for. Reciprocal. Reflects on both sides.
//! Source: R. Cook and K. Torrance, A Reflectance Model for Computer Graphics, 1982; B. Walter and others, 2007, equation 20;
//! F is in [`fresnel`](crate::fresnel), D and G2 in [`ggx`](crate::ggx).

use crate::ggx::normal_along;
use crate::valid::debug_assert_unit;
use crate::{ComplexIndex, Density, Ggx, Lobe, Real, Sample, Split, Vector};

/// Reflects as a metal does.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor<R: Real> {
    /// The metal's index against what is outside.
    pub index: ComplexIndex<R>,
    /// How its microscopic normals are distributed.
    pub roughness: Ggx<R>,
}

impl<R: Real> Conductor<R> {
    /// True where it mirrors: all densities are discrete.
    #[inline]
    pub fn is_specular(&self) -> bool {
        self.roughness.is_smooth()
    }

    /// f · |cos θi|, per steradian.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3) -> R::Vec3 {
        self.facet(wo, wi).map_or(R::Vec3::splat(R::zero()), |(density, m)| {
            let (wo, wi) = upward::<R>(wo, wi);
            self.index.reflectance(wo.dot(m).at_least(R::zero()).at_most(R::one()))
                * (density * self.roughness.shadowing(wo, wi))
        })
    }

    /// The density of [`sample`](Self::sample), per steradian of `wi`.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        self.facet(wo, wi).map_or(R::zero(), |(density, _)| density)
    }

    /// The density of reflection from `wo` to `wi`, and the normal that does it; none where there is none.
    #[inline]
    fn facet(&self, wo: R::Vec3, wi: R::Vec3) -> Option<(R, R::Vec3)> {
        debug_assert_unit::<R>(wo);
        debug_assert_unit::<R>(wi);
        if self.is_specular() || wi.z() == R::zero() || (wo.z() >= R::zero()) != (wi.z() > R::zero()) {
            return None;
        }
        let (wo, wi) = upward::<R>(wo, wi);
        let (m, _) = normal_along::<R>(wo + wi)?;
        Some((self.roughness.visible_normals_over_cosine(wo, m) / R::from_f64(4.0), m))
    }

    /// A direction for `wi`, from a point of the unit square; `None` where it falls below the surface.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, u: [R; 2]) -> Option<Sample<R>> {
        debug_assert_unit::<R>(wo);
        if self.is_specular() {
            return self.split(wo).reflected;
        }
        let above = wo.z() >= R::zero();
        let out = if above { wo } else { wo.mirrored() };
        let m = self.roughness.sample(out, u);
        let cos = out.dot(m);
        let wi = m * (R::from_f64(2.0) * cos) - out;
        let pdf = self.roughness.visible_normals_over_cosine(out, m) / R::from_f64(4.0);
        (wi.z() > R::zero() && cos > R::zero() && pdf > R::zero()).then(|| Sample {
            wi: if above { wi } else { wi.mirrored() },
            weight: self.index.reflectance(cos.at_most(R::one())) * self.roughness.shadowing(out, wi),
            pdf: Density::SolidAngle(pdf),
            lobe: Lobe::GlossyReflection,
            eta: R::one(),
        })
    }

    /// The one child of a smooth metal; a rough one has none.
    #[inline]
    pub fn split(&self, wo: R::Vec3) -> Split<R> {
        debug_assert_unit::<R>(wo);
        let mirror = || Sample::mirror(wo, self.index.reflectance(wo.z().abs().at_most(R::one())));
        Split { reflected: self.is_specular().then(mirror), transmitted: None }
    }
}

/// Two directions of the same side, seen from the upper one.
#[inline]
fn upward<R: Real>(wo: R::Vec3, wi: R::Vec3) -> (R::Vec3, R::Vec3) {
    if wo.z() >= R::zero() { (wo, wi) } else { (wo.mirrored(), wi.mirrored()) }
}
