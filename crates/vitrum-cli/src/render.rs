//! `vitrum render`.

use crate::args::Render;
use crate::failure::Failure;
use crate::input;
use crate::interrupt::Interrupt;
use crate::progress::Watcher;
use crate::summary::{Phases, summary};
use crate::terminal::say;
use std::process::ExitCode;
use std::time::Instant;
use vitrum_io::image::{self, ImageView};
use vitrum_io::load::Loaded;
use vitrum_tracer::{RenderError, Settings, ShadowMode, on_threads, render};

/// The clock of the program: the libraries have none.
#[expect(clippy::disallowed_methods, reason = "the program shows how long it takes")]
pub(crate) fn now() -> Instant {
    Instant::now()
}

pub(crate) fn run(arguments: &Render) -> Result<ExitCode, Failure> {
    let start = now();
    // Before anything that takes long: a picture that can't be written is not worth rendering.
    image::check_writable(&arguments.output)?;
    let interrupt = Interrupt::listen()?;
    let load = || input::load(arguments.scene.as_deref(), &arguments.model, arguments.size);
    let loaded = on_threads(arguments.threads as usize, load)??;
    if !arguments.quiet {
        say(&loaded.warnings.to_string());
    }
    let settings = settings(&loaded, arguments);
    let loading = start.elapsed();

    let area = settings.area();
    let samples = u64::from(area.width) * u64::from(area.height) * u64::from(settings.spp);
    let watcher = Watcher::new(samples, arguments.quiet, interrupt.clone());
    let rendering = render(&loaded.scene, &settings, &watcher).map_err(|e| explain(e, &settings))?;
    watcher.finish();
    let rendering_time = watcher.elapsed();
    if rendering.stats.samples == 0 {
        if !arguments.quiet {
            say(&format!("stopped before the first sample; {} is as it was\n", arguments.output.display()));
        }
        return Ok(interrupt.code());
    }

    let writing = now();
    let pixels = rendering.film.image();
    let view = ImageView { width: area.width, height: area.height, pixels: &pixels };
    image::write(
        &arguments.output,
        view,
        &metadata(&settings, rendering.film.fewest_samples()),
        loaded.display,
    )?;
    let phases = Phases { loading, rendering: rendering_time, writing: writing.elapsed() };

    if !arguments.quiet {
        say(&summary(&rendering, &phases, &arguments.output));
    }
    Ok(if rendering.complete { ExitCode::SUCCESS } else { interrupt.code() })
}

fn settings(loaded: &Loaded, arguments: &Render) -> Settings {
    let scene = &loaded.settings;
    Settings {
        size: arguments.size.unwrap_or(scene.size),
        crop: arguments.crop,
        spp: arguments.spp.unwrap_or(scene.spp),
        max_depth: arguments.max_depth.unwrap_or(scene.max_depth),
        cutoff: arguments.cutoff.unwrap_or(scene.cutoff),
        seed: arguments.seed.unwrap_or(scene.seed),
        threads: arguments.threads as usize,
        tile: arguments.tile,
        ..*scene
    }
}

/// The failure behind an error, in terms of the command line.
fn explain(error: RenderError, settings: &Settings) -> Failure {
    let RenderError::Crop(crop) = error else { return error.into() };
    let [width, height] = settings.size;
    Failure::usage(format!(
        "--crop {},{},{},{} reaches beyond the picture of {width} x {height} pixels; expected left + width up to {width} and \
         top + height up to {height}",
        crop.x, crop.y, crop.width, crop.height
    ))
}

/// What the picture says of itself: nothing that changes from run to run.
fn metadata(settings: &Settings, samples: u32) -> Vec<(String, String)> {
    let shadow = match settings.shadow {
        ShadowMode::Opaque => "opaque",
        ShadowMode::Straight => "straight (biased)",
    };
    let [width, height] = settings.size;
    let pair = |key: &str, value: String| (key.to_owned(), value);
    let mut pairs = vec![
        pair("version", env!("CARGO_PKG_VERSION").to_owned()),
        pair("integrator", "whitted".to_owned()),
        pair("size", format!("{width}x{height}")),
        pair("spp", samples.to_string()),
        pair("max_depth", settings.max_depth.to_string()),
        pair("cutoff", settings.cutoff.to_string()),
        pair("seed", settings.seed.to_string()),
        pair("shadow", shadow.to_owned()),
    ];
    if let Some(crop) = settings.crop {
        pairs.push(pair("crop", format!("{},{},{},{}", crop.x, crop.y, crop.width, crop.height)));
    }
    pairs
}
