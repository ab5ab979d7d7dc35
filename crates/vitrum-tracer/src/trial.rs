//! What a square of pixels is like on each way to branch, tried with samples of its own.
//!
//! With the same random numbers, addressed by place in the tree, a path that follows one child at random is one way through the
//! tree that follows all: what it finds differs from the tree's value by chance alone, and the mean square of the difference is the
//! variance that branching would take away (and that of roulette on the tree's light branches, which is little). The rest of the
//! variance, from the places in the pixel and on the lights, two independent trees of one pixel tell by their difference.
//!
//! The same is asked of nets, which are means of as many evenly spread samples as a block of the film has: even numbers take down
//! each part of the variance by another factor.

use crate::film::{BLOCK, SQUARE};
use crate::filter::FilterSampler;
use crate::path::AnyPath;
use crate::settings::Branching;
use crate::walker::Walker;
use vitrum_math::{Rgb, SampleAddress};

/// The ways to branch. First whole trees, which the others are compared with, and which are right in doubt.
pub(crate) const WAYS: [Branching; 3] = [Branching::Tree, Branching::First, Branching::One];

/// The seeds of the two sequences are so much farther on than that of the picture.
const SEEDS: [u64; 2] = [0x6a09_e667_f3bc_c909, 0xbb67_ae85_84ca_a73b];
/// Samples of a net.
const NET: usize = BLOCK as usize;
/// Pixels of a square that are tried.
const PIXELS: [[u32; 2]; 2] = [[2, 2], [6, 6]];
/// The largest squared difference of two samples that counts: rare bright ones tell more of themselves than of the square.
const MOST: f64 = 30.0;

/// What a sample returned on each of the ways.
type Returned = [Rgb; WAYS.len()];

/// Variances, relative as in relMSE, and cost of a sample; sums over pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Findings {
    /// Variance that is left when all children are followed.
    pub(crate) between: f64,
    /// What each way adds to it.
    pub(crate) within: [f64; WAYS.len()],
    /// What each way costs, in rays that meet no large mesh.
    pub(crate) cost: [f64; WAYS.len()],
}

impl Findings {
    pub(crate) fn add(&mut self, other: &Self) {
        self.between += other.between;
        for way in 0..WAYS.len() {
            self.within[way] += other.within[way];
            self.cost[way] += other.cost[way];
        }
    }

    /// Adds what the means of two independent groups of samples of a pixel tell of the variance of one sample, times a share.
    fn compare(&mut self, [a, b]: [&[Returned]; 2], mean: Rgb, share: f64) {
        let scale = mean * mean + Rgb::splat(0.01);
        // The squared mean of differences, sample by sample, and times the number of samples.
        let squared = |difference: &dyn Fn(usize) -> Rgb| {
            let held_down = |at: usize| {
                let difference = difference(at);
                let squared = (difference * difference / scale).element_sum();
                difference * (MOST / squared.max(MOST)).sqrt()
            };
            let sum = (0..a.len()).fold(Rgb::ZERO, |sum, at| sum + held_down(at));
            (sum * sum / scale).element_sum() / a.len() as f64
        };
        // Two values differ by twice the variance of one, in the mean square.
        self.between += share * 0.5 * squared(&|at| a[at][0] - b[at][0]);
        for way in 1..WAYS.len() {
            // Each group tells the same.
            self.within[way] += share * 0.5 * squared(&|at| a[at][way] - a[at][0]);
            self.within[way] += share * 0.5 * squared(&|at| b[at][way] - b[at][0]);
        }
    }
}

/// Tries a square, given by its column and row in the whole image, with single samples.
pub(crate) fn singles(
    walker: &mut Walker<'_, AnyPath>,
    filter: &FilterSampler,
    square: [u32; 2],
) -> Findings {
    let (pixels, cost) = samples::<1>(walker, filter, square);
    let mut found = Findings { cost, ..Findings::default() };
    add_singles(&mut found, &pixels, 0, 1.0);
    found
}

/// Tries a square with nets: what their samples tell one by one, and what they tell.
pub(crate) fn nets(
    walker: &mut Walker<'_, AnyPath>,
    filter: &FilterSampler,
    square: [u32; 2],
) -> [Findings; 2] {
    let (pixels, cost) = samples::<NET>(walker, filter, square);
    let [mut of_singles, mut of_nets] = [Findings { cost, ..Findings::default() }; 2];
    for at in 0..NET {
        add_singles(&mut of_singles, &pixels, at, 1.0 / NET as f64);
    }
    let mean = mean(pixels.as_flattened().as_flattened());
    for [a, b] in &pixels {
        of_nets.compare([a, b], mean, 1.0);
    }
    [of_singles, of_nets]
}

/// Adds what the samples of one index tell by themselves.
fn add_singles<const N: usize>(found: &mut Findings, pixels: &[[[Returned; N]; 2]], at: usize, share: f64) {
    let singles: Vec<Returned> = pixels.as_flattened().iter().map(|samples| samples[at]).collect();
    let mean = mean(&singles);
    for [a, b] in singles.as_chunks::<2>().0 {
        found.compare([&[*a], &[*b]], mean, share);
    }
}

/// What trees return on average.
fn mean(samples: &[Returned]) -> Rgb {
    samples.iter().fold(Rgb::ZERO, |sum, [tree, ..]| sum + *tree) / samples.len().max(1) as f64
}

/// For each pixel that is tried so many samples of two sequences; and what a sample costs, summed over the pixels.
fn samples<const N: usize>(
    walker: &mut Walker<'_, AnyPath>,
    filter: &FilterSampler,
    [column, row]: [u32; 2],
) -> (Vec<[[Returned; N]; 2]>, [f64; WAYS.len()]) {
    let settings = walker.settings;
    let mut cost = [0.0; WAYS.len()];
    let mut sample = |[x, y]: [u32; 2], seed: u64, index: usize| -> Returned {
        let address = SampleAddress::new(settings.seed.wrapping_add(seed), x, y, index as u32)
            .of_sequence(settings.sequence);
        std::array::from_fn(|way| {
            let rays = walker.stats.rays();
            walker.branching = WAYS[way];
            let returned = walker.sample(filter, [x, y], &address);
            cost[way] += ((walker.stats.rays() - rays) as f64 + walker.dearer) / (2 * N) as f64;
            // What the film leaves out is black here.
            Rgb::from_array(returned.unwrap_or_default().map(f64::from))
        })
    };
    let pixels = PIXELS
        .map(|[x, y]| [column * SQUARE + x, row * SQUARE + y])
        .into_iter()
        .filter(|[x, y]| *x < settings.size[0] && *y < settings.size[1])
        .map(|pixel| SEEDS.map(|seed| std::array::from_fn(|index| sample(pixel, seed, index))))
        .collect();
    (pixels, cost)
}
