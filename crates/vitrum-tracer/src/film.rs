//! The film: sums of samples in an order that nothing can change.
//!
//! The samples of a pixel are summed in double precision, in order, in blocks of 8; blocks are combined by a perfect binary
//! tree on the block index. So any range of whole subtrees can be summed elsewhere and put together to the same bytes.

use crate::settings::Crop;
use crate::stats::GivenUp;
use vitrum_math::{NodeKey, Purpose, Rgb, SampleAddress, Sequence};

/// Samples in a block.
pub(crate) const BLOCK: u32 = 8;

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

/// The goal that comes after `goal`, on the way to `last`, never less: each round is a whole subtree, as large as all before it, so
/// that a picture stopped between two of them has the same number of samples everywhere, and the sums still follow the tree.
pub(crate) fn next_goal(goal: u32, last: u32) -> u32 {
    let next = if goal == 0 { BLOCK } else { goal.saturating_mul(2) };
    next.min(last).max(goal)
}

/// No film has more samples in a pixel.
const MOST_SAMPLES: u32 = 1 << 30;

/// Edge of the squares of pixels, at multiples of itself in the whole image, that have the same number of samples.
pub(crate) const SQUARE: u32 = 8;

/// The pixels of the rendered area.
///
/// Once, or twice where two buffers of independent random numbers watch each other (see [`Target`](crate::Target)); the image
/// is then the mean of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    pub(crate) area: Crop,
    pub(crate) buffers: Vec<Buffer>,
}

/// The pixels of one sequence of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    /// For each square of 8 x 8 pixels of the whole image that the area touches, row by row, the samples that its pixels are
    /// to have at the end of the present round.
    pub goals: Vec<u32>,
    /// The pixels of the area, row by row.
    pub pixels: Vec<Pixel>,
}

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Sum of the samples of all rounds but the last that it took part in.
    pub before: Rgb,
    /// Sum of the samples of that one.
    pub last: Rgb,
    /// Samples taken.
    pub taken: u32,
    /// Samples that count: those that were not dropped.
    pub counted: u32,
    /// Those of the last round among them.
    pub last_counted: u32,
    /// Weight of the subtrees of rays that were not followed, summed over the samples.
    pub given_up: f64,
    /// Rays of all kinds.
    pub rays: u64,
}

/// The error of an image, as its samples tell it.
///
/// The unit is that of relMSE: squared error over the squared radiance plus 0.01, averaged over channels and pixels. Light that
/// no sample has found is not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// The estimate.
    pub rel_mse: f64,
    /// An interval that holds it with a probability of roughly 90 %, from the differences between squares of the image.
    pub interval: [f64; 2],
}

/// A film that does not fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the parts of the film do not fit its size")]
pub struct FilmError;

impl Pixel {
    /// Adds a round.
    fn add(&mut self, round: &Self) {
        self.before += self.last;
        self.last = round.last;
        self.taken += round.taken;
        self.counted += round.last_counted;
        self.last_counted = round.last_counted;
        self.given_up += round.given_up;
        self.rays += round.rays;
    }

    /// Mean of the samples that count; black without any.
    fn mean(&self) -> Rgb {
        if self.counted == 0 { Rgb::ZERO } else { (self.before + self.last) / f64::from(self.counted) }
    }

    /// The squared standard error of the mean, from the difference between the last round and all before it. Both are nets of
    /// their own, so it is rather too large; none where there is only one round.
    fn variance(&self) -> Option<Rgb> {
        let (last, before) = (f64::from(self.last_counted), f64::from(self.counted - self.last_counted));
        if last == 0.0 || before == 0.0 {
            return None;
        }
        let apart = self.before / before - self.last / last;
        let all = last + before;
        Some(apart * apart * (last * before / (all * all)))
    }
}

/// A variance as relMSE has it, the mean of the channels.
fn relative(variance: Rgb, mean: Rgb) -> f64 {
    (variance / (mean * mean + Rgb::splat(0.01))).element_sum() / 3.0
}

impl Film {
    /// An empty film with one buffer, or two.
    pub(crate) fn new(area: Crop, buffers: usize) -> Self {
        let mut film = Self { area, buffers: Vec::new() };
        let goals = vec![0; film.squares().0 as usize * film.squares().1 as usize];
        let pixels = vec![Pixel::default(); area.width as usize * area.height as usize];
        film.buffers = vec![Buffer { goals, pixels }; buffers];
        film
    }

    /// A film of its parts.
    ///
    /// # Errors
    /// [`FilmError`] where there are not one or two buffers, or a buffer has not the squares and pixels of the area, a pixel more
    /// samples than its square is to have, or numbers that no samples give; and where the only buffer has not the same goal
    /// everywhere.
    pub fn from_parts(area: Crop, buffers: Vec<Buffer>) -> Result<Self, FilmError> {
        let (squares, pixels) = Self::extent(area).ok_or(FilmError)?;
        let film = Self { area, buffers };
        let fits = |buffer: &Buffer| {
            let has_all = buffer.goals.len() == squares && buffer.pixels.len() == pixels;
            let within = |(at, pixel): (usize, &Pixel)| {
                let goal = buffer.goals[film.square_of(at)];
                let counts = pixel.taken <= goal
                    && pixel.counted <= pixel.taken
                    && pixel.last_counted <= pixel.counted
                    && pixel.rays < 1 << 40;
                counts && pixel.before.is_finite() && pixel.last.is_finite() && pixel.given_up.is_finite()
            };
            has_all && buffer.pixels.iter().enumerate().all(within)
        };
        let goals = |buffer: &Buffer| {
            let same = film.buffers.len() == 2 || buffer.goals.windows(2).all(|pair| pair[0] == pair[1]);
            same && buffer.goals.iter().all(|goal| *goal <= MOST_SAMPLES)
        };
        if matches!(film.buffers.len(), 1 | 2)
            && film.buffers.iter().all(goals)
            && film.buffers.iter().all(fits)
        {
            Ok(film)
        } else {
            Err(FilmError)
        }
    }

    /// The number of squares that an area touches, and of its pixels; `None` for an area without any or of too many.
    pub fn extent(area: Crop) -> Option<(usize, usize)> {
        let end = |from: u32, length: u32| from.checked_add(length).filter(|_| length > 0);
        end(area.x, area.width).zip(end(area.y, area.height))?;
        let (columns, rows) = Self { area, buffers: Vec::new() }.squares();
        let product = |a: u32, b: u32| (a as usize).checked_mul(b as usize);
        product(columns, rows).zip(product(area.width, area.height))
    }

    /// Its buffers.
    pub fn buffers(&self) -> &[Buffer] {
        &self.buffers
    }

    /// The part of the image that the film holds.
    pub fn area(&self) -> Crop {
        self.area
    }

    /// Columns and rows of squares that the area touches.
    pub(crate) fn squares(&self) -> (u32, u32) {
        let touched = |from: u32, length: u32| (from + length - 1) / SQUARE - from / SQUARE + 1;
        (touched(self.area.x, self.area.width), touched(self.area.y, self.area.height))
    }

    /// The square that a pixel of the whole image lies in.
    pub(crate) fn square(&self, x: u32, y: u32) -> usize {
        let (column, row) = (x / SQUARE - self.area.x / SQUARE, y / SQUARE - self.area.y / SQUARE);
        row as usize * self.squares().0 as usize + column as usize
    }

    /// The same by its place in the area.
    pub(crate) fn square_of(&self, pixel: usize) -> usize {
        let (row, column) = (pixel / self.area.width as usize, pixel % self.area.width as usize);
        self.square(self.area.x + column as u32, self.area.y + row as u32)
    }

    /// The place of a pixel of the whole image in the area.
    pub(crate) fn place(&self, x: u32, y: u32) -> usize {
        (y - self.area.y) as usize * self.area.width as usize + (x - self.area.x) as usize
    }

    /// True while a pixel lacks samples of the present round.
    pub(crate) fn is_unfinished(&self) -> bool {
        self.missing() > 0
    }

    /// Samples that the present round lacks.
    pub(crate) fn missing(&self) -> u64 {
        let lacks = |buffer: &Buffer| {
            let pixels = buffer.pixels.iter().enumerate();
            pixels.map(|(at, pixel)| u64::from(buffer.goals[self.square_of(at)] - pixel.taken)).sum::<u64>()
        };
        self.buffers.iter().map(lacks).sum()
    }

    /// Adds what a round brought to the pixels of a tile (in the coordinates of the whole image, row by row).
    pub(crate) fn add(&mut self, buffer: usize, tile: Crop, round: &[Pixel]) {
        for (row, line) in (tile.y..).zip(round.chunks_exact(tile.width as usize)) {
            let start = self.place(tile.x, row);
            let pixels = &mut self.buffers[buffer].pixels[start..][..line.len()];
            for (pixel, more) in pixels.iter_mut().zip(line).filter(|(_, more)| more.taken > 0) {
                pixel.add(more);
            }
        }
    }

    /// The image: mean radiance of each pixel, linear Rec.709, row by row from the top; black where no sample counts.
    pub fn image(&self) -> Vec<[f32; 3]> {
        let pixels = 0..self.buffers[0].pixels.len();
        pixels.map(|at| self.mean(at).to_array().map(|c| c as f32)).collect()
    }

    fn mean(&self, at: usize) -> Rgb {
        match &self.buffers[..] {
            [one] => one.pixels[at].mean(),
            // A round that was stopped may have reached one of both.
            [a, b] if a.pixels[at].counted == 0 => b.pixels[at].mean(),
            [a, b] if b.pixels[at].counted == 0 => a.pixels[at].mean(),
            both => (both[0].pixels[at].mean() + both[1].pixels[at].mean()) * 0.5,
        }
    }

    /// The squared standard error of a pixel's mean: of two buffers from their difference, of one from its rounds; none where
    /// there are too few samples.
    fn variance(&self, at: usize) -> Option<Rgb> {
        match &self.buffers[..] {
            [a, b] => {
                let (a, b) = (&a.pixels[at], &b.pixels[at]);
                let apart = (a.mean() - b.mean()) * 0.5;
                (a.counted > 0 && b.counted > 0).then(|| apart * apart)
            }
            buffers => buffers[0].pixels[at].variance(),
        }
    }

    /// The standard error of each pixel and channel, row by row: the root of the mean of its squares over the pixel and its
    /// neighbours, since one difference alone tells little. Zero where none of them tells; `None` where no pixel does: one buffer
    /// takes two rounds, two take one.
    pub fn standard_error(&self) -> Option<Vec<[f32; 3]>> {
        let (width, height) = (self.area.width as usize, self.area.height as usize);
        let variances: Vec<Option<Rgb>> = (0..width * height).map(|at| self.variance(at)).collect();
        if variances.iter().all(Option::is_none) {
            return None;
        }
        let pooled = |at: usize| {
            let (x, y) = (at % width, at / width);
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            let near = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
            let known = near.filter_map(|at| variances[at]);
            let (sum, count) = known.fold((Rgb::ZERO, 0.0), |(sum, count), v| (sum + v, count + 1.0));
            (sum / f64::max(count, 1.0)).to_array().map(|v| v.sqrt() as f32)
        };
        Some((0..width * height).map(pooled).collect())
    }

    /// Mean of a value over those pixels of each square that have one, zero where none has; `None` where no pixel of all has.
    fn by_square(&self, value: impl Fn(usize) -> Option<f64>) -> Option<Vec<f64>> {
        let (columns, rows) = self.squares();
        let mut sums = vec![(0.0, 0.0); columns as usize * rows as usize];
        for at in 0..self.buffers[0].pixels.len() {
            if let Some(value) = value(at) {
                let (sum, count) = &mut sums[self.square_of(at)];
                *sum += value;
                *count += 1.0;
            }
        }
        let any = sums.iter().any(|(_, count)| *count > 0.0);
        any.then(|| sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect())
    }

    /// For each square the error of the image.
    pub(crate) fn errors(&self) -> Option<Vec<f64>> {
        self.by_square(|at| Some(relative(self.variance(at)?, self.mean(at))))
    }

    /// For each square the error of one buffer, by itself.
    pub(crate) fn errors_of(&self, buffer: usize) -> Option<Vec<f64>> {
        let pixels = &self.buffers[buffer].pixels;
        self.by_square(|at| Some(relative(pixels[at].variance()?, pixels[at].mean())))
    }

    /// For each square the rays of one buffer, and its pixels.
    pub(crate) fn costs_of(&self, buffer: usize) -> Vec<(u64, u32)> {
        let (columns, rows) = self.squares();
        let mut costs = vec![(0, 0); columns as usize * rows as usize];
        for (at, pixel) in self.buffers[buffer].pixels.iter().enumerate() {
            let (rays, pixels) = &mut costs[self.square_of(at)];
            *rays += pixel.rays;
            *pixels += 1;
        }
        costs
    }

    /// The error of the image; `None` where there are too few samples: one buffer takes two rounds, two take one.
    pub fn error(&self) -> Option<ErrorEstimate> {
        const RESAMPLES: u32 = 200;
        let errors = self.errors()?;
        let sizes = self.costs_of(0);
        let count = errors.len();
        let mean_of = |chosen: &mut dyn Iterator<Item = usize>| {
            let (mut sum, mut pixels) = (0.0, 0.0);
            for square in chosen {
                let size = f64::from(sizes[square].1);
                sum += errors[square] * size;
                pixels += size;
            }
            sum / pixels
        };
        // The bootstrap (B. Efron, 1979): squares are drawn anew, with replacement.
        let resampled = |resample: u32| {
            let draw = |i: usize| {
                let address = SampleAddress::new(0, resample, i as u32, 0).of_sequence(Sequence::Independent);
                let [u, _] = address.pair(NodeKey::ROOT, Purpose::Film);
                ((u * count as f64) as usize).min(count - 1)
            };
            mean_of(&mut (0..count).map(draw))
        };
        let mut means: Vec<f64> = (0..RESAMPLES).map(resampled).collect();
        means.sort_by(f64::total_cmp);
        let at = |share: f64| means[(share * f64::from(RESAMPLES - 1)) as usize];
        Some(ErrorEstimate { rel_mse: mean_of(&mut (0..count)), interval: [at(0.05), at(0.95)] })
    }

    /// The smallest and the largest number of samples taken in any pixel, of all buffers together.
    pub fn samples(&self) -> [u32; 2] {
        let (least, most) =
            self.taken().fold((u32::MAX, 0), |(least, most): (u32, u32), n: u32| (least.min(n), most.max(n)));
        [least, most]
    }

    /// The number of samples of each pixel, row by row.
    pub fn sample_counts(&self) -> Vec<u32> {
        self.taken().collect()
    }

    fn taken(&self) -> impl Iterator<Item = u32> {
        let pixels = 0..self.buffers[0].pixels.len();
        pixels.map(|at| self.buffers.iter().map(|b| b.pixels[at].taken).sum())
    }

    /// How much weight was not followed.
    pub fn given_up(&self) -> GivenUp {
        let of = |p: &Pixel| if p.taken == 0 { 0.0 } else { p.given_up / f64::from(p.taken) };
        let pixels = || self.buffers.iter().flat_map(|b| &b.pixels).map(of);
        let largest = pixels().fold(0.0, f64::max);
        let count = self.buffers.iter().map(|b| b.pixels.len()).sum::<usize>();
        GivenUp { mean: pixels().sum::<f64>() / count as f64, largest }
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

    fn goals(spp: u32) -> Vec<u32> {
        std::iter::successors(Some(next_goal(0, spp)), |goal| {
            Some(next_goal(*goal, spp)).filter(|n| n > goal)
        })
        .collect()
    }

    #[test]
    fn goals_double_up_to_the_last() {
        assert_eq!(goals(100), [8, 16, 32, 64, 100]);
        assert_eq!(goals(5), [5]);
        assert_eq!(goals(16), [8, 16]);
        assert_eq!(next_goal(64, 32), 64, "what has been taken stays");
    }

    /// The tree of a whole range is the sum of the trees of its rounds, to the last bit.
    #[test]
    fn rounds_sum_to_the_same_bits_as_one_range() {
        for spp in [1, 8, 16, 64, 128, 1024] {
            let mut pixel = Pixel::default();
            let mut from = 0;
            for goal in goals(spp) {
                let counted = goal - from;
                pixel.add(&Pixel {
                    last: sum(from..goal),
                    taken: counted,
                    counted,
                    last_counted: counted,
                    ..Pixel::default()
                });
                from = goal;
            }
            let by_rounds = pixel.before + pixel.last;
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
