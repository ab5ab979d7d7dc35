//! Pictures of all directions: what their files say arrives in the scene, and what is wrong with them is told.

use std::fs;
use std::path::{Path, PathBuf};
use vitrum_io::image::{self, Display, ImageRgb, ImageView};
use vitrum_io::load::{self, Loaded, SceneOptions};
use vitrum_math::{DVec3, Rgb};
use vitrum_testkit::{assets, files_with_extension};
use vitrum_tracer::Background;

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// A Radiance file without runs.
fn flat(header: &str, size: &str, pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = format!("{header}\n\n{size}\n").into_bytes();
    bytes.extend(pixels.iter().flatten());
    bytes
}

fn read(path: &Path, bytes: &[u8]) -> Result<ImageRgb, String> {
    fs::write(path, bytes).expect("writable");
    image::read_radiance(path).map_err(|error| error.to_string())
}

/// Means of the channels, and the largest value.
fn moments(image: &ImageRgb) -> [f64; 4] {
    let mean =
        |c: usize| image.pixels.iter().map(|p| f64::from(p[c])).sum::<f64>() / image.pixels.len() as f64;
    let largest = image.pixels.iter().flatten().fold(0.0, |most: f32, c| most.max(*c));
    [mean(0), mean(1), mean(2), f64::from(largest)]
}

/// A mantissa of m and an exponent of e are m · 2^(e - 136); the header's exposures are divided out.
#[test]
fn radiance_files_mean_what_their_format_says() {
    let folder = folder();
    let path = folder.path().join("a.hdr");
    let pixels = [[128, 64, 32, 129], [255, 0, 1, 137], [7, 7, 7, 0], [1, 2, 3, 1]];
    let header = "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4\nEXPOSURE=0.5";
    let image = read(&path, &flat(header, "-Y 2 +X 2", &pixels)).expect("readable");
    assert_eq!((image.width, image.height), (2, 2));
    let tiny = 0.5 * 2.0_f32.powi(-135);
    let expected = [[0.5, 0.25, 0.125], [255.0, 0.0, 1.0], [0.0; 3], [tiny, 2.0 * tiny, 3.0 * tiny]];
    assert_eq!(image.pixels[..3], expected[..3]);
    assert_eq!(image.pixels[3], expected[3]);
    // Other programs write another signature, and the oldest none.
    for header in ["#?RGBE\nFORMAT=32-bit_rle_rgbe", "FORMAT=32-bit_rle_rgbe"] {
        let image = read(&path, &flat(header, "-Y 2 +X 2", &pixels)).expect("readable");
        assert_eq!(image.pixels[0], [1.0, 0.5, 0.25]);
    }
}

/// Sizes, means and largest values as the reader of Mitsuba 3.9.1 gives them; of the old runs, which that refuses, as a few
/// lines of Python do.
#[test]
fn real_files_are_read_like_by_other_programs() {
    let Some(folder) = assets() else { return };
    let expected = [
        ("old-rle.hdr", [551, 276], [0.187_386_569_9, 0.25, 0.312_613_430_1, 0.375]),
        ("std_env.hdr", [1500, 750], [0.644_380_55, 0.644_380_43, 0.644_380_55, 10.125]),
        ("studio_small_03_1k.hdr", [1024, 512], [1.635_954_74, 1.882_325_67, 2.127_458_98, 3568.0]),
        ("venice_sunset_1k.hdr", [1024, 512], [0.404_656_55, 0.416_238_2, 0.573_428_71, 6496.0]),
        ("luxcore_sky.exr", [1024, 512], [0.462_207_97, 0.486_775_96, 0.544_547_29, 1.0]),
    ];
    for (name, size, values) in expected {
        let image = image::read_radiance(&folder.join("hdr").join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!([image.width, image.height], size, "{name}");
        for (found, expected) in moments(&image).into_iter().zip(values) {
            assert!((found / expected - 1.0).abs() < 1e-7, "{name}: {found} instead of {expected}");
        }
    }
}

/// A file that holds 315 x 100 pixels of a picture of 1920 x 1920, from column 1012 and row 1097 on: the rest is black. The
/// mean over what it holds is that of Mitsuba 3.9.1, which shows nothing else.
#[test]
fn what_an_exr_does_not_hold_is_black() {
    let Some(folder) = assets() else { return };
    let image = image::read_radiance(&folder.join("hdr/exr-data-window-differs.exr")).expect("readable");
    assert_eq!((image.width, image.height), (1920, 1920));
    let inside = |at: usize| (1012..1327).contains(&(at % 1920)) && (1097..1197).contains(&(at / 1920));
    let outside = image.pixels.iter().enumerate().filter(|(at, _)| !inside(*at));
    assert!(outside.map(|(_, p)| p).all(|p| *p == [0.0; 3]));
    let share = (1920.0 * 1920.0) / (315.0 * 100.0);
    let [red, ..] = moments(&image);
    assert!((red * share / 0.089_496_21 - 1.0).abs() < 1e-6, "{red}");
}

#[test]
fn damaged_files_are_refused() {
    let folder = folder();
    let path = folder.path().join("a.hdr");
    let whole = flat("#?RADIANCE\nFORMAT=32-bit_rle_rgbe", "-Y 2 +X 2", &[[1, 2, 3, 128]; 4]);
    for length in 0..whole.len() {
        let said = read(&path, &whole[..length]).expect_err("cut off");
        assert!(said.contains("a.hdr: the file cannot be read as a Radiance picture"), "{said}");
    }
    for size in
        ["-Y 0 +X 2", "-Y 2 +X 0", "-Y 100000 +X 100000", "+X 2 -Y 2", "-Y two +X 2", "-Y 4000000000 +X 1"]
    {
        read(&path, &flat("#?RADIANCE", size, &[[1, 2, 3, 128]; 4])).expect_err(size);
    }
    for exposure in ["0", "-1", "inf", "nan"] {
        let header = format!("#?RADIANCE\nEXPOSURE={exposure}");
        read(&path, &flat(&header, "-Y 2 +X 2", &[[1, 2, 3, 128]; 4])).expect_err(exposure);
    }
    let said = image::read_radiance(&folder.path().join("a.tiff")).expect_err("another format").to_string();
    assert!(
        said.ends_with("a.tiff: found the extension .tiff, expected .hdr (Radiance) or .exr (OpenEXR)"),
        "{said}"
    );
    if let Some(assets) = assets() {
        for path in files_with_extension(&assets.join("malformed/exr"), "exr") {
            image::read_radiance(&path).expect_err("damaged");
        }
    }
}

/// A scene under a picture, in a folder of its own.
fn scene(folder: &Path, background: &str) -> PathBuf {
    let path = folder.join("scene.toml");
    let camera = "[camera]\ntype = \"pinhole\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n";
    fs::write(&path, format!("{camera}\n[background]\ntype = \"image\"\n{background}\n")).expect("writable");
    path
}

fn write(folder: &Path, pixels: &[[f32; 3]], width: u32) {
    let view = ImageView { width, height: pixels.len() as u32 / width, pixels };
    image::write(&folder.join("sky.exr"), view, &[], &[], Display::default()).expect("writable");
}

fn radiance(loaded: &Loaded, direction: DVec3) -> Rgb {
    let Background::Environment(map) = &loaded.scene.background else { panic!("a picture was asked for") };
    map.radiance(direction)
}

#[test]
fn a_scene_is_surrounded_by_its_picture() {
    let folder = folder();
    let pixels: Vec<[f32; 3]> = (0..8u8).map(|i| [f32::from(i), 1.0, 0.0]).collect();
    write(folder.path(), &pixels, 4);
    let background = "file = \"sky.exr\"\nrotation = 90\nscale = 2";
    let loaded = load::scene_file(&scene(folder.path(), background), SceneOptions::default()).expect("good");
    // Half a column right of -Z is the third texel, and a quarter turn brings it half a column left of it.
    let found = radiance(&loaded, DVec3::new(-0.5, 0.5_f64.sqrt(), -0.5));
    assert!((found - Rgb::new(4.0, 2.0, 0.0)).length() < 1e-6, "{found}");
    // A single texel is a constant.
    write(folder.path(), &[[0.5; 3]], 1);
    let loaded = load::scene_file(&scene(folder.path(), "file = \"sky.exr\""), SceneOptions::default());
    assert_eq!(radiance(&loaded.expect("good"), DVec3::X), Rgb::splat(0.5));
}

#[test]
fn texels_that_are_no_radiance_are_refused_or_replaced() {
    let folder = folder();
    let bad = [[1.0; 3], [f32::NAN, 1.0, 1.0], [f32::INFINITY, -2.0, 3.0], [7.0; 3]];
    write(folder.path(), &bad, 2);
    let path = scene(folder.path(), "file = \"sky.exr\"");
    let said = load::scene_file(&path, SceneOptions::default()).expect_err("no radiance").to_string();
    for part in [
        "sky.exr: 2 texels are no radiance (not a number, infinite or negative), the first in column 1 of row 0",
        "scene.toml:9:8",
        "--repair",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
    let loaded =
        load::scene_file(&path, SceneOptions { repair: true, ..SceneOptions::default() }).expect("repaired");
    let warned = loaded.warnings.to_string();
    assert!(warned.contains("2 texels were no radiance"), "{warned}");
    let Background::Environment(map) = &loaded.scene.background else { panic!("a picture was asked for") };
    assert_eq!(map.brightest(), 7.0);
    // Nothing to repair, nothing to say.
    write(folder.path(), &[[1.0; 3]; 4], 2);
    let loaded =
        load::scene_file(&path, SceneOptions { repair: true, ..SceneOptions::default() }).expect("good");
    assert!(loaded.warnings.is_empty());
}

#[test]
fn a_missing_picture_is_told_with_its_place() {
    let folder = folder();
    let path = scene(folder.path(), "file = \"nowhere.hdr\"");
    let said = load::scene_file(&path, SceneOptions::default()).expect_err("missing").to_string();
    for part in
        ["nowhere.hdr: there is no such file", "scene.toml:9:8", "relative to the folder of the scene file"]
    {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
}
