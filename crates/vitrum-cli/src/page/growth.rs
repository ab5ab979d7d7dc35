//! How cost grows with something: the results of `benches/cost.py`, as tables, plots and exponents.

use super::figures::{in_order, three_digits};
use super::{escaped, plot};
use crate::bench;
use crate::failure::Failure;
use crate::report::Report;
use serde::Deserialize;
use std::fmt::Write;
use std::path::Path;
use vitrum_measure::Curve;

/// One render of one of several scenes that differ in one number.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Cost {
    /// What the number counts.
    growing: String,
    /// What it is expected to say something about.
    tell: Vec<Tell>,
    number: f64,
    threads: u32,
    #[serde(flatten)]
    report: Report,
}

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Tell {
    /// Seconds of rendering.
    Rendering,
    /// Nanoseconds of a ray.
    Ray,
    /// Bytes.
    Memory,
}

/// Reads a file of costs.
pub(crate) fn read(path: &Path) -> Result<Vec<Cost>, Failure> {
    let costs: Vec<Cost> = bench::lines(path, "cost of a render", "benches/cost.py")?;
    let is_whole = |cost: &&Cost| cost.number > 0.0 && cost.report.rendering > 0.0 && cost.report.rays() > 0;
    match costs.iter().find(|cost| !is_whole(cost)) {
        None => Ok(costs),
        Some(cost) => Err(Failure::usage(format!(
            "{}: found {} {} with {} seconds of rendering and {} rays, expected all of them above 0",
            path.display(),
            cost.number,
            cost.growing,
            cost.report.rendering,
            cost.report.rays()
        ))),
    }
}

/// Medians over the renders of one scene.
struct Row {
    number: f64,
    threads: u32,
    loading: f64,
    rendering: f64,
    processors: f64,
    rays: u64,
    /// Where the system told.
    memory: Option<f64>,
}

/// All numbers of one kind.
struct Growth<'a> {
    growing: &'a str,
    tell: Vec<Tell>,
    /// By rising number.
    rows: Vec<Row>,
}

const HEADINGS: [&str; 7] =
    ["loading s", "rendering s", "busy s", "idle %", "rays", "ns a ray", "memory MiB"];

const HOW: &str = "Each scene was rendered several times, in turn with the others: medians. Busy seconds are of all threads together \
while they render, nanoseconds a ray are of busy ones, idle is the share of the threads' seconds that they were not busy. Memory is \
the most that the process had. Exponents are slopes of lines fitted to logarithms, bytes are those of a line fitted to memory.";

impl<'a> Growth<'a> {
    fn of_all(costs: &'a [Cost]) -> Vec<Self> {
        let of = |growing: &'a str| {
            let of: Vec<&Cost> = costs.iter().filter(|cost| cost.growing == growing).collect();
            let mut numbers: Vec<f64> = of.iter().map(|cost| cost.number).collect();
            numbers.sort_by(f64::total_cmp);
            numbers.dedup();
            let rows = numbers.into_iter().filter_map(|number| Row::new(number, &of)).collect();
            Self { growing, tell: of[0].tell.clone(), rows }
        };
        in_order(costs.iter().map(|cost| cost.growing.as_str())).into_iter().map(of).collect()
    }

    /// The exponent of what grows with the number; none where there is one number only.
    fn exponent(&self, of: impl Fn(&Row) -> f64) -> Option<f64> {
        Curve::new(self.rows.iter().map(|row| [row.number, of(row)])).slope()
    }

    /// Bytes for each, by least squares.
    fn bytes_each(&self) -> Option<f64> {
        let points: Vec<[f64; 2]> =
            self.rows.iter().filter_map(|row| Some([row.number, row.memory?])).collect();
        let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
        let [n, m] = [mean(0), mean(1)];
        let square: f64 = points.iter().map(|p| (p[0] - n) * (p[0] - n)).sum();
        let product: f64 = points.iter().map(|p| (p[0] - n) * (p[1] - m)).sum();
        (square > 0.0).then(|| product / square)
    }

    /// What the table says, in a few words; nothing where nothing follows a law.
    fn summary(&self) -> String {
        let told = self.tell.iter().filter_map(|tell| {
            Some(match tell {
                Tell::Rendering => format!("rendering: exponent {:.2}", self.exponent(|row| row.rendering)?),
                Tell::Ray => format!("a ray: exponent {:.2}", self.exponent(Row::ns)?),
                Tell::Memory => format!("memory: {:.0} bytes each", self.bytes_each()?),
            })
        });
        told.collect::<Vec<_>>().join(", ")
    }
}

impl Row {
    fn new(number: f64, of: &[&Cost]) -> Option<Self> {
        let with: Vec<&Cost> = of.iter().copied().filter(|cost| cost.number == number).collect();
        let first = with.first()?;
        let median = |of: fn(&Cost) -> f64| {
            let mut values: Vec<f64> = with.iter().map(|cost| of(cost)).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        Some(Self {
            number,
            threads: first.threads,
            loading: median(|cost| cost.report.loading),
            rendering: median(|cost| cost.report.rendering),
            processors: median(|cost| cost.report.processors),
            rays: first.report.rays(),
            memory: Some(median(|cost| cost.report.memory as f64)).filter(|bytes| *bytes > 0.0),
        })
    }

    fn ns(&self) -> f64 {
        1e9 * self.processors / self.rays as f64
    }

    fn cells(&self) -> [String; HEADINGS.len()] {
        let idle = 100.0 * (1.0 - self.processors / (f64::from(self.threads) * self.rendering));
        [
            three_digits(self.loading),
            three_digits(self.rendering),
            three_digits(self.processors),
            format!("{:.1}", idle.max(0.0)),
            self.rays.to_string(),
            three_digits(self.ns()),
            self.memory.map_or("-".to_owned(), |bytes| format!("{:.1}", bytes / f64::from(1 << 20))),
        ]
    }
}

/// As a part of a page.
pub(super) fn html(costs: &[Cost]) -> Result<String, Failure> {
    let mut html = format!("<h1>How cost grows</h1>\n<p>{HOW}</p>\n");
    for growth in Growth::of_all(costs) {
        let (name, summary) = (escaped(growth.growing), escaped(&growth.summary()));
        let points = growth.rows.iter().map(|row| [row.number, row.rendering]).collect::<Vec<_>>();
        html += &format!("<h2>{name}</h2>\n<p>{summary}</p>\n<div class=\"scene\">\n");
        html += &plot::growth(growth.growing, &points)?;
        html += &format!("<div class=\"scroll\"><table><tr><th>{name}");
        HEADINGS.iter().for_each(|heading| html += &format!("<th>{heading}"));
        for row in &growth.rows {
            html += &format!("<tr><td>{}", row.number);
            row.cells().iter().for_each(|cell| html += &format!("<td>{cell}"));
        }
        html += "</table></div>\n</div>\n";
    }
    Ok(html)
}

/// The tables as Markdown.
pub(super) fn markdown(costs: &[Cost]) -> String {
    let mut text = String::new();
    for growth in Growth::of_all(costs) {
        // Writing to a String can't fail.
        let summary = growth.summary();
        let colon = if summary.is_empty() { "" } else { ": " };
        let _ = write!(text, "**{}**{colon}{summary}\n\n", growth.growing);
        let columns = "---:|".repeat(HEADINGS.len() + 1);
        let _ = write!(text, "| {} | {} |\n|{columns}\n", growth.growing, HEADINGS.join(" | "));
        for row in &growth.rows {
            let _ = writeln!(text, "| {} | {} |", row.number, row.cells().join(" | "));
        }
        text.push('\n');
    }
    text
}
