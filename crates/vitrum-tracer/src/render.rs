//! Tiles, samples and threads.

use crate::feature::Feature;
use crate::film::{Buffer, Film, Pixel, PixelSum};
use crate::filter::FilterSampler;
use crate::light_sampler::LightSampler;
use crate::media::{MediaTable, MediumId};
use crate::media_list::MediaList;
use crate::outlines::Outlines;
use crate::overlaps::MOST;
use crate::path::{AnyPath, Path};
use crate::pilot;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::schedule::Schedule;
use crate::settings::{Branching, Crop, Integrator, NoSkip, Settings, Target};
use crate::stats::{Dropped, Stats};
use crate::threads::{on_each, on_threads};
use crate::walker::{Policy, Walker};
use crate::whitted::Whitted;
use vitrum_math::{Rgb, SampleAddress};

/// What the seed of the second buffer is farther on: any large odd number will do, that nobody counts up to.
const OTHER_BUFFER: u64 = 0x9e6c_63d0_876a_9a35;

/// Whoever watches a render. Asked from many threads.
pub trait Progress: Sync {
    /// A tile is done: so many more samples and rays.
    fn advance(&self, samples: u64, rays: u64);
    /// True when the render should stop with what there is. Asked before every sample.
    fn is_stopped(&self) -> bool {
        false
    }
    /// A round of so many samples begins.
    fn plan(&self, _samples: u64) {}
    /// A round is done. What is kept of the film now is enough to go on from here.
    fn keep(&self, _film: &Film) {}
    /// Seconds until the picture should be done, where time is limited. Asked between rounds: the one in hand is ended.
    fn seconds_left(&self) -> Option<f64> {
        None
    }
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All samples were taken.
    Samples,
    /// The error to reach was reached.
    Error,
    /// There is no time for another round.
    Time,
    /// It was stopped.
    Stopped,
}

/// Nobody watches.
impl Progress for () {
    fn advance(&self, _samples: u64, _rays: u64) {}
}

/// What a render leaves.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The pixels.
    pub film: Film,
    /// What was counted.
    pub stats: Stats,
    /// What the scene needed.
    pub plan: Plan,
    /// Which of the rays that glass divides were followed, for each square of 8 x 8 pixels of the whole image that the area
    /// touches, row by row.
    pub branching: Vec<Branching>,
    /// Why it ended.
    pub ended: Ended,
}

/// Settings that make no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// An image without pixels, or with more than 2²⁸.
    #[error(
        "an image of {0} × {1} pixels can't be rendered: each side must be at least 1 and all pixels at most 2^28"
    )]
    Size(u32, u32),
    /// No samples.
    #[error("0 samples per pixel make no picture: ask for at least 1")]
    NoSamples,
    /// One sample, where an error is to be reached.
    #[error("1 sample per pixel tells no error: ask for at least 2 with an error to reach")]
    OneSample,
    /// A part that is empty or not inside the image.
    #[error("the crop of {width} × {height} pixels at ({x}, {y}) is not inside the image", x = .0.x, y = .0.y, width = .0.width, height = .0.height)]
    Crop(Crop),
    /// An error to reach that is not a number above 0.
    #[error("an error of {0} can't be reached: ask for one above 0")]
    Target(f64),
    /// A film that was begun with other settings.
    #[error("the film to go on with is not of this size, or not of this kind of rounds")]
    OtherFilm,
    /// Threads could not be started.
    #[error("could not start threads: {0}")]
    Threads(String),
}

/// A scene, how it is rendered, and what was worked out for that.
#[derive(Clone, Copy)]
pub(crate) struct Setup<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) lights: &'s LightSampler,
    pub(crate) settings: &'s Settings,
    pub(crate) plan: &'s Plan,
    pub(crate) media: &'s MediaTable,
}

/// Renders a scene.
///
/// # Errors
/// [`RenderError`] for settings that make no picture.
pub fn render(scene: &Scene, settings: &Settings, progress: &dyn Progress) -> Result<Rendering, RenderError> {
    check(settings)?;
    let film = Film::new(settings.area(), buffers(settings));
    let more = in_full(scene, settings);
    let scene = more.as_ref().unwrap_or(scene);
    on_threads(settings.threads, || render_here(scene, settings, film, progress))
}

/// Goes on with a film that was stopped: with the same scene and settings the picture is, to the last bit, the one that it would
/// have become. Counts of rays begin anew.
///
/// # Errors
/// [`RenderError`] for settings that make no picture, or not the film's.
pub fn resume(
    scene: &Scene,
    settings: &Settings,
    film: Film,
    progress: &dyn Progress,
) -> Result<Rendering, RenderError> {
    check(settings)?;
    if film.area() != settings.area() || film.buffers().len() != buffers(settings) {
        return Err(RenderError::OtherFilm);
    }
    let more = in_full(scene, settings);
    let scene = more.as_ref().unwrap_or(scene);
    on_threads(settings.threads, || render_here(scene, settings, film, progress))
}

/// The scene with more to search, where that was asked for.
fn in_full(scene: &Scene, settings: &Settings) -> Option<Scene> {
    let NoSkip { object_tree, solids, .. } = settings.no_skip;
    (object_tree || solids).then(|| scene.searched_in_full(object_tree, solids))
}

fn buffers(settings: &Settings) -> usize {
    if settings.until.is_some() { 2 } else { 1 }
}

/// Renders on the threads of the pool that it is called in, or on the calling one.
// Never inlined: benches/gate.py counts the instructions of this function.
#[inline(never)]
fn render_here(scene: &Scene, settings: &Settings, mut film: Film, progress: &dyn Progress) -> Rendering {
    let lights = LightSampler::of(scene, settings);
    let plan = Plan::with_lights(scene, settings, &lights);
    let with_solids = plan.needs(Feature::NestedMedia) || plan.needs(Feature::Absorption);
    let media = MediaTable::new(scene, settings.size, with_solids);
    let setup = Setup { scene, lights: &lights, settings, plan: &plan, media: &media };
    let mut stats = Stats::default();
    let tiles = tiles(settings);
    let work: Vec<(usize, Crop)> =
        (0..film.buffers().len()).flat_map(|buffer| tiles.iter().map(move |tile| (buffer, *tile))).collect();
    let filter = FilterSampler::new(settings.filter);
    let outlines = Outlines::new(scene, settings);
    let (branching, pilot_rays) = pilot::branching(setup, &filter, &film, progress);
    stats.pilot_rays = pilot_rays;
    let mut schedule = Schedule::new(settings);
    let render_tile = smallest(&plan, settings.integrator);
    loop {
        if let Err(ended) = schedule.next(&mut film, progress) {
            return Rendering { film, stats, plan, branching, ended };
        }
        let render = |(buffer, tile): &(usize, Crop)| {
            let how = (&branching[..], &filter, &outlines);
            let done = render_tile(setup, how, &film, *buffer, *tile, progress)?;
            progress.advance(done.1.samples, done.1.rays());
            Some(done)
        };
        let done = on_each(settings, &work, render);
        for ((buffer, tile), (pixels, tile_stats)) in
            work.iter().zip(&done).filter_map(|(t, d)| Some((t, d.as_ref()?)))
        {
            film.add(*buffer, *tile, pixels);
            stats.merge(tile_stats);
        }
        if done.iter().any(Option::is_none) {
            return Rendering { film, stats, plan, branching, ended: Ended::Stopped };
        }
        progress.keep(&film);
    }
}

fn check(settings: &Settings) -> Result<(), RenderError> {
    let [width, height] = settings.size;
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) > 1 << 28 {
        return Err(RenderError::Size(width, height));
    }
    if settings.spp == 0 {
        return Err(RenderError::NoSamples);
    }
    if settings.until.is_some() && settings.spp < 2 {
        return Err(RenderError::OneSample);
    }
    if let Some(Target::RelMse(limit) | Target::Noise(limit)) = settings.until
        && !(limit > 0.0 && limit.is_finite())
    {
        return Err(RenderError::Target(limit));
    }
    let area = settings.area();
    let inside = |start: u32, length: u32, whole: u32| {
        length > 0 && start.checked_add(length).is_some_and(|end| end <= whole)
    };
    if inside(area.x, area.width, width) && inside(area.y, area.height, height) {
        Ok(())
    } else {
        Err(RenderError::Crop(area))
    }
}

/// The squares that the area is cut into, row by row.
fn tiles(settings: &Settings) -> Vec<Crop> {
    let area = settings.area();
    let edge = settings.tile.max(1);
    let starts = |from: u32, length: u32| (from..from + length).step_by(edge as usize);
    let cut = |start: u32, from: u32, length: u32| edge.min(from + length - start);
    starts(area.y, area.height)
        .flat_map(|y| starts(area.x, area.width).map(move |x| (x, y)))
        .map(|(x, y)| Crop { x, y, width: cut(x, area.x, area.width), height: cut(y, area.y, area.height) })
        .collect()
}

/// [`render_tile`] by one of the walkers.
type RenderTile = fn(
    Setup<'_>,
    (&[Branching], &FilterSampler, &Outlines),
    &Film,
    usize,
    Crop,
    &dyn Progress,
) -> Option<(Vec<Pixel>, Stats)>;

/// By the smallest walker that can do what the scene needs. There are eight, and each takes its time to be compiled.
fn smallest(plan: &Plan, integrator: Integrator) -> RenderTile {
    let (absorption, thin_sheets) = (plan.needs(Feature::Absorption), plan.needs(Feature::ThinSheets));
    match (integrator, plan.nested_media) {
        (Integrator::Whitted, 0) if absorption => render_tile::<Whitted<MediumId>>,
        (Integrator::Whitted, 0) => render_tile::<Whitted<()>>,
        (Integrator::Whitted, _) => render_tile::<Whitted<MediaList<MOST>>>,
        (Integrator::Path, 0) if thin_sheets => render_tile::<Path<MediumId, true>>,
        (Integrator::Path, 0) if absorption => render_tile::<Path<MediumId, false>>,
        (Integrator::Path, 0) => render_tile::<Path<(), false>>,
        (Integrator::Path, 1 | 2) => render_tile::<Path<MediaList<2>, true>>,
        (Integrator::Path, _) => render_tile::<AnyPath>,
    }
}

/// What the present round brings to the pixels of a tile, row by row; `None` when the render is to stop before the tile is done.
fn render_tile<P: Policy>(
    setup: Setup<'_>,
    (branching, filter, outlines): (&[Branching], &FilterSampler, &Outlines),
    film: &Film,
    buffer: usize,
    tile: Crop,
    progress: &dyn Progress,
) -> Option<(Vec<Pixel>, Stats)> {
    let mut walker = Walker::<P>::new(setup);
    let mut pixels = Vec::with_capacity(tile.width as usize * tile.height as usize);
    let mut sum = PixelSum::default();
    let seed = setup.settings.seed.wrapping_add(buffer as u64 * OTHER_BUFFER);
    let Buffer { goals, pixels: before } = &film.buffers()[buffer];
    for y in tile.y..tile.y + tile.height {
        for x in tile.x..tile.x + tile.width {
            sum.clear();
            let square = film.square(x, y);
            let (from, to) = (before[film.place(x, y)].taken, goals[square]);
            walker.branching = branching[square];
            walker.sees_objects = outlines.may_reach([x, y]);
            let rays = walker.stats.rays();
            for sample in from..to {
                if progress.is_stopped() {
                    return None;
                }
                let address = SampleAddress::new(seed, x, y, sample).of_sequence(setup.settings.sequence);
                let rounded = walker.sample(filter, [x, y], &address);
                if rounded.is_none() {
                    walker.stats.dropped += 1;
                    walker.stats.first_dropped.get_or_insert(Dropped { y, x, sample });
                }
                sum.push(rounded);
                sum.given_up += walker.given_up;
            }
            walker.stats.samples += u64::from(to - from);
            pixels.push(Pixel {
                before: Rgb::ZERO,
                last: sum.total(),
                taken: sum.taken,
                counted: sum.counted,
                last_counted: sum.counted,
                given_up: sum.given_up,
                rays: walker.stats.rays() - rays,
            });
        }
    }
    Some((pixels, walker.stats))
}
