//! How a scene is rendered, apart from what is in it.

use crate::filter::Filter;
use vitrum_math::Sequence;

/// How light is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// The whole ray tree of mirrors and glass, and light that comes straight from point lights: deterministic apart from the
    /// places in the pixel.
    #[default]
    Whitted,
    /// Light on all its ways, estimated without bias along random paths.
    Path,
}

/// How many children of a hit on glass or a mirror a path follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Branching {
    /// Whichever of the others is best, square by square of 8 x 8 pixels, as a few samples beforehand tell.
    #[default]
    Auto,
    /// One, by chance.
    One,
    /// All at the camera ray's hit, then one.
    First,
    /// All, while they weigh enough.
    Tree,
}

/// How paths find the light of objects that shine. No picture depends on it but in its noise; all but the first are for
/// study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSampling {
    /// By asking for it and by meeting it, each as it does better.
    #[default]
    Mis,
    /// By asking for it where that can be done.
    Lights,
    /// By meeting it. Light that can't be met (points, directions) is asked for.
    Bsdf,
}

/// What glass does to shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowMode {
    /// It blocks them, like everything else.
    #[default]
    Opaque,
    /// They go straight through, undeflected, and lose what each surface does not transmit. Biased: real light is refracted.
    Straight,
}

/// An error of the picture that is enough. Reaching it takes two buffers of independent samples, which decide for each other
/// where more are needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The mean over channels and pixels of squared error over squared radiance plus 0.01.
    RelMse(f64),
    /// The root of that, in every square of 8 x 8 pixels.
    Noise(f64),
}

/// What can run without being needed, and is made to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoSkip {
    /// Lights are asked for where there are none.
    pub lights: bool,
    /// Ambient light is added where it is black.
    pub ambient: bool,
    /// Clear media absorb nothing, segment by segment.
    pub absorption: bool,
    /// Rays count the solids that they are in where none reach into each other.
    pub nested_media: bool,
    /// Shadow rays look for sheets that light goes through.
    pub thin_sheets: bool,
    /// Objects stand in a tree, however few they are.
    pub object_tree: bool,
    /// Rays inside solids search everything.
    pub solids: bool,
    /// Pixels are searched that no object reaches.
    pub outlines: bool,
}

impl NoSkip {
    /// All of it.
    pub const ALL: Self = Self {
        lights: true,
        ambient: true,
        absorption: true,
        nested_media: true,
        thin_sheets: true,
        object_tree: true,
        solids: true,
        outlines: true,
    };
}

/// A part of the image, in pixels from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns, at least one.
    pub width: u32,
    /// Rows, at least one.
    pub height: u32,
}

/// How a scene is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Width and height of the whole image, pixels.
    pub size: [u32; 2],
    /// The part that is rendered; its pixels are the same bytes as in the whole image, but where an error or a time ends the render.
    pub crop: Option<Crop>,
    /// Samples per pixel; with an error to reach, the most that a pixel may get.
    pub spp: u32,
    /// The error to reach; none takes the samples as they are, the same number in each pixel.
    pub until: Option<Target>,
    /// Which points of the film a pixel is the mean of.
    pub filter: Filter,
    /// A ray deeper than this is not traced; the camera ray has depth 0. None: see [`deepest`](Self::deepest).
    pub max_depth: Option<u32>,
    /// How light is followed.
    pub integrator: Integrator,
    /// Of paths.
    pub branching: Branching,
    /// Of paths.
    pub light_sampling: LightSampling,
    /// Random numbers.
    pub sequence: Sequence,
    /// No channel of a sample counts for more than this: hides rare bright samples, and the light that they stand for. None,
    /// the default, hides nothing.
    pub clamp: Option<f64>,
    /// Of ray trees: a child ray is not traced when the largest channel of its weight, corrected for the radiance factor of
    /// the media, is below this. What is given up is summed and reported. Zero: never.
    pub cutoff: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// What glass does to shadow rays of ray trees.
    pub shadow: ShadowMode,
    /// What runs although the scene does not need it: shows what skipping it is worth. No effect on the image.
    pub no_skip: NoSkip,
    /// Threads; zero for as many as the machine has. No effect on the image.
    pub threads: usize,
    /// Edge of the squares that threads work on, pixels. No effect on the image.
    pub tile: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: [640, 480],
            crop: None,
            spp: 16,
            until: None,
            filter: Filter::Box,
            max_depth: None,
            integrator: Integrator::Whitted,
            branching: Branching::Auto,
            light_sampling: LightSampling::Mis,
            sequence: Sequence::Sobol,
            clamp: None,
            cutoff: 1e-3,
            seed: 0,
            shadow: ShadowMode::Opaque,
            no_skip: NoSkip::default(),
            threads: 0,
            tile: 16,
        }
    }
}

/// The deepest ray of a ray tree, unless something else is asked for.
const WHITTED_DEPTH: u32 = 10;

/// Fewer samples per pixel are not worth finding out how to branch.
const LEAST_FOR_PILOT: u32 = 16;

impl Settings {
    /// A ray deeper than this is not traced: 10 in ray trees and no limit for paths, unless `max_depth` says something else.
    #[inline]
    pub fn deepest(&self) -> u32 {
        self.max_depth.unwrap_or(match self.integrator {
            Integrator::Whitted => WHITTED_DEPTH,
            Integrator::Path => u32::MAX,
        })
    }

    /// How paths branch: of few samples whole trees, where it would be found out by trying.
    pub fn branches(&self) -> Branching {
        match self.branching {
            Branching::Auto if self.spp < LEAST_FOR_PILOT => Branching::Tree,
            given => given,
        }
    }

    /// The part of the image that is rendered.
    pub fn area(&self) -> Crop {
        self.crop.unwrap_or(Crop { x: 0, y: 0, width: self.size[0], height: self.size[1] })
    }
}
