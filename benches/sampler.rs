//! Sample points: two numbers in [0, 1) for an address.
//!
//! Elements are pairs of numbers.

use crate::measure::Harness;
use std::hint::black_box;
use vitrum::math::{NodeKey, Purpose, SampleAddress, concentric_disk};

pub(crate) fn bench(harness: &mut Harness) {
    film(harness);
    lens(harness);
    nodes(harness);
}

/// Pairs of one pass.
const PAIRS: u32 = 4096;

/// Every sample of one pixel, as the tile loop asks for them.
fn film(harness: &mut Harness) {
    harness.measure("sampler/film, one pixel", PAIRS as usize, || {
        for index in 0..PAIRS {
            black_box(SampleAddress::new(7, 3, 9, index).pair(NodeKey::ROOT, Purpose::Film));
        }
    });
}

/// A point on the lens, mapped from the square to the disk.
fn lens(harness: &mut Harness) {
    harness.measure("sampler/lens, with its disk", PAIRS as usize, || {
        for index in 0..PAIRS {
            let pair = SampleAddress::new(7, 3, 9, index).pair(NodeKey::ROOT, Purpose::Lens);
            black_box(concentric_disk(pair));
        }
    });
}

/// Nodes deep in a tree: the key of each is that of its parent, moved on.
fn nodes(harness: &mut Harness) {
    let address = SampleAddress::new(7, 3, 9, 5);
    harness.measure("sampler/down a tree", PAIRS as usize, || {
        let mut node = NodeKey::ROOT;
        for level in 0..PAIRS {
            node = if level % 3 == 0 { node.reflected() } else { node.transmitted() };
            black_box(address.pair(node, Purpose::Film));
        }
    });
}
