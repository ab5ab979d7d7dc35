//! A sphere with constant kr and kt = 1 − kr in white surroundings.
//!
//! For n ≥ 1 no ray from outside is ever totally reflected inside, so each inner hit sends kt out and keeps kr. At depth
//! limit D the picture inside the disc is kr + kt (kt + kt kr + … ) = 1 − kt kr^(D−1): the radiance factors of entering
//! and leaving cancel in every path that gets out.

use crate::stage::{camera, clear_glass, object, picture, unit_sphere, white};
use vitrum::tracer::{Projection, Settings};

#[test]
fn the_disc_shows_one_minus_what_the_depth_limit_cuts() {
    let size = 48u32;
    let height = 2.5;
    for n in [1.0, 1.0003, 1.5, 2.42] {
        for (kr, kt) in [(0.1, 0.9), (0.3, 0.7), (0.5, 0.5)] {
            let glass = object("ball", unit_sphere(), clear_glass(kr, kt, 1.0, n));
            let scene = white(vec![glass], camera(Projection::Orthographic { height }, 10.0));
            for depth in 0..=8u32 {
                let settings = Settings {
                    size: [size; 2],
                    spp: 4,
                    max_depth: Some(depth),
                    cutoff: 0.0,
                    ..Settings::default()
                };
                let expected = if depth == 0 { 0.0 } else { 1.0 - kt * kr.powi(depth.cast_signed() - 1) };
                let mut inside = 0;
                for (i, pixel) in (0u32..).zip(picture(&scene, &settings)) {
                    // The farthest and the nearest corner of the pixel from the axis, in radii.
                    let away = |p: u32, c: u32| {
                        ((f64::from(p + c) - f64::from(size) / 2.0) * height / f64::from(size)).abs()
                    };
                    let (x, y) = (i % size, i / size);
                    let farthest = away(x, 0).max(away(x, 1)).hypot(away(y, 0).max(away(y, 1)));
                    let nearest = away(x, 0).min(away(x, 1)).hypot(away(y, 0).min(away(y, 1)));
                    if farthest < 1.0 {
                        inside += 1;
                        for channel in pixel {
                            assert!(
                                (f64::from(channel) - expected).abs() < 1e-6,
                                "n = {n}, kr = {kr}, depth {depth}: {channel} instead of {expected}"
                            );
                        }
                    } else if nearest > 1.0 {
                        assert_eq!(pixel, [1.0; 3]);
                    }
                }
                assert!(inside > 1000, "the disc fills the picture");
            }
        }
    }
}

/// What the depth limit cuts is what the statistics say was given up.
#[test]
fn the_weight_given_up_is_the_missing_light() {
    let glass = object("ball", unit_sphere(), clear_glass(0.1, 0.9, 1.0, 1.5));
    // Narrow enough to see nothing but the sphere.
    let scene = white(vec![glass], camera(Projection::Orthographic { height: 1.0 }, 10.0));
    for (max_depth, cutoff) in [(3, 0.0), (8, 0.05)] {
        let settings =
            Settings { size: [16; 2], spp: 8, max_depth: Some(max_depth), cutoff, ..Settings::default() };
        let rendering = vitrum::tracer::render(&scene, &settings, &()).expect("valid settings");
        let image = rendering.film.image();
        let mean: f64 = image.iter().map(|p| f64::from(p[0])).sum::<f64>() / image.len() as f64;
        let given_up = rendering.film.given_up();
        // Samples are rounded to single precision at the film.
        assert!((mean + given_up.mean - 1.0).abs() < 1e-6, "{mean} + {}", given_up.mean);
        assert!(given_up.largest >= given_up.mean && given_up.mean > 0.0);
        assert_eq!(rendering.plan.radiance_bound, Some(1.0));
    }
}
