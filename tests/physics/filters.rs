//! Pixel filters, across the edge of a bright half of the picture: each pixel shows the share of its filter's weight that lies on
//! the bright side.

use crate::stage::{camera, object, picture};
use std::f64::consts::TAU;
use vitrum::geometry::shape::{Rectangle, Shape};
use vitrum::materials::{Material, Texture};
use vitrum::math::{DVec3, Rgb};
use vitrum::tracer::{Filter, Integrator, Projection, Scene, Settings};

/// The share of the weight of the Blackman-Harris window, three wide, below x: its terms integrated one by one.
fn bell_below(x: f64) -> f64 {
    let t = x / 3.0 + 0.5;
    let term = |a: f64, k: f64| a * (TAU * k * t).sin() / (TAU * k);
    (0.35875 * t + term(-0.48829, 1.0) + term(0.14128, 2.0) + term(-0.01168, 3.0)) / 0.35875
}

/// The same of the tent.
fn tent_below(x: f64) -> f64 {
    if x < 0.0 { 0.5 * (1.0 + x) * (1.0 + x) } else { 1.0 - 0.5 * (1.0 - x) * (1.0 - x) }
}

#[test]
fn an_edge_is_as_soft_as_the_filter() {
    // Pixels are a metre wide; the bright half begins at x = 0, between the fourth and the fifth of eight.
    let half = Rectangle::new(DVec3::new(0.0, -50.0, 0.0), DVec3::X * 50.0, DVec3::Y * 100.0);
    let shining = Material::Emissive { radiance: Texture::Constant(Rgb::ONE) };
    let half = object("half", Shape::Rectangle(half.expect("valid rectangle")), shining);
    let scene = Scene::new(vec![half], camera(Projection::Orthographic { height: 8.0 }, 10.0));
    let scene = scene.expect("valid scene");
    let below = |filter: Filter, x: f64| match filter {
        Filter::Box => (x + 0.5).clamp(0.0, 1.0),
        Filter::Tent => tent_below(x.clamp(-1.0, 1.0)),
        Filter::BlackmanHarris => bell_below(x.clamp(-1.5, 1.5)),
    };
    for filter in [Filter::Box, Filter::Tent, Filter::BlackmanHarris] {
        let settings =
            Settings { size: [8; 2], spp: 4096, filter, integrator: Integrator::Path, ..Settings::default() };
        for (column, pixel) in picture(&scene, &settings)[..8].iter().enumerate() {
            // From the middle of the pixel the edge is at -x, and the filter is even.
            let expected = below(filter, column as f64 - 3.5);
            // Evenly spread numbers cut an interval to within one of 4096.
            let found = f64::from(pixel[0]);
            assert!((found - expected).abs() < 1e-3, "{filter:?}, column {column}: {found} for {expected}");
        }
    }
}
