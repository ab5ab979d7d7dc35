//! Images out, and back in for comparing: linear OpenEXR and display-ready PNG. Images in for textures: `read.rs`.
//!
//! Pixels are linear Rec.709 radiance, in rows from the top, each from the left. The extension of the file's name
//! decides the format: `.exr` keeps every bit (`openexr.rs`), `.png` is for looking at (`png.rs`, `tone.rs`). Radiance that
//! lights a scene is read from `.exr` too, and from `.hdr` (`radiance.rs`).
//! Metadata is stored under keys that begin with `vitrum:`; it is all that a file says beside its pixels, so the same
//! image gives the same bytes. A failure leaves no half of a file and the old one as it was.

mod error;
mod openexr;
mod png;
mod radiance;
mod read;
mod tone;

use std::io::Write;
use std::path::{Path, PathBuf};

pub use error::{ImageError, WriteError};
pub use read::{Texels, read_texture};
pub use tone::{Display, Tone};

use crate::atomic;

/// Images with more pixels are not read: a few damaged bytes must not take all memory.
const MOST_PIXELS: u64 = 1 << 28;

/// The pixels of a picture, borrowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageView<'a> {
    /// Width in pixels, 1 to 2^31 − 1.
    pub width: u32,
    /// Height in pixels, 1 to 2^31 − 1.
    pub height: u32,
    /// Linear Rec.709 radiance in rows from the top, each from the left: width × height pixels.
    pub pixels: &'a [[f32; 3]],
}

/// Numbers of each pixel beside radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, as OpenEXR has them: the part before the last dot is a layer's.
    pub name: String,
    /// In rows from the top, each from the left: width × height values.
    pub values: Vec<f32>,
}

/// A picture that was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageRgb {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Linear radiance in rows from the top, each from the left: width × height pixels.
    pub pixels: Vec<[f32; 3]>,
    /// Text attributes of the file, sorted; keys are as stored, with `vitrum:`.
    pub metadata: Vec<(String, String)>,
}

impl ImageRgb {
    /// The picture, borrowed.
    pub fn view(&self) -> ImageView<'_> {
        ImageView { width: self.width, height: self.height, pixels: &self.pixels }
    }
}

#[derive(Clone, Copy)]
enum Format {
    OpenExr,
    Png,
}

/// Writes an image, in the format that the extension of its name says. `channels` are for OpenEXR alone, `display` is for PNG
/// alone. `metadata` are pairs of key and value; of equal keys the last counts.
///
/// # Errors
/// When the extension is not known, the image has no pixels or not the number that its size says, the metadata cannot
/// be stored, or the file cannot be written. Then the old file, if any, is unchanged.
pub fn write(
    path: &Path,
    image: ImageView<'_>,
    channels: &[Channel],
    metadata: &[(String, String)],
    display: Display,
) -> Result<(), ImageError> {
    let format = format_of(path)?;
    check_image(image)?;
    if let Some(channel) = channels.iter().find(|channel| channel.values.len() != image.pixels.len()) {
        let pixels = channel.values.len();
        return Err(ImageError::Size { width: image.width, height: image.height, pixels });
    }
    let metadata = last_of_equal_keys(metadata)?;
    let encode_error = |message| ImageError::Encode { path: path.to_owned(), message };
    let bytes = match format {
        Format::OpenExr => {
            openexr::encode(image, channels, &metadata).map_err(|error| encode_error(error.to_string()))?
        }
        Format::Png => {
            png::encode(image, &metadata, display).map_err(|error| encode_error(error.to_string()))?
        }
    };
    Ok(atomic::replace(path, |file| file.write_all(&bytes))?)
}

/// The bytes of a PNG file of an image.
///
/// # Errors
/// When the image has no pixels or not the number that its size says.
pub fn png_bytes(image: ImageView<'_>, display: Display) -> Result<Vec<u8>, ImageError> {
    check_image(image)?;
    png::encode(image, &[], display)
        .map_err(|error| ImageError::Encode { path: PathBuf::new(), message: error.to_string() })
}

/// Whether a file of this name holds channels beside radiance.
pub fn holds_channels(path: &Path) -> bool {
    matches!(format_of(path), Ok(Format::OpenExr))
}

/// Whether an image can be written under this name: for finding out before the rendering rather than after it.
///
/// # Errors
/// When the extension is not known, the folder does not exist, nothing can be created in it, or the name is taken by
/// something that should not be replaced. Not when the disk is full.
pub fn check_writable(path: &Path) -> Result<(), ImageError> {
    format_of(path)?;
    Ok(atomic::check(path)?)
}

/// Reads R, G and B of an OpenEXR file of any compression as float32, and its text attributes.
///
/// # Errors
/// When the file cannot be read, is damaged, has no layer with R, G and B, or has more than 2^28 pixels.
pub fn read_exr(path: &Path) -> Result<ImageRgb, ImageError> {
    openexr::read(path)
}

/// Reads linear radiance: an OpenEXR file as [`read_exr`] does, or a Radiance file (.hdr, .pic).
///
/// # Errors
/// When the extension is none of these, the file cannot be read or is damaged, or it has more than 2^28 pixels.
pub fn read_radiance(path: &Path) -> Result<ImageRgb, ImageError> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
    match extension.as_deref().map(str::to_ascii_lowercase).as_deref() {
        Some("exr") => openexr::read(path),
        Some("hdr" | "pic") => radiance::read(path),
        _ => Err(ImageError::NoRadiance { path: path.to_owned(), found: extension }),
    }
}

fn format_of(path: &Path) -> Result<Format, ImageError> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
    match extension.as_deref().map(str::to_ascii_lowercase).as_deref() {
        Some("exr") => Ok(Format::OpenExr),
        Some("png") => Ok(Format::Png),
        _ => Err(ImageError::UnknownExtension { path: path.to_owned(), found: extension }),
    }
}

fn check_image(image: ImageView<'_>) -> Result<(), ImageError> {
    let ImageView { width, height, pixels } = image;
    let side = 1..=i32::MAX.cast_unsigned();
    let is_right = side.contains(&width)
        && side.contains(&height)
        && u64::from(width) * u64::from(height) == pixels.len() as u64;
    if is_right { Ok(()) } else { Err(ImageError::Size { width, height, pixels: pixels.len() }) }
}

/// The metadata in the order given, without those that a later one replaces.
fn last_of_equal_keys(metadata: &[(String, String)]) -> Result<Vec<(String, String)>, ImageError> {
    let storable = |(key, value): &(String, String)| {
        (1..=72).contains(&key.len())
            && key.bytes().all(|byte| byte.is_ascii_graphic())
            && !value.contains('\0')
    };
    if let Some((key, _)) = metadata.iter().find(|pair| !storable(pair)) {
        return Err(ImageError::Metadata { key: key.clone() });
    }
    let is_last = |at: usize| metadata[at + 1..].iter().all(|(key, _)| *key != metadata[at].0);
    Ok((0..metadata.len()).filter(|&at| is_last(at)).map(|at| metadata[at].clone()).collect())
}

/// The key under which a file holds a piece of metadata.
fn stored_key(key: &str) -> String {
    format!("vitrum:{key}")
}
