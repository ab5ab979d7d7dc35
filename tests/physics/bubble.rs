//! A bubble (n = 0.75, air in water): rays that pass the centre at more than 0.75 radii are totally reflected outside, the
//! rest goes through. Under parallel rays that is 1 − 0.75² = 43.75 % of the disc; from a pinhole at distance d it is
//! 1 − tan²(asin(0.75 R/d)) / tan²(asin(R/d)).
//!
//! With kr = kt = 0 total reflection is all that is left, so the share can be read off the mean of the picture.

use crate::stage::{camera, clear_glass, object, picture, unit_sphere, white};
use vitrum::tracer::{Projection, Settings};

/// Mean and standard error of the share of the disc that is totally reflected; `disc` is its share of the picture.
fn share(projection: Projection, distance: f64, disc: f64) -> (f64, f64) {
    let bubble = object("bubble", unit_sphere(), clear_glass(0.0, 0.0, 1.0, 0.75));
    let scene = white(vec![bubble], camera(projection, distance));
    let shares: Vec<f64> = (0..8)
        .map(|seed| {
            let settings = Settings { size: [200, 200], spp: 16, seed, ..Settings::default() };
            let image = picture(&scene, &settings);
            let mean: f64 = image.iter().map(|p| f64::from(p[0])).sum::<f64>() / image.len() as f64;
            (mean - (1.0 - disc)) / disc
        })
        .collect();
    let n = shares.len() as f64;
    let mean = shares.iter().sum::<f64>() / n;
    let variance = shares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

#[test]
fn outer_total_reflection_covers_the_closed_form_share_of_the_disc() {
    let height = 2.1;
    let disc = std::f64::consts::PI / (height * height);
    let parallel = share(Projection::Orthographic { height }, 5.0, disc);

    let (distance, fov) = (4.0, 0.55f64);
    let tan2 = |b: f64| (b / distance).asin().tan().powi(2);
    let disc = std::f64::consts::PI * tan2(1.0) / (2.0 * (fov / 2.0).tan()).powi(2);
    let pinhole = share(Projection::Pinhole { fov }, distance, disc);

    for ((found, sigma), expected) in [(parallel, 0.4375), (pinhole, 1.0 - tan2(0.75) / tan2(1.0))] {
        println!("share {found:.6} ± {sigma:.6}, closed form {expected:.6}");
        // The spread of eight seeds; four sigma of it, because eight give sigma itself only to a quarter.
        assert!(sigma < 1e-4, "sigma {sigma}");
        assert!((found - expected).abs() < 4.0 * sigma, "{found} ± {sigma} instead of {expected}");
    }
}
