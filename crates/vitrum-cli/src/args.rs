//! The command line.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};
use std::time::Duration;
use vitrum_io::load::{ModelMaterial, ModelOptions};
use vitrum_io::scene::Normals;
use vitrum_math::Sequence;
use vitrum_tracer::{Branching, Crop, Filter, Integrator, LightSampling, NoSkip, Target};

/// Renders glass, accurately and fast.
#[derive(Debug, Parser)]
#[command(name = "vitrum", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

impl Arguments {
    /// The command line; ends the program when that is wrong, or asks for help.
    pub(crate) fn read() -> Self {
        Self::try_parse().unwrap_or_else(|mut error| {
            if let Some(tip) = tip(&error) {
                error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
            }
            error.exit()
        })
    }
}

/// A scene in the place of a command is one that somebody wants rendered.
fn tip(error: &clap::Error) -> Option<String> {
    let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(name))) =
        (error.kind(), error.get(ContextKind::InvalidSubcommand))
    else {
        return None;
    };
    let extension = Path::new(name).extension()?.to_str()?;
    matches!(extension, "toml" | "obj").then(|| format!("to render it: vitrum render {name}"))
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene (.toml) or a model (.obj) to a picture
    ///
    /// Without SCENE a built-in scene is rendered. A model is put on a floor, under a light, into the middle of the picture.
    Render(Render),
    /// Say what is in a scene or model, what is wrong with it, and what rendering it needs
    Inspect(Inspect),
    /// Tell the ray tree through a pixel: what each ray meets, in which medium, and what becomes of it
    Explain(Explain),
    /// Say how far a picture is from its reference
    Compare(Compare),
    /// Measure run time against error on scenes with references
    Bench(Bench),
    /// Draw results of `bench` as one page
    Page(Page),
}

#[derive(Debug, Args)]
pub(crate) struct Render {
    /// Scene (.toml) or model (.obj)
    pub(crate) scene: Option<PathBuf>,

    /// Picture to write: .png to look at, .exr for linear values
    #[arg(short, long, value_name = "FILE", default_value = "vitrum.png")]
    pub(crate) output: PathBuf,

    /// Samples per pixel, in place of the scene's
    #[arg(long, value_name = "N", value_parser = whole::<1, 1_000_000>, allow_negative_numbers = true)]
    pub(crate) spp: Option<u32>,

    /// Error that is enough: noise=1% in every part of the picture, or relmse=1e-3 on average. Then --spp is the most that a
    /// pixel gets
    #[arg(long, value_name = "ERROR", value_parser = target)]
    pub(crate) until: Option<Target>,

    /// Time to render: 90s, 5m, 2h. Ends on a whole round of samples; --spp is the most that a pixel gets
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) time: Option<Duration>,

    /// Go on with a render that was stopped, from the checkpoint beside the picture: FILE.checkpoint
    #[arg(long)]
    pub(crate) resume: bool,

    /// Keep a checkpoint beside the picture: after each round, and at the end, to go on with more samples
    #[arg(long)]
    pub(crate) checkpoint: bool,

    /// What an .exr is to hold beside radiance, by comma: errors and numbers of samples, and what is seen in each pixel
    #[arg(long, value_enum, value_name = "C", value_delimiter = ',')]
    pub(crate) channels: Vec<ChannelChoice>,

    /// How light is followed, in place of the scene's choice
    #[arg(long, value_enum, value_name = "I")]
    pub(crate) integrator: Option<IntegratorChoice>,

    /// How many of the rays that glass divides a path follows, in place of the scene's choice
    #[arg(long, value_enum, value_name = "B")]
    pub(crate) branching: Option<BranchingChoice>,

    /// Largest value of a sample: hides rare bright samples, and the light that they stand for (biased; off unless given)
    #[arg(long, value_name = "L", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) clamp: Option<f64>,

    /// How paths find the light of objects that shine, for study
    #[arg(long, value_enum, value_name = "S", default_value_t = LightSamplingChoice::Mis)]
    pub(crate) light_sampling: LightSamplingChoice,

    /// Random numbers, for study
    #[arg(long, value_enum, value_name = "S", default_value_t = SequenceChoice::Sobol)]
    pub(crate) sequence: SequenceChoice,

    /// Run what the scene does not need, for study: the picture is the same, later. All that can be run so, or what is listed
    #[arg(long, value_enum, value_name = "S", value_delimiter = ',', num_args = 0.., require_equals = true)]
    pub(crate) no_skip: Option<Vec<NoSkipChoice>>,

    /// Which points of the film a pixel is the mean of, in place of the scene's choice
    #[arg(long, value_enum, value_name = "F")]
    pub(crate) filter: Option<FilterChoice>,

    /// Deepest ray, in place of the scene's; the camera ray has depth 0
    #[arg(long, value_name = "N", value_parser = whole::<0, 1000>, allow_negative_numbers = true)]
    pub(crate) max_depth: Option<u32>,

    /// Weight below which subtrees of ray trees are given up, in place of the scene's (0 to 1)
    #[arg(long, value_name = "W", value_parser = unit_interval, allow_negative_numbers = true)]
    pub(crate) cutoff: Option<f64>,

    /// Size of the picture in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,

    /// Part of the picture to render, in pixels from its upper left corner; its bytes are those of the whole picture, unless an
    /// error or a time ends the render
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(crate) crop: Option<Crop>,

    /// Seed of all random numbers, in place of the scene's
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,

    /// Threads, at most 1024; 0 for as many as the machine has. The picture does not depend on it
    #[arg(short, long, value_name = "N", default_value_t = 0, value_parser = whole::<0, 1024>, allow_negative_numbers = true)]
    pub(crate) threads: u32,

    /// Edge of the squares that threads work on, in pixels. The picture does not depend on it
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = whole::<1, 4096>, allow_negative_numbers = true)]
    pub(crate) tile: u32,

    /// Take environments with texels that are no radiance: 0 for what is not a number or negative, the largest finite value
    /// for what is infinite
    #[arg(long)]
    pub(crate) repair: bool,

    /// File for what the summary says, as JSON: seconds and counts
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,

    /// No progress, no warnings, no summary
    #[arg(short, long)]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) model: Model,
}

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Scene (.toml) or model (.obj); the built-in scene without
    pub(crate) scene: Option<PathBuf>,

    /// Take environments with texels that are no radiance, as `render` does
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) model: Model,
}

#[derive(Debug, Args)]
pub(crate) struct Explain {
    /// Scene (.toml) or model (.obj); the built-in scene without
    pub(crate) scene: Option<PathBuf>,

    /// Column and row of the pixel, 0,0 the upper left one; the ray goes through its middle
    #[arg(long, value_name = "X,Y", value_parser = pixel)]
    pub(crate) pixel: [u32; 2],

    /// Width and height of the picture, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,

    /// So many rays are told at most
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole::<1, 100_000>, allow_negative_numbers = true)]
    pub(crate) rays: u32,

    /// Take environments with texels that are no radiance, as `render` does
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) model: Model,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Picture: .exr or .hdr, linear
    pub(crate) image: PathBuf,

    /// What it should be: .exr or .hdr, of the same size
    pub(crate) reference: PathBuf,

    /// Picture of the differences to write: .png shows what an eye sees of them (FLIP; dark is none), .exr holds image minus
    /// reference
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Exposure in stops of both pictures, for what an eye sees of their difference
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = stops, allow_negative_numbers = true)]
    pub(crate) exposure: f64,

    /// The numbers as one line of JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// Scenes (.toml), each with a reference beside it: references/NAME.exr [default: all of scenes/bench]
    pub(crate) scenes: Vec<PathBuf>,

    /// Folder for the results, without any yet: results.jsonl, results.csv, index.html, and pictures of the first seed
    #[arg(short, long, value_name = "FOLDER", default_value = "bench-results")]
    pub(crate) output: PathBuf,

    /// Two programs to compare, in place of this one: every run of one is followed by the same run of the other
    #[arg(long, num_args = 2, value_names = ["BEFORE", "AFTER"])]
    pub(crate) against: Vec<PathBuf>,

    /// Samples per pixel of the runs, in place of 1, 2, 4 and so on
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = whole::<1, 1_000_000>, allow_negative_numbers = true)]
    pub(crate) spp: Vec<u32>,

    /// Samples are doubled until a run takes this long, or the reference is no longer good enough to tell its error
    #[arg(long, value_name = "TIME", value_parser = duration, default_value = "4s")]
    pub(crate) time: Duration,

    /// Runs of each number of samples, each with its own seed
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = whole::<1, 1000>, allow_negative_numbers = true)]
    pub(crate) seeds: u32,

    /// Threads of each run, at most 1024; 0 for as many as the machine has
    #[arg(short, long, value_name = "N", default_value_t = 0, value_parser = whole::<0, 1024>, allow_negative_numbers = true)]
    pub(crate) threads: u32,

    /// More results to draw on the page (.jsonl), such as those of other renderers
    #[arg(long, value_name = "FILE")]
    pub(crate) include: Vec<PathBuf>,

    /// Makes the references of the scenes instead: the mean of as many renders as there are --seeds, of --spp samples each
    #[arg(long, requires = "spp", conflicts_with_all = ["against", "include", "output", "time"])]
    pub(crate) make_references: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Page {
    /// Results (.jsonl); their pictures lie where they say, relative to them
    #[arg(required_unless_present = "costs")]
    pub(crate) results: Vec<PathBuf>,

    /// How cost grows, as `benches/cost.py` of vitrum's sources measures it (.jsonl); may be given several times
    #[arg(long, value_name = "FILE")]
    pub(crate) costs: Vec<PathBuf>,

    /// Page to write: one HTML file that needs no other
    #[arg(short, long, value_name = "FILE", default_value = "index.html")]
    pub(crate) output: PathBuf,

    /// Print the tables of the page as Markdown, and write no page
    #[arg(long)]
    pub(crate) markdown: bool,
}

/// How a model (.obj) is shown; without effect on scenes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Models")]
pub(crate) struct Model {
    /// What the model is made of
    #[arg(long, value_enum, value_name = "M")]
    pub(crate) material: Option<MaterialChoice>,

    /// Index of refraction of the glass, inside over outside [default: 1.5]
    #[arg(long, value_name = "N", value_parser = index, allow_negative_numbers = true)]
    pub(crate) ior: Option<f64>,

    /// Normals that the model is shaded with [default: the file's, else smooth]
    #[arg(long, value_enum, value_name = "N")]
    pub(crate) normals: Option<NormalsChoice>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ChannelChoice {
    /// Standard error of the mean, by channel: error.R, error.G, error.B
    Error,
    /// Samples taken: samples.Y
    Samples,
    /// The object in the middle of the pixel: object.id, its place in the metadata `objects` from 1; 0 for none
    Object,
    /// Its material, by number from 1: material.id
    Material,
    /// Distance from the camera, metres: depth.Z
    Depth,
    /// Normal of the first surface, towards the camera: normal.X, normal.Y, normal.Z
    Normal,
    /// Share of light that it gives back: albedo.R, albedo.G, albedo.B
    Albedo,
    /// Normal of the first surface behind glass and mirrors: behind.normal.X, Y, Z
    NormalBehind,
    /// What that gives back: behind.albedo.R, G, B
    AlbedoBehind,
    /// The most solids of glass inside each other on the way there: media.Y
    Media,
    /// How often rays left glass that they had not entered, or media did not fit: unmatched.Y
    Unmatched,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum NoSkipChoice {
    /// Asking for light where there is none
    Lights,
    /// Adding black ambient light
    Ambient,
    /// What clear media absorb
    Absorption,
    /// Counting the solids that a ray is in
    NestedMedia,
    /// Looking for sheets on the way to lights
    ThinSheets,
    /// A tree over few objects
    ObjectTree,
    /// Searching everything from inside a solid
    Solids,
    /// Searching pixels that no object reaches
    Outlines,
}

/// What `--no-skip` says: nothing, everything, or what it lists.
pub(crate) fn no_skip(asked: Option<&[NoSkipChoice]>) -> NoSkip {
    let mut found = NoSkip::default();
    match asked {
        None => {}
        Some([]) => found = NoSkip::ALL,
        Some(listed) => listed.iter().for_each(|choice| match choice {
            NoSkipChoice::Lights => found.lights = true,
            NoSkipChoice::Ambient => found.ambient = true,
            NoSkipChoice::Absorption => found.absorption = true,
            NoSkipChoice::NestedMedia => found.nested_media = true,
            NoSkipChoice::ThinSheets => found.thin_sheets = true,
            NoSkipChoice::ObjectTree => found.object_tree = true,
            NoSkipChoice::Solids => found.solids = true,
            NoSkipChoice::Outlines => found.outlines = true,
        }),
    }
    found
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum IntegratorChoice {
    /// The ray tree of mirrors and glass
    Whitted,
    /// Light on all its ways
    Path,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum BranchingChoice {
    /// Whichever is best, part by part of the picture
    Auto,
    /// One, by chance
    One,
    /// All at the first hit, then one
    First,
    /// All, while they weigh enough
    Tree,
}

impl From<IntegratorChoice> for Integrator {
    fn from(choice: IntegratorChoice) -> Self {
        match choice {
            IntegratorChoice::Whitted => Self::Whitted,
            IntegratorChoice::Path => Self::Path,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FilterChoice {
    /// Those of its square
    Box,
    /// Falling to the middles of its neighbours
    Tent,
    /// A bell over three pixels
    BlackmanHarris,
}

impl From<FilterChoice> for Filter {
    fn from(choice: FilterChoice) -> Self {
        match choice {
            FilterChoice::Box => Self::Box,
            FilterChoice::Tent => Self::Tent,
            FilterChoice::BlackmanHarris => Self::BlackmanHarris,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LightSamplingChoice {
    /// By asking for it and by meeting it
    Mis,
    /// By asking for it
    Lights,
    /// By meeting it
    Bsdf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SequenceChoice {
    /// Those of the samples of a pixel fill the unit square evenly
    Sobol,
    /// Each by itself
    Independent,
}

impl From<LightSamplingChoice> for LightSampling {
    fn from(choice: LightSamplingChoice) -> Self {
        match choice {
            LightSamplingChoice::Mis => Self::Mis,
            LightSamplingChoice::Lights => Self::Lights,
            LightSamplingChoice::Bsdf => Self::Bsdf,
        }
    }
}

impl From<SequenceChoice> for Sequence {
    fn from(choice: SequenceChoice) -> Self {
        match choice {
            SequenceChoice::Sobol => Self::Sobol,
            SequenceChoice::Independent => Self::Independent,
        }
    }
}

impl From<BranchingChoice> for Branching {
    fn from(choice: BranchingChoice) -> Self {
        match choice {
            BranchingChoice::Auto => Self::Auto,
            BranchingChoice::One => Self::One,
            BranchingChoice::First => Self::First,
            BranchingChoice::Tree => Self::Tree,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MaterialChoice {
    /// Glass, whatever the file says (the default)
    Glass,
    /// Grey and matte, to look at the shape
    Matte,
    /// What the file says
    File,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum NormalsChoice {
    /// Averaged at vertices
    Smooth,
    /// Of each triangle
    Flat,
    /// The file's, flat where it has none
    File,
}

impl Model {
    /// True when something was asked for that only a model has.
    pub(crate) fn is_given(&self) -> bool {
        self.material.is_some() || self.ior.is_some() || self.normals.is_some()
    }

    /// True when an index of refraction was asked for and no glass.
    pub(crate) fn has_idle_index(&self) -> bool {
        self.ior.is_some() && !matches!(self.material, None | Some(MaterialChoice::Glass))
    }

    pub(crate) fn options(&self, size: Option<[u32; 2]>) -> ModelOptions {
        let default = ModelOptions::default();
        ModelOptions {
            material: match self.material {
                None | Some(MaterialChoice::Glass) => ModelMaterial::Glass,
                Some(MaterialChoice::Matte) => ModelMaterial::Matte,
                Some(MaterialChoice::File) => ModelMaterial::File,
            },
            ior: self.ior.unwrap_or(default.ior),
            size: size.unwrap_or(default.size),
            normals: self.normals.map(|n| match n {
                NormalsChoice::Smooth => Normals::Smooth,
                NormalsChoice::Flat => Normals::Flat,
                NormalsChoice::File => Normals::File,
            }),
        }
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let number = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=65536).contains(n));
    text.split_once(['x', 'X'])
        .and_then(|(w, h)| Some([number(w)?, number(h)?]))
        .ok_or_else(|| "expected width and height in pixels, 1 to 65536 each, such as 640x480".to_owned())
}

fn pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers =
        text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    numbers.ok_or_else(|| "expected a column and a row, such as 320,240".to_owned())
}

fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|s| s.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop { x, y, width, height }),
        _ => Err("expected four whole numbers, left,top,width,height, such as 100,50,64,64".to_owned()),
    }
}

/// A whole number from `MIN` to `MAX`.
fn whole<const MIN: u32, const MAX: u32>(text: &str) -> Result<u32, String> {
    let number = text.parse().ok().filter(|n| (MIN..=MAX).contains(n));
    number.ok_or_else(|| format!("expected a whole number from {MIN} to {MAX}"))
}

/// `noise=1%`, `noise=0.01` or `relmse=1e-3`.
fn target(text: &str) -> Result<Target, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|n: &f64| *n > 0.0 && *n < 1.0);
    let share = |text: &str| match text.strip_suffix('%') {
        Some(percent) => percent.trim().parse().ok().map(|n: f64| n / 100.0).filter(|n| *n > 0.0 && *n < 1.0),
        None => number(text),
    };
    let found = match text.split_once('=') {
        Some(("noise", limit)) => share(limit).map(Target::Noise),
        Some(("relmse", limit)) => number(limit).map(Target::RelMse),
        _ => None,
    };
    found.ok_or_else(|| "expected noise=1% or relmse=1e-3, above 0 and below 100 %".to_owned())
}

/// `90s`, `5m`, `2h`, or seconds without a unit.
fn duration(text: &str) -> Result<Duration, String> {
    let (number, unit) = match text.trim().char_indices().last() {
        Some((at, 's')) => (&text[..at], 1.0),
        Some((at, 'm')) => (&text[..at], 60.0),
        Some((at, 'h')) => (&text[..at], 3600.0),
        _ => (text, 1.0),
    };
    let seconds = number.trim().parse().ok().map(|n: f64| n * unit).filter(|s| *s > 0.0 && *s <= 3.2e7);
    seconds
        .map(Duration::from_secs_f64)
        .ok_or_else(|| "expected a time above 0 and up to a year, such as 90s, 5m or 2h".to_owned())
}

fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

fn unit_interval(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n| (0.0..=1.0).contains(n));
    number.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

fn stops(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| n.abs() <= 100.0);
    number.ok_or_else(|| "expected a number of stops from -100 to 100, such as 1".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| *n > 0.0 && n.is_finite());
    number.ok_or_else(|| "expected a number above 0, such as 10".to_owned())
}

fn index(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n| (1e-3..=1e3).contains(n));
    number.ok_or_else(|| "expected a number from 0.001 to 1000, such as 1.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn sizes_and_crops_are_read() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert!(size("0x480").is_err() && size("640").is_err() && size("-1x2").is_err());
        assert_eq!(crop("1, 2,3,4"), Ok(Crop { x: 1, y: 2, width: 3, height: 4 }));
        assert!(crop("1,2,3").is_err() && crop("1,2,0,4").is_err());
    }

    #[test]
    fn errors_and_times_are_read() {
        assert_eq!(target("noise=2%"), Ok(Target::Noise(0.02)));
        assert_eq!(target("noise=0.5"), Ok(Target::Noise(0.5)));
        assert_eq!(target("relmse=1e-3"), Ok(Target::RelMse(1e-3)));
        for text in
            ["", "noise", "noise=", "noise=0", "noise=100%", "noise=-1%", "relmse=1%", "rmse=1", "relmse=nan"]
        {
            assert!(target(text).is_err(), "{text}");
        }
        assert_eq!(duration("90s"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("2h"), Ok(Duration::from_secs(7200)));
        assert_eq!(duration("0.25"), Ok(Duration::from_millis(250)));
        for text in ["", "s", "0", "-1s", "1d", "inf", "nan", "1e9h", "5 minutes", "3é"] {
            assert!(duration(text).is_err(), "{text}");
        }
    }

    #[test]
    fn whole_numbers_have_their_range() {
        assert_eq!(whole::<1, 16>("16"), Ok(16));
        for text in ["0", "17", "1.5", "-1", "", "99999999999999999999"] {
            assert_eq!(whole::<1, 16>(text), Err("expected a whole number from 1 to 16".to_owned()));
        }
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        assert!(seed("18446744073709551616").is_err() && seed("-1").is_err());
    }
}
