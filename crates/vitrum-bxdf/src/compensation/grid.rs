//! Where the table of energy compensation has its nodes. Read by the build script, which fills the table, and by the models.
//!
//! The single-scattering albedo E of a rough interface depends on the cosine μ of the direction, the roughness α and the
//! ratio of indices n ≥ 1 (by q = √(n² − 1)), on the rarer and on the denser side. It changes quickly in three places: at
//! grazing angles of the order of α (masking), at those of the order of q (Fresnel), and on the denser side at the critical
//! cosine q/n, within about α. The coordinates below go with these places, so that from row to row the same features stand
//! at the same nodes and interpolation does not smear them. The weights were found by a random search for the least error
//! of trilinear interpolation.

use libm::sqrt;

/// Nodes over the cosine, the roughness and the ratio of indices.
pub(crate) const COSINES: usize = 40;
pub(crate) const ROUGHNESSES: usize = 24;
pub(crate) const RATIOS: usize = 32;

/// √(n² − 1) of the largest ratio of indices, 2.5.
pub(crate) const LARGEST_Q: f64 = 2.291_287_847_477_92;

/// The least roughness: below, surfaces are smooth.
pub(crate) const LEAST_ALPHA: f64 = 1e-4;

/// The side of the interface that a direction is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// That of the lower index.
    Rarer,
    /// That of the higher index.
    Denser,
}

/// The place of a row of cosines in the table.
pub(crate) const fn row(roughness: usize, ratio: usize, side: Side) -> usize {
    ((roughness * RATIOS + ratio) * 2 + side as usize) * COSINES
}

/// 0 at the least roughness, 1 at roughness one.
pub(crate) fn of_roughness(alpha: f64) -> f64 {
    let least = sqrt(LEAST_ALPHA);
    (sqrt(alpha.max(LEAST_ALPHA)) - least) / (1.0 - least)
}

/// 0 for equal indices, 1 at the largest ratio.
pub(crate) fn of_ratio(q: f64, alpha: f64) -> f64 {
    const RELATIVE: f64 = 0.9;
    let place = |q: f64| RELATIVE * q / (q + alpha) + (1.0 - RELATIVE) * q / LARGEST_Q;
    place(q) / place(LARGEST_Q)
}

/// The coordinate of the cosine for one roughness and ratio of indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cosines {
    alpha: f32,
    /// Cosine of the critical angle, q/n > 0.
    critical: f32,
    /// Where the step at the critical angle begins along the surface, and one over its height.
    low: f32,
    per_height: f32,
}

const MASKING: f64 = 2.3;
const FRESNEL: f64 = 0.32;
const EVEN: f64 = 0.37;
const CRITICAL: f64 = 0.21;

impl Cosines {
    pub(crate) fn new(alpha: f64, critical: f64) -> Self {
        let mut cosines = Self { alpha: alpha as f32, critical: critical as f32, low: 0.0, per_height: 1.0 };
        let (low, high) = (cosines.step(0.0), cosines.step(1.0));
        cosines.low = low as f32;
        cosines.per_height = (1.0 / (high - low)) as f32;
        cosines
    }

    /// From −1 to 1 about the critical angle, as wide as the roughness.
    fn step(&self, mu: f64) -> f64 {
        let beyond = mu - f64::from(self.critical);
        beyond / (beyond.abs() + f64::from(self.alpha))
    }

    /// 0 along the surface, 1 along the normal.
    pub(crate) fn coordinate(&self, mu: f64, side: Side) -> f64 {
        // From 0 to 1, with its middle at the scale.
        let from_grazing = |scale: f32| sqrt(mu * (1.0 + f64::from(scale)) / (mu + f64::from(scale)));
        let sum = MASKING * from_grazing(self.alpha) + FRESNEL * from_grazing(self.critical) + EVEN * mu;
        let whole = MASKING + FRESNEL + EVEN;
        if side == Side::Rarer {
            return sum / whole;
        }
        let step = (self.step(mu) - f64::from(self.low)) * f64::from(self.per_height);
        (sum + CRITICAL * step) / (whole + CRITICAL)
    }
}
