//! What the runs of a program on a scene come to.

use crate::bench::{Record, TELLING};
use vitrum_measure::{Curve, Reached, curve::geometric_mean};

/// Errors that seconds are told to.
pub(crate) const TARGETS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// The figures of one program on one scene.
pub(crate) struct Figures {
    pub(crate) scene: String,
    pub(crate) program: String,
    /// By rising samples.
    pub(crate) points: Vec<Point>,
    reached: [String; TARGETS.len()],
    efficiency: Option<f64>,
    slope: Option<f64>,
    bias: Option<[f64; 2]>,
    loading: f64,
}

/// All seeds of a number of samples.
pub(crate) struct Point {
    pub(crate) seconds: f64,
    /// Geometric mean.
    pub(crate) error: f64,
    /// The least and the largest.
    pub(crate) range: [f64; 2],
}

/// Each name once, in the order of first sight.
pub(crate) fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found: Vec<&str> = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

impl Figures {
    /// Scene by scene, in the order of first sight.
    pub(crate) fn of_all(records: &[Record]) -> Vec<Self> {
        let mut all = Vec::new();
        for scene in in_order(records.iter().map(|r| r.scene.as_str())) {
            for program in in_order(records.iter().map(|r| r.program.as_str())) {
                let of = records.iter().filter(|r| r.scene == scene && r.program == program);
                // What the reference cannot tell is not shown.
                all.extend(Self::new(&of.filter(|r| r.is_told()).collect::<Vec<_>>()));
            }
        }
        all
    }

    /// None without records.
    fn new(records: &[&Record]) -> Option<Self> {
        let first = records.first()?;
        let sorted = |mut values: Vec<u64>| {
            values.sort_unstable();
            values.dedup();
            values
        };
        let seeds = sorted(records.iter().map(|r| r.seed).collect());
        let samples = sorted(records.iter().map(|r| u64::from(r.spp)).collect());
        let with = |spp: u64| records.iter().filter(move |r| u64::from(r.spp) == spp);
        let points: Vec<Point> = samples
            .iter()
            .filter_map(|spp| {
                let errors: Vec<f64> = with(*spp).map(|r| r.error()).filter(|e| *e > 0.0).collect();
                let seconds: Vec<f64> = with(*spp).map(|r| r.seconds()).collect();
                let fold = |f: fn(f64, f64) -> f64| errors.iter().copied().reduce(f);
                Some(Point {
                    seconds: geometric_mean(&seconds)?,
                    error: geometric_mean(&errors)?,
                    range: [fold(f64::min)?, fold(f64::max)?],
                })
            })
            .collect();
        let curves: Vec<Curve> = seeds
            .iter()
            .map(|seed| {
                let of = records.iter().filter(|r| r.seed == *seed);
                Curve::new(of.map(|r| [r.seconds(), r.error()]))
            })
            .collect();
        let slopes: Vec<f64> = seeds
            .iter()
            .filter_map(|seed| {
                let of = records.iter().filter(|r| r.seed == *seed);
                long_runs(&Curve::new(of.map(|r| [r.rendering, r.error()]))).slope()
            })
            .collect();
        let last: Vec<&&Record> = with(*samples.last()?).collect();
        let works: Vec<f64> = last.iter().map(|r| 1.0 / (r.error() * r.seconds())).collect();
        let biases: Vec<f64> = last.iter().map(|r| r.errors.bias).collect();
        let least_told = TELLING * first.reference_error;
        let reading = |target| if target < least_told { "-".to_owned() } else { reading(&curves, target) };
        Some(Self {
            scene: first.scene.clone(),
            program: first.program.clone(),
            points,
            reached: TARGETS.map(reading),
            efficiency: geometric_mean(&works),
            slope: (!slopes.is_empty()).then(|| mean(&slopes)),
            bias: bias(&biases),
            loading: mean(&records.iter().map(|r| r.loading).collect::<Vec<_>>()),
        })
    }

    /// The cells of its row, after scene and program.
    pub(crate) fn cells(&self) -> [String; TARGETS.len() + 4] {
        let [a, b, c, d] = self.reached.clone();
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
        [
            a,
            b,
            c,
            d,
            or_dash(self.efficiency.map(three_digits)),
            or_dash(self.slope.map(|slope| format!("{slope:.2}"))),
            or_dash(self.bias.map(|[bias, error]| format!("{:+.2} ± {:.2}", 100.0 * bias, 100.0 * error))),
            three_digits(self.loading),
        ]
    }
}

/// The runs of a curve that take at least a sixteenth of its longest: in shorter ones there is more than samples, such as finding out
/// how to branch.
fn long_runs(curve: &Curve) -> Curve {
    let longest = curve.points().last().map_or(0.0, |p| p[0]);
    Curve::new(curve.points().iter().copied().filter(|p| p[0] >= longest / 16.0))
}

/// The mean, and its standard error from the seeds.
fn bias(biases: &[f64]) -> Option<[f64; 2]> {
    let (mean, count) = (mean(biases), biases.len() as f64);
    let squares: f64 = biases.iter().map(|b| (b - mean) * (b - mean)).sum();
    (biases.len() > 1).then(|| [mean, (squares / (count * (count - 1.0))).sqrt()])
}

/// Seconds to an error, over the seeds.
fn reading(curves: &[Curve], target: f64) -> String {
    let found: Vec<Reached> = curves.iter().filter_map(|curve| curve.reaches(target)).collect();
    let seconds: Vec<f64> = found
        .iter()
        .map(|reached| match *reached {
            Reached::After(t) | Reached::Before(t) | Reached::Not(t) => t,
        })
        .collect();
    let sign = if found.iter().any(|r| matches!(r, Reached::Not(_))) {
        "≥ "
    } else if found.iter().any(|r| matches!(r, Reached::Before(_))) {
        "≤ "
    } else {
        ""
    };
    geometric_mean(&seconds).map_or_else(|| "-".to_owned(), |mean| format!("{sign}{}", three_digits(mean)))
}

/// Three digits that count, as a plain number where that is short.
pub(crate) fn three_digits(value: f64) -> String {
    let place = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&place) {
        return if value == 0.0 { "0".to_owned() } else { format!("{value:.2e}") };
    }
    let decimals = (2.0 - place).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.012_345, "0.0123"),
            (1.0, "1.00"),
            (12.34, "12.3"),
            (123_456.0, "123456"),
            (3e7, "3.00e7"),
            (0.0, "0"),
        ] {
            assert_eq!(three_digits(value), text);
        }
    }

    #[test]
    fn what_some_seed_did_not_reach_is_said() {
        let curve = |scale: f64| Curve::new([[1.0, scale], [10.0, 0.1 * scale], [100.0, 0.01 * scale]]);
        let [near, far] = [curve(1.0), curve(10.0)];
        // 1/t and 10/t come to 0.2 after 5 and 50, and to 0.05 after 20 and (not yet) 100.
        assert_eq!(reading(&[near.clone(), far.clone()], 0.2), "15.8");
        assert_eq!(reading(&[near.clone(), far.clone()], 0.05), "≥ 44.7");
        assert_eq!(reading(&[near, far], 2.0), "≤ 2.24");
        assert_eq!(reading(&[], 0.1), "-");
    }
}
