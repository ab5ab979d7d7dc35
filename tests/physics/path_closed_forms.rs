//! Scenes of path tracing whose mean radiance is known in closed form, with every way of branching.

use crate::estimate::assert_mean;
use crate::stage::{camera, object, picture, unit_sphere, white};
use std::f64::consts::PI;
use vitrum::bxdf::Ggx;
use vitrum::geometry::shape::{Cuboid, Plane, Rectangle, Shape, Sphere};
use vitrum::materials::{Absorption, Dielectric, IndexOfRefraction, Material, Media, Medium, Phong, Texture};
use vitrum::math::{DVec3, Rgb};
use vitrum::tracer::{
    Background, Branching, Camera, Integrator, Light, Projection, Scene, SceneObject, Settings,
};

fn glass(outside: f64, inside: f64, roughness: f64, absorbed: Absorption) -> Material {
    let medium = |n: f64, absorption: Absorption| {
        let index = IndexOfRefraction::new(n).expect("a valid index");
        Medium { index, absorption }
    };
    let media = Media::new(medium(outside, Absorption::NONE), medium(inside, absorbed));
    let ggx = if roughness > 0.0 { Ggx::isotropic(roughness).expect("valid") } else { Ggx::smooth() };
    Material::Dielectric(Dielectric::new(media, ggx))
}

fn clear(n: f64) -> Material {
    glass(1.0, n, 0.0, Absorption::NONE)
}

fn per_metre(sigma: f64) -> Absorption {
    Absorption::per_metre(Rgb::splat(sigma)).expect("valid")
}

fn matte(reflectance: f64) -> Material {
    Material::Matte(Phong { kd: 1.0, colour: Texture::Constant(Rgb::splat(reflectance)), ..Phong::NONE })
}

fn shining(radiance: f64) -> Material {
    Material::Emissive { radiance: Texture::Constant(Rgb::splat(radiance)) }
}

/// Square to the view from above, one pixel of a few square centimetres around the origin.
fn spot_below(objects: Vec<SceneObject>) -> Scene {
    let above = Camera::new(
        DVec3::new(0.0, 0.9, 0.0),
        DVec3::ZERO,
        DVec3::X,
        Projection::Orthographic { height: 1e-3 },
    );
    Scene::new(objects, above.expect("valid camera")).expect("valid scene")
}

fn settings(branching: Branching, size: u32, spp: u32) -> Settings {
    Settings { size: [size; 2], spp, integrator: Integrator::Path, branching, ..Settings::default() }
}

const ALL: [Branching; 3] = [Branching::One, Branching::First, Branching::Tree];

/// The disc of a sphere of n = 1.5 in white surroundings at depths 1 to 5, averaged: what Fresnel's equations reflect at first
/// is ∫ R dsin² = 0.0918, and so on along the series of inner reflections (all of an inner path's hits are alike).
#[test]
fn a_fresnel_sphere_shows_what_the_depth_limit_leaves() {
    let scene = white(
        vec![object("ball", unit_sphere(), clear(1.5))],
        camera(Projection::Orthographic { height: 2.0 }, 10.0),
    );
    // R averaged over the disc, by the midpoint rule in sin²; each depth adds the mean of (1 − R)² R^(depth − 2).
    let steps = 100_000;
    let mean = |f: &dyn Fn(f64) -> f64| {
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
        (0..steps).map(|i| f(reflectance((1.0 - at(i)).sqrt(), 1.5))).sum::<f64>() / f64::from(steps)
    };
    let published = [0.0918, 0.9273, 0.9885, 0.9965, 0.9985];
    let mut disc = mean(&|r| r);
    for depth in 1..=5u32 {
        if depth > 1 {
            disc += mean(&|r| (1.0 - r) * (1.0 - r) * r.powi(depth.cast_signed() - 2));
        }
        assert!((disc - published[depth as usize - 1]).abs() < 6e-5, "depth {depth}: {disc}");
        // The corners of the picture show the surroundings.
        let expected = disc * PI / 4.0 + (1.0 - PI / 4.0);
        for branching in ALL {
            let settings = Settings { max_depth: Some(depth), ..settings(branching, 32, 64) };
            assert_mean(&format!("depth {depth}, {branching:?}"), &scene, &settings, expected, 2e-4);
        }
        let tree = Settings {
            integrator: Integrator::Whitted,
            cutoff: 0.0,
            max_depth: Some(depth),
            ..settings(Branching::One, 32, 64)
        };
        assert_mean(&format!("depth {depth}, ray tree"), &scene, &tree, expected, 2e-4);
    }
}

/// Fresnel's reflectance of unpolarised light, as in any textbook.
fn reflectance(cos: f64, n: f64) -> f64 {
    let cos_t = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * cos_t) / (cos + n * cos_t);
    let p = (n * cos - cos_t) / (n * cos + cos_t);
    0.5 * (s * s + p * p)
}

/// In white surroundings, what absorbs nothing is invisible.
#[test]
fn furnaces_are_white() {
    // From no direction in which the mesh is symmetric: light can be caught between symmetric facets for thousands of hits.
    let (from, projection) = (DVec3::new(3.1, 4.3, 8.7), Projection::Orthographic { height: 2.2 });
    let camera = Camera::new(from, DVec3::ZERO, DVec3::Y, projection).expect("valid camera");
    let sphere = |r: f64| Shape::Sphere(Sphere::new(DVec3::ZERO, r).expect("valid sphere"));
    let mesh = crate::mesh_sphere::subdivided(3, false);
    let cases: [(&str, Vec<SceneObject>, f64); 5] = [
        ("sphere", vec![object("a", sphere(1.0), clear(1.5))], 1e-4),
        ("mesh", vec![object("a", mesh, clear(1.5))], 1e-4),
        (
            "hollow",
            vec![
                object("a", sphere(1.0), clear(1.5)),
                object("b", sphere(0.8), glass(1.5, 1.0, 0.0, Absorption::NONE)),
            ],
            1e-4,
        ),
        ("rough", vec![object("a", sphere(1.0), glass(1.0, 1.5, 0.3, Absorption::NONE))], 1e-3),
        (
            "matte in glass",
            vec![object("a", sphere(1.0), clear(1.5)), object("b", sphere(0.5), matte(1.0))],
            1e-4,
        ),
    ];
    for (name, objects, sigma) in cases {
        let scene = white(objects, camera);
        for branching in ALL {
            let settings = settings(branching, 24, 128);
            if name == "rough" {
                // Compensation of rough glass is a table, good to 1e-3 on average.
                let moments = crate::estimate::means(&scene, &settings, 16);
                assert!(
                    moments.standard_error() < sigma && (moments.mean() - 1.0).abs() < 2e-3,
                    "{moments:?}"
                );
            } else {
                assert_mean(&format!("{name}, {branching:?}"), &scene, &settings, 1.0, sigma);
            }
        }
    }
}

/// A matte floor under a rectangle that faces it: the irradiance at the foot of a corner of an a × b rectangle at height h is
/// L/2 (X atan(Y/√…) + …), the configuration factor of J. Howell's catalogue (B-3), four times for the middle.
#[test]
fn a_floor_under_a_rectangle_has_its_configuration_factor() {
    let (a, b, h, radiance, albedo) = (0.7, 0.4, 1.0, 3.0, 0.6);
    let floor = Plane::new(DVec3::ZERO, DVec3::Y).expect("valid plane");
    for (name, albedo_of_lamp) in [("one bounce", 0.0), ("sphere beside", 1.0)] {
        let lamp = Rectangle::new(DVec3::new(-a, h, -b), DVec3::X * (2.0 * a), DVec3::Z * (2.0 * b));
        let lamp = object("lamp", Shape::Rectangle(lamp.expect("valid")), shining(radiance));
        let mut objects = vec![object("floor", Shape::Plane(floor), matte(albedo)), lamp];
        if albedo_of_lamp > 0.0 {
            // A second light, so that the choice between two is in the estimate: a sphere far above the horizon, whose
            // irradiance is π L sin²(half angle) cos(incidence).
            let (centre, r) = (DVec3::new(0.0, 4.0, 3.0), 0.5);
            let sphere = Sphere::new(centre, r).expect("valid");
            objects.push(object("moon", Shape::Sphere(sphere), shining(20.0)));
        }
        let scene = spot_below(objects);
        let (x, y) = (a / h, b / h);
        let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        let factor = 4.0 * (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / (2.0 * PI);
        let mut expected = albedo * radiance * factor;
        if albedo_of_lamp > 0.0 {
            let (centre, r) = (DVec3::new(0.0, 4.0, 3.0), 0.5);
            expected += albedo * 20.0 * (r * r / centre.dot(centre)) * (centre.y / centre.length());
        }
        for branching in [Branching::One, Branching::First] {
            assert_mean(name, &scene, &settings(branching, 8, 256), expected, 1e-3 * expected);
        }
    }
}

/// A matte floor under one ball, three and twenty, of all sizes: each gives π L sin²(half its angle) cos(incidence). One is always
/// asked, a few are estimated, many are chosen by power.
#[test]
fn a_floor_under_balls_has_the_sum_of_their_irradiances() {
    let albedo = 0.5;
    for count in [1, 3, 20] {
        let floor = Plane::new(DVec3::ZERO, DVec3::Y).expect("valid plane");
        let mut objects = vec![object("floor", Shape::Plane(floor), matte(albedo))];
        let mut expected = 0.0;
        for i in 0..count {
            // On a spiral, where none hides another.
            let (turn, out) = (2.4 * f64::from(i), 1.0 + 0.2 * f64::from(i));
            let centre = DVec3::new(turn.cos(), 1.2 + 0.35 * f64::from(i), turn.sin()) * out;
            let (r, radiance) = (0.05 + 0.01 * f64::from(i % 4), 5.0 + 30.0 * f64::from(i % 3));
            let ball = Shape::Sphere(Sphere::new(centre, r).expect("valid"));
            objects.push(object(&format!("ball {i}"), ball, shining(radiance)));
            expected += albedo * radiance * (r * r / centre.dot(centre)) * (centre.y / centre.length());
        }
        let settings = settings(Branching::One, 8, 256);
        assert_mean(&format!("{count} balls"), &spot_below(objects), &settings, expected, 2e-3 * expected);
    }
}

/// Under a spot: intensity over the square of the distance within the inner cone, nothing outside of the outer one, and between
/// them the smooth step s² (3 − 2 s) of the cosine.
#[test]
fn a_spot_fades_from_its_inner_to_its_outer_cone() {
    let floor = Plane::new(DVec3::ZERO, DVec3::Y).expect("valid plane");
    let (height, intensity, albedo) = (0.8, 7.0, 0.8);
    let (cos_inner, cos_outer) = (20f64.to_radians().cos(), 30f64.to_radians().cos());
    for degrees in [0.0, 15.0, 25.0, 31.0] {
        // The axis is turned away from the spot below by this much.
        let angle = f64::to_radians(degrees);
        let step = ((angle.cos() - cos_outer) / (cos_inner - cos_outer)).clamp(0.0, 1.0);
        let share = step * step * (3.0 - 2.0 * step);
        let mut scene = spot_below(vec![object("floor", Shape::Plane(floor), matte(albedo))]);
        scene.lights = vec![Light::Spot {
            position: DVec3::Y * height,
            axis: DVec3::new(angle.sin(), -angle.cos(), 0.0),
            intensity: Rgb::splat(intensity),
            cos_inner,
            cos_outer,
            shadows: true,
        }];
        let expected = albedo / PI * intensity * share / (height * height);
        // There is no noise; the picture is a millimetre wide.
        let found = crate::estimate::means(&scene, &settings(Branching::One, 4, 64), 1).mean();
        assert!(
            (found - expected).abs() < 1e-5 * intensity,
            "{degrees} degrees: {found} instead of {expected}"
        );
    }
}

/// A slab shows a shining rectangle behind it by the sum of its inner reflections, T = (1 − R)² a/(1 − R² a²) along the normal,
/// a the share that is left after one pass; clear and coloured.
#[test]
fn a_rectangle_through_a_slab_is_dimmer_by_the_series() {
    let thickness = 0.3;
    let slab =
        Cuboid::new(DVec3::new(-50.0, -50.0, -thickness), DVec3::new(50.0, 50.0, 0.0)).expect("valid box");
    let lamp = Rectangle::new(DVec3::new(-40.0, -40.0, -3.0), DVec3::X * 80.0, DVec3::Y * 80.0);
    let lamp = lamp.expect("valid");
    for (n, sigma) in [(1.5, 0.0), (1.5, 2.0), (2.42, 0.5)] {
        let material = glass(1.0, n, 0.0, per_metre(sigma));
        let objects = vec![
            object("slab", Shape::Cuboid(slab), material),
            object("lamp", Shape::Rectangle(lamp), shining(2.0)),
        ];
        let camera = camera(Projection::Orthographic { height: 1e-3 }, 5.0);
        let mut scene = Scene::new(objects, camera).expect("valid scene");
        scene.background = Background::Constant(Rgb::ZERO);
        let r = reflectance(1.0, n);
        let pass = (-sigma * thickness).exp();
        let expected = 2.0 * (1.0 - r) * (1.0 - r) * pass / (1.0 - r * r * pass * pass);
        for branching in ALL {
            let name = format!("n = {n}, sigma = {sigma}, {branching:?}");
            // Light that the slab throws back onto the lamp is absorbed there: its face does not reflect.
            assert_mean(&name, &scene, &settings(branching, 8, 256), expected, 1e-3 * expected);
        }
    }
}

/// A coloured ball that does not refract: the mean over the disc of exp(−2 σ r √(1 − b²)) is (1 − (1 + s) e^−s) 2/s², s = 2 σ r.
#[test]
fn a_coloured_ball_has_its_mean_transmittance() {
    for sigma in [0.1, 1.0, 4.0] {
        let ball = object("ball", unit_sphere(), glass(1.0, 1.0, 0.0, per_metre(sigma)));
        let scene = white(vec![ball], camera(Projection::Orthographic { height: 2.0 }, 10.0));
        let s: f64 = 2.0 * sigma;
        let disc = 2.0 * (1.0 - (1.0 + s) * (-s).exp()) / (s * s);
        let expected = disc * PI / 4.0 + (1.0 - PI / 4.0);
        for branching in ALL {
            assert_mean(&format!("sigma = {sigma}"), &scene, &settings(branching, 32, 64), expected, 1e-4);
        }
    }
}

/// The same with refraction, against the sum over inner reflections of Fresnel's equations and absorption, by the midpoint rule.
#[test]
fn a_coloured_glass_ball_has_its_mean_transmittance() {
    let (n, sigma) = (1.5, 0.7);
    let ball = object("ball", unit_sphere(), glass(1.0, n, 0.0, per_metre(sigma)));
    let scene = white(vec![ball], camera(Projection::Orthographic { height: 2.0 }, 10.0));
    let steps = 100_000;
    let disc: f64 = (0..steps)
        .map(|i| {
            let sin_squared = (f64::from(i) + 0.5) / f64::from(steps);
            let r = reflectance((1.0 - sin_squared).sqrt(), n);
            let chord = 2.0 * (1.0 - sin_squared / (n * n)).sqrt();
            let pass = (-sigma * chord).exp();
            r + (1.0 - r) * (1.0 - r) * pass / (1.0 - r * pass)
        })
        .sum::<f64>()
        / f64::from(steps);
    let expected = disc * PI / 4.0 + (1.0 - PI / 4.0);
    for branching in ALL {
        assert_mean(&format!("{branching:?}"), &scene, &settings(branching, 32, 128), expected, 2e-4);
    }
}

/// Nothing but the background: no noise at all.
#[test]
fn an_empty_scene_is_its_background() {
    let scene = white(vec![], camera(Projection::Pinhole { fov: 1.0 }, 5.0));
    assert!(picture(&scene, &settings(Branching::First, 8, 4)).iter().all(|p| *p == [1.0; 3]));
}

/// A clamp hides what is brighter, and only that.
#[test]
fn a_clamp_cuts_samples() {
    let lamp =
        Rectangle::new(DVec3::new(-40.0, -40.0, 0.0), DVec3::X * 80.0, DVec3::Y * 80.0).expect("valid");
    let material = Material::Emissive { radiance: Texture::Constant(Rgb::new(5.0, 1.0, 2.5)) };
    let camera = camera(Projection::Orthographic { height: 1.0 }, 5.0);
    let scene =
        Scene::new(vec![object("lamp", Shape::Rectangle(lamp), material)], camera).expect("valid scene");
    let plain = settings(Branching::One, 2, 4);
    assert!(picture(&scene, &plain).iter().all(|p| *p == [5.0, 1.0, 2.5]));
    assert!(picture(&scene, &Settings { clamp: Some(2.0), ..plain }).iter().all(|p| *p == [2.0, 1.0, 2.0]));
}

/// Seen from within coloured water, everything is dimmer by the way through it: a camera in the middle of a ball of it that does
/// not refract, and in a ball of it that does, before a white sky.
#[test]
fn a_camera_stands_in_what_its_first_surface_encloses() {
    let sigma = 0.8;
    let inside = Camera::new(DVec3::ZERO, -DVec3::Z, DVec3::Y, Projection::Pinhole { fov: 0.01 });
    for n in [1.0, 1.33] {
        let ball = object("ball", unit_sphere(), glass(1.0, n, 0.0, per_metre(sigma)));
        let scene = white(vec![ball], inside.expect("valid camera"));
        // Along the normal: what is reflected inside comes through at the other side, and so on; radiance is n² of the sky's.
        let (r, pass) = (reflectance(1.0, n), (-sigma).exp());
        let expected = n * n * (1.0 - r) * pass / (1.0 - r * pass * pass);
        for integrator in [Integrator::Path, Integrator::Whitted] {
            let settings = Settings { integrator, cutoff: 0.0, ..settings(Branching::Tree, 2, 4096) };
            let found = crate::estimate::means(&scene, &settings, 8);
            let allowed = 4.0 * found.standard_error() + 1e-6;
            assert!(
                (found.mean() - expected).abs() < allowed,
                "n = {n}, {integrator:?}: {found:?}, {expected}"
            );
        }
    }
}
