//! Pixel filters: which points of the film a pixel is the mean of.
//!
//! A pixel's samples are spread as its filter weighs the film, so that each counts the same (M. Ernst, M. Stamminger and
//! G. Greiner, Filter Importance Sampling, 2006). So pixels share no samples: noise stays independent between them, and a crop has
//! the bytes of the whole picture. All filters are products of one function of each coordinate, and nowhere negative.
//!
//! | filter | weight at a distance of x pixels from the middle | reach |
//! |---|---|---|
//! | box | 1 | 1/2 |
//! | tent | 1 - \|x\| | 1 |
//! | Blackman-Harris | the window of four terms (F. J. Harris, On the Use of Windows for Harmonic Analysis, 1978), 1.5 pixels wide on either side | 3/2 |

use std::f64::consts::PI;

/// Half the width of the Blackman-Harris filter, pixels.
const REACH: f64 = 1.5;
/// Its terms.
const TERMS: [f64; 4] = [0.35875, -0.48829, 0.14128, -0.01168];
/// Steps of its table.
const STEPS: usize = 4096;

/// A pixel filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The square of the pixel, evenly.
    #[default]
    Box,
    /// Falls linearly to the middles of the neighbours.
    Tent,
    /// A smooth bell over three pixels: soft, almost without aliasing.
    BlackmanHarris,
}

/// A filter, ready to be sampled.
#[derive(Clone, Debug)]
pub(crate) struct FilterSampler {
    filter: Filter,
    /// Of Blackman-Harris: distances from the middle below which so many steps of all weight lie.
    distances: Vec<f64>,
}

impl Filter {
    /// How far it goes from the middle of a pixel, pixels.
    pub(crate) fn reach(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Tent => 1.0,
            Self::BlackmanHarris => REACH,
        }
    }
}

impl FilterSampler {
    pub(crate) fn new(filter: Filter) -> Self {
        let distances = match filter {
            Filter::BlackmanHarris => (0..=STEPS).map(|step| distance(step as f64 / STEPS as f64)).collect(),
            Filter::Box | Filter::Tent => Vec::new(),
        };
        Self { filter, distances }
    }

    /// A point of the film relative to the upper left corner of the pixel, for a point of the unit square.
    #[inline]
    pub(crate) fn sample(&self, u: [f64; 2]) -> [f64; 2] {
        match self.filter {
            Filter::Box => u,
            Filter::Tent => u.map(|u| 0.5 + tent(u)),
            Filter::BlackmanHarris => u.map(|u| 0.5 + self.bell(u)),
        }
    }

    /// Between the steps of the table weight is even.
    fn bell(&self, u: f64) -> f64 {
        let at = u * STEPS as f64;
        let step = (at as usize).min(STEPS - 1);
        let (low, high) = (self.distances[step], self.distances[step + 1]);
        low + (high - low) * (at - step as f64)
    }
}

/// Where a share of `u` of a tent's weight lies below.
fn tent(u: f64) -> f64 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 * (1.0 - u)).sqrt() }
}

/// The share of the weight of Blackman-Harris that lies below a distance from the middle.
fn share_below(x: f64) -> f64 {
    // The integral of Σ a_k cos(2π k t) over t from 0, where t is 0 at one end and 1 at the other.
    let t = (x / REACH + 1.0) * 0.5;
    let term = |k: usize| {
        let turns = 2.0 * PI * k as f64;
        TERMS[k] * libm::sin(turns * t) / turns
    };
    (TERMS[0] * t + term(1) + term(2) + term(3)) / TERMS[0]
}

/// The inverse, by bisection.
fn distance(share: f64) -> f64 {
    let (mut low, mut high) = (-REACH, REACH);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if share_below(middle) < share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of a filter, from evenly spread numbers.
    fn moments(filter: Filter) -> (f64, f64) {
        let sampler = FilterSampler::new(filter);
        let count = 100_000;
        let at = |i: i32| sampler.sample([(f64::from(i) + 0.5) / f64::from(count), 0.25])[0] - 0.5;
        let mean = (0..count).map(at).sum::<f64>() / f64::from(count);
        (mean, (0..count).map(|i| at(i) * at(i)).sum::<f64>() / f64::from(count))
    }

    /// Variances of the box (1/12), the tent (1/6) and, by integrating t² times its terms, of Blackman-Harris: with the middle at 0
    /// the terms are a0 + |a1| cos(2πt) + a2 cos(4πt) + |a3| cos(6πt) over t from -1/2 to 1/2, and the integral of t² cos(2πkt) is
    /// (-1)^k / (2π²k²). The last steps of the table are wide, which adds a thousandth.
    #[test]
    fn filters_have_their_moments() {
        let bell = TERMS[0] / 12.0 + (-0.48829 + 0.14128 / 4.0 - 0.01168 / 9.0) / (2.0 * PI * PI);
        let bell = bell / TERMS[0] * (2.0 * REACH) * (2.0 * REACH);
        for (filter, variance) in
            [(Filter::Box, 1.0 / 12.0), (Filter::Tent, 1.0 / 6.0), (Filter::BlackmanHarris, bell)]
        {
            let (mean, found) = moments(filter);
            assert!(
                mean.abs() < 1e-9 && (found - variance).abs() < 2e-4,
                "{filter:?}: {mean}, {found}, {variance}"
            );
        }
    }

    #[test]
    fn both_coordinates_are_alike_and_within_reach() {
        for (filter, reach) in [(Filter::Box, 0.5), (Filter::Tent, 1.0), (Filter::BlackmanHarris, REACH)] {
            let sampler = FilterSampler::new(filter);
            for u in [0.0, 1e-9, 0.2, 0.5, 0.9, 1.0 - 1e-16] {
                let [x, y] = sampler.sample([u, u]);
                assert_eq!(x, y);
                assert!((x - 0.5).abs() <= reach, "{filter:?}: {x}");
            }
        }
    }
}
