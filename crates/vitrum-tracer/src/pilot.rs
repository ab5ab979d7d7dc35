//! Which of the rays that glass divides are followed, square of pixels by square: found by trying.
//!
//! Following more of them makes a sample cost more and vary less. With the same random numbers, addressed by place in the tree, a
//! path that follows one child at random is one way through the tree that follows all: what it finds differs from the tree's value
//! by chance alone, and the mean square of the difference is the variance that branching would take away. The rest of the variance,
//! from the places in the pixel and on the lights, two trees of one pixel tell by their difference. The cost of each way is counted
//! in rays.
//!
//! Every pixel has as many samples, and what counts is the error of the whole picture times its cost. So a square takes the way of
//! the least sum of both, error over that of the picture and cost over that of the picture: where there is little error, trees
//! would cost more than they save. Error and cost of the picture come from some squares all over it.
//!
//! The numbers that the pilot draws are its own, so that what it decides has nothing to do with the samples that are averaged: any
//! choice leaves the picture unbiased. It depends on the scene, the settings and the place in the whole image, and on nothing that
//! has been rendered. A square is judged together with its neighbours, for its own few samples say little.

use crate::film::SQUARE;
use crate::filter::FilterSampler;
use crate::path::Path;
use crate::settings::{Branching, Settings};
use crate::walker::Walker;
use vitrum_math::{NodeKey, Purpose, Rgb, SampleAddress};

/// What the seed of the pilot is farther on.
const SEED: u64 = 0x6a09_e667_f3bc_c909;
/// Every so many pixels across and down one is tried.
const STRIDE: u32 = 4;
/// Samples of each of them.
const SAMPLES: u32 = 2;
/// By so much evenly spread numbers take down the variance from places faster than that from choices. Of 2, 3, 4 and 6,
/// tried on four scenes of `benches/peers/mitsuba`, it loses least against the best fixed way where it loses most.
const GAIN: f64 = 4.0;
/// What is chosen must be better by this factor than whole trees, which are right where the pilot says little.
const MARGIN: f64 = 0.97;
/// Squares across and down that tell what the picture is like.
pub(crate) const SURVEYED: u32 = 16;

/// The ways to branch, the one that is right in doubt first.
const WAYS: [Branching; 3] = [Branching::Tree, Branching::First, Branching::One];

/// What the pilot finds in a square.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Findings {
    /// Variance that is left when all children are followed.
    between: f64,
    /// What is added by each way.
    within: [f64; 3],
    /// Rays of each way.
    cost: [f64; 3],
}

impl Findings {
    pub(crate) fn add(&mut self, other: &Self) {
        self.between += other.between;
        for way in 0..WAYS.len() {
            self.within[way] += other.within[way];
            self.cost[way] += other.cost[way];
        }
    }

    /// Rays of all ways.
    pub(crate) fn rays(&self) -> u64 {
        self.cost.iter().sum::<f64>() as u64
    }

    /// Error and cost of a way.
    fn of(&self, way: usize) -> (f64, f64) {
        (self.between / GAIN + self.within[way], self.cost[way])
    }

    /// The place of the best way, where a ray is worth so much error.
    fn best_at(&self, price: f64) -> usize {
        let worth = |way: usize| {
            let (error, cost) = self.of(way);
            error + price * cost
        };
        let other = if worth(1) < worth(2) { 1 } else { 2 };
        if worth(other) < MARGIN * worth(0) { other } else { 0 }
    }

    /// The best way, where a ray is worth so much error.
    pub(crate) fn best(&self, price: f64) -> Branching {
        WAYS[self.best_at(price)]
    }
}

/// What a ray is worth in error: that of the picture over its rays, when its squares take their best ways.
pub(crate) fn price(squares: &[Findings]) -> f64 {
    let mut price = 0.0;
    for _ in 0..4 {
        let sum = |(error, cost): (f64, f64), square: &Findings| {
            let (its_error, its_cost) = square.of(square.best_at(price));
            (error + its_error, cost + its_cost)
        };
        let (error, cost) = squares.iter().fold((0.0, 0.0), sum);
        price = if cost > 0.0 { error / cost } else { 0.0 };
    }
    price
}

/// Tries a square, given by its column and row in the whole image.
pub(crate) fn explore(
    walker: &mut Walker<'_, Path>,
    filter: &FilterSampler,
    [column, row]: [u32; 2],
) -> Findings {
    let settings: &Settings = walker.settings;
    let [width, height] = settings.size;
    let mut findings = Findings::default();
    // Not at the edge of the square: the middle of each part.
    let places = |from: u32, end: u32| (from + STRIDE / 2..(from + SQUARE).min(end)).step_by(STRIDE as usize);
    for y in places(row * SQUARE, height) {
        for x in places(column * SQUARE, width) {
            let mut trees = [Rgb::ZERO; SAMPLES as usize];
            for (sample, tree) in (0..SAMPLES).zip(&mut trees) {
                let address = SampleAddress::new(settings.seed.wrapping_add(SEED), x, y, sample)
                    .of_sequence(settings.sequence);
                let [dx, dy] = filter.sample(address.pair(NodeKey::ROOT, Purpose::Film));
                for (way, branching) in WAYS.into_iter().enumerate() {
                    let lens = || address.pair(NodeKey::ROOT, Purpose::Lens);
                    let ray =
                        walker.scene.camera.ray(f64::from(x) + dx, f64::from(y) + dy, settings.size, lens);
                    let rays = walker.stats.rays();
                    walker.branching = branching;
                    let radiance = walker.radiance(ray, &address);
                    findings.cost[way] += (walker.stats.rays() - rays) as f64;
                    if way == 0 {
                        *tree = radiance;
                    }
                    findings.within[way] += relative(radiance - *tree, *tree);
                }
            }
            let mean = (trees[0] + trees[1]) * 0.5;
            // Two values differ by twice the variance of one, in the mean square.
            findings.between += f64::from(SAMPLES) * 0.5 * relative(trees[0] - trees[1], mean);
        }
    }
    findings
}

/// The squared difference as relMSE has it. Rare bright samples are held down: they tell more of themselves than of the square.
fn relative(difference: Rgb, value: Rgb) -> f64 {
    let squared = difference * difference / (value * value + Rgb::splat(0.01));
    squared.element_sum().min(MOST)
}

/// The largest squared difference that counts.
const MOST: f64 = 30.0;
