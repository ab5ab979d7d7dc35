//! What is sampled next, and when it is enough.
//!
//! A picture is made in rounds. Without an error to reach, each doubles the samples of every pixel, up to a fixed number: that is
//! unbiased whatever the picture is. With a limit of time the last round takes as many as still fit.
//!
//! With an error to reach, each round doubles the samples of those squares of pixels that gain most for their cost. What has been
//! averaged must not decide how much of it is averaged (D. Kirk and J. Arvo, Unbiased Sampling Techniques for Image Synthesis,
//! 1991: dark pixels would end early). So there are two buffers of independent samples, and the errors of each say where the
//! other goes on. What both decide together is how many rounds there are, and one factor of all errors. By these, and by way of the
//! other buffer from one round to the one after the next, a sum still has a little say in how long it is: to first order there is no
//! bias, and none has been found.

use crate::film::{BLOCK, Film, next_goal};
use crate::render::{Ended, Progress};
use crate::settings::{Settings, Target};
use std::f64::consts::SQRT_2;

/// Share of the time that is left which a round may take, as the one before it tells.
const SAFETY: f64 = 0.95;
/// A last round of less than this share of the samples so far is not worth it.
const LEAST_ROUND: u32 = 16;
/// Samples that every pixel of a buffer has before errors are asked.
const FIRST: u32 = 16;

/// The rounds of one render.
pub(crate) struct Schedule<'s> {
    settings: &'s Settings,
    /// Seconds left at the start of the round, and its samples.
    round: Option<(f64, u64)>,
}

impl<'s> Schedule<'s> {
    pub(crate) fn new(settings: &'s Settings) -> Self {
        Self { settings, round: None }
    }

    /// Sets the film's goals for the next round, or says why there is none.
    pub(crate) fn next(&mut self, film: &mut Film, progress: &dyn Progress) -> Result<(), Ended> {
        if film.is_unfinished() {
            // A round that was stopped comes first.
        } else {
            let affordable = self.affordable(progress);
            // Where time is limited, a few samples tell what it is good for.
            let is_unknown = affordable.is_none() && progress.seconds_left().is_some();
            match self.settings.until {
                None => self.all(film, affordable, is_unknown)?,
                Some(target) => {
                    let few =
                        f64::from(BLOCK) * film.buffers.len() as f64 * film.buffers[0].pixels.len() as f64;
                    self.some(film, target, affordable.or(is_unknown.then_some(few)))?;
                }
            }
        }
        let samples = film.missing();
        progress.plan(samples);
        self.round = progress.seconds_left().map(|left| (left, samples));
        Ok(())
    }

    /// The number of samples that there is time for, where time is limited and it is known what a sample takes.
    fn affordable(&self, progress: &dyn Progress) -> Option<f64> {
        let left = progress.seconds_left()?;
        let (before, samples) = self.round?;
        Some((left * SAFETY).max(0.0) / (before - left).max(1e-9) * samples as f64)
    }

    /// All pixels alike.
    fn all(&self, film: &mut Film, affordable: Option<f64>, is_unknown: bool) -> Result<(), Ended> {
        let [buffer] = &mut film.buffers[..] else { unreachable!("an error to reach takes two") };
        let goal = buffer.goals[0];
        let mut next = next_goal(goal, self.settings.spp);
        if is_unknown {
            next = next.min(goal.saturating_add(BLOCK));
        }
        if next == goal {
            return Err(Ended::Samples);
        }
        if let Some(samples) = affordable {
            let fit = (samples / buffer.pixels.len() as f64).min(f64::from(u32::MAX)) as u32 / 8 * 8;
            if fit < next - goal {
                if fit == 0 || fit < goal / LEAST_ROUND {
                    return Err(Ended::Time);
                }
                next = goal + fit;
            }
        }
        buffer.goals.fill(next);
        Ok(())
    }

    /// Those squares that need it most.
    fn some(&self, film: &mut Film, target: Target, affordable: Option<f64>) -> Result<(), Ended> {
        let most = (self.settings.spp / 2).max(1);
        let first = film.buffers[0].goals[0];
        if first < FIRST.min(most) {
            let next = next_goal(first, most);
            let samples = 2.0 * f64::from(next - first) * film.buffers[0].pixels.len() as f64;
            if affordable.is_some_and(|affordable| affordable < samples) {
                return Err(Ended::Time);
            }
            for buffer in &mut film.buffers {
                buffer.goals.fill(next);
            }
            return Ok(());
        }
        let (Some(errors), Some(of_a), Some(of_b)) = (film.errors(), film.errors_of(0), film.errors_of(1))
        else {
            return Err(Ended::Samples);
        };
        let sizes = film.costs_of(0);
        let pixels: f64 = sizes.iter().map(|(_, size)| f64::from(*size)).sum();
        let mean = |errors: &[f64]| {
            errors.iter().zip(&sizes).map(|(error, (_, size))| error * f64::from(*size)).sum::<f64>() / pixels
        };
        let reached = mean(&errors);
        // Halves of one sequence differ more than independent sequences of their mean's error: by how much, both buffers tell.
        let overestimate = 0.25 * (mean(&of_a) + mean(&of_b));
        let scale = if overestimate > 0.0 { (reached / overestimate).clamp(0.1, 10.0) } else { 1.0 };
        if matches!(target, Target::RelMse(limit) if reached <= limit) {
            return Err(Ended::Error);
        }
        let wanted = [(0, &of_b), (1, &of_a)].map(|(buffer, of_other)| {
            // The error of the mean of both buffers, if the other one were like this one: of as many samples.
            let (own, other) = (&film.buffers[buffer].goals, &film.buffers[1 - buffer].goals);
            let ratio = |at: usize| f64::from(other[at]) / f64::from(own[at]);
            let errors: Vec<f64> = pooled(film, of_other)
                .iter()
                .enumerate()
                .map(|(at, error)| 0.5 * scale * error * ratio(at))
                .collect();
            match target {
                Target::RelMse(limit) => best(film, buffer, &errors, limit, most),
                Target::Noise(limit) => {
                    let above = |at: &usize| errors[*at] > limit * limit;
                    let mut order: Vec<usize> = (0..errors.len()).filter(above).collect();
                    order.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]).then(a.cmp(b)));
                    order
                }
            }
        });
        let (mut any, mut capped, mut late) = (false, false, false);
        for (buffer, wanted) in film.buffers.iter_mut().zip(wanted) {
            let mut left = affordable.map_or(f64::INFINITY, |samples| 0.5 * samples);
            for square in wanted {
                let goal = buffer.goals[square];
                let next = next_goal(goal, most);
                let samples = f64::from(next - goal) * f64::from(sizes[square].1);
                if next == goal {
                    capped = true;
                } else if samples > left {
                    late = true;
                } else {
                    left -= samples;
                    buffer.goals[square] = next;
                    any = true;
                }
            }
        }
        match (any, late, capped) {
            (true, ..) => Ok(()),
            (false, true, _) => Err(Ended::Time),
            (false, false, false) if matches!(target, Target::Noise(_)) => Err(Ended::Error),
            (false, false, _) => Err(Ended::Samples),
        }
    }
}

/// The squares whose samples should be doubled on the cheapest way to a mean error of `limit`, those that gain most first.
///
/// Where an error is a variance over a number of samples, and samples have their cost, the best numbers are proportional to the
/// root of variance over cost; the factor is the one that brings the error to the limit. None gets more than `most`.
fn best(film: &Film, buffer: usize, errors: &[f64], limit: f64, most: u32) -> Vec<usize> {
    let costs = film.costs_of(1 - buffer);
    let (goals, pixels) = (&film.buffers[buffer].goals, film.buffers[buffer].pixels.len() as f64);
    let samples = |square: usize| f64::from(goals[square]);
    let share = |square: usize| f64::from(costs[square].1) / pixels;
    let per_sample = |square: usize| errors[square] * samples(square);
    // Rays of a sample, in the other buffer.
    let taken = &film.buffers[1 - buffer].goals;
    let cost = |square: usize| {
        costs[square].0.max(1) as f64 / (f64::from(taken[square]) * f64::from(costs[square].1))
    };
    let ideal: Vec<f64> = (0..errors.len()).map(|at| (per_sample(at) / cost(at)).sqrt()).collect();
    let error = |factor: f64| -> f64 {
        let of = |at: usize| {
            share(at) * per_sample(at) / samples(at).max((factor * ideal[at]).min(f64::from(most)))
        };
        (0..errors.len()).map(of).sum()
    };
    let (mut low, mut high) = (1e-12_f64, 1e24_f64);
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        if error(middle) > limit { low = middle } else { high = middle }
    }
    // Rounded to the nearest power of two, of all at least the one that is farthest below.
    let lack = |at: usize| high * ideal[at] / samples(at);
    let grows = |at: &usize| errors[*at] > 0.0 && next_goal(goals[*at], most) > goals[*at];
    let mut order: Vec<usize> = (0..errors.len()).filter(grows).collect();
    order.sort_by(|a, b| lack(*b).total_cmp(&lack(*a)).then(a.cmp(b)));
    let enough = order.iter().take_while(|at| lack(**at) > SQRT_2).count();
    order.truncate(enough.max(order.len().div_ceil(64)));
    order
}

/// The error of each square, but at least a sixteenth of the mean of three by three: rare bright samples seen next door are likely
/// here too.
fn pooled(film: &Film, errors: &[f64]) -> Vec<f64> {
    let (columns, rows) = film.squares();
    let (columns, rows) = (columns as usize, rows as usize);
    let around = |square: usize| {
        let (x, y) = (square % columns, square / columns);
        let near = (y.saturating_sub(1)..(y + 2).min(rows))
            .flat_map(move |y| (x.saturating_sub(1)..(x + 2).min(columns)).map(move |x| y * columns + x));
        let (sum, count) = near.fold((0.0, 0.0), |(sum, count), at| (sum + errors[at], count + 1.0));
        errors[square].max(sum / (16.0 * count))
    };
    (0..errors.len()).map(around).collect()
}
