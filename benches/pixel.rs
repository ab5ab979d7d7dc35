//! Whole pixels, from the camera to the film, on one thread: what all the other benches add up to.
//!
//! Elements are samples: camera rays with their whole trees and their shadow rays. Small pictures of the whole view, so
//! that floor, sky and glass have the share that they have in a large one.

use crate::measure::measure;
use criterion::Criterion;
use std::hint::black_box;
use std::path::Path;
use vitrum::io::load::{Loaded, ModelOptions, model_file, scene_text};
use vitrum::tracer::{Settings, render};

pub(crate) fn bench(criterion: &mut Criterion) {
    built_in_scene(criterion);
    glass_mesh(criterion);
    paths(criterion);
}

fn picture(criterion: &mut Criterion, name: &str, loaded: &Loaded, size: [u32; 2], spp: u32) {
    let settings = Settings { size, spp, threads: 1, ..loaded.settings };
    let samples = size[0] as usize * size[1] as usize * spp as usize;
    measure(criterion, name, samples, || {
        black_box(render(&loaded.scene, &settings, &()).expect("the settings are valid"));
    });
}

/// What `vitrum render` shows without a scene: glass, a mirror and a checker; seven objects without a tree.
fn built_in_scene(criterion: &mut Criterion) {
    let loaded = scene_text("built-in scene", include_str!("../scenes/default.toml"), Path::new(""));
    picture(criterion, "pixel/built-in scene", &loaded.expect("the scene is valid"), [72, 48], 4);
}

/// Paths among balls of glass on a floor, under a lamp.
fn paths(criterion: &mut Criterion) {
    let text = include_str!("../tests/scenes/glass_on_a_floor.toml");
    let loaded = scene_text("glass on a floor", text, Path::new(""));
    picture(criterion, "pixel/paths around glass", &loaded.expect("the scene is valid"), [64, 48], 4);
}

/// What `vitrum render torus_knot.obj` shows: a mesh of 12 288 triangles with interpolated normals as glass.
fn glass_mesh(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/meshes/torus_knot.obj");
    let loaded = model_file(&path, &ModelOptions::default());
    picture(criterion, "pixel/glass knot", &loaded.expect("the mesh is part of the repository"), [48, 48], 4);
}
