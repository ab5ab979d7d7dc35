//! Pictures of equal time, and what an eye sees of their difference from the reference.

use super::escaped;
use super::figures::three_digits;
use crate::bench::Record;
use crate::errors;
use crate::failure::Failure;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::path::Path;
use vitrum_io::image::{self, Display, ImageRgb, Tone};

/// The reference of a scene, and beside it one picture of each program, all of nearly the same seconds.
pub(super) fn html(all: &[(Record, &Path)], scene: &str, programs: &[&str]) -> Result<String, Failure> {
    let kept = |program: &str| -> Vec<(&Record, &Path, &Path)> {
        let of = all.iter().filter(|(r, _)| r.scene == scene && r.program == program);
        of.filter_map(|(record, folder)| Some((record, *folder, record.picture.as_deref()?))).collect()
    };
    let longest = |program: &&str| kept(program).iter().map(|(r, ..)| r.seconds()).reduce(f64::max);
    // A tenth of the time that all have, where noise can still be seen.
    let Some(time) = programs.iter().filter_map(longest).reduce(f64::min).map(|t| 0.1 * t) else {
        return Ok(String::new());
    };
    let mut html = String::from("<div class=\"pictures\">\n");
    let mut is_first = true;
    for program in programs {
        let far = |record: &Record| (record.seconds() / time).ln().abs();
        let kept = kept(program);
        let Some((record, folder, picture)) = kept.into_iter().min_by(|a, b| far(a.0).total_cmp(&far(b.0)))
        else {
            continue;
        };
        // Results travel without their pictures, too.
        let (picture, reference) = (folder.join(picture), folder.join(&record.reference));
        if !(picture.is_file() && reference.is_file()) {
            continue;
        }
        let [picture, reference] = errors::read_pair(&picture, &reference)?;
        if is_first {
            html += &figure(&[&reference], "reference")?;
            is_first = false;
        }
        let (found, map) = errors::between(&picture, &reference, 0.0);
        let map = errors::picture_of(&map, picture.width, picture.height);
        let caption = format!(
            "{}, {} s, {} samples: relMSE {:.1e} ({:.1e} without the worst 0.1 %), \u{a7fb}LIP {:.3}",
            escaped(program),
            three_digits(record.seconds()),
            record.spp,
            found.rel_mse,
            found.rel_mse_trimmed,
            found.flip
        );
        html += &figure(&[&picture, &map], &caption)?;
    }
    html += "</div>\n";
    Ok(html)
}

/// Pictures over each other.
fn figure(pictures: &[&ImageRgb], caption: &str) -> Result<String, Failure> {
    let mut html = String::from("<figure>");
    for picture in pictures {
        let display = Display { exposure_stops: 0.0, tone: Tone::Clip };
        let bytes = image::png_bytes(picture.view(), display)?;
        html += &format!(
            "<img alt=\"{caption}\" src=\"data:image/png;base64,{}\">",
            BASE64_STANDARD.encode(bytes)
        );
    }
    html += &format!("<figcaption>{caption}</figcaption></figure>\n");
    Ok(html)
}
