//! Rough glass: a distribution of microscopic smooth interfaces.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `interface` | the pair of indices above and below | |
//! | `roughness` | distribution of microscopic normals | [`Ggx`] |
//!
//! With m the microscopic normal, F its Fresnel reflectance and η = n(wi)/n(wo):
//!
//! - reflection, m along wo + wi: `f = F D(m) G2/(4 |cos θo cos θi|)`;
//! - transmission, m along ±(wo + η wi): `f = (1 − F) D(m) G2 |wo·m| |wi·m| η²/(|cos θo cos θi| |wo + η wi|²)`, and 1/η²
//!   of it for radiance.
//!
//! (B. Walter and others, Microfacet Models for Refraction through Rough Surfaces, 2007, equations 20 and 21; D and G2 as in
//! `ggx.rs`.) Normals are sampled as they are seen from `wo`, then one of both children by F: the weight is G2/G1(wo).
//!
//! **Energy.** Light that meets the surface more than once is not followed, so a share 1 − E is lost: at an index of 1.5 and
//! along the normal 0.1 % at roughness 0.1 seen from outside, 58 % at roughness one seen from inside, and more where indices
//! nearly match. [`new`](RoughDielectric::new) makes up for it by the factor 1/E(wo) (E. Turquin, Practical Multiple
//! Scattering Compensation for Microfacet Models, 2019, applied to both lobes together), from a table over direction,
//! roughness and index ratio:
//!
//! - Index ratios in [1/2.5, 2.5]; beyond, nothing is made up for.
//! - For isotropic roughness and ratios that differ from one by 10 % or more the albedo is one within 5e-3 in every
//!   direction and within 1e-3 on average. Where indices match more closely, interpolation may gain up to 1.2 % in single
//!   directions; and from the denser side near the surface, where next to no single scattering is left, the factor ends at
//!   16 and a loss remains. On average both stay below 2e-3.
//! - Roughness that differs by direction counts as √(αx αy). That is an approximation: at (0.2, 0.3) the albedo of single
//!   directions is one within 12 %, at (0.1, 0.4) it is between 0.78 and 1.1 at an index of 1.5 and between 0.66 and 1.24
//!   at 1.2.
//!
//! [`single_scattering`](RoughDielectric::single_scattering) leaves it out.
//!
//! **Reciprocity.** Without compensation `f(wo, wi)/n_o² = f(wi, wo)/n_i²`. The factor 1/E(wo) is not symmetric; for
//! importance it is 1/E(wi), so that the importance a light path carries is the exact adjoint of the radiance of a camera
//! path, and both directions of transport agree.
//!
//! **Smooth limits.** Below roughness 1e-4 ([`Ggx::is_smooth`]) the model is [`FresnelDielectric`], with discrete densities.
//! So it is where indices are so close that the half vectors of transmission are lost to rounding, `α |n_1/n_2 − 1| < 128 ε`
//! for the larger of both ratios: 3e-14 in f64, 1.5e-5 in f32.
//!
//! **Single precision.** A sample's density is that of the direction before it was rounded. For narrow lobes at grazing
//! angles [`pdf`](RoughDielectric::pdf) of the rounded direction differs: by 1 % at most down to roughness 0.02.

use crate::compensation::Compensation;
use crate::ggx::normal_along;
use crate::valid::debug_assert_unit;
use crate::{Density, FresnelDielectric, Ggx, Interface, Lobe, Real, Sample, Split, TransportMode, Vector};

/// Reflects and refracts about microscopic normals.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric<R: Real> {
    interface: Interface<R>,
    roughness: Ggx<R>,
    compensation: Option<Compensation>,
    specular: bool,
}

impl<R: Real> RoughDielectric<R> {
    /// A rough interface that loses no energy, where the table reaches.
    pub fn new(interface: Interface<R>, roughness: Ggx<R>) -> Self {
        let single = Self::single_scattering(interface, roughness);
        let compensation =
            if single.specular { None } else { Compensation::new(&single.interface, &single.roughness) };
        Self { compensation, ..single }
    }

    /// A rough interface that scatters light once.
    pub fn single_scattering(interface: Interface<R>, roughness: Ggx<R>) -> Self {
        // A half vector of wo + η wi is known to about ε/|η − 1|; its slope in units of the roughness must be known better
        // than a hundredth.
        let eta = interface.eta();
        let apart = (eta - R::one()).abs() / eta.at_most(R::one());
        let specular =
            roughness.is_smooth() || apart * roughness.largest_alpha() < R::epsilon() * R::from_f64(128.0);
        Self { interface, roughness, compensation: None, specular }
    }

    /// The pair of indices.
    pub fn interface(&self) -> &Interface<R> {
        &self.interface
    }

    /// The distribution of microscopic normals.
    pub fn roughness(&self) -> &Ggx<R> {
        &self.roughness
    }

    /// True where lost energy is made up for.
    pub fn is_compensated(&self) -> bool {
        self.compensation.is_some()
    }

    /// True in the smooth limits: all densities are discrete.
    #[inline]
    pub fn is_specular(&self) -> bool {
        self.specular
    }

    #[inline]
    fn smooth(&self) -> FresnelDielectric<R> {
        FresnelDielectric { interface: self.interface }
    }

    /// f · |cos θi|, per steradian.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3, mode: TransportMode) -> R::Vec3 {
        let density = self.pdf(wo, wi);
        let value = if density > R::zero() { density * self.weight(wo, wi, mode) } else { R::zero() };
        R::Vec3::splat(value)
    }

    /// The density of [`sample`](Self::sample), per steradian of `wi`.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        debug_assert_unit::<R>(wo);
        debug_assert_unit::<R>(wi);
        let zero = R::zero();
        if self.specular || wi.z() == zero {
            return zero;
        }
        let above = wo.z() >= zero;
        let crossing = self.interface.crossing(above);
        let (wo, wi) = if above { (wo, wi) } else { (wo.mirrored(), wi.mirrored()) };
        let reflects = wi.z() > zero;
        let half = if reflects { wo + wi } else { wo + wi * crossing.eta };
        let Some((m, length_squared)) = normal_along::<R>(half) else { return zero };
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        // Both directions must see the facet from the sides that the lobe says.
        if cos_o <= zero || (cos_i > zero) != reflects {
            return zero;
        }
        let reflected = {
            let c = cos_o.at_most(R::one());
            let e_squared = crossing.e_squared(c);
            if e_squared <= zero { R::one() } else { crossing.reflectance(c, e_squared.sqrt()).unpolarised() }
        };
        let seen = self.roughness.visible_normals_over_cosine(wo, m);
        if reflects {
            reflected * seen / R::from_f64(4.0)
        } else {
            let per_steradian = cos_o * crossing.eta.squared() * cos_i.abs() / length_squared;
            (R::one() - reflected) * seen * per_steradian
        }
    }

    /// f · |cos θi| over the density of sampling.
    #[inline]
    fn weight(&self, wo: R::Vec3, wi: R::Vec3, mode: TransportMode) -> R {
        let upper = |w: R::Vec3| if w.z() < R::zero() { w.mirrored() } else { w };
        let shadowing = self.roughness.shadowing(upper(wo), upper(wi));
        let known = match mode {
            TransportMode::Radiance => wo,
            TransportMode::Importance => wi,
        };
        let made_up_for = self.compensation.map_or(R::one(), |compensation| compensation.scale(known.z()));
        let above = wo.z() >= R::zero();
        let crosses = (wi.z() >= R::zero()) != above;
        let scale = if crosses { mode.crossing_scale(self.interface.crossing(above).eta) } else { R::one() };
        shadowing * made_up_for * scale
    }

    /// A direction for `wi`, from `uc` in [0, 1) that chooses reflection or transmission and a point `u` of the unit square
    /// that chooses the normal; `None` where the direction falls on the wrong side.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R, u: [R; 2], mode: TransportMode) -> Option<Sample<R>> {
        if self.specular {
            return self.smooth().sample(wo, uc, mode);
        }
        debug_assert_unit::<R>(wo);
        let (zero, one) = (R::zero(), R::one());
        let above = wo.z() >= zero;
        let crossing = self.interface.crossing(above);
        let eta = crossing.eta;
        let out = if above { wo } else { wo.mirrored() };
        let m = self.roughness.sample(out, u);
        let c = out.dot(m).at_most(one);
        if c <= zero {
            return None;
        }
        let e_squared = crossing.e_squared(c);
        let e = e_squared.at_least(zero).sqrt();
        let reflected = if e_squared <= zero { one } else { crossing.reflectance(c, e).unpolarised() };
        let seen = self.roughness.visible_normals_over_cosine(out, m);
        let (wi, pdf, lobe, eta) = if uc < reflected {
            let wi = m * (R::from_f64(2.0) * c) - out;
            (wi, reflected * seen / R::from_f64(4.0), Lobe::GlossyReflection, one)
        } else {
            // wo + η wi = (c − e) m, and c − e = −k/(c + e) loses nothing where indices nearly match.
            let along = crossing.k / (c + e);
            let wi = crossing.of_unit_length(-(out + m * along) / eta);
            let per_steradian = c * eta * e / along.squared();
            (wi, (one - reflected) * seen * per_steradian, Lobe::GlossyTransmission, eta)
        };
        if (wi.z() > zero) == lobe.is_transmission() || wi.z() == zero || pdf <= zero {
            return None;
        }
        let wi = if above { wi } else { wi.mirrored() };
        let weight = R::Vec3::splat(self.weight(wo, wi, mode));
        Some(Sample { wi, weight, pdf: Density::SolidAngle(pdf), lobe, eta })
    }

    /// Both children in the smooth limits; a rough surface has none.
    #[inline]
    pub fn split(&self, wo: R::Vec3, mode: TransportMode) -> Split<R> {
        if self.specular { self.smooth().split(wo, mode) } else { Split::NONE }
    }
}
