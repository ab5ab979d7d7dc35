//! Renders the gallery's contact sheet: `cargo run --release --example gallery_sheet`.
//!
//! Every scene is rendered at the size of its cell, so that nothing is scaled, and shown with its own exposure and tone.
//! Writes `scenes/gallery/contact_sheet.png`; takes some minutes.

use png::{BitDepth, ColorType, Compression, Encoder, Filter, SrgbRenderingIntent};
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use vitrum::io::load;
use vitrum::tracer::{Settings, render};

/// A picture of the sheet: scene file, depth limit if not the scene's own, width in pixels.
type Cell = (&'static str, Option<u32>, u32);

const GAP: u32 = 4;
const SAMPLES: u32 = 16;
const WHITE: u8 = 255;

/// The rows, each with the height of its pictures.
const ROWS: [(u32, &[Cell]); 4] = [
    (
        150,
        &[
            ("01_matched", None, 150),
            ("01_invisible", None, 150),
            ("02_glass", None, 150),
            ("03_bubble", None, 150),
            ("04_snell_window", None, 150),
            ("04_total_reflection", None, 150),
        ],
    ),
    (
        84,
        &[
            ("05_depth", Some(1), 150),
            ("05_depth", Some(2), 150),
            ("05_depth", Some(3), 150),
            ("05_depth", Some(4), 150),
            ("05_depth", Some(5), 150),
            ("05_depth", Some(6), 150),
        ],
    ),
    (
        150,
        &[
            ("07_box_solid", None, 150),
            ("07_box_right", None, 150),
            ("07_box_wrong", None, 150),
            ("07_cylinder_solid", None, 150),
            ("07_cylinder_right", None, 150),
            ("07_cylinder_wrong", None, 150),
        ],
    ),
    (
        242,
        &[
            ("06_box", None, 242),
            ("08_torus_knot", None, 242),
            ("08_wine_glass", None, 182),
            ("08_brilliant", None, 242),
        ],
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery");
    let width = ROWS.iter().map(|(_, cells)| row_width(cells)).max().expect("there are rows");
    let height = ROWS.iter().map(|(height, _)| height).sum::<u32>() + GAP * (ROWS.len() as u32 - 1);
    let mut sheet = Sheet { width, bytes: vec![WHITE; 3 * width as usize * height as usize] };

    let mut top = 0;
    for (row_height, cells) in ROWS {
        let mut left = 0;
        for &(name, max_depth, cell_width) in cells {
            writeln!(io::stdout(), "{name}")?;
            let picture = picture(&gallery, name, max_depth, [cell_width, row_height])?;
            sheet.place(left, top, cell_width, &picture);
            left += cell_width + GAP;
        }
        top += row_height + GAP;
    }

    let bytes = encode(&sheet.bytes, width, height)?;
    let path = gallery.join("contact_sheet.png");
    fs::write(&path, &bytes)?;
    writeln!(io::stdout(), "{}: {width} x {height}, {} bytes", path.display(), bytes.len())?;
    Ok(())
}

fn row_width(cells: &[Cell]) -> u32 {
    cells.iter().map(|(_, _, width)| width + GAP).sum::<u32>() - GAP
}

/// A scene as it is displayed: red, green and blue of each pixel, row by row.
fn picture(
    gallery: &Path,
    name: &str,
    max_depth: Option<u32>,
    size: [u32; 2],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let loaded = load::scene_file(&gallery.join(name).with_extension("toml"), load::SceneOptions::default())?;
    let own = loaded.settings;
    let settings = Settings { size, spp: SAMPLES, max_depth: max_depth.or(own.max_depth), ..own };
    let rendering = render(&loaded.scene, &settings, &())?;
    Ok(rendering.film.image().into_iter().flat_map(|pixel| loaded.display.encode(pixel)).collect())
}

struct Sheet {
    width: u32,
    bytes: Vec<u8>,
}

impl Sheet {
    /// Copies a picture to where its upper left corner belongs.
    fn place(&mut self, left: u32, top: u32, width: u32, picture: &[u8]) {
        let start = |row: u32| 3 * (row * self.width + left) as usize;
        for (row, line) in (top..).zip(picture.chunks_exact(3 * width as usize)) {
            let at = start(row);
            self.bytes[at..at + line.len()].copy_from_slice(line);
        }
    }
}

fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::Adaptive);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}
