//! What a render did, for programs: one JSON object.

use crate::failure::Failure;
use crate::summary::Phases;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use vitrum_tracer::Rendering;

/// `render --report FILE` writes it, `bench` reads it. Seconds, and counts; what an older program did not count yet is zero.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Report {
    /// Of the program.
    pub(crate) version: String,
    /// Reading the scene and building its trees.
    pub(crate) loading: f64,
    pub(crate) rendering: f64,
    /// What all threads together were busy while rendering.
    pub(crate) processors: f64,
    pub(crate) writing: f64,
    /// The most that the process has had so far, bytes; zero where the system does not tell.
    pub(crate) memory: u64,
    pub(crate) samples: u64,
    pub(crate) camera_rays: u64,
    /// Those among them that no object can be in the way of.
    pub(crate) unsearched_rays: u64,
    pub(crate) reflected_rays: u64,
    pub(crate) transmitted_rays: u64,
    pub(crate) shadow_rays: u64,
    /// Rays that found out how to branch.
    pub(crate) pilot_rays: u64,
    /// Largest depth of a ray.
    pub(crate) deepest: u32,
    /// Rays that guards against endless paths met.
    pub(crate) guarded: u64,
    /// Surfaces of solids that were passed straight, and those that were crossed together with another.
    pub(crate) passed: u64,
    pub(crate) merged: u64,
    /// Solids that were left without having been entered.
    pub(crate) unmatched_exits: u64,
    /// Samples that were not finite or negative, and are left out.
    pub(crate) dropped: u64,
}

impl Report {
    pub(crate) fn new(rendering: &Rendering, phases: &Phases) -> Self {
        let stats = &rendering.stats;
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            loading: phases.loading.as_secs_f64(),
            rendering: phases.rendering.as_secs_f64(),
            processors: phases.processors.as_secs_f64(),
            writing: phases.writing.as_secs_f64(),
            memory: most_memory().unwrap_or(0),
            samples: stats.samples,
            camera_rays: stats.camera_rays,
            unsearched_rays: stats.unsearched_rays,
            reflected_rays: stats.reflected_rays,
            transmitted_rays: stats.transmitted_rays,
            shadow_rays: stats.shadow_rays,
            pilot_rays: stats.pilot_rays,
            deepest: stats.deepest,
            guarded: stats.guarded,
            passed: stats.passed,
            merged: stats.merged,
            unmatched_exits: stats.unmatched_exits,
            dropped: stats.dropped,
        }
    }

    /// Rays of all kinds that are searched for, those of the pilot too.
    pub(crate) fn rays(&self) -> u64 {
        let camera_rays = self.camera_rays - self.unsearched_rays;
        camera_rays + self.reflected_rays + self.transmitted_rays + self.shadow_rays + self.pilot_rays
    }

    pub(crate) fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string(self).map_err(|e| Failure::running(e.to_string()))? + "\n";
        Ok(vitrum_io::write_text(path, &text)?)
    }

    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let text = fs::read_to_string(path)
            .map_err(|e| Failure::running(format!("{}: cannot be read ({e})", path.display())))?;
        serde_json::from_str(&text)
            .map_err(|e| Failure::running(format!("{}: is no report of a render ({e})", path.display())))
    }
}

/// As Linux tells.
fn most_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
