//! The gallery's scenes, as they are or changed for a question.

use std::fs;
use std::path::{Path, PathBuf};
use vitrum::io::load::{self, Loaded};
use vitrum::io::scene::{self, MaterialChoice, Model, SceneDesc};
use vitrum::math::Rgb;
use vitrum::tracer::{Ended, Settings, render};

pub(crate) fn gallery() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery")
}

/// Names of the scene files, without their extension, in order.
pub(crate) fn names() -> Vec<String> {
    let files = fs::read_dir(gallery()).expect("the gallery is there").flatten().map(|entry| entry.path());
    let mut names: Vec<String> = files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .filter_map(|path| path.file_stem()?.to_str().map(str::to_owned))
        .collect();
    names.sort();
    assert!(names.len() > 10, "the gallery is not in {}", gallery().display());
    names
}

/// What a scene file of the gallery says.
pub(crate) fn described(name: &str) -> SceneDesc {
    let path = gallery().join(name).with_extension("toml");
    let (desc, problems) = scene::parse(name, &fs::read_to_string(path).expect("the scene can be read"));
    desc.unwrap_or_else(|| panic!("{problems}"))
}

/// The scene that a description means.
pub(crate) fn loaded(desc: &SceneDesc) -> Loaded {
    load::description(desc, &gallery()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The picture of a description at another size and number of samples, row by row.
pub(crate) fn picture(desc: &SceneDesc, size: [u32; 2], spp: u32) -> Vec<[f32; 3]> {
    let loaded = loaded(desc);
    let settings = Settings { size, spp, ..loaded.settings };
    let rendering = render(&loaded.scene, &settings, &()).expect("the settings make a picture");
    assert_eq!(rendering.ended, Ended::Samples);
    assert_eq!(rendering.stats.dropped, 0, "{:?}", rendering.stats.first_dropped);
    rendering.film.image()
}

/// Keeps only the objects with these names.
pub(crate) fn keep(desc: &mut SceneDesc, names: &[&str]) {
    desc.objects.retain(|object| object.name.as_ref().is_some_and(|n| names.contains(&n.text.as_str())));
    assert_eq!(desc.objects.len(), names.len(), "{names:?} are not all there");
}

/// Takes out the object with this name.
pub(crate) fn remove(desc: &mut SceneDesc, name: &str) {
    let before = desc.objects.len();
    desc.objects.retain(|object| object.name.as_ref().is_none_or(|n| n.text != name));
    assert_eq!(desc.objects.len() + 1, before, "there is no `{name}`");
}

/// Sets what all glass of the scene reflects and transmits, and takes its highlights away.
pub(crate) fn set_glass(desc: &mut SceneDesc, reflected: f64, transmitted: f64) {
    let inline = desc.objects.iter_mut().filter_map(|object| match &mut object.material {
        Some(MaterialChoice::Inline(material)) => Some(&mut **material),
        _ => None,
    });
    for material in desc.materials.iter_mut().chain(inline) {
        if let Model::Transparent { phong, kr, kt, .. } = &mut material.model {
            phong.ks = 0.0;
            (*kr, *kt) = (Rgb::splat(reflected), Rgb::splat(transmitted));
        }
    }
}

/// Nothing but even light of radiance 1 from everywhere.
pub(crate) fn surround_with_white(desc: &mut SceneDesc) {
    desc.lights.clear();
    desc.background = scene::Background::Constant { color: Rgb::ONE };
}

/// Asks `of` at the four corners of a pixel; the answer if they agree, so that the whole pixel is on one side of an edge
/// that is straight at this scale.
pub(crate) fn unanimous<T: PartialEq>(x: u32, y: u32, of: impl Fn(f64, f64) -> T) -> Option<T> {
    let (left, top) = (f64::from(x), f64::from(y));
    let first = of(left, top);
    let others = [of(left + 1.0, top), of(left, top + 1.0), of(left + 1.0, top + 1.0)];
    others.iter().all(|other| *other == first).then_some(first)
}
