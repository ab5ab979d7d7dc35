//! The closed family of models, listed once.

use crate::{
    Conductor, FresnelDielectric, GlossySpecular, Lambertian, PerfectSpecular, PerfectTransmitter, Real,
    RoughDielectric, Sample, Split, ThinDielectric, TransportMode, Vector,
};

/// One scattering model with its parameters. A plain value: copy it, keep it on the stack.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Bxdf<R: Real> {
    /// Diffuse reflection.
    Lambertian(Lambertian<R>),
    /// Phong's highlight.
    GlossySpecular(GlossySpecular<R>),
    /// Perfect mirror.
    PerfectSpecular(PerfectSpecular<R>),
    /// Glass with constant coefficients.
    PerfectTransmitter(PerfectTransmitter<R>),
    /// Smooth glass.
    FresnelDielectric(FresnelDielectric<R>),
    /// A thin sheet of glass.
    ThinDielectric(ThinDielectric<R>),
    /// Rough glass.
    RoughDielectric(RoughDielectric<R>),
    /// Metal, smooth or rough.
    Conductor(Conductor<R>),
}

const _: () = assert!(size_of::<Bxdf<f64>>() <= 128 && size_of::<Bxdf<f32>>() <= 80);

macro_rules! from_models {
    ($($model:ident),+) => {
        $(impl<R: Real> From<$model<R>> for Bxdf<R> {
            fn from(model: $model<R>) -> Self {
                Self::$model(model)
            }
        })+
    };
}
from_models!(
    Lambertian,
    GlossySpecular,
    PerfectSpecular,
    PerfectTransmitter,
    FresnelDielectric,
    ThinDielectric,
    RoughDielectric,
    Conductor
);

impl<R: Real> Bxdf<R> {
    /// True when all densities are discrete: `eval` and `pdf` are zero, light sources can't be sampled through the model,
    /// and [`split`](Self::split) gives all there is.
    #[inline]
    pub fn is_specular(&self) -> bool {
        match self {
            Self::Lambertian(_) | Self::GlossySpecular(_) => false,
            Self::PerfectSpecular(_)
            | Self::PerfectTransmitter(_)
            | Self::FresnelDielectric(_)
            | Self::ThinDielectric(_) => true,
            Self::RoughDielectric(b) => b.is_specular(),
            Self::Conductor(b) => b.is_specular(),
        }
    }

    /// f · |cos θi| per steradian; zero for perfectly specular models.
    #[inline]
    pub fn eval(&self, wo: R::Vec3, wi: R::Vec3, mode: TransportMode) -> R::Vec3 {
        match self {
            Self::Lambertian(b) => b.eval(wo, wi),
            Self::GlossySpecular(b) => b.eval(wo, wi),
            Self::RoughDielectric(b) => b.eval(wo, wi, mode),
            Self::Conductor(b) => b.eval(wo, wi),
            Self::PerfectSpecular(_)
            | Self::PerfectTransmitter(_)
            | Self::FresnelDielectric(_)
            | Self::ThinDielectric(_) => R::Vec3::splat(R::zero()),
        }
    }

    /// The density of [`sample`](Self::sample) per steradian of `wi`; zero for perfectly specular models.
    #[inline]
    pub fn pdf(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        match self {
            Self::Lambertian(b) => b.pdf(wo, wi),
            Self::GlossySpecular(b) => b.pdf(wo, wi),
            Self::RoughDielectric(b) => b.pdf(wo, wi),
            Self::Conductor(b) => b.pdf(wo, wi),
            Self::PerfectSpecular(_)
            | Self::PerfectTransmitter(_)
            | Self::FresnelDielectric(_)
            | Self::ThinDielectric(_) => R::zero(),
        }
    }

    /// A direction for `wi`, from `uc` in [0, 1) that chooses a lobe and a point `u` of the unit square; `None` where the
    /// model scatters nothing or the direction falls on the wrong side of the surface.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, uc: R, u: [R; 2], mode: TransportMode) -> Option<Sample<R>> {
        match self {
            Self::Lambertian(b) => b.sample(wo, u),
            Self::GlossySpecular(b) => b.sample(wo, u),
            Self::PerfectSpecular(b) => b.sample(wo),
            Self::PerfectTransmitter(b) => b.sample(wo, uc, mode),
            Self::FresnelDielectric(b) => b.sample(wo, uc, mode),
            Self::ThinDielectric(b) => b.sample(wo, uc),
            Self::RoughDielectric(b) => b.sample(wo, uc, u, mode),
            Self::Conductor(b) => b.sample(wo, u),
        }
    }

    /// Both perfectly specular children, without a random number; none for models with a density.
    #[inline]
    pub fn split(&self, wo: R::Vec3, mode: TransportMode) -> Split<R> {
        match self {
            Self::Lambertian(_) | Self::GlossySpecular(_) => Split::NONE,
            Self::PerfectSpecular(b) => b.split(wo),
            Self::PerfectTransmitter(b) => b.split(wo, mode),
            Self::FresnelDielectric(b) => b.split(wo, mode),
            Self::ThinDielectric(b) => b.split(wo),
            Self::RoughDielectric(b) => b.split(wo, mode),
            Self::Conductor(b) => b.split(wo),
        }
    }
}
