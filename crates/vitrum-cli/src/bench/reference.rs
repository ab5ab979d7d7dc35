//! References: what pictures should be, and how well that is known.

use super::{BenchScene, Program, Run, program};
use crate::args::Bench;
use crate::errors;
use crate::failure::Failure;
use crate::terminal::say;
use std::fs;
use std::path::Path;
use vitrum_io::image::{self, Display, ImageRgb};
use vitrum_measure::Difference;

/// Key of the metadata of a reference: its own relMSE.
const ERROR: &str = "reference_error";
/// How it was made.
const BY: &str = "reference_by";

/// The seeds of references are not those of runs.
const FIRST_SEED: u64 = 1_000_000;

/// A converged picture.
pub(crate) struct Reference {
    pub(crate) image: ImageRgb,
    /// Its own relMSE.
    pub(crate) error: f64,
}

impl Reference {
    /// A picture of the same size.
    pub(super) fn image_like(&self, path: &Path) -> Result<ImageRgb, Failure> {
        let picture = errors::read(path)?;
        let size = |picture: &ImageRgb| [picture.width, picture.height];
        if size(&picture) == size(&self.image) {
            return Ok(picture);
        }
        let ([w, h], [a, b]) = (size(&picture), size(&self.image));
        Err(Failure::usage(format!(
            "{}: found {w} x {h} pixels, and the reference has {a} x {b}; make the references anew where scenes have changed",
            path.display()
        )))
    }
}

/// The reference of a scene.
pub(super) fn read(scene: &BenchScene) -> Result<Reference, Failure> {
    if !scene.reference.is_file() {
        return Err(Failure::usage(format!(
            "{}: found no reference of {}; `vitrum bench --make-references --spp 4096 {}` makes it",
            scene.reference.display(),
            scene.name,
            scene.path.display()
        )));
    }
    let image = errors::read(&scene.reference)?;
    let key = format!("vitrum:{ERROR}");
    let stored = image.metadata.iter().find(|(k, _)| *k == key).and_then(|(_, value)| value.parse().ok());
    let error = stored.filter(|e: &f64| *e >= 0.0 && e.is_finite()).ok_or_else(|| {
        Failure::usage(format!(
            "{}: found no attribute {key} with a number, expected the relMSE of the reference itself",
            scene.reference.display()
        ))
    })?;
    Ok(Reference { image, error })
}

/// Makes the reference of a scene: the mean of several renders, whose differences tell its own error.
pub(super) fn make(scene: &BenchScene, program: &Program, arguments: &Bench) -> Result<(), Failure> {
    let [spp] = arguments.spp[..] else {
        return Err(Failure::usage("--make-references takes one number of samples, such as --spp 4096"));
    };
    if arguments.seeds < 2 {
        return Err(Failure::usage(
            "--make-references takes at least --seeds 2: their differences tell the error of the reference",
        ));
    }
    if scene.reference.exists() {
        return Err(Failure::usage(format!(
            "{}: this reference is there already; remove it first, if all that was measured against it may be in vain",
            scene.reference.display()
        )));
    }
    let folder = scene.reference.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .map_err(|e| Failure::running(format!("{}: cannot be created ({e})", folder.display())))?;
    image::check_writable(&scene.reference)?;
    let scratch = scene.reference.with_extension("part.exr");
    let mut parts: Vec<ImageRgb> = Vec::new();
    for seed in FIRST_SEED..FIRST_SEED + u64::from(arguments.seeds) {
        program::render(scene, &Run { program, spp, seed, threads: arguments.threads }, &scratch)?;
        parts.push(errors::read(&scratch)?);
    }
    // It was just read.
    let _ = fs::remove_file(&scratch);
    let flat: Vec<&[[f32; 3]]> = parts.iter().map(|part| part.pixels.as_slice()).collect();
    let error = Difference::rel_mse_of_mean(&flat).unwrap_or(f64::INFINITY);
    let mean = |pixel: usize| {
        [0, 1, 2].map(|c| {
            let sum: f64 = parts.iter().map(|part| f64::from(part.pixels[pixel][c])).sum();
            (sum / parts.len() as f64) as f32
        })
    };
    let pixels = (0..parts[0].pixels.len()).map(mean).collect();
    let picture = ImageRgb { pixels, metadata: Vec::new(), ..parts[0] };
    let by = format!("vitrum {}, {} renders of {spp} samples", env!("CARGO_PKG_VERSION"), parts.len());
    let metadata = [(ERROR.to_owned(), format!("{error:.4e}")), (BY.to_owned(), by)];
    image::write(&scene.reference, picture.view(), &[], &metadata, Display::default())?;
    say(&format!("{}: own relMSE {error:.2e}\n", scene.reference.display()));
    Ok(())
}
