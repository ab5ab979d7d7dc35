//! `vitrum page`, and the page that `vitrum bench` ends with: results as one HTML file that needs no other.

mod figures;
mod growth;
mod pictures;
mod plot;

use crate::args::Page;
use crate::bench::{self, Record};
use crate::failure::Failure;
use crate::terminal::answer;
pub(crate) use figures::in_order;
use figures::{Figures, TARGETS};
use growth::Cost;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Page) -> Result<ExitCode, Failure> {
    let mut all: Vec<(Record, &Path)> = Vec::new();
    for path in &arguments.results {
        add(&mut all, bench::read(path)?, path);
    }
    let mut costs = Vec::new();
    for path in &arguments.costs {
        costs.extend(growth::read(path)?);
    }
    if arguments.markdown {
        let records: Vec<Record> = all.into_iter().map(|(record, _)| record).collect();
        let results = if records.is_empty() { String::new() } else { markdown(&records) + "\n" };
        answer((results + &growth::markdown(&costs)).trim_end())?;
    } else {
        write(&all, &costs, &arguments.output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Adds what a file holds. A program that was measured in several files is several programs: say, before and after a change.
pub(crate) fn add<'a>(all: &mut Vec<(Record, &'a Path)>, mut records: Vec<Record>, file: &'a Path) {
    let known: BTreeSet<String> = all.iter().map(|(record, _)| record.program.clone()).collect();
    for record in records.iter_mut().filter(|record| known.contains(&record.program)) {
        record.program = format!("{} ({})", record.program, file.display());
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    all.extend(records.into_iter().map(|record| (record, folder)));
}

/// Headings of the columns after scene and program.
fn headings() -> Vec<String> {
    let mut headings: Vec<String> = TARGETS.iter().map(|target| format!("s to {target:.0e}")).collect();
    headings.extend(["1/(relMSE s)", "slope", "bias %", "loading s"].map(str::to_owned));
    headings
}

/// The table for a terminal.
pub(crate) fn table(records: &[Record]) -> String {
    let figures = Figures::of_all(records);
    let width = |column: fn(&Figures) -> &str| figures.iter().map(|f| column(f).len()).max().unwrap_or(0);
    let (scene, program) = (width(|f| &f.scene), width(|f| &f.program));
    let mut text = format!("{:<scene$}  {:<program$}", "scene", "program");
    // Writing to a String can't fail.
    headings().iter().for_each(|heading| {
        let _ = write!(text, " {heading:>13}");
    });
    text.push('\n');
    for row in &figures {
        let _ = write!(text, "{:<scene$}  {:<program$}", row.scene, row.program);
        row.cells().iter().for_each(|cell| {
            let _ = write!(text, " {cell:>13}");
        });
        text.push('\n');
    }
    text
}

/// The table of results as Markdown.
fn markdown(records: &[Record]) -> String {
    let headings = headings();
    let mut text = format!("| scene | program | {} |\n|---|---|", headings.join(" | "));
    text += &"---:|".repeat(headings.len());
    text.push('\n');
    for row in Figures::of_all(records) {
        let [scene, program] = [&row.scene, &row.program].map(|name| name.replace('|', "\\|"));
        text += &format!("| {scene} | {program} | {} |\n", row.cells().join(" | "));
    }
    text
}

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:#222;\
background:#fff}h1,h2{font-weight:600}h2{margin-top:2.5em}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
th,td{padding:.2em .7em;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}\
th:nth-child(-n+2),td:nth-child(-n+2){text-align:left}.scroll{overflow-x:auto}\
.scene{display:flex;flex-wrap:wrap;gap:1.5em;align-items:flex-start}.pictures{display:flex;flex-wrap:wrap;gap:1em}\
figure{margin:0}figcaption{font-size:13px;color:#555;max-width:256px}\
img{image-rendering:pixelated;width:256px;display:block}svg{max-width:100%;height:auto}";

const HOW: &str = "relMSE is the mean over pixels and channels of squared error over squared radiance plus 0.01, without the \
reference's own. Seconds are of loading and rendering together. Lines are geometric means, bands reach from the best seed to \
the worst. Seconds to an error are where a seed's own line crosses it for the last time, their geometric mean over seeds; \
\u{2265} and \u{2264} say that some seed has not reached it by its last run, or has by its first. The slope is that of error \
against seconds of rendering alone. A dash stands where the reference is not known well enough. Pictures are of equal time, as \
far as the runs allow, with the difference that an eye sees below (\u{a7fb}LIP: black is none).";

/// Writes the page. Pictures lie relative to the folder beside each record.
pub(crate) fn write(all: &[(Record, &Path)], costs: &[Cost], output: &Path) -> Result<(), Failure> {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>vitrum: what pictures cost</title><style>{STYLE}</style>\n"
    );
    if !all.is_empty() {
        html += &results(all)?;
    }
    if !costs.is_empty() {
        html += &growth::html(costs)?;
    }
    html += "</html>\n";
    Ok(vitrum_io::write_text(output, &html)?)
}

/// Figures, curves and pictures of all programs and scenes.
fn results(all: &[(Record, &Path)]) -> Result<String, Failure> {
    let records: Vec<Record> = all.iter().map(|(record, _)| record.clone()).collect();
    let figures = Figures::of_all(&records);
    let programs = figures::in_order(records.iter().map(|r| r.program.as_str()));
    let mut html = format!("<h1>Run time against error</h1>\n<p>{HOW}</p>\n");
    for program in &programs {
        let of = records.iter().filter(|r| r.program == *program);
        let machines = figures::in_order(of.clone().map(|r| r.machine.as_str()));
        let versions = figures::in_order(of.map(|r| r.version.as_str()));
        html += &format!(
            "<p><b>{}</b> {} on {}</p>\n",
            escaped(program),
            escaped(&versions.join(", ")),
            escaped(&machines.join("; "))
        );
    }
    html += "<div class=\"scroll\"><table><tr><th>scene<th>program";
    headings().iter().for_each(|heading| html += &format!("<th>{heading}"));
    for row in &figures {
        html += &format!("<tr><td>{}<td>{}", escaped(&row.scene), escaped(&row.program));
        row.cells().iter().for_each(|cell| html += &format!("<td>{cell}"));
    }
    html += "</table></div>\n";
    for scene in figures::in_order(records.iter().map(|r| r.scene.as_str())) {
        let of: Vec<&Figures> = figures.iter().filter(|f| f.scene == scene).collect();
        html += &format!("<h2>{}</h2>\n<div class=\"scene\">\n", escaped(scene));
        html += &plot::svg(&of, &programs)?;
        html += &pictures::html(all, scene, &programs)?;
        html += "</div>\n";
    }
    Ok(html)
}

/// Text in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
