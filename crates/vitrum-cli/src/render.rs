//! `vitrum render`.

use crate::args::{ChannelChoice, Render, no_skip};
use crate::failure::Failure;
use crate::input;
use crate::interrupt::Interrupt;
use crate::progress::Watcher;
use crate::report::Report;
use crate::store::Store;
use crate::summary::{Phases, summary};
use crate::terminal::say;
use cpu_time::ProcessTime;
use std::process::ExitCode;
use std::time::Instant;
use vitrum_io::image::{self, Channel, ImageView};
use vitrum_io::load::{Loaded, SceneOptions};
use vitrum_materials::Material;
use vitrum_math::{DVec3, Rgb, Sequence};
use vitrum_tracer::{
    Branching, Ended, Filter, Integrator, LightSampling, RenderError, Rendering, Scene, Seen, Settings,
    ShadowMode, Target, on_threads, render, resume, seen,
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
    if !arguments.channels.is_empty() && !image::holds_channels(&arguments.output) {
        return Err(Failure::usage(
            "--channels: only .exr holds channels beside radiance; choose such a name for -o",
        ));
    }
    if let Some(report) = &arguments.report {
        vitrum_io::check_text_writable(report)?;
    }
    let interrupt = Interrupt::listen()?;
    let options = SceneOptions { repair: arguments.repair, ..SceneOptions::default() };
    let load = || input::load(arguments.scene.as_deref(), options, &arguments.model, arguments.size);
    let loaded = on_threads(arguments.threads as usize, load)??;
    if !arguments.quiet {
        say(&loaded.warnings.to_string());
    }
    let settings = settings(&loaded, arguments);
    check_integrator(&loaded, settings.integrator)?;
    let is_one_buffer = settings.until.is_none();
    if arguments.channels.contains(&ChannelChoice::Error) && is_one_buffer && settings.spp < LEAST_FOR_ERRORS
    {
        return Err(Failure::usage(format!(
            "--channels error: found {} samples per pixel; a standard error takes at least {LEAST_FOR_ERRORS}",
            settings.spp
        )));
    }
    let store = Store::new(&arguments.output, &loaded, &settings)?;
    let film = if arguments.resume { Some(store.read()?) } else { None };
    let loading = start.elapsed();
    let busy = ProcessTime::now();

    let area = settings.area();
    let is_limited = arguments.until.is_some() || arguments.time.is_some();
    let samples = u64::from(area.width) * u64::from(area.height) * u64::from(settings.spp);
    let watcher = Watcher::new(
        (!is_limited && film.is_none()).then_some(samples),
        arguments.time,
        arguments.quiet,
        interrupt.clone(),
        arguments.checkpoint.then_some(&store),
    );
    let was_begun = film.is_some();
    let rendering = match film {
        Some(film) => resume(&loaded.scene, &settings, film, &watcher),
        None => render(&loaded.scene, &settings, &watcher),
    };
    let rendering = rendering.map_err(|e| explain(e, &settings))?;
    watcher.finish();
    let rendering_time = watcher.elapsed();
    let processors = busy.elapsed();
    let is_stopped = rendering.ended == Ended::Stopped;
    if is_stopped && rendering.stats.samples == 0 {
        if !arguments.quiet {
            let kept = if was_begun { "; so is its checkpoint" } else { "" };
            say(&format!(
                "stopped before the first sample; {} is as it was{kept}\n",
                arguments.output.display()
            ));
        }
        return Ok(interrupt.code());
    }

    let writing = now();
    // First: from it the picture can be made again, and not the other way round. But where it fails there is the picture still.
    let is_kept = is_stopped || arguments.checkpoint;
    let kept = if is_kept { store.write(&rendering.film) } else { Ok(()) };
    let pixels = rendering.film.image();
    let view = ImageView { width: area.width, height: area.height, pixels: &pixels };
    let channels = channels(&rendering, &loaded.scene, &settings, &arguments.channels)?;
    let mut metadata = metadata(&settings, rendering.film.samples());
    if arguments.channels.contains(&ChannelChoice::Object) {
        metadata.push(("objects".to_owned(), loaded.scene.names().join("\n")));
    }
    let knows_errors = channels.iter().any(|channel| channel.name.starts_with("error."));
    if arguments.channels.contains(&ChannelChoice::Error) && !knows_errors && !arguments.quiet {
        say("warning: there are too few samples to tell errors; the channels of the error are left out\n");
    }
    if let Err(failure) = image::write(&arguments.output, view, &channels, &metadata, loaded.display) {
        // What was rendered is not lost with the picture.
        if !is_kept && store.write(&rendering.film).is_ok() {
            say(&format!(
                "the samples are kept in {}: mend what follows, and add --resume\n",
                store.path().display()
            ));
        }
        return Err(failure.into());
    }
    if let Some(trouble) = store.trouble().filter(|_| !arguments.quiet) {
        say(&format!("warning: a checkpoint could not be kept: {trouble}\n"));
    }
    kept?;
    if was_begun && !is_kept {
        store.remove()?;
    }
    let phases = Phases { loading, rendering: rendering_time, writing: writing.elapsed(), processors };
    if let Some(path) = &arguments.report {
        Report::new(&rendering, &phases).write(path)?;
    }

    if !arguments.quiet {
        say(&summary(&rendering, is_limited, &phases, &arguments.output));
        if is_stopped {
            say(&format!("go on with the same command and --resume, from {}\n", store.path().display()));
        }
    }
    Ok(if is_stopped { interrupt.code() } else { ExitCode::SUCCESS })
}

/// What an .exr holds beside radiance. A render that was stopped early knows no errors.
fn channels(
    rendering: &Rendering,
    scene: &Scene,
    settings: &Settings,
    asked: &[ChannelChoice],
) -> Result<Vec<Channel>, Failure> {
    let film = &rendering.film;
    let errors = film.standard_error().filter(|_| asked.contains(&ChannelChoice::Error)).unwrap_or_default();
    let mut channels = Vec::new();
    if !errors.is_empty() {
        for (c, name) in ["error.R", "error.G", "error.B"].into_iter().enumerate() {
            let values = errors.iter().map(|pixel| pixel[c]).collect();
            channels.push(Channel { name: name.to_owned(), values });
        }
    }
    if asked.contains(&ChannelChoice::Samples) {
        let values = film.sample_counts().into_iter().map(|n| n as f32).collect();
        channels.push(Channel { name: "samples.Y".to_owned(), values });
    }
    if asked.iter().any(|choice| !matches!(choice, ChannelChoice::Error | ChannelChoice::Samples)) {
        let seen = seen(scene, settings).map_err(|error| explain(error, settings))?;
        let once = asked.iter().enumerate().filter(|(i, choice)| !asked[..*i].contains(choice));
        for (_, choice) in once {
            add_seen(*choice, &seen, &mut channels);
        }
    }
    Ok(channels)
}

/// Adds the channels of a choice about what is seen.
fn add_seen(choice: ChannelChoice, seen: &[Seen], channels: &mut Vec<Channel>) {
    let mut add = |name: String, value: &dyn Fn(&Seen) -> f64| {
        channels.push(Channel { name, values: seen.iter().map(|s| value(s) as f32).collect() });
    };
    let mut three = |name: &str, axes: [&str; 3], value: &dyn Fn(&Seen) -> DVec3| {
        for (axis, letter) in axes.into_iter().enumerate() {
            add(format!("{name}.{letter}"), &|s| value(s)[axis]);
        }
    };
    const XYZ: [&str; 3] = ["X", "Y", "Z"];
    const RGB: [&str; 3] = ["R", "G", "B"];
    match choice {
        ChannelChoice::Error | ChannelChoice::Samples => {}
        ChannelChoice::Normal => three("normal", XYZ, &|s| s.normal),
        ChannelChoice::NormalBehind => three("behind.normal", XYZ, &|s| s.normal_behind),
        ChannelChoice::Albedo => three("albedo", RGB, &|s| s.albedo),
        ChannelChoice::AlbedoBehind => three("behind.albedo", RGB, &|s| s.albedo_behind),
        ChannelChoice::Object => add("object.id".to_owned(), &|s| f64::from(s.object)),
        ChannelChoice::Material => add("material.id".to_owned(), &|s| f64::from(s.material)),
        ChannelChoice::Depth => add("depth.Z".to_owned(), &|s| s.depth),
        ChannelChoice::Media => add("media.Y".to_owned(), &|s| f64::from(s.media)),
        ChannelChoice::Unmatched => add("unmatched.Y".to_owned(), &|s| s.unmatched),
    }
}

/// Two rounds: their difference is what tells a standard error.
const LEAST_FOR_ERRORS: u32 = 9;

/// Samples per pixel where an error or a time ends the render.
const MOST_SAMPLES: u32 = 1_000_000;

fn settings(loaded: &Loaded, arguments: &Render) -> Settings {
    let scene = &loaded.settings;
    Settings {
        size: arguments.size.unwrap_or(scene.size),
        crop: arguments.crop,
        spp: match arguments.spp {
            Some(spp) => spp,
            None if arguments.until.is_some() || arguments.time.is_some() => MOST_SAMPLES,
            None => scene.spp,
        },
        until: arguments.until,
        max_depth: arguments.max_depth.or(scene.max_depth),
        filter: arguments.filter.map_or(scene.filter, Into::into),
        integrator: arguments.integrator.map_or(scene.integrator, Into::into),
        branching: arguments.branching.map_or(scene.branching, Into::into),
        light_sampling: arguments.light_sampling.into(),
        sequence: arguments.sequence.into(),
        clamp: arguments.clamp,
        no_skip: no_skip(arguments.no_skip.as_deref()),
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
fn metadata(settings: &Settings, [least, most]: [u32; 2]) -> Vec<(String, String)> {
    let mut pairs = decisive(settings);
    let samples = if least == most { least.to_string() } else { format!("{least} to {most}") };
    pairs.push(("spp".to_owned(), samples));
    if let Some(target) = settings.until {
        let (name, limit) = match target {
            Target::RelMse(limit) => ("relmse", limit),
            Target::Noise(limit) => ("noise", limit),
        };
        pairs.push(("until".to_owned(), format!("{name}={limit}")));
    }
    pairs
}

/// What decides the values of samples.
pub(crate) fn decisive(settings: &Settings) -> Vec<(String, String)> {
    let shadow = match settings.shadow {
        ShadowMode::Opaque => "opaque",
        ShadowMode::Straight => "straight (biased)",
    };
    let branching = match settings.branches() {
        Branching::Auto => "auto",
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
        pair("max_depth", if depth == u32::MAX { "none".to_owned() } else { depth.to_string() }),
        pair("seed", settings.seed.to_string()),
    ];
    if let Some(most) = settings.clamp {
        pairs.push(pair("clamp", format!("{most} (biased)")));
    }
    match settings.filter {
        Filter::Box => {}
        Filter::Tent => pairs.push(pair("filter", "tent".to_owned())),
        Filter::BlackmanHarris => pairs.push(pair("filter", "blackman-harris".to_owned())),
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
