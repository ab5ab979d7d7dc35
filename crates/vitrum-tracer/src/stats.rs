//! What a render did, counted.

use crate::feature::{Feature, Uses};
use vitrum_geometry::Counters;

/// Counts of one render. Sums and maxima only, so that they don't depend on the order of the work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Samples taken.
    pub samples: u64,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Those among them that were not searched for: no object reaches their pixel.
    pub unsearched_rays: u64,
    /// Rays that stayed on their side of a surface.
    pub reflected_rays: u64,
    /// Rays that crossed a surface.
    pub transmitted_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Rays that found out which of the rays that glass divides are worth following. They are in no picture, and in none of the
    /// other counts.
    pub pilot_rays: u64,
    /// The largest depth of a ray that was traced.
    pub deepest: u32,
    /// Nodes of paths that met a guard against endless paths and trees: roulette there, never a cut.
    pub guarded: u64,
    /// Hits where an interpolated normal put a direction on the wrong side, so that the geometric normal was used.
    pub normal_fallbacks: u64,
    /// Surfaces of solids that were passed straight, because another solid fills both sides.
    pub passed: u64,
    /// Surfaces of solids that were crossed together with another one, because they are the same but for rounding.
    pub merged: u64,
    /// Surfaces of solids near the origin of a ray that were ignored, because the ray has crossed them already.
    pub contradictions: u64,
    /// Solids that were left without having been entered, and rays that escaped out of one without having left it.
    pub unmatched_exits: u64,
    /// Solids that were not counted, because a ray was in eight others.
    pub overfull: u64,
    /// Rays that were given up on their way straight through solids.
    pub unending: u64,
    /// Rare events of the ray queries.
    pub geometry: Counters,
    /// Of features, in builds that count them: see [`Stats::uses_of`].
    pub(crate) uses: Uses,
    /// Samples that were not finite, or negative, and were left out.
    pub dropped: u64,
    /// The first of them in the order of pixels and samples.
    pub first_dropped: Option<Dropped>,
}

/// A sample that was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Dropped {
    /// Row.
    pub y: u32,
    /// Column.
    pub x: u32,
    /// Index of the sample.
    pub sample: u32,
}

/// Energy that was not followed, as weight: at most this share of the radiance that would have arrived is missing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GivenUp {
    /// Mean over the pixels.
    pub mean: f64,
    /// Largest mean over the samples of one pixel.
    pub largest: f64,
}

impl Stats {
    /// Rays of all kinds that were searched for.
    pub fn searched_rays(&self) -> u64 {
        self.rays() - self.unsearched_rays
    }

    /// Rays of all kinds.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.reflected_rays + self.transmitted_rays + self.shadow_rays
    }

    /// Nodes of the ray trees: all rays but those towards lights.
    pub fn nodes(&self) -> u64 {
        self.camera_rays + self.reflected_rays + self.transmitted_rays
    }

    /// How often a feature was used. In builds that do not count uses ([`Uses::ARE_COUNTED`]) only shadow rays are known.
    pub fn uses_of(&self, feature: Feature) -> u64 {
        match feature {
            Feature::ShadowRays => self.shadow_rays,
            Feature::Meshes => self.geometry.mesh_searches,
            Feature::ObjectTree => self.geometry.tree_searches,
            Feature::SmoothNormals => self.geometry.interpolated_normals,
            _ => self.uses.of(feature),
        }
    }

    /// Adds what another part of the image counted.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.samples += other.samples;
        self.camera_rays += other.camera_rays;
        self.unsearched_rays += other.unsearched_rays;
        self.reflected_rays += other.reflected_rays;
        self.transmitted_rays += other.transmitted_rays;
        self.shadow_rays += other.shadow_rays;
        self.pilot_rays += other.pilot_rays;
        self.deepest = self.deepest.max(other.deepest);
        self.guarded += other.guarded;
        self.normal_fallbacks += other.normal_fallbacks;
        self.passed += other.passed;
        self.merged += other.merged;
        self.contradictions += other.contradictions;
        self.unmatched_exits += other.unmatched_exits;
        self.overfull += other.overfull;
        self.unending += other.unending;
        self.geometry.merge(&other.geometry);
        self.uses.merge(&other.uses);
        self.dropped += other.dropped;
        self.first_dropped = match (self.first_dropped, other.first_dropped) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }
}
