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
use vitrum_io::load::{Loaded, SceneOptions};
use vitrum_materials::Material;
use vitrum_math::{Rgb, Sequence};
use vitrum_tracer::{
    Branching, Integrator, LightSampling, RenderError, Settings, ShadowMode, on_threads, render,
};

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
    let options = SceneOptions { repair: arguments.repair };
    let load = || input::load(arguments.scene.as_deref(), options, &arguments.model, arguments.size);
    let loaded = on_threads(arguments.threads as usize, load)??;
    if !arguments.quiet {
        say(&loaded.warnings.to_string());
    }
    let settings = settings(&loaded, arguments);
    check_integrator(&loaded, settings.integrator)?;
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
        max_depth: arguments.max_depth.or(scene.max_depth),
        integrator: arguments.integrator.map_or(scene.integrator, Into::into),
        branching: arguments.branching.map_or(scene.branching, Into::into),
        light_sampling: arguments.light_sampling.into(),
        sequence: arguments.sequence.into(),
        clamp: arguments.clamp,
        cutoff: arguments.cutoff.unwrap_or(scene.cutoff),
        seed: arguments.seed.unwrap_or(scene.seed),
        threads: arguments.threads as usize,
        tile: arguments.tile,
        ..*scene
    }
}

/// A scene that was written for one way of following light may not do for the other.
fn check_integrator(loaded: &Loaded, integrator: Integrator) -> Result<(), Failure> {
    let scene = &loaded.scene;
    match integrator {
        Integrator::Path if scene.ambient != Rgb::ZERO => Err(Failure::usage(
            "--integrator path: the scene has an ambient light, which paths don't know; light it by a background, or use \
             whitted"
                .to_owned(),
        )),
        Integrator::Path if loaded.settings.shadow == ShadowMode::Straight => Err(Failure::usage(
            "--integrator path: the scene has straight shadows, which paths don't know; use whitted".to_owned(),
        )),
        Integrator::Whitted => {
            let rough = (0u32..).zip(scene.names()).find(|(id, _)| scene.materials_of(*id).iter().any(Material::is_rough));
            rough.map_or(Ok(()), |(_, name)| {
                Err(Failure::usage(format!(
                    "--integrator whitted: `{name}` is rough, and a ray tree can't follow light that it scatters; use path"
                )))
            })
        }
        Integrator::Path => Ok(()),
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
    let branching = match settings.branching {
        Branching::One => "one",
        Branching::First => "first",
        Branching::Tree => "tree",
    };
    let depth = settings.deepest();
    let [width, height] = settings.size;
    let pair = |key: &str, value: String| (key.to_owned(), value);
    let mut pairs = vec![
        pair("version", env!("CARGO_PKG_VERSION").to_owned()),
        pair(
            "integrator",
            match settings.integrator {
                Integrator::Whitted => "whitted".to_owned(),
                Integrator::Path => "path".to_owned(),
            },
        ),
        pair("size", format!("{width}x{height}")),
        pair("spp", samples.to_string()),
        pair("max_depth", if depth == u32::MAX { "none".to_owned() } else { depth.to_string() }),
        pair("seed", settings.seed.to_string()),
    ];
    if let Some(most) = settings.clamp {
        pairs.push(pair("clamp", format!("{most} (biased)")));
    }
    if settings.sequence == Sequence::Independent {
        pairs.push(pair("sequence", "independent".to_owned()));
    }
    pairs.extend(match settings.integrator {
        Integrator::Whitted => {
            [pair("cutoff", settings.cutoff.to_string()), pair("shadow", shadow.to_owned())].to_vec()
        }
        Integrator::Path => {
            let light_sampling = match settings.light_sampling {
                LightSampling::Mis => "mis",
                LightSampling::Lights => "lights",
                LightSampling::Bsdf => "bsdf",
            };
            vec![pair("branching", branching.to_owned()), pair("light_sampling", light_sampling.to_owned())]
        }
    });
    if let Some(crop) = settings.crop {
        pairs.push(pair("crop", format!("{},{},{},{}", crop.x, crop.y, crop.width, crop.height)));
    }
    pairs
}
