//! One program against another, from runs in pairs: the same scene, samples and seed, one right after the other.

use super::Record;
use crate::page::in_order;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use vitrum_measure::{Interval, interval_of_mean};

/// The probability that an interval holds what it is about.
const PROBABILITY: f64 = 0.95;

/// The most samples that a pair may have less than the most of its scene, as a factor: below, most of the time is not rendering.
const SHORT: u32 = 8;

/// Ratios of a scene, after over before, with their intervals.
struct Ratios {
    seconds: Interval,
    error: Interval,
    work: Interval,
}

/// What the pairs of each scene say, and all scenes together.
pub(super) fn table(records: &[Record], [before, after]: [&str; 2]) -> String {
    let mut text = format!(
        "\n{after} over {before}; below 1 is better. Bootstrap intervals of 95 % over the seeds, which hold about 85 % with five of\n\
         them and 90 % with ten\n\
         {:<28} {:>22} {:>22} {:>22}\n",
        "scene", "seconds", "relMSE", "seconds x relMSE"
    );
    let mut all: Vec<BTreeMap<u64, Logs>> = Vec::new();
    for scene in in_order(records.iter().map(|record| record.scene.as_str())) {
        let of = |program: &str| -> Vec<&Record> {
            records.iter().filter(|r| r.scene == scene && r.program == program && r.is_told()).collect()
        };
        let logs = logs(&of(before), &of(after));
        // Writing to a String can't fail.
        let _ = match Ratios::of(logs.values().copied()) {
            Some(ratios) => writeln!(text, "{scene:<28} {}", ratios.line()),
            None => writeln!(text, "{scene:<28} no pair of runs whose errors the reference can tell"),
        };
        all.push(logs);
    }
    // A seed stands for one picture of every scene: its mean over those that have it.
    all.retain(|logs| !logs.is_empty());
    let seeds: BTreeSet<u64> = all.iter().flat_map(|logs| logs.keys().copied()).collect();
    let together = seeds.iter().map(|seed| mean(all.iter().filter_map(|logs| logs.get(seed).copied())));
    if let (Some(ratios), true) = (Ratios::of(together), all.len() > 1) {
        let _ = writeln!(text, "{:<28} {}", "all", ratios.line());
    }
    text
}

/// Logarithms of the ratios of seconds, of errors and of their product.
type Logs = [f64; 3];

/// By seed: the mean over numbers of samples.
fn logs(before: &[&Record], after: &[&Record]) -> BTreeMap<u64, Logs> {
    let most = before.iter().map(|r| r.spp).max().unwrap_or(0);
    let mut pairs: BTreeMap<u64, Vec<Logs>> = BTreeMap::new();
    for a in before.iter().filter(|r| r.spp >= most / SHORT && r.error() > 0.0) {
        if let Some(b) = after.iter().find(|b| b.seed == a.seed && b.spp == a.spp && b.error() > 0.0) {
            let [time, error] = [b.seconds() / a.seconds(), b.error() / a.error()].map(f64::ln);
            pairs.entry(a.seed).or_default().push([time, error, time + error]);
        }
    }
    pairs.into_iter().map(|(seed, pairs)| (seed, mean(pairs.into_iter()))).collect()
}

fn mean(all: impl Iterator<Item = Logs>) -> Logs {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for logs in all {
        (0..3).for_each(|i| sum[i] += logs[i]);
        count += 1.0;
    }
    sum.map(|s| s / count)
}

impl Ratios {
    /// None without seeds.
    fn of(seeds: impl Iterator<Item = Logs>) -> Option<Self> {
        let seeds: Vec<Logs> = seeds.collect();
        let ratio = |which: usize| {
            let logs: Vec<f64> = seeds.iter().map(|logs| logs[which]).collect();
            let Interval { mean, low, high } = interval_of_mean(&logs, PROBABILITY)?;
            Some(Interval { mean: mean.exp(), low: low.exp(), high: high.exp() })
        };
        Some(Self { seconds: ratio(0)?, error: ratio(1)?, work: ratio(2)? })
    }

    fn line(&self) -> String {
        [self.seconds, self.error, self.work]
            .map(|Interval { mean, low, high }| format!("{mean:>7.3} ({low:.3}-{high:.3})"))
            .map(|cell| format!("{cell:>22}"))
            .join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::errors::Errors;

    /// A run that takes `seconds` and is off by `error`.
    fn run(program: &str, spp: u32, seed: u64, seconds: f64, error: f64) -> Record {
        let errors = Errors {
            rmse: 0.0,
            rel_mse: error + 1e-6,
            rel_mse_trimmed: 0.0,
            mape: 0.0,
            flip: 0.0,
            bias: 0.0,
            bias_error: 0.0,
            max_abs: 0.0,
        };
        Record {
            scene: "scene".to_owned(),
            program: program.to_owned(),
            version: String::new(),
            machine: String::new(),
            spp,
            seed,
            loading: 0.25 * seconds,
            rendering: 0.75 * seconds,
            processors: None,
            rays: None,
            errors,
            reference_error: 1e-6,
            reference: "r.exr".into(),
            picture: None,
        }
    }

    #[test]
    fn known_ratios_are_found() {
        // Twice as long and a quarter of the error, whatever the samples and the seed are like.
        let mut records = Vec::new();
        for seed in 1..=5 {
            for spp in [16, 32] {
                let (seconds, error) = (0.01 * f64::from(spp) * seed as f64, 0.1 / f64::from(spp));
                records.push(run("a", spp, seed, seconds, error));
                records.push(run("b", spp, seed, 2.0 * seconds, 0.25 * error));
            }
        }
        let text = table(&records, ["a", "b"]);
        let row = text.lines().find(|line| line.starts_with("scene  ") && line.contains('(')).expect("a row");
        for ratio in ["2.000 (2.000-2.000)", "0.250 (0.250-0.250)", "0.500 (0.500-0.500)"] {
            assert!(row.contains(ratio), "{text}");
        }
        // Errors that the reference cannot tell make no pair.
        let records = [run("a", 16, 1, 1.0, 1e-6), run("b", 16, 1, 1.0, 1e-6)];
        assert!(table(&records, ["a", "b"]).contains("no pair of runs"));
    }
}
