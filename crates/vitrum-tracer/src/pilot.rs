//! Which of the rays that glass divides are followed, square of pixels by square: found by trying (`trial.rs`).
//!
//! Following more of them makes a sample cost more and vary less. First comes the picture as a whole: squares all over it are tried
//! with nets, and the way of the least error times cost is its best one. Then each square is tried with single samples, whose
//! variances count by the factors that nets made of them all over the picture. Where every pixel has as many samples, what counts is
//! the error of the whole picture times its cost: so a square takes another way where that has the lesser sum of both, error over
//! that of the picture and cost over that of the picture. Where there is little error, trees would cost more than they save. It must be
//! clearly better, and a square is judged together with its neighbours, for its own few samples say little.
//!
//! Costs are counted in rays and not read from a clock, so that the same picture comes out anywhere; rays inside a large mesh count
//! more ([`Scene::ray_cost`]).
//!
//! The numbers that are tried are drawn for that alone, so that what is decided has nothing to do with the samples that are averaged:
//! any choice leaves the picture unbiased. It depends on the scene, the settings and the place in the whole image, and on nothing
//! that has been rendered.

use crate::film::{Film, SQUARE};
use crate::filter::FilterSampler;
use crate::path::AnyPath;
use crate::render::{Progress, Setup};
use crate::settings::{Branching, Integrator};
use crate::threads::on_each;
use crate::trial::{self, Findings, WAYS};
use crate::walker::Walker;

/// At most so many squares across and down tell what the picture is like, and about one on so many pixels. Then all trials
/// together are about three samples of a hundred where there are sixteen a pixel; more where a part of a picture is rendered, for
/// the whole is asked.
const ACROSS: u32 = 16;
const PIXELS_EACH: u64 = 300;
/// A square goes another way than the picture where that is better by this factor.
const CLEARLY: f64 = 0.8;

/// What is best for the picture as a whole.
struct Verdict {
    /// The place of the best way, if all squares take the same.
    best: usize,
    /// By what nets multiply the variances that single samples show: that of trees, and what each way adds.
    between: f64,
    within: [f64; WAYS.len()],
    /// What a ray is worth in error: that of the picture over its cost.
    price: f64,
}

impl Verdict {
    /// From what single samples and nets tell of squares all over the picture.
    fn of(surveyed: &[[Findings; 2]]) -> Self {
        let [mut singles, mut nets] = [Findings::default(); 2];
        for [of_singles, of_nets] in surveyed {
            singles.add(of_singles);
            nets.add(of_nets);
        }
        let error = |way: usize| nets.between + nets.within[way];
        let product = |way: &usize| error(*way) * nets.cost[*way];
        let best = (0..WAYS.len()).min_by(|a, b| product(a).total_cmp(&product(b))).expect("there are ways");
        // Where nothing varies, factors multiply nothing.
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 1.0 };
        Self {
            best,
            between: ratio(nets.between, singles.between),
            within: std::array::from_fn(|way| ratio(nets.within[way], singles.within[way])),
            price: if nets.cost[best] > 0.0 { error(best) / nets.cost[best] } else { 0.0 },
        }
    }

    /// The way of a square.
    fn on(&self, square: &Findings) -> Branching {
        let worth = |way: &usize| {
            let error = self.between * square.between + self.within[*way] * square.within[*way];
            error + self.price * square.cost[*way]
        };
        let others = (0..WAYS.len()).filter(|way| *way != self.best);
        let other = others.min_by(|a, b| worth(a).total_cmp(&worth(b))).expect("there are other ways");
        WAYS[if worth(&other) < CLEARLY * worth(&self.best) { other } else { self.best }]
    }
}

/// How the paths of each square of the film branch, and the rays that it took to find out.
pub(crate) fn branching(
    setup @ Setup { settings, plan, .. }: Setup<'_>,
    filter: &FilterSampler,
    film: &Film,
    progress: &dyn Progress,
) -> (Vec<Branching>, u64) {
    let (columns, rows) = film.squares();
    let all = |way: Branching| (vec![way; columns as usize * rows as usize], 0);
    match settings.branches() {
        Branching::Auto if settings.integrator == Integrator::Whitted || !plan.divides => {
            return all(Branching::Tree);
        }
        Branching::Auto => {}
        given => return all(given),
    }
    let whole = settings.size.map(|side| side.div_ceil(SQUARE));
    let pixels = u64::from(settings.size[0]) * u64::from(settings.size[1]);
    let across = ((pixels / PIXELS_EACH).isqrt() as u32).clamp(1, ACROSS);
    let all_over = whole.map(|squares| -> Vec<u32> {
        let count = squares.min(across);
        (0..count).map(|i| (2 * i + 1) * squares / (2 * count)).collect()
    });
    let survey = |walker: &mut Walker<'_, AnyPath>, square| trial::nets(walker, filter, square);
    let (surveyed, survey_rays) = tried(setup, &all_over, survey, progress);
    let verdict = Verdict::of(&surveyed);

    // A square is judged with its neighbours in the whole image, so that a part of it is judged the same.
    let first = [settings.area().x, settings.area().y].map(|at| at / SQUARE);
    let from = first.map(|square| square.saturating_sub(1));
    let to = [(first[0] + columns + 1).min(whole[0]), (first[1] + rows + 1).min(whole[1])];
    let here = [0, 1].map(|axis| (from[axis]..to[axis]).collect::<Vec<u32>>());
    let look = |walker: &mut Walker<'_, AnyPath>, square| trial::singles(walker, filter, square);
    let (found, rays) = tried(setup, &here, look, progress);
    let judged = |at: u32| {
        let (column, row) = (first[0] + at % columns, first[1] + at / columns);
        let mut sum = Findings::default();
        for y in row.saturating_sub(1).max(from[1])..(row + 2).min(to[1]) {
            for x in column.saturating_sub(1).max(from[0])..(column + 2).min(to[0]) {
                sum.add(&found[((y - from[1]) * (to[0] - from[0]) + x - from[0]) as usize]);
            }
        }
        verdict.on(&sum)
    };
    ((0..columns * rows).map(judged).collect(), survey_rays + rays)
}

/// What is found of the squares in columns and rows, row by row, and the rays that it took. What is stopped now is stopped before
/// the first sample.
fn tried<T: Default + Send>(
    setup: Setup<'_>,
    [columns, rows]: &[Vec<u32>; 2],
    look: impl Fn(&mut Walker<'_, AnyPath>, [u32; 2]) -> T + Sync,
    progress: &dyn Progress,
) -> (Vec<T>, u64) {
    let squares: Vec<[u32; 2]> =
        rows.iter().flat_map(|row| columns.iter().map(|column| [*column, *row])).collect();
    let done = on_each(setup.settings, &squares, |square| {
        let mut walker = Walker::<AnyPath>::new(setup);
        let found = if progress.is_stopped() { T::default() } else { look(&mut walker, *square) };
        (found, walker.stats.rays())
    });
    let rays = done.iter().map(|(_, rays)| rays).sum();
    (done.into_iter().map(|(found, _)| found).collect(), rays)
}
