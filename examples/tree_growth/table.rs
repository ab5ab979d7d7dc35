//! Three scenes of the gallery, rendered small at every depth limit from 0 to 12, with and without the weight cut-off.
//!
//! - Nodes are rays without those towards lights, per sample of a pixel.
//! - Given up is the mean weight of the branches that were not followed. The scenes have neither lights nor anything that
//!   absorbs (kr + kt = 1), so it is just the share of light that is missing.
//!
//! Counts are exact and the same on every machine, so the table is text that can be compared.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use vitrum::io::load;
use vitrum::tracer::{Settings, render};

/// What is counted: scene file and heading.
pub(crate) const SCENES: [(&str, &str); 3] =
    [("06_sphere.toml", "one ball"), ("06_cluster.toml", "nine balls"), ("06_box.toml", "box with bubbles")];
const DEEPEST: u32 = 12;
/// Samples are 32 x 32 pixels, one each: enough for a mean, few enough for a test.
const SIZE: [u32; 2] = [32, 32];

/// What a render counted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Growth {
    /// Per sample.
    pub(crate) nodes: f64,
    /// Mean weight.
    pub(crate) given_up: f64,
}

/// Renders a scene with this depth limit and cut-off.
pub(crate) fn growth(scene: &Path, max_depth: u32, cutoff: f64) -> Result<Growth, Box<dyn Error>> {
    let loaded = load::scene_file(scene, load::SceneOptions::default())?;
    let settings =
        Settings { size: SIZE, spp: 1, max_depth: Some(max_depth), cutoff, threads: 1, ..loaded.settings };
    let rendering = render(&loaded.scene, &settings, &())?;
    let nodes = rendering.stats.nodes() as f64 / rendering.stats.samples as f64;
    Ok(Growth { nodes, given_up: rendering.film.given_up().mean })
}

/// The whole table.
pub(crate) fn markdown(gallery: &Path) -> Result<String, Box<dyn Error>> {
    let default = Settings::default().cutoff;
    let mut text = String::from("| `max_depth` |");
    for (_, heading) in SCENES {
        write!(text, " {heading}: all nodes | given up | with cut-off | given up |")?;
    }
    text.push_str("\n| ---: |");
    text.push_str(&" ---: |".repeat(4 * SCENES.len()));
    text.push('\n');
    for depth in 0..=DEEPEST {
        write!(text, "| {depth} |")?;
        for (file, _) in SCENES {
            for cutoff in [0.0, default] {
                let Growth { nodes, given_up } = growth(&gallery.join(file), depth, cutoff)?;
                write!(text, " {nodes:.2} | {given_up:.1e} |")?;
            }
        }
        text.push('\n');
    }
    Ok(text)
}
