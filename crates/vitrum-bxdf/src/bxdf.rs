//! The closed family of models, listed once.

use crate::{
    GlossySpecular, Lambertian, PerfectSpecular, PerfectTransmitter, Real, Sample, Split, TransportMode,
    Vector,
};

/// One scattering model with its parameters. A plain value: copy it, keep it on the stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bxdf<R: Real> {
    /// Diffuse reflection.
    Lambertian(Lambertian<R>),
    /// Phong's highlight.
    GlossySpecular(GlossySpecular<R>),
    /// Perfect mirror.
    PerfectSpecular(PerfectSpecular<R>),
    /// Glass with constant coefficients.
    PerfectTransmitter(PerfectTransmitter<R>),
}

const _: () = assert!(size_of::<Bxdf<f64>>() <= 128 && size_of::<Bxdf<f32>>() <= 64);

impl<R: Real> Bxdf<R> {
    /// f · |cos θi| per steradian; zero for perfectly specular models.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3) -> R::Vec3 {
        match self {
            Self::Lambertian(b) => b.eval(wo, wi),
            Self::GlossySpecular(b) => b.eval(wo, wi),
            Self::PerfectSpecular(_) | Self::PerfectTransmitter(_) => R::Vec3::splat(R::zero()),
        }
    }

    /// The density of [`sample`](Self::sample) per steradian of `wi`; zero for perfectly specular models.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        match self {
            Self::Lambertian(b) => b.pdf(wo, wi),
            Self::GlossySpecular(b) => b.pdf(wo, wi),
            Self::PerfectSpecular(_) | Self::PerfectTransmitter(_) => R::zero(),
        }
    }

    /// A direction for `wi`, from `uc` in [0, 1) that chooses a lobe and a point `u` of the unit square; `None` where the
    /// model reflects nothing or the direction falls below the surface.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R, u: [R; 2], mode: TransportMode) -> Option<Sample<R>> {
        match self {
            Self::Lambertian(b) => b.sample(wo, u),
            Self::GlossySpecular(b) => b.sample(wo, u),
            Self::PerfectSpecular(b) => b.sample(wo),
            Self::PerfectTransmitter(b) => b.sample(wo, uc, mode),
        }
    }

    /// Both perfectly specular children; none for models with a density.
    #[inline]
    pub fn split(&self, wo: R::Vec3, mode: TransportMode) -> Split<R> {
        match self {
            Self::Lambertian(_) | Self::GlossySpecular(_) => Split::NONE,
            Self::PerfectSpecular(b) => b.split(wo),
            Self::PerfectTransmitter(b) => b.split(wo, mode),
        }
    }
}
