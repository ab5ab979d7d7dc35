//! What sampling a model returns, and in which sense light is carried.

use crate::{Real, Vector};

/// What the path carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// Radiance, along a path from the camera.
    Radiance,
    /// Importance, along a path from a light.
    Importance,
}

impl TransportMode {
    /// What a crossing with index ratio `eta = eta_t / eta_i` multiplies the carried quantity by, beside the transmission
    /// coefficient. Radiance is squeezed into, or spread over, another solid angle: (η_i/η_t)² along a camera path, for
    /// example 1/2.25 entering n = 1.5 and 2.25 leaving it. Importance is not scaled. (E. Veach, Robust Monte Carlo
    /// Methods for Light Transport Simulation, 1997, section 5.2.)
    #[inline]
    pub fn crossing_scale<R: Real>(self, eta: R) -> R {
        match self {
            Self::Radiance => R::one() / (eta * eta),
            Self::Importance => R::one(),
        }
    }
}

/// A probability of choosing a direction, with its measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density<R> {
    /// A probability: the direction is one of finitely many.
    Discrete(R),
    /// A density per steradian.
    SolidAngle(R),
}

/// Which part of a model a direction comes from: what happened to the light, and how sharply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Lobe {
    /// Reflection over the whole hemisphere.
    DiffuseReflection,
    /// Reflection about the mirror direction, with a density.
    GlossyReflection,
    /// Transmission about the refracted direction, with a density.
    GlossyTransmission,
    /// Reflection in exactly the mirror direction.
    SpecularReflection,
    /// Transmission in exactly the refracted direction.
    SpecularTransmission,
}

impl Lobe {
    /// True where the direction lies on the other side of the surface.
    #[inline]
    pub const fn is_transmission(self) -> bool {
        matches!(self, Self::GlossyTransmission | Self::SpecularTransmission)
    }

    /// True where the direction is one of finitely many: its density is [`Density::Discrete`], and neither `eval` nor `pdf`
    /// knows it.
    #[inline]
    pub const fn is_specular(self) -> bool {
        matches!(self, Self::SpecularReflection | Self::SpecularTransmission)
    }
}

/// A direction that light may come from, chosen by a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<R: Real> {
    /// The direction, unit length, local frame.
    pub wi: R::Vec3,
    /// `f · |cos θi| / pdf` per channel: what the radiance arriving from `wi` is multiplied by.
    pub weight: R::Vec3,
    /// The density with which `wi` was chosen, before it was rounded.
    pub pdf: Density<R>,
    /// The lobe that `wi` belongs to.
    pub lobe: Lobe,
    /// Index ratio η_t/η_i of the crossing; one for reflection.
    pub eta: R,
}

impl<R: Real> Sample<R> {
    /// The mirror direction of `wo`, chosen with certainty.
    #[inline]
    pub(crate) fn mirror(wo: R::Vec3, weight: R::Vec3) -> Self {
        Self {
            wi: R::Vec3::new(-wo.x(), -wo.y(), wo.z()),
            weight,
            pdf: Density::Discrete(R::one()),
            lobe: Lobe::SpecularReflection,
            eta: R::one(),
        }
    }

    /// The same direction, chosen with this probability only: its weight grows to make up for it.
    #[inline]
    fn with_probability(self, probability: R) -> Self {
        Self { weight: self.weight / probability, pdf: Density::Discrete(probability), ..self }
    }
}

/// The specular children of a ray, each chosen with certainty; `None` where a child would carry nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split<R: Real> {
    /// The child that stays on `wo`'s side.
    pub reflected: Option<Sample<R>>,
    /// The child that crosses.
    pub transmitted: Option<Sample<R>>,
}

impl<R: Real> Split<R> {
    /// No children.
    pub const NONE: Self = Self { reflected: None, transmitted: None };

    /// One child, chosen by `uc` in [0, 1): the reflected one with `reflection / (reflection + transmission)`; evenly where
    /// both are so small that they are zero.
    #[inline]
    pub(crate) fn choose(self, uc: R, reflection: R, transmission: R) -> Option<Sample<R>> {
        match self {
            Self { reflected: Some(reflected), transmitted: Some(transmitted) } => {
                let sum = reflection + transmission;
                let p = if sum > R::zero() { reflection / sum } else { R::from_f64(0.5) };
                Some(if uc < p {
                    reflected.with_probability(p)
                } else {
                    transmitted.with_probability(R::one() - p)
                })
            }
            Self { reflected, transmitted } => reflected.or(transmitted),
        }
    }
}
