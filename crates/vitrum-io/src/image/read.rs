//! Images in, for textures: PNG and JPEG (8 or 16 bits), Radiance HDR and OpenEXR, told apart by their first bytes and not by
//! their names.
//!
//! PNG and JPEG hold colours for a display unless told otherwise: sRGB. HDR and EXR are linear by definition. Grey becomes three
//! equal channels, transparency is not used and said, the orientation that a camera noted is applied, colour profiles are not.
//! What is damaged, cut off or too large is refused; a pixel that is negative or not finite, too.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use ::image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, metadata::Orientation};
use vitrum_materials::{Encoding, Image, InvalidImage};

use super::{ImageError, MOST_PIXELS, openexr, radiance};

/// Bytes of the largest pixel, red, green, blue and coverage in 16 bits each.
const PIXEL_BYTES: u64 = 8;

/// An image that was read, and what there is to say about it.
#[derive(Debug)]
pub struct Texels {
    /// The image.
    pub image: Image,
    /// True when it has transparent parts, which are not used.
    pub is_transparent: bool,
}

/// What a file holds, by its first bytes.
enum Format {
    Png,
    Jpeg,
    Hdr,
    OpenExr,
}

impl Format {
    fn of(start: &[u8]) -> Option<Self> {
        let formats: [(&[u8], Self); 4] = [
            (b"\x89PNG\r\n\x1a\n", Self::Png),
            (b"\xff\xd8\xff", Self::Jpeg),
            (b"#?", Self::Hdr),
            (b"\x76\x2f\x31\x01", Self::OpenExr),
        ];
        formats.into_iter().find(|(magic, _)| start.starts_with(magic)).map(|(_, format)| format)
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Hdr => "Radiance HDR",
            Self::OpenExr => "OpenEXR",
        }
    }
}

/// Reads an image, called `name` in what is said about it. `encoding` is what the numbers of a PNG or JPEG mean, sRGB if it is not
/// given.
///
/// # Errors
/// When the file is missing, unreadable, of another format, damaged, cut off, larger than 2^28 pixels, or holds pixels that are no
/// colours; and when an HDR or EXR file is said to be encoded as sRGB.
pub fn read_texture(path: &Path, name: &str, encoding: Option<Encoding>) -> Result<Texels, ImageError> {
    let refused = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => ImageError::NotFound { path: path.to_owned() },
        _ => ImageError::Unreadable { path: path.to_owned(), source },
    };
    if !fs::metadata(path).map_err(refused)?.is_file() {
        return Err(refused(io::Error::other("this is not a file")));
    }
    let mut file = BufReader::new(File::open(path).map_err(refused)?);
    let start = file.fill_buf().map_err(refused)?;
    let Some(format) = Format::of(start) else {
        return Err(ImageError::NotAnImage { path: path.to_owned(), found: found(start) });
    };
    let is_linear = matches!(format, Format::Hdr | Format::OpenExr);
    if is_linear && encoding == Some(Encoding::Srgb) {
        return Err(ImageError::Encoding { path: path.to_owned(), format: format.name() });
    }
    let damaged =
        |message: String| ImageError::Damaged { path: path.to_owned(), format: format.name(), message };
    let (image, is_transparent) = match format {
        Format::OpenExr => {
            let read = openexr::read(path)?;
            (Image::from_numbers(name, [read.width, read.height], read.pixels), false)
        }
        Format::Jpeg => {
            // The decoder takes what is missing for grey.
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).map_err(refused)?;
            if !has_end(&bytes) {
                return Err(damaged("the end is missing".to_owned()));
            }
            let decoded = decode(io::Cursor::new(bytes), ImageFormat::Jpeg, path, &damaged)?;
            texels(name, decoded, encoding)
        }
        Format::Png => texels(name, decode(file, ImageFormat::Png, path, &damaged)?, encoding),
        Format::Hdr => {
            let read = radiance::read(path)?;
            (Image::from_numbers(name, [read.width, read.height], read.pixels), false)
        }
    };
    match image {
        Ok(image) => Ok(Texels { image, is_transparent }),
        Err(reason @ InvalidImage::Texels { .. }) => {
            Err(ImageError::BadPixels { path: path.to_owned(), reason: reason.to_string() })
        }
        Err(reason) => Err(damaged(reason.to_string())),
    }
}

/// What a file that is no image begins with, for people to read.
fn found(start: &[u8]) -> String {
    const KNOWN: [(&[u8], &str); 8] = [
        (b"GIF8", "a GIF"),
        (b"BM", "a BMP"),
        (b"II*\0", "a TIFF"),
        (b"MM\0*", "a TIFF"),
        (b"RIFF", "a WebP"),
        (b"DDS ", "a DDS"),
        (b"8BPS", "a Photoshop file"),
        (b"\xabKTX", "a KTX"),
    ];
    if start.is_empty() {
        return "the file is empty".to_owned();
    }
    match KNOWN.iter().find(|(magic, _)| start.starts_with(magic)) {
        Some((_, what)) => format!("found {what}"),
        None => {
            let bytes: Vec<String> = start.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
            format!("found something that begins with the bytes {}", bytes.join(" "))
        }
    }
}

fn decode(
    file: impl BufRead + io::Seek,
    format: ImageFormat,
    path: &Path,
    damaged: &dyn Fn(String) -> ImageError,
) -> Result<DynamicImage, ImageError> {
    let broken = |error: ::image::ImageError| damaged(error.to_string());
    let mut reader = ImageReader::with_format(file, format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_PIXELS * PIXEL_BYTES);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(ImageError::TooManyPixels { path: path.to_owned(), width, height, limit: MOST_PIXELS });
    }
    // A note that can't be read says nothing.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    image.apply_orientation(orientation);
    Ok(image)
}

/// The texels of a decoded image, and whether some are transparent.
fn texels(
    name: &str,
    decoded: DynamicImage,
    encoding: Option<Encoding>,
) -> (Result<Image, InvalidImage>, bool) {
    let encoding = encoding.unwrap_or(Encoding::Srgb);
    let size = [decoded.width(), decoded.height()];
    let is_transparent = is_transparent(&decoded);
    let image = match decoded {
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let linear: Vec<f32> =
                (0..=u16::MAX).map(|step| encoding.decode(f64::from(step) / 65535.0) as f32).collect();
            let pixels = decoded.into_rgb16().into_raw();
            let pixels: &[[u16; 3]] = pixels.as_chunks().0;
            let texels = pixels.iter().map(|pixel| pixel.map(|step| linear[step as usize])).collect();
            Image::from_numbers(name, size, texels)
        }
        _ => {
            let pixels = decoded.into_rgb8().into_raw();
            Image::from_bytes(name, size, pixels.as_chunks().0.to_vec(), encoding)
        }
    };
    (image, is_transparent)
}

fn is_transparent(image: &DynamicImage) -> bool {
    match image {
        DynamicImage::ImageLumaA8(pixels) => pixels.pixels().any(|p| p.0[1] < u8::MAX),
        DynamicImage::ImageRgba8(pixels) => pixels.pixels().any(|p| p.0[3] < u8::MAX),
        DynamicImage::ImageLumaA16(pixels) => pixels.pixels().any(|p| p.0[1] < u16::MAX),
        DynamicImage::ImageRgba16(pixels) => pixels.pixels().any(|p| p.0[3] < u16::MAX),
        _ => false,
    }
}

/// Whether the picture of a JPEG file has an end: the marker FF D9 after the first scan. Within a scan no FF comes before D9; the
/// segments before it, which may hold pictures of their own, say how long they are.
fn has_end(bytes: &[u8]) -> bool {
    const SCAN: u8 = 0xda;
    let mut at = 2;
    while let Some(&[0xff, marker, high, low]) = bytes.get(at..).and_then(|rest| rest.first_chunk()) {
        at += 2;
        match marker {
            // Fill bytes before a marker.
            0xff => at -= 1,
            // Markers without a segment.
            0x01 | 0xd0..=0xd8 => {}
            SCAN => return bytes[at..].windows(2).any(|pair| pair == [0xff, 0xd9]),
            _ => at += usize::from(u16::from_be_bytes([high, low])).max(2),
        }
    }
    // Not as files should be: the decoder says what is wrong.
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_picture_is_not_that_of_its_preview() {
        let preview = [0xff, 0xd8, 0xff, 0xe1, 0, 6, 0xff, 0xda, 0xff, 0xd9];
        let scan = [0xff, 0xda, 0, 2, 1, 2, 3];
        assert!(!has_end(&[&preview[..], &scan].concat()));
        assert!(has_end(&[&preview[..], &scan, &[0xff, 0xd9, 0, 0]].concat()));
        assert!(has_end(&[0xff, 0xff, 0xff, 0xff]) && has_end(&[]), "for the decoder to refuse");
    }
}
