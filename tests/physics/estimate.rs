//! Pictures of paths, whose numbers are known up to an error that the seeds tell.

use crate::stage::picture;
use vitrum::tracer::{Scene, Settings};
use vitrum_testkit::Moments;

/// Means over a picture, one from each of several seeds.
pub(crate) fn means(scene: &Scene, settings: &Settings, seeds: u64) -> Moments {
    let mut moments = Moments::default();
    for seed in 0..seeds {
        let image = picture(scene, &Settings { seed, ..*settings });
        let sum: f64 = image.iter().flatten().map(|c| f64::from(*c)).sum();
        moments.push(sum / (3.0 * image.len() as f64));
    }
    moments
}

/// The mean over a picture is `expected`: within four standard errors, and these are at most `sigma`. An error that sixteen
/// seeds tell is itself uncertain: of Student's t with 15 degrees of freedom beyond 4 lies 0.1 %, as beyond 3.3 of the normal
/// distribution.
pub(crate) fn assert_mean(name: &str, scene: &Scene, settings: &Settings, expected: f64, sigma: f64) {
    let moments = means(scene, settings, 16);
    let (mean, error) = (moments.mean(), moments.standard_error());
    assert!(error <= sigma, "{name}: standard error {error}, wanted {sigma}");
    // Samples are rounded to single precision at the film.
    let allowed = 4.0 * error + 1e-7 * expected;
    assert!((mean - expected).abs() <= allowed, "{name}: {mean} ± {error} instead of {expected}");
}
