//! From a resolved scene to radiance on a film.
//!
//! Knows no files, clocks, environment variables or terminals. Read in this order: [`Scene`] (immutable, everything
//! resolved), [`Plan`] (what the scene needs, and what it can skip), [`render`] (tiles, samples, film), `schedule` (what is sampled
//! next), `walker` (the ray
//! tree: the hot loop), `whitted` and `path` (what happens at a hit).
//!
//! Threads never change the image: every random number is a function of its address, every pixel is summed in a fixed
//! order.

mod background;
mod camera;
mod crossing;
mod direct;
mod environment;
mod environment_sampler;
mod explain;
mod feature;
mod film;
mod filter;
mod light;
mod light_sampler;
mod light_tree;
mod media;
mod media_list;
mod outlines;
mod overlaps;
mod path;
mod pilot;
mod plan;
mod ray_tree;
mod render;
mod scene;
mod schedule;
mod seen;
mod settings;
mod stats;
mod threads;
mod trial;
mod walker;
mod whereabouts;
mod whitted;

pub use background::Background;
pub use camera::{Camera, CameraError, Projection};
pub use environment::{EnvironmentError, EnvironmentMap};
pub use environment_sampler::Sun;
pub use explain::{Ending, ExplainedHit, ExplainedRay, Way, explain, medium_at};
pub use feature::{Feature, Uses};
pub use film::{Buffer, ErrorEstimate, Film, FilmError, Pixel};
pub use filter::Filter;
pub use light::{Falloff, Light};
pub use outlines::background_pixels;
pub use plan::Plan;
pub use render::{Ended, Progress, RenderError, Rendering, render, resume};
pub use scene::{Scene, SceneError, SceneObject};
pub use seen::{Seen, seen};
pub use settings::{Branching, Crop, Integrator, LightSampling, NoSkip, Settings, ShadowMode, Target};
pub use stats::{Dropped, GivenUp, Stats};
pub use threads::on_threads;
