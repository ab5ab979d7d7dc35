//! Images as files: what is written can be read back, by other libraries too, and failures leave nothing behind.

use std::fs;
use std::path::{Path, PathBuf};

use vitrum_io::image::{self, Display, ImageView, Tone};

/// A picture whose pixels are all different, with every kind of float among them.
fn picture(width: u32, height: u32) -> Vec<[f32; 3]> {
    let count = width * height;
    let mut pixels: Vec<[f32; 3]> = (0..count)
        .map(|i| [i as f32 / count as f32, (i as f32 * 0.37).sin(), (i as f32 * 0.2).exp2()])
        .collect();
    let special = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, f32::MIN_POSITIVE / 8.0, f32::MAX];
    for (pixel, value) in pixels.iter_mut().zip(special) {
        pixel[1] = value;
    }
    pixels
}

fn bits(pixels: &[[f32; 3]]) -> Vec<[u32; 3]> {
    pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

fn metadata() -> Vec<(String, String)> {
    let pairs = [
        ("version", "0.1.0"),
        ("seed", "7"),
        ("integrator", "whitted"),
        ("samples", "16"),
        ("scene", "Glä✓s"),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn exr_keeps_every_bit() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    for (width, height) in [(1, 1), (7, 5), (33, 40), (3, 100)] {
        let pixels = picture(width, height);
        image::write(
            &path,
            ImageView { width, height, pixels: &pixels },
            &[],
            &metadata(),
            Display::default(),
        )
        .expect("writable");
        let read = image::read_exr(&path).expect("readable");
        assert_eq!((read.width, read.height), (width, height));
        assert_eq!(bits(&read.pixels), bits(&pixels));
        let mut expected: Vec<_> =
            metadata().into_iter().map(|(key, value)| (format!("vitrum:{key}"), value)).collect();
        expected.sort();
        assert_eq!(read.metadata, expected);
    }
}

#[test]
fn the_same_image_gives_the_same_bytes() {
    let folder = folder();
    let pixels = picture(20, 30);
    let view = ImageView { width: 20, height: 30, pixels: &pixels };
    for name in ["a.exr", "a.png"] {
        let path = folder.path().join(name);
        let write = || {
            image::write(&path, view, &[], &metadata(), Display::default()).expect("writable");
            fs::read(&path).expect("readable")
        };
        let first = write();
        // The library's hash map has another order each time: one run of luck is not enough.
        assert!((0..20).all(|_| write() == first), "{name}");
    }
}

/// Attributes of an EXR header: name, type and value, read by hand.
fn exr_header(bytes: &[u8]) -> Vec<(String, String, Vec<u8>)> {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("names are text");
    let mut attributes = Vec::new();
    let mut rest = &bytes[8..];
    while rest[0] != 0 {
        let mut fields = rest.splitn(3, |&byte| byte == 0);
        let mut field = || fields.next().expect("three fields");
        let (name, kind, value) = (field(), field(), field());
        let size = u32::from_le_bytes(value[..4].try_into().expect("four bytes")) as usize;
        attributes.push((text(name), text(kind), value[4..4 + size].to_vec()));
        rest = &value[4 + size..];
    }
    attributes
}

#[test]
fn exr_says_what_it_is() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    let pixels = picture(4, 4);
    image::write(
        &path,
        ImageView { width: 4, height: 4, pixels: &pixels },
        &[],
        &metadata(),
        Display::default(),
    )
    .expect("writable");
    let bytes = fs::read(&path).expect("readable");
    assert_eq!(
        bytes[..8],
        [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0],
        "magic number; version 2, one part, scanlines"
    );
    let header = exr_header(&bytes);
    assert!(header.is_sorted());
    let attribute = |name: &str| {
        let found = header.iter().find(|attribute| attribute.0 == name).expect(name);
        (found.1.as_str(), &found.2[..])
    };
    assert_eq!(attribute("compression"), ("compression", &[3][..]), "ZIP, 16 lines");
    assert_eq!(attribute("lineOrder"), ("lineOrder", &[0][..]), "increasing");
    let rec709: Vec<u8> = [0.64_f32, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290]
        .into_iter()
        .flat_map(f32::to_le_bytes)
        .collect();
    assert_eq!(attribute("chromaticities"), ("chromaticities", &rec709[..]));
    assert_eq!(attribute("vitrum:seed"), ("string", &b"7"[..]));
    let (kind, channels) = attribute("channels");
    assert_eq!(kind, "chlist");
    // Three channels of type 2 (float), in the order B, G, R that the format asks for.
    let names: Vec<_> = channels.chunks(18).take(3).map(|channel| (channel[0], channel[2])).collect();
    assert_eq!(names, [(b'B', 2), (b'G', 2), (b'R', 2)]);
    for forbidden in ["capDate", "owner", "comments", "utcOffset"] {
        assert!(header.iter().all(|attribute| attribute.0 != forbidden));
    }
}

/// The display transform, written down a second time with the platform's functions.
fn expected_byte(value: f32, stops: f64) -> u8 {
    let value = f64::from(value) * stops.exp2();
    let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
    let encoded = if value <= 0.0031308 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[test]
fn png_holds_what_the_formula_says() {
    let folder = folder();
    let path = folder.path().join("a.PNG");
    let (width, height) = (37, 11);
    let pixels = picture(width, height);
    for stops in [0.0, 1.5, -3.0] {
        let display = Display { exposure_stops: stops, tone: Tone::Clip };
        image::write(&path, ImageView { width, height, pixels: &pixels }, &[], &[], display)
            .expect("writable");
        let format = ::image::ImageFormat::Png;
        let read = ::image::load_from_memory_with_format(&fs::read(&path).expect("readable"), format);
        let read = read.expect("a PNG file").into_rgb8();
        assert_eq!(read.dimensions(), (width, height));
        let expected: Vec<u8> = pixels.iter().flatten().map(|&value| expected_byte(value, stops)).collect();
        assert_eq!(read.into_raw(), expected);
    }
}

#[test]
fn png_says_how_it_was_made() {
    let folder = folder();
    let path = folder.path().join("a.png");
    let display = Display { exposure_stops: -0.5, tone: Tone::Neutral };
    let mut pairs = metadata();
    pairs.insert(0, ("seed".to_owned(), "replaced".to_owned()));
    image::write(&path, ImageView { width: 1, height: 1, pixels: &[[0.5; 3]] }, &[], &pairs, display)
        .expect("writable");
    let bytes = fs::read(&path).expect("readable");
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG file");
    let info = reader.info();
    assert!(info.srgb.is_some());
    let plain = info.uncompressed_latin1_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.text.clone()));
    let unicode = info.utf8_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.get_text().expect("text")));
    let mut found: Vec<_> = plain.chain(unicode).collect();
    found.sort();
    let expected = [
        ("vitrum:exposure", "-0.5 stops"),
        ("vitrum:integrator", "whitted"),
        ("vitrum:samples", "16"),
        ("vitrum:scene", "Glä✓s"),
        ("vitrum:seed", "7"),
        ("vitrum:tone", "neutral"),
        ("vitrum:version", "0.1.0"),
    ];
    assert_eq!(found, expected.map(|(key, value)| (key.to_owned(), value.to_owned())));
}

#[test]
fn mistakes_are_named_and_leave_no_file() {
    let folder = folder();
    let one = [[0.5; 3]];
    let write = |name: &str, width, height, metadata: &[(String, String)]| {
        let path = folder.path().join(name);
        let view = ImageView { width, height, pixels: &one };
        image::write(&path, view, &[], metadata, Display::default()).expect_err("must fail").to_string()
    };
    let pair = |key: &str, value: &str| [(key.to_owned(), value.to_owned())];
    let cases = [
        (
            write("a.jpg", 1, 1, &[]),
            "found the extension .jpg, expected .exr (linear, for further work) or .png",
        ),
        (write("a", 1, 1, &[]), "the name has no extension, expected .exr"),
        (write("a.exr", 0, 1, &[]), "the image is 0 x 1 and has 1 pixels"),
        (write("a.png", 2, 2, &[]), "the image is 2 x 2 and has 1 pixels"),
        (write("a.png", 1 << 31, 1, &[]), "expected 1 to 2147483647 each way"),
        (write("a.exr", 1, 1, &pair("", "")), "the metadata `` cannot be stored"),
        (write("a.exr", 1, 1, &pair("a b", "")), "the metadata `a b` cannot be stored"),
        (write("a.png", 1, 1, &pair("a", "\0")), "the metadata `a` cannot be stored"),
        (write("none/a.png", 1, 1, &[]), "there is no folder"),
    ];
    for (message, phrase) in cases {
        assert!(message.contains(phrase), "`{message}` lacks `{phrase}`");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn writability_is_known_beforehand() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    image::check_writable(&path("a.png")).expect("writable");
    assert!(!path("a.png").exists(), "checking writes nothing");
    fs::create_dir(path("b.png")).expect("writable");
    let message = |path: PathBuf| image::check_writable(&path).expect_err("must fail").to_string();
    assert!(message(path("b.png")).contains("this is a folder"));
    assert!(message(path("none/a.png")).contains("there is no folder"));
    assert!(message(path("a.tiff")).contains("found the extension .tiff"));
}

#[test]
fn what_is_no_exr_is_refused() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    let message = |path: &Path| image::read_exr(path).expect_err("must fail").to_string();
    assert!(message(&path).contains("check the path"));
    assert!(message(folder.path()).contains("cannot be read"));
    fs::write(&path, "no image").expect("writable");
    assert!(message(&path).contains("cannot be read as an OpenEXR image"));

    let pixels = picture(30, 30);
    image::write(
        &path,
        ImageView { width: 30, height: 30, pixels: &pixels },
        &[],
        &metadata(),
        Display::default(),
    )
    .expect("writable");
    let whole = fs::read(&path).expect("readable");
    for length in (0..whole.len()).step_by(97) {
        fs::write(&path, &whole[..length]).expect("writable");
        message(&path);
    }
}

#[test]
fn damaged_exr_files_of_the_assets_are_refused_or_read() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let mut count = 0;
    for entry in fs::read_dir(assets.join("malformed/exr")).expect("the assets have this folder") {
        // Either is right; only a panic or an endless loop is wrong.
        let _ = image::read_exr(&entry.expect("readable").path());
        count += 1;
    }
    assert!(count >= 4);
}
