//! Sample points: two numbers in [0, 1) for an address.
//!
//! Elements are pairs of numbers.

use crate::measure::measure;
use criterion::Criterion;
use std::hint::black_box;
use vitrum::math::{NodeKey, Purpose, SampleAddress, concentric_disk};

pub(crate) fn bench(criterion: &mut Criterion) {
    film(criterion);
    lens(criterion);
    nodes(criterion);
}

/// Pairs of one pass.
const PAIRS: u32 = 4096;

/// Every sample of one pixel, as the tile loop asks for them.
fn film(criterion: &mut Criterion) {
    measure(criterion, "sampler/film, one pixel", PAIRS as usize, || {
        for index in 0..PAIRS {
            black_box(SampleAddress::new(7, 3, 9, index).pair(NodeKey::ROOT, Purpose::Film));
        }
    });
}

/// A point on the lens, mapped from the square to the disk.
fn lens(criterion: &mut Criterion) {
    measure(criterion, "sampler/lens, with its disk", PAIRS as usize, || {
        for index in 0..PAIRS {
            let pair = SampleAddress::new(7, 3, 9, index).pair(NodeKey::ROOT, Purpose::Lens);
            black_box(concentric_disk(pair));
        }
    });
}

/// Nodes deep in a tree: the key of each is that of its parent, moved on.
fn nodes(criterion: &mut Criterion) {
    let address = SampleAddress::new(7, 3, 9, 5);
    measure(criterion, "sampler/down a tree", PAIRS as usize, || {
        let mut node = NodeKey::ROOT;
        for level in 0..PAIRS {
            node = if level % 3 == 0 { node.reflected() } else { node.transmitted() };
            black_box(address.pair(node, Purpose::Film));
        }
    });
}
