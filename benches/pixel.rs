//! Whole pixels, from the camera to the film, on one thread: what all the other benches add up to.
//!
//! Elements are samples, where nothing else is said: camera rays with their whole trees and their shadow rays. Small pictures of the whole view, so
//! that floor, sky and glass have the share that they have in a large one.

use crate::measure::Harness;
use std::hint::black_box;
use std::path::Path;
use vitrum::io::load::{Loaded, ModelOptions, SceneOptions, model_file, scene_text};
use vitrum::tracer::{Branching, Crop, Integrator, Settings, render};

pub(crate) fn bench(harness: &mut Harness) {
    walker(harness);
    built_in_scene(harness);
    glass_mesh(harness);
    paths(harness);
}

fn picture(harness: &mut Harness, name: &str, loaded: &Loaded, size: [u32; 2], spp: u32) {
    let settings = Settings { size, spp, threads: 1, ..loaded.settings };
    let samples = size[0] as usize * size[1] as usize * spp as usize;
    harness.measure(name, samples, || {
        black_box(render(&loaded.scene, &settings, &()).expect("the settings are valid"));
    });
}

/// The ray tree alone: one pixel that looks into a ball of glass, a thousand times. Elements are rays, those towards lights too.
fn walker(harness: &mut Harness) {
    let text = include_str!("../tests/scenes/glass_on_a_floor.toml");
    let loaded = scene_text("glass on a floor", text, Path::new("")).expect("the scene is valid");
    let (path, whitted) = (Integrator::Path, Integrator::Whitted);
    for (name, integrator, branching) in [
        ("paths, one ray at glass", path, Branching::One),
        ("paths, whole trees", path, Branching::Tree),
        ("ray trees", whitted, Branching::Tree),
    ] {
        let crop = Some(Crop { x: 20, y: 24, width: 1, height: 1 });
        let settings = Settings {
            size: [64, 48],
            crop,
            spp: 1024,
            threads: 1,
            integrator,
            branching,
            ..loaded.settings
        };
        let pixel = || render(&loaded.scene, &settings, &()).expect("the settings are valid");
        harness.measure(&format!("walker/{name}"), pixel().stats.rays() as usize, || {
            black_box(pixel());
        });
    }
}

/// What `vitrum render` shows without a scene: glass, a mirror and a checker; seven objects without a tree.
fn built_in_scene(harness: &mut Harness) {
    let loaded = scene_text("built-in scene", include_str!("../scenes/default.toml"), Path::new(""));
    picture(harness, "pixel/built-in scene", &loaded.expect("the scene is valid"), [72, 48], 4);
}

/// Paths among balls of glass on a floor, under a lamp.
fn paths(harness: &mut Harness) {
    let text = include_str!("../tests/scenes/glass_on_a_floor.toml");
    let loaded = scene_text("glass on a floor", text, Path::new(""));
    picture(harness, "pixel/paths around glass", &loaded.expect("the scene is valid"), [64, 48], 4);
}

/// What `vitrum render torus_knot.obj` shows: a mesh of 12 288 triangles with interpolated normals as glass.
fn glass_mesh(harness: &mut Harness) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/meshes/torus_knot.obj");
    let loaded = model_file(&path, &ModelOptions::default(), SceneOptions::default());
    picture(harness, "pixel/glass knot", &loaded.expect("the mesh is part of the repository"), [48, 48], 4);
}
