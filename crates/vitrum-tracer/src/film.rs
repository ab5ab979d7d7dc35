//! The film: sums of samples in an order that nothing can change.
//!
//! The samples of a pixel are summed in double precision, in order, in blocks of 8; blocks are combined by a perfect binary
//! tree on the block index. So any range of whole subtrees can be summed elsewhere and put together to the same bytes.

use crate::settings::Crop;
use crate::stats::GivenUp;
use vitrum_math::Rgb;

/// Samples in a block.
const BLOCK: u32 = 8;

/// The sum of a range of one pixel's samples that starts at a multiple of its own size's power of two: blocks enter as
/// leaves, equal neighbours merge.
#[derive(Clone, Debug, Default)]
pub(crate) struct PixelSum {
    /// Complete subtrees, the largest first: (level, sum).
    subtrees: Vec<(u32, Rgb)>,
    block: Rgb,
    in_block: u32,
    /// Samples taken.
    pub(crate) taken: u32,
    /// Samples that count: those that were not dropped.
    pub(crate) counted: u32,
    /// Weight of the subtrees of rays that were not followed, summed over the samples.
    pub(crate) given_up: f64,
}

impl PixelSum {
    /// Starts over, keeping the memory.
    pub(crate) fn clear(&mut self) {
        self.subtrees.clear();
        *self = Self { subtrees: std::mem::take(&mut self.subtrees), ..Self::default() };
    }

    /// Takes the next sample; `None` stands for one that was dropped.
    pub(crate) fn push(&mut self, sample: Option<[f32; 3]>) {
        if let Some(sample) = sample {
            self.block += Rgb::from_array(sample.map(f64::from));
            self.counted += 1;
        }
        self.taken += 1;
        self.in_block += 1;
        if self.in_block == BLOCK {
            let (mut level, mut sum) = (0, self.block);
            while let Some(&(last_level, last)) = self.subtrees.last()
                && last_level == level
            {
                sum = last + sum;
                level += 1;
                self.subtrees.pop();
            }
            self.subtrees.push((level, sum));
            (self.block, self.in_block) = (Rgb::ZERO, 0);
        }
    }

    /// The sum of all samples: what is incomplete is folded in from the smallest subtree up.
    pub(crate) fn total(&self) -> Rgb {
        self.subtrees.iter().rev().fold(self.block, |sum, (_, subtree)| *subtree + sum)
    }
}

/// The ranges of samples that are rendered one after another: each is a whole subtree, as large as all before it, so that a
/// picture stopped between two of them has the same number of samples everywhere, and the sums still follow the tree.
pub(crate) fn rounds(spp: u32) -> impl Iterator<Item = std::ops::Range<u32>> {
    let mut done = 0u32;
    std::iter::from_fn(move || {
        let start = done;
        done = if done == 0 { BLOCK } else { done.saturating_mul(2) }.min(spp);
        (start < spp).then_some(start..done)
    })
}

/// The pixels of the rendered area.
#[derive(Clone, Debug)]
pub struct Film {
    area: Crop,
    pixels: Vec<Pixel>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pixel {
    pub(crate) sum: Rgb,
    pub(crate) taken: u32,
    pub(crate) counted: u32,
    pub(crate) given_up: f64,
}

impl Film {
    pub(crate) fn new(area: Crop) -> Self {
        Self { area, pixels: vec![Pixel::default(); area.width as usize * area.height as usize] }
    }

    /// Adds the sums of a round to the pixels of a tile (in the coordinates of the whole image, row by row).
    pub(crate) fn add(&mut self, tile: Crop, sums: &[Pixel]) {
        let rows = sums.chunks_exact(tile.width as usize);
        for (row, sums) in (tile.y..tile.y + tile.height).zip(rows) {
            let start =
                (row - self.area.y) as usize * self.area.width as usize + (tile.x - self.area.x) as usize;
            for (pixel, sum) in self.pixels[start..].iter_mut().zip(sums) {
                pixel.sum += sum.sum;
                pixel.taken += sum.taken;
                pixel.counted += sum.counted;
                pixel.given_up += sum.given_up;
            }
        }
    }

    /// The part of the image that the film holds.
    pub fn area(&self) -> Crop {
        self.area
    }

    /// The image: mean radiance of each pixel, linear Rec.709, row by row from the top; black where no sample counts.
    pub fn image(&self) -> Vec<[f32; 3]> {
        let mean = |p: &Pixel| {
            if p.counted == 0 {
                [0.0; 3]
            } else {
                (p.sum / f64::from(p.counted)).to_array().map(|c| c as f32)
            }
        };
        self.pixels.iter().map(mean).collect()
    }

    /// The smallest number of samples taken in any pixel.
    pub fn fewest_samples(&self) -> u32 {
        self.pixels.iter().map(|p| p.taken).min().unwrap_or(0)
    }

    /// How much weight was not followed.
    pub fn given_up(&self) -> GivenUp {
        let of = |p: &Pixel| if p.taken == 0 { 0.0 } else { p.given_up / f64::from(p.taken) };
        let sum: f64 = self.pixels.iter().map(of).sum();
        let largest = self.pixels.iter().map(of).fold(0.0, f64::max);
        GivenUp { mean: sum / self.pixels.len() as f64, largest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(range: std::ops::Range<u32>) -> Rgb {
        let mut pixel = PixelSum::default();
        for i in range {
            pixel.push(Some([libm::sinf(i as f32) + 1.5, 1.0 / (i as f32 + 1.0), i as f32]));
        }
        pixel.total()
    }

    #[test]
    fn rounds_cover_all_samples_and_double() {
        assert_eq!(rounds(100).collect::<Vec<_>>(), [0..8, 8..16, 16..32, 32..64, 64..100]);
        assert_eq!(rounds(5).collect::<Vec<_>>(), vec![0..5]);
        assert_eq!(rounds(16).collect::<Vec<_>>(), [0..8, 8..16]);
    }

    /// The tree of a whole range is the sum of the trees of its rounds, to the last bit.
    #[test]
    fn rounds_sum_to_the_same_bits_as_one_range() {
        for spp in [1, 8, 16, 64, 128, 1024] {
            let by_rounds = rounds(spp).map(sum).reduce(|a, b| a + b).expect("at least one");
            assert_eq!(
                by_rounds.to_array().map(f64::to_bits),
                sum(0..spp).to_array().map(f64::to_bits),
                "{spp}"
            );
        }
    }

    #[test]
    fn dropped_samples_do_not_darken() {
        let mut pixel = PixelSum::default();
        for sample in [Some([2.0, 4.0, 6.0]), None, Some([2.0, 4.0, 6.0])] {
            pixel.push(sample);
        }
        assert_eq!((pixel.total() / f64::from(pixel.counted)).to_array(), [2.0, 4.0, 6.0]);
    }
}
