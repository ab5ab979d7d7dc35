//! Images that textures are read from: every format and depth, and whatever can be wrong with a file.

use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbImage};
use std::fs;
use std::path::{Path, PathBuf};
use vitrum_io::image::{Display, ImageError, ImageView, Texels, read_texture, write};
use vitrum_materials::{Encoding, Filter, ImageTexture, srgb_to_linear};
use vitrum_math::{DVec2, Rgb};
use vitrum_testkit::{Uniform, assets, files_with_extension};

/// A folder for one test.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        fs::write(self.path(name), bytes).expect("written");
        self.path(name)
    }

    fn save(&self, name: &str, image: &DynamicImage, format: ImageFormat) -> PathBuf {
        image.save_with_format(self.path(name), format).expect("encoded");
        self.path(name)
    }
}

fn read(path: &Path, encoding: Option<Encoding>) -> Result<Texels, ImageError> {
    read_texture(path, "the image", encoding)
}

/// The texel in a column and a row from the top.
fn texel(texels: &Texels, column: u32, row: u32) -> Rgb {
    let [width, height] = texels.image.size().map(f64::from);
    let texture = ImageTexture { filter: Filter::Nearest, ..ImageTexture::new(texels.image.clone().into()) };
    let (u, v) = ((f64::from(column) + 0.5) / width, 1.0 - (f64::from(row) + 0.5) / height);
    texture.at(DVec2::new(u, v))
}

/// Three columns and two rows, all different.
fn bytes() -> [[u8; 3]; 6] {
    [[0, 1, 2], [10, 11, 12], [128, 64, 32], [255, 254, 253], [188, 200, 99], [77, 0, 255]]
}

fn small() -> RgbImage {
    RgbImage::from_raw(3, 2, bytes().concat()).expect("six pixels")
}

#[test]
fn eight_bits_are_colours_for_a_display_unless_told_otherwise() {
    let place = Place::new();
    let path = place.save("small.png", &small().into(), ImageFormat::Png);
    for (encoding, is_srgb) in [(None, true), (Some(Encoding::Srgb), true), (Some(Encoding::Linear), false)] {
        let texels = read(&path, encoding).expect("an image");
        assert_eq!(
            (texels.image.size(), texels.image.name(), texels.is_transparent),
            ([3, 2], "the image", false)
        );
        for (at, expected) in (0..).zip(bytes()) {
            let value = |byte: u8| {
                let share = f64::from(byte) / 255.0;
                if is_srgb { srgb_to_linear(share) } else { share }
            };
            assert_eq!(texel(&texels, at % 3, at / 3).to_array(), expected.map(value), "{encoding:?} {at}");
        }
    }
}

#[test]
fn grey_transparent_and_deep_images_are_read() {
    let place = Place::new();
    let whole = DynamicImage::from(small());
    let step = |texels: &Texels| (texel(texels, 1, 0).y - srgb_to_linear(11.0 / 255.0)).abs();
    let deep = read(&place.save("deep.png", &whole.to_rgb16().into(), ImageFormat::Png), None).expect("read");
    assert!(step(&deep) < 1e-9, "{}", step(&deep));
    let clear = whole.to_rgba8();
    let opaque =
        read(&place.save("opaque.png", &clear.clone().into(), ImageFormat::Png), None).expect("read");
    assert!(!opaque.is_transparent && step(&opaque) == 0.0);
    let mut clear = clear;
    clear.get_pixel_mut(2, 1).0[3] = 254;
    for image in [DynamicImage::from(clear.clone()), DynamicImage::from(clear).to_rgba16().into()] {
        let path = place.save("clear.png", &image, ImageFormat::Png);
        assert!(read(&path, None).expect("read").is_transparent);
    }
    for grey in
        [whole.to_luma8().into(), whole.to_luma_alpha8().into(), DynamicImage::from(whole.to_luma16())]
    {
        let expected = f64::from(whole.to_luma8().get_pixel(0, 1).0[0]) / 255.0;
        let read =
            read(&place.save("grey.png", &grey, ImageFormat::Png), Some(Encoding::Linear)).expect("read");
        let found = texel(&read, 0, 1);
        assert!((found - Rgb::splat(expected)).abs().max_element() < 2e-3, "{found} {expected}");
        assert!(found.x == found.y && found.y == found.z);
    }
}

#[test]
fn jpeg_is_read_by_what_is_in_it() {
    let place = Place::new();
    let plain = RgbImage::from_pixel(16, 8, image::Rgb([200, 100, 50]));
    let path = place.save("called.png", &plain.into(), ImageFormat::Jpeg);
    let texels = read(&path, Some(Encoding::Linear)).expect("read");
    assert_eq!(texels.image.size(), [16, 8]);
    let expected = Rgb::new(200.0, 100.0, 50.0) / 255.0;
    // Lossy: two steps.
    assert!((texel(&texels, 7, 3) - expected).abs().max_element() < 2.0 / 255.0);
}

#[test]
fn hdr_and_exr_are_linear() {
    let place = Place::new();
    // What eight bits of mantissa hold.
    let pixels = [[0.5, 1.0, 0.25], [4.0, 0.0, 2.0], [128.0, 64.0, 1.0], [0.0; 3]];
    let hdr = Rgb32FImage::from_raw(2, 2, pixels.concat()).expect("four pixels");
    let hdr = place.save("light.hdr", &hdr.into(), ImageFormat::Hdr);
    let exr = place.path("light.exr");
    let view = ImageView { width: 2, height: 2, pixels: &pixels };
    write(&exr, view, &[], &[], Display::default()).expect("written");
    for path in [hdr, exr] {
        let texels = read(&path, None).expect("read");
        for (at, expected) in (0..).zip(pixels) {
            assert_eq!(texel(&texels, at % 2, at / 2).to_array(), expected.map(f64::from), "{path:?} {at}");
        }
        assert_eq!(texels.image.brightest(), Rgb::new(128.0, 64.0, 2.0));
        let srgb = read(&path, Some(Encoding::Srgb)).expect_err("refused").to_string();
        assert!(
            srgb.contains("is linear, and was said to be encoded as sRGB; leave out `encoding`"),
            "{srgb}"
        );
    }
}

#[test]
fn pixels_that_are_no_colours_are_refused_with_their_place() {
    let place = Place::new();
    let mut pixels = vec![[0.5_f32; 3]; 12];
    (pixels[6], pixels[9]) = ([1.0, -0.25, 0.0], [f32::NAN; 3]);
    let path = place.path("bad.exr");
    write(&path, ImageView { width: 4, height: 3, pixels: &pixels }, &[], &[], Display::default())
        .expect("written");
    let said = read(&path, None).expect_err("refused").to_string();
    let expected = "pixels that are negative or not finite: 2, the first in column 2 and row 1 from the top left, \
                    [1.0, -0.25, 0.0]; write the image again without them";
    assert!(said.ends_with(expected), "{said}");
}

#[test]
fn what_is_no_image_says_what_it_is() {
    let place = Place::new();
    let said = |path: &Path| read(path, None).expect_err("refused").to_string();
    let of = |bytes: &[u8]| said(&place.write("file", bytes));
    assert!(of(b"").contains("the file is empty, expected an image: PNG, JPEG, Radiance HDR or OpenEXR"));
    assert!(of(b"GIF89a...").contains("found a GIF, expected an image"));
    assert!(of(b"# Blender\nv 1 2 3").contains("begins with the bytes 23 20 42 6c"));
    assert!(said(&place.path("gone.png")).ends_with("gone.png: there is no such file"));
    assert!(said(place.0.path()).contains("this is not a file"));
    // A header that promises 400 million pixels.
    let mut large = Vec::new();
    let mut writer = png::Encoder::new(&mut large, 20_000, 20_000).write_header().expect("a header");
    writer.write_chunk(png::chunk::IDAT, &[0; 32]).expect("a chunk");
    drop(writer);
    let large = of(&large);
    assert!(large.contains("the image has 20000 x 20000 pixels, the limit is 268435456 together"), "{large}");
}

/// Cut off anywhere, an image is refused; with any byte changed, it is read or refused.
#[test]
fn damaged_files_are_refused_and_nothing_breaks() {
    let place = Place::new();
    let noise = |x: u32, y: u32| ((x * 7919 + y * 104_729) % 251) as u8;
    let image = RgbImage::from_fn(24, 17, |x, y| image::Rgb([noise(x, y), noise(y, x), noise(x + y, x)]));
    let image = DynamicImage::from(image);
    let mut files: Vec<(&str, Vec<u8>)> = Vec::new();
    let formats = [("png", ImageFormat::Png), ("jpg", ImageFormat::Jpeg), ("hdr", ImageFormat::Hdr)];
    for (name, format) in formats {
        let image = if name == "hdr" { image.to_rgb32f().into() } else { image.clone() };
        files.push((name, fs::read(place.save(name, &image, format)).expect("written")));
    }
    let pixels: Vec<[f32; 3]> = image.to_rgb32f().pixels().map(|p| p.0).collect();
    let path = place.path("a.exr");
    write(&path, ImageView { width: 24, height: 17, pixels: &pixels }, &[], &[], Display::default())
        .expect("written");
    files.push(("exr", fs::read(path).expect("written")));
    let mut uniform = Uniform::new(5);
    for (name, whole) in files {
        assert!(read(&place.write("file", &whole), None).is_ok(), "{name}");
        // The end of a PNG holds nothing that is needed.
        let needed = if name == "png" { whole.len() - 12 } else { whole.len() };
        for length in (0..needed).step_by(1 + needed / 200) {
            assert!(read(&place.write("file", &whole[..length]), None).is_err(), "{name} of {length} bytes");
        }
        for _ in 0..300 {
            let mut changed = whole.clone();
            let [at, to] = uniform.pair();
            changed[(at * whole.len() as f64) as usize] = (to * 256.0) as u8;
            if let Err(error) = read(&place.write("file", &changed), None) {
                assert!(!error.to_string().is_empty());
            }
        }
    }
}

/// Files that other programs made.
#[test]
fn real_files_are_read() {
    let Some(assets) = assets() else { return };
    let size = |file: &str| read(&assets.join(file), None).map(|t| (t.image.size(), t.image.mean()));
    for (file, expected) in [
        ("hdr/venice_sunset_1k.hdr", [1024, 512]),
        ("hdr/studio_small_03_1k.hdr", [1024, 512]),
        ("hdr/std_env.hdr", [1500, 750]),
        ("hdr/luxcore_sky.exr", [1024, 512]),
    ] {
        let (found, mean) = size(file).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(found, expected, "{file}");
        assert!(mean.min_element() > 0.0 && mean.is_finite(), "{file} {mean}");
    }
    for file in ["hdr/old-rle.hdr", "hdr/exr-data-window-differs.exr"] {
        match size(file) {
            Ok((found, _)) => assert!(found[0] > 0, "{file}"),
            // Ringing of a filter left it a few negative pixels.
            Err(error) => assert!(error.to_string().contains("negative or not finite"), "{error}"),
        }
    }
    for folder in ["gltf-glass/ToyCar", "gltf-glass/MosquitoInAmber", "gltf-structure/BoxWithSpaces"] {
        let mut count = 0;
        for path in ["png", "jpg"].iter().flat_map(|end| files_with_extension(&assets.join(folder), end)) {
            let texels = read(&path, None).unwrap_or_else(|error| panic!("{error}"));
            assert!(texels.image.brightest().max_element() <= 1.0);
            count += 1;
        }
        assert!(count > 0, "{folder} has no images");
    }
    for path in files_with_extension(&assets.join("malformed/exr"), "exr") {
        if let Err(error) = read(&path, None) {
            assert!(!error.to_string().is_empty());
        }
    }
}
