//! The errors of a picture, under the names that records and reports have for them.

use crate::failure::Failure;
use serde::{Deserialize, Serialize};
use std::path::Path;
use vitrum_io::image::{Display, ImageRgb, Tone, read_radiance};
use vitrum_measure::{Difference, flip, mean};

/// How far a picture is from its reference. `vitrum_measure` defines each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Errors {
    pub(crate) rmse: f64,
    pub(crate) rel_mse: f64,
    pub(crate) rel_mse_trimmed: f64,
    pub(crate) mape: f64,
    pub(crate) flip: f64,
    pub(crate) bias: f64,
    pub(crate) bias_error: f64,
    pub(crate) max_abs: f64,
}

/// The errors, and what an eye sees of them pixel by pixel, 0 to 1. The pictures are of one size.
pub(crate) fn between(image: &ImageRgb, reference: &ImageRgb, exposure_stops: f64) -> (Errors, Vec<f32>) {
    let Difference { max_abs, rmse, rel_mse, rel_mse_trimmed, mape, bias, bias_error } =
        Difference::between(&image.pixels, &reference.pixels);
    let display = Display { exposure_stops, tone: Tone::Clip };
    let [shown, expected] = [image, reference]
        .map(|picture| picture.pixels.iter().map(|pixel| display.encode(*pixel)).collect::<Vec<_>>());
    let map = flip(&shown, &expected, image.width as usize);
    let flip = mean(&map);
    (Errors { rmse, rel_mse, rel_mse_trimmed, mape, flip, bias, bias_error, max_abs }, map)
}

/// A picture that can be compared.
pub(crate) fn read(path: &Path) -> Result<ImageRgb, Failure> {
    let picture = read_radiance(path).map_err(|e| Failure::usage(e.to_string()))?;
    let bad = picture.pixels.iter().position(|pixel| pixel.iter().any(|c| !c.is_finite()));
    bad.map_or(Ok(()), |at| {
        let (x, y) = (at as u32 % picture.width, at as u32 / picture.width);
        Err(Failure::usage(format!(
            "{}: found {:?} in pixel ({x}, {y}), expected finite radiance: what is infinite is infinitely far from anything",
            path.display(),
            picture.pixels[at]
        )))
    })?;
    Ok(picture)
}

/// Two pictures of one size.
pub(crate) fn read_pair(image: &Path, reference: &Path) -> Result<[ImageRgb; 2], Failure> {
    let (first, second) = (read(image)?, read(reference)?);
    if (first.width, first.height) == (second.width, second.height) {
        return Ok([first, second]);
    }
    let size = |picture: &ImageRgb| format!("{} x {}", picture.width, picture.height);
    Err(Failure::usage(format!(
        "{}: found {} pixels, and {} has {}; expected pictures of one size",
        image.display(),
        size(&first),
        reference.display(),
        size(&second)
    )))
}

/// What an eye sees of a difference, as colours: black, violet, orange, pale yellow. Linear, so that a display shows these.
pub(crate) fn picture_of(map: &[f32], width: u32, height: u32) -> ImageRgb {
    let pixels = map.iter().map(|value| colour(*value)).collect();
    ImageRgb { width, height, pixels, metadata: Vec::new() }
}

/// sRGB of five shares, between which colours go over evenly. Their lightness rises all the way, so that grey prints read alike.
const RAMP: [[f32; 3]; 5] =
    [[0.0, 0.0, 4.0], [81.0, 18.0, 124.0], [183.0, 55.0, 121.0], [252.0, 137.0, 97.0], [252.0, 253.0, 191.0]];

fn colour(share: f32) -> [f32; 3] {
    let place = share.clamp(0.0, 1.0) * (RAMP.len() - 1) as f32;
    let step = (place as usize).min(RAMP.len() - 2);
    let [low, high] = [RAMP[step], RAMP[step + 1]];
    [0, 1, 2].map(|c| {
        let encoded = (low[c] + (high[c] - low[c]) * (place - step as f32)) / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    })
}
