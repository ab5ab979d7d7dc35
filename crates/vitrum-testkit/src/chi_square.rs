//! Chi-square goodness of fit: do the directions of a sampler follow the density that it claims?
//!
//! The sphere is cut into cells, the sampler's directions are counted per cell, and the counts are compared with the
//! integrals of the density: Σ (counted - expected)² / expected follows a chi-square distribution when sampler and
//! density agree (Pearson 1900). Cells that expect few counts are pooled until each pool expects at least five
//! (Cochran 1954, "Some methods for strengthening the common χ² tests"). The same design as in PBRT
//! (Pharr, Jakob and Humphreys, "Physically Based Rendering", its tests of BSDFs) and Mitsuba.
//!
//! It covers densities per steradian; mirror directions have none and are checked by their closed form. It can't see
//! what happens inside one cell: a lobe narrower than a few cells needs a finer grid.

use crate::significance::chi_square_p_value;
use crate::{SphereGrid, Uniform};
use core::fmt;
use vitrum_math::DVec3;

/// A pool expects at least this many counts.
const LEAST_EXPECTED: f64 = 5.0;

/// The share of directions that may fall where the density is zero: rounding at the edge of a lobe, nothing else.
const TOLERATED_IMPOSSIBLE: f64 = 1e-5;

/// What a density may integrate to beyond one: the quadrature's own error at jumps, with room to spare.
const TOLERATED_EXCESS: f64 = 1e-3;

/// The outcome of a chi-square test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ (counted - expected)² / expected over the pools.
    pub statistic: f64,
    /// One less than the number of pools.
    pub degrees_of_freedom: usize,
    /// The probability of a statistic at least this large when sampler and density agree.
    pub p_value: f64,
    /// How many directions were asked for.
    pub samples: u64,
    /// How many of them were refused (the sampler returned nothing).
    pub refused: u64,
    /// How many fell where the density is zero or not a positive finite number.
    pub impossible: u64,
    /// The integral of the density over the sphere: one minus the probability of a refusal.
    pub integral: f64,
}

impl ChiSquare {
    /// Whether sampler and density agree at this level (say 1e-3 over all tests, shared out by
    /// [`sidak_level`](crate::sidak_level)).
    ///
    /// Whatever the statistic says, a density that integrates to more than 1.001 fails, and so do directions where it
    /// is zero, beyond 1e-5 of the samples.
    pub fn passes(&self, level: f64) -> bool {
        self.p_value >= level
            && self.integral <= 1.0 + TOLERATED_EXCESS
            && self.impossible as f64 <= TOLERATED_IMPOSSIBLE * self.samples as f64
    }
}

impl fmt::Display for ChiSquare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { statistic, degrees_of_freedom, p_value, samples, refused, impossible, integral } = self;
        write!(
            f,
            "chi-square {statistic:.1} with {degrees_of_freedom} degrees of freedom, p = {p_value:.3e}; {samples} samples, \
             {refused} refused, {impossible} where the density is zero; the density integrates to {integral:.6}"
        )
    }
}

/// Draws `samples` directions from `sample` and compares them with `density` (per steradian) on the cells of `grid`.
///
/// `sample` takes what uniform numbers it needs and returns a unit direction, or `None` where it refuses; refusals
/// are compared with what the density lacks to one, as one more cell. The draws are determined by `seed`.
///
/// # Panics
/// If fewer than two pools remain: too few samples, or a lobe inside a single cell.
pub fn chi_square_of_directions(
    mut sample: impl FnMut(&mut Uniform) -> Option<DVec3>,
    density: impl Fn(DVec3) -> f64,
    grid: SphereGrid,
    samples: u64,
    seed: u64,
) -> ChiSquare {
    let mut uniform = Uniform::new(seed);
    let mut counted = vec![0.0; grid.cells()];
    let (mut refused, mut impossible) = (0, 0);
    for _ in 0..samples {
        let Some(direction) = sample(&mut uniform) else {
            refused += 1;
            continue;
        };
        let claimed = density(direction);
        // A direction that is not a number lies in no cell; the density can't be right about it either.
        if !(claimed > 0.0 && claimed.is_finite() && direction.is_finite()) {
            impossible += 1;
        }
        if direction.is_finite() {
            counted[grid.cell_of(direction)] += 1.0;
        }
    }

    let mut expected = grid.integrals(density);
    let integral = expected.iter().sum::<f64>();
    expected.iter_mut().for_each(|share| *share *= samples as f64);
    counted.push(refused as f64);
    expected.push(samples as f64 * (1.0 - integral).max(0.0));

    let pools = pools(&counted, &expected);
    assert!(
        pools.len() >= 2,
        "{} pool(s) from {samples} samples: more samples or a finer grid are needed",
        pools.len()
    );
    let statistic = pools.iter().map(|pool| (pool.counted - pool.expected).powi(2) / pool.expected).sum();
    let degrees_of_freedom = pools.len() - 1;
    // A density that is not a number gives a statistic that is none: that is no agreement.
    let p_value =
        if f64::is_nan(statistic) { 0.0 } else { chi_square_p_value(statistic, degrees_of_freedom) };
    ChiSquare { statistic, degrees_of_freedom, p_value, samples, refused, impossible, integral }
}

/// Cells counted as one.
#[derive(Clone, Copy, Default)]
struct Pool {
    counted: f64,
    expected: f64,
}

/// Pools the cells from the least expected upwards; the last, too small one joins its neighbour. Counts where next to
/// nothing is expected so end in the smallest pool, where they weigh most.
fn pools(counted: &[f64], expected: &[f64]) -> Vec<Pool> {
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|&a, &b| expected[a].total_cmp(&expected[b]));

    let mut pools = Vec::new();
    let mut open = Pool::default();
    for cell in order {
        open.counted += counted[cell];
        open.expected += expected[cell];
        if open.expected >= LEAST_EXPECTED || open.expected.is_nan() {
            pools.push(core::mem::take(&mut open));
        }
    }
    if let Some(last) = pools.last_mut() {
        last.counted += open.counted;
        last.expected += open.expected;
    }
    pools
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{PI, TAU};

    const SAMPLES: u64 = 200_000;
    const LEVEL: f64 = 1e-3;

    fn direction(z: f64, u: f64) -> DVec3 {
        let r = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(r * (TAU * u).cos(), r * (TAU * u).sin(), z)
    }

    fn cosine(uniform: &mut Uniform) -> DVec3 {
        let [u, v] = uniform.pair();
        direction((1.0 - u).sqrt(), v)
    }

    fn cosine_density(d: DVec3) -> f64 {
        d.z.max(0.0) / PI
    }

    fn test(sample: impl FnMut(&mut Uniform) -> Option<DVec3>, density: impl Fn(DVec3) -> f64) -> ChiSquare {
        chi_square_of_directions(sample, density, SphereGrid::default(), SAMPLES, 11)
    }

    #[test]
    fn right_samplers_pass() {
        let uniform_sphere = test(|u| Some(direction(1.0 - 2.0 * u.number(), u.number())), |_| 0.25 / PI);
        let cosine = test(|u| Some(cosine(u)), cosine_density);
        // A lobe cos^e about a tilted axis, part of it below the horizon and refused there.
        let axis = DVec3::new(0.96, 0.0, 0.28);
        let side = DVec3::new(0.28, 0.0, -0.96);
        let exponent = 30.0;
        let lobe = |u: &mut Uniform| {
            let d = direction(u.number().powf(1.0 / (exponent + 1.0)), u.number());
            Some(d.x * side + d.y * DVec3::Y + d.z * axis).filter(|d| d.z > 0.0)
        };
        let lobe_density = |d: DVec3| {
            if d.z > 0.0 { (exponent + 1.0) / TAU * d.dot(axis).max(0.0).powf(exponent) } else { 0.0 }
        };
        let lobe = test(lobe, lobe_density);
        assert!(lobe.refused > 0 && lobe.integral < 1.0, "{lobe}");
        for outcome in [uniform_sphere, cosine, lobe] {
            assert!(outcome.passes(LEVEL), "{outcome}");
            assert_eq!(outcome.impossible, 0);
        }
    }

    #[test]
    fn a_wrong_density_fails() {
        // The textbook slips: uniform claimed as cosine, a lobe that leans, a density that is not normalised.
        let uniform_hemisphere = |u: &mut Uniform| Some(direction(1.0 - u.number(), u.number()));
        assert!(!test(uniform_hemisphere, cosine_density).passes(LEVEL));
        let tilted = |d: DVec3| cosine_density(d) * (1.0 + 0.15 * d.x);
        assert!(!test(|u| Some(cosine(u)), tilted).passes(LEVEL));
        let short = |d: DVec3| 0.98 * cosine_density(d);
        assert!(!test(|u| Some(cosine(u)), short).passes(LEVEL));
        let long = |d: DVec3| 1.02 * cosine_density(d);
        assert!(!test(|u| Some(cosine(u)), long).passes(LEVEL));
        assert!(!test(|u| Some(cosine(u)), |_| f64::NAN).passes(LEVEL));
    }

    #[test]
    fn a_wrong_sampler_fails() {
        // Refuses one in a hundred without the density knowing it.
        let lazy = |u: &mut Uniform| Some(cosine(u)).filter(|_| u.number() > 0.01);
        assert!(!test(lazy, cosine_density).passes(LEVEL));
        // Goes below the horizon one time in ten thousand: too few for the statistic of a large cell, but impossible.
        let leaking = |u: &mut Uniform| Some(cosine(u) * if u.number() < 1e-4 { -1.0 } else { 1.0 });
        let outcome = test(leaking, cosine_density);
        assert!(outcome.impossible > 0 && !outcome.passes(LEVEL), "{outcome}");
        let broken = |u: &mut Uniform| Some(if u.number() < 1e-3 { DVec3::NAN } else { cosine(u) });
        assert!(!test(broken, cosine_density).passes(LEVEL));
    }

    #[test]
    fn p_values_are_uniform_when_nothing_is_wrong() {
        // Of 200 honest tests 10 % should fail at 10 %: binomial with sigma 4.2, taken at four of them.
        let grid = SphereGrid { theta: 8, phi: 8 };
        let failed = (0..200)
            .filter(|&seed| {
                !chi_square_of_directions(|u| Some(cosine(u)), cosine_density, grid, 2000, seed).passes(0.1)
            })
            .count();
        assert!((3..=37).contains(&failed), "{failed} of 200 failed");
    }

    #[test]
    fn pooling_keeps_every_count() {
        let pools = pools(&[1.0, 0.0, 7.0, 100.0, 3.0], &[0.5, 0.0, 6.0, 90.0, 2.0]);
        assert_eq!(pools.iter().map(|pool| pool.counted).sum::<f64>(), 111.0);
        assert!(pools.iter().all(|pool| pool.expected >= LEAST_EXPECTED));
        assert_eq!(pools.len(), 2);
    }

    #[test]
    #[should_panic(expected = "more samples or a finer grid")]
    fn too_little_to_judge_is_refused() {
        chi_square_of_directions(
            |u| Some(cosine(u)),
            cosine_density,
            SphereGrid { theta: 1, phi: 1 },
            100,
            0,
        );
    }
}
