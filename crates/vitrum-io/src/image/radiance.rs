//! Radiance's own format (.hdr, .pic): three mantissas and a common exponent for each pixel (G. Ward, Real Pixels, 1991).
//!
//! Values are divided by the exposure that the header tells, so that they are the radiance that was recorded.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use ::image::ImageDecoder;
use ::image::codecs::hdr::HdrDecoder;

use super::{ImageError, ImageRgb, MOST_PIXELS};

/// Reads all pixels.
pub(super) fn read(path: &Path) -> Result<ImageRgb, ImageError> {
    let unreadable = |source| ImageError::Unreadable { path: path.to_owned(), source };
    let damaged =
        |message: String| ImageError::Decode { path: path.to_owned(), format: "a Radiance picture", message };
    let file = File::open(path).map_err(unreadable)?;
    let about = file.metadata().map_err(unreadable)?;
    if !about.is_file() {
        return Err(unreadable(std::io::Error::other("this is not a file")));
    }
    // The oldest files have no signature, and some programs write another one.
    let decoder = HdrDecoder::new_nonstrict(BufReader::new(file)).map_err(|e| damaged(e.to_string()))?;
    let (width, height) = decoder.dimensions();
    let count = u64::from(width) * u64::from(height);
    if count == 0 {
        return Err(damaged(format!("{width} x {height} pixels")));
    }
    // A run of at most 127 equal pixels takes two bytes for each of four components; older runs of any length take four.
    if count > MOST_PIXELS || u64::from(height) > about.len() {
        return Err(damaged(format!("{width} x {height} pixels in {} bytes", about.len())));
    }
    let exposure = decoder.metadata().exposure.unwrap_or(1.0);
    if !(exposure.is_finite() && exposure > 0.0) {
        return Err(damaged(format!("an exposure of {exposure}")));
    }
    let mut bytes = vec![0; usize::try_from(decoder.total_bytes()).map_err(|e| damaged(e.to_string()))?];
    decoder.read_image(&mut bytes).map_err(|e| damaged(e.to_string()))?;
    let value = |bytes: &[u8]| bytes.first_chunk().map_or(0.0, |bytes| f32::from_ne_bytes(*bytes)) / exposure;
    let pixels = bytes.chunks_exact(12).map(|p| [value(p), value(&p[4..]), value(&p[8..])]).collect();
    Ok(ImageRgb { width, height, pixels, metadata: Vec::new() })
}
