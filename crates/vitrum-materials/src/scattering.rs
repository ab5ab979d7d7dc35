//! What a surface does to light at one point.

use vitrum_bxdf::{Bxdf, GlossySpecular, Lambertian, Split, TransportMode, Vector};
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
    /// The perfectly specular part, where there is one.
    pub specular: Option<Bxdf<f64>>,
}

impl Scattering {
    /// Nothing is emitted and nothing comes back.
    pub const BLACK: Self =
        Self { emitted: Rgb::ZERO, ambient: Rgb::ZERO, diffuse: None, glossy: None, specular: None };

    /// True when light from a point can be reflected towards the viewer: only then are lights asked.
    #[inline]
    pub fn answers_lights(&self) -> bool {
        self.diffuse.is_some() || self.glossy.is_some()
    }

    /// f · |cos θi| per steradian, of all parts that have a density.
    #[inline]
    pub fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        let diffuse = self.diffuse.map_or(Rgb::ZERO, |b| b.eval(wo, wi));
        diffuse + self.glossy.map_or(Rgb::ZERO, |b| b.eval(wo, wi))
    }

    /// The perfectly specular children.
    #[inline]
    pub fn split(&self, wo: DVec3, mode: TransportMode) -> Split<f64> {
        self.specular.map_or(Split::NONE, |b| b.split(wo, mode))
    }
}

/// A part with a zero coefficient is no part: it is not evaluated.
pub(crate) fn unless_zero<T>(coefficient: Rgb, part: T) -> Option<T> {
    (!coefficient.is_zero()).then_some(part)
}
