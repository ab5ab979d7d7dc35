//! What a surface does to light at one point.

use vitrum_bxdf::{Bxdf, Density, GlossySpecular, Lambertian, Sample, TransportMode, Vector};
use vitrum_math::{DVec3, Rgb};

/// The models at one point. Directions are in the local frame of `vitrum-bxdf`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// Emitted radiance, on the front side.
    pub emitted: Rgb,
    /// What ambient radiance is multiplied by: the share that a matte surface reflects of light from everywhere.
    pub ambient: Rgb,
    /// The diffuse part, where there is one.
    pub diffuse: Option<Lambertian<f64>>,
    /// The highlight, where there is one.
    pub glossy: Option<GlossySpecular<f64>>,
    /// Mirror, glass or metal, where there is one: perfectly specular, or rough.
    pub(crate) body: Option<Bxdf<f64>>,
    /// Which of both.
    pub(crate) is_rough: bool,
}

impl Scattering {
    /// Nothing is emitted and nothing comes back.
    pub const BLACK: Self = Self {
        emitted: Rgb::ZERO,
        ambient: Rgb::ZERO,
        diffuse: None,
        glossy: None,
        body: None,
        is_rough: false,
    };

    /// One model and nothing else.
    #[inline]
    pub(crate) fn of(bxdf: Bxdf<f64>) -> Self {
        Self { body: Some(bxdf), is_rough: !bxdf.is_specular(), ..Self::BLACK }
    }

    /// The same with another mirror, glass or metal.
    #[inline(always)]
    pub fn with_body(self, bxdf: Bxdf<f64>) -> Self {
        Self { body: Some(bxdf), is_rough: !bxdf.is_specular(), ..self }
    }

    /// Mirror, glass or metal, smooth or rough, where there is one.
    pub fn body(&self) -> Option<&Bxdf<f64>> {
        self.body.as_ref()
    }

    /// The perfectly specular part, where there is one.
    #[inline]
    pub fn specular(&self) -> Option<&Bxdf<f64>> {
        if self.is_rough { None } else { self.body.as_ref() }
    }

    /// The rough part of glass and metal, where there is one.
    #[inline]
    pub fn rough(&self) -> Option<&Bxdf<f64>> {
        if self.is_rough { self.body.as_ref() } else { None }
    }

    /// The same on the back side, as paths have it: a Phong part over glass is a coat on its outer side. Within the glass it would
    /// add to light that is totally reflected already, hit after hit.
    #[inline]
    pub fn of_back(self) -> Self {
        match self.body {
            Some(Bxdf::PerfectTransmitter(_)) => Self { diffuse: None, glossy: None, ..self },
            _ => self,
        }
    }

    /// True when light from a point can be scattered towards the viewer: only then are lights asked.
    #[inline]
    pub fn answers_lights(&self) -> bool {
        self.diffuse.is_some() || self.glossy.is_some() || self.is_rough
    }

    /// f · |cos θi| per steradian, of all parts that have a density.
    #[inline]
    pub fn eval(&self, wo: DVec3, wi: DVec3, mode: TransportMode) -> Rgb {
        let diffuse = self.diffuse.map_or(Rgb::ZERO, |b| b.eval(wo, wi));
        let glossy = self.glossy.map_or(Rgb::ZERO, |b| b.eval(wo, wi));
        diffuse + glossy + self.rough().map_or(Rgb::ZERO, |b| b.eval(wo, wi, mode))
    }

    /// The density of [`sample`](Self::sample) per steradian of `wi`.
    #[inline]
    pub fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let shares = self.shares();
        let diffuse = self.diffuse.map_or(0.0, |b| shares.diffuse * b.pdf(wo, wi));
        let glossy = self.glossy.map_or(0.0, |b| shares.glossy * b.pdf(wo, wi));
        diffuse + glossy + self.rough().map_or(0.0, |b| b.pdf(wo, wi))
    }

    /// A direction of the parts that have a density, from `uc` in [0, 1) that chooses among them and their lobes and a point
    /// `u` of the unit square. Its weight is that of all of them, over the density of all of them.
    #[inline]
    pub fn sample(&self, wo: DVec3, uc: f64, u: [f64; 2], mode: TransportMode) -> Option<Sample<f64>> {
        if let Some(rough) = self.rough() {
            return rough.sample(wo, uc, u, mode);
        }
        match (&self.diffuse, &self.glossy) {
            (Some(diffuse), None) => diffuse.sample(wo, u),
            (None, Some(glossy)) => glossy.sample(wo, u),
            (Some(diffuse), Some(glossy)) => {
                let one =
                    if uc < self.shares().diffuse { diffuse.sample(wo, u) } else { glossy.sample(wo, u) }?;
                let density = self.pdf(wo, one.wi);
                let weight = self.eval(wo, one.wi, mode) / density;
                (density > 0.0).then_some(Sample { weight, pdf: Density::SolidAngle(density), ..one })
            }
            (None, None) => None,
        }
    }

    /// Roughly the share of light that the parts with a density give back: what they weigh against specular ones.
    #[inline]
    pub fn albedo(&self) -> f64 {
        let rough = if self.is_rough { 1.0 } else { 0.0 };
        rough + self.diffuse_albedo() + self.glossy_albedo()
    }

    fn diffuse_albedo(&self) -> f64 {
        self.diffuse.map_or(0.0, |b| b.reflectance.max_element())
    }

    /// Of light along the normal: the integral of the lobe, 2π peak/(exponent + 2).
    fn glossy_albedo(&self) -> f64 {
        self.glossy.map_or(0.0, |b| b.peak.max_element() * (std::f64::consts::TAU / (b.exponent + 2.0)))
    }

    /// How often the diffuse part and the highlight are chosen, where there are both. A rough part stands alone.
    #[inline]
    fn shares(&self) -> Shares {
        match (&self.diffuse, &self.glossy) {
            (Some(_), Some(_)) => {
                let (diffuse, glossy) = (self.diffuse_albedo(), self.glossy_albedo());
                let diffuse = diffuse / (diffuse + glossy);
                Shares { diffuse, glossy: 1.0 - diffuse }
            }
            _ => Shares { diffuse: 1.0, glossy: 1.0 },
        }
    }
}

struct Shares {
    diffuse: f64,
    glossy: f64,
}

/// A part with a zero coefficient is no part: it is not evaluated.
pub(crate) fn unless_zero<T>(coefficient: Rgb, part: T) -> Option<T> {
    (!coefficient.is_zero()).then_some(part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, Phong, Texture};
    use vitrum_math::DVec2;

    /// With the same numbers, sampling a mixture and integrating its value over the hemisphere give the same share: both by
    /// a million stratified points.
    #[test]
    fn a_mixture_is_sampled_as_it_is_evaluated() {
        let colour = Texture::Constant(Rgb::new(0.3, 0.6, 0.2));
        let phong = Phong { colour, kd: 0.5, ks: Rgb::splat(0.9), exponent: 20.0, ..Phong::NONE };
        let scattering =
            Material::Phong(phong).scattering(&mut (DVec3::ZERO, || -> DVec2 { unreachable!() }));
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let (mut sampled, mut integrated, mut densities) = (Rgb::ZERO, Rgb::ZERO, 0.0);
        let edge = 100;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(edge);
        for i in 0..edge {
            for j in 0..edge {
                for k in 0..edge {
                    if let Some(s) = scattering.sample(wo, at(k), [at(i), at(j)], TransportMode::Radiance) {
                        sampled += s.weight;
                        assert_eq!(s.pdf, Density::SolidAngle(scattering.pdf(wo, s.wi)));
                    }
                }
                let (z, phi) = (at(i), std::f64::consts::TAU * at(j));
                let r = (1.0 - z * z).sqrt();
                let wi = DVec3::new(r * phi.cos(), r * phi.sin(), z);
                integrated += scattering.eval(wo, wi, TransportMode::Radiance);
                densities += scattering.pdf(wo, wi);
            }
        }
        let points = f64::from(edge * edge);
        let (sampled, integrated) =
            (sampled / (points * f64::from(edge)), integrated * std::f64::consts::TAU / points);
        // Half steps of the grids.
        assert!((sampled - integrated).abs().max_element() < 2e-3, "{sampled} {integrated}");
        let total = densities * std::f64::consts::TAU / points;
        assert!(total <= 1.0 + 1e-3 && total > 0.9, "{total}");
    }
}
