//! What is said when a render is done.

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;
use vitrum_tracer::{Branching, Ended, Rendering};

/// Where the time went.
pub(crate) struct Phases {
    pub(crate) loading: Duration,
    pub(crate) rendering: Duration,
    pub(crate) writing: Duration,
    /// What all threads together were busy while rendering.
    pub(crate) processors: Duration,
}

/// The summary, several lines. Why a render ended is said where something limits it beside the samples.
pub(crate) fn summary(rendering: &Rendering, is_limited: bool, phases: &Phases, output: &Path) -> String {
    let stats = &rendering.stats;
    let seconds = |d: Duration| format!("{:.2} s", d.as_secs_f64());
    let rate = stats.searched_rays() as f64 / phases.rendering.as_secs_f64().max(1e-9) / 1e6;
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a String can't fail.
        let _ = writeln!(text, "{name:<10} {value}");
    };
    let area = rendering.film.area();
    let samples = match rendering.film.samples() {
        [least, most] if least == most => most.to_string(),
        [least, most] => format!("{least} to {most}"),
    };
    let stopped = if rendering.ended == Ended::Stopped { " (stopped)" } else { "" };
    line(
        "wrote",
        format!(
            "{} ({} x {}, {samples} samples per pixel{stopped})",
            output.display(),
            area.width,
            area.height
        ),
    );
    line(
        "time",
        format!(
            "{} loading, {} rendering, {} writing",
            seconds(phases.loading),
            seconds(phases.rendering),
            seconds(phases.writing)
        ),
    );
    let background = match stats.unsearched_rays {
        0 => String::new(),
        some => format!(", less {some} that only the background can meet"),
    };
    line(
        "rays",
        format!(
            "{} ({rate:.1} million/s): {} camera, {} reflected, {} transmitted, {} shadow{background}",
            stats.searched_rays(),
            stats.camera_rays,
            stats.reflected_rays,
            stats.transmitted_rays,
            stats.shadow_rays
        ),
    );
    if let Some(error) = rendering.film.error() {
        let [low, high] = error.interval;
        let noise = 100.0 * error.rel_mse.sqrt();
        line(
            "error",
            format!("relMSE {:.2e} (90 %: {low:.2e} to {high:.2e}), noise {noise:.2} %", error.rel_mse),
        );
    }
    let ended = match rendering.ended {
        Ended::Error => Some("the error to reach was reached"),
        Ended::Time => Some("there was no time for another round"),
        Ended::Samples if is_limited => Some("all samples were taken"),
        Ended::Samples | Ended::Stopped => None,
    };
    if let Some(why) = ended {
        line("ended", why.to_owned());
    }
    let nodes = stats.nodes() as f64 / stats.samples.max(1) as f64;
    line("tree", format!("{nodes:.2} nodes per sample, deepest {}", stats.deepest));
    let ways =
        [(Branching::One, "one ray"), (Branching::First, "all at the first hit"), (Branching::Tree, "all")];
    let share = |way: Branching| {
        let count = rendering.branching.iter().filter(|found| **found == way).count();
        100.0 * count as f64 / rendering.branching.len() as f64
    };
    if rendering.branching.iter().any(|way| *way != rendering.branching[0]) {
        let shares = ways.map(|(way, name)| format!("{name} in {:.0} %", share(way)));
        line("branching", format!("{} of the picture", shares.join(", ")));
    }
    if stats.pilot_rays > 0 {
        line("pilot", format!("{} rays more found out how to branch", stats.pilot_rays));
    }
    let given_up = rendering.film.given_up();
    let at_most = rendering.plan.radiance_bound.map_or(String::new(), |bound| {
        format!(
            "; at most {:.2e} of radiance is missing on average, {:.2e} in one pixel",
            given_up.mean * bound,
            given_up.largest * bound
        )
    });
    line(
        "given up",
        format!(
            "weight {:.2e} on average, {:.2e} in the worst pixel{at_most}",
            given_up.mean, given_up.largest
        ),
    );
    if stats.guarded > 0 {
        line(
            "guarded",
            format!("{} rays of very long paths or large trees went on by roulette", stats.guarded),
        );
    }
    if stats.passed > 0 {
        line(
            "overlaps",
            format!(
                "{} surfaces were passed inside of stronger solids, {} crossed together with one in the same place",
                stats.passed, stats.merged
            ),
        );
    }
    let lost = stats.unmatched_exits + stats.overfull + stats.unending;
    if lost > 0 {
        line(
            "warning",
            format!(
                "{lost} times a ray lost count of the solids that it is in ({} left one that it had not entered); `vitrum explain` shows a \
                 pixel, `vitrum inspect` the meshes",
                stats.unmatched_exits
            ),
        );
    }
    if stats.geometry.neighbours_ignored > 0 || stats.normal_fallbacks > 0 {
        line(
            "rare",
            format!(
                "{} neighbouring faces passed over at edges, {} interpolated normals replaced by geometric ones",
                stats.geometry.neighbours_ignored, stats.normal_fallbacks
            ),
        );
    }
    if let Some(first) = stats.first_dropped {
        line(
            "warning",
            format!(
                "{} samples were not finite or negative and are left out, the first in pixel ({}, {}), sample {}",
                stats.dropped, first.x, first.y, first.sample
            ),
        );
    }
    text
}
