//! Pictures of all directions, from their files.

use crate::image::{self, ImageError};
use std::io;
use std::path::Path;
use vitrum_tracer::{EnvironmentError, EnvironmentMap};

/// Why a file is no environment, and what to do.
pub(super) struct Refused {
    pub(super) message: String,
    pub(super) help: Option<&'static str>,
}

/// Reads an environment. Texels that are no radiance are refused, or replaced on demand; then the second result says what was
/// replaced.
pub(super) fn read(
    path: &Path,
    rotation: f64,
    scale: f64,
    repair: bool,
) -> Result<(EnvironmentMap, Option<String>), Refused> {
    let mut picture = image::read_radiance(path).map_err(|error| match error {
        ImageError::Unreadable { source, .. } if source.kind() == io::ErrorKind::NotFound => Refused {
            message: format!("{}: there is no such file", path.display()),
            help: Some("paths are relative to the folder of the scene file"),
        },
        other => Refused { message: other.to_string(), help: None },
    })?;
    let size = (picture.width as usize, picture.height as usize);
    let repaired = if repair { mend(&mut picture.pixels, size.0) } else { None };
    let map = EnvironmentMap::new(size.0, size.1, picture.pixels, rotation, scale);
    let map = map.map_err(|error| Refused {
        message: format!("{}: {error}", path.display()),
        help: matches!(error, EnvironmentError::NoRadiance { .. }).then_some(
            "--repair takes 0 for what is not a number or negative, and the largest finite value of the picture for what is \
             infinite",
        ),
    })?;
    Ok((map, repaired))
}

/// Replaces what is no radiance; says how much of what.
fn mend(pixels: &mut [[f32; 3]], width: usize) -> Option<String> {
    let is_wrong = |c: &f32| !c.is_finite() || *c < 0.0;
    let first = pixels.iter().position(|pixel| pixel.iter().any(is_wrong))?;
    let count = pixels.iter().filter(|pixel| pixel.iter().any(is_wrong)).count();
    let finite = pixels.iter().flatten().filter(|c| c.is_finite());
    let largest = finite.fold(0.0, |most: f32, c| most.max(*c));
    for c in pixels.iter_mut().flatten().filter(|c| is_wrong(c)) {
        *c = if *c == f32::INFINITY { largest } else { 0.0 };
    }
    Some(format!(
        "{count} texels were no radiance (not a number, infinite or negative), the first in column {} of row {}; they were \
         replaced",
        first % width,
        first / width
    ))
}
