//! Light from pictures of all directions, against closed forms, and found in every way.

use crate::estimate::{assert_mean, means};
use crate::stage::object;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;
use vitrum::geometry::shape::{Disk, Plane, Shape, Sphere};
use vitrum::io::load::scene_text;
use vitrum::materials::{Material, Phong, Texture};
use vitrum::math::{DVec3, Rgb};
use vitrum::tracer::{
    Background, Branching, Camera, EnvironmentMap, Integrator, LightSampling, Projection, Scene, SceneObject,
    Settings,
};

fn matte(reflectance: f64) -> Material {
    Material::Matte(Phong { kd: 1.0, colour: Texture::Constant(Rgb::splat(reflectance)), ..Phong::NONE })
}

fn floor() -> SceneObject {
    object("floor", Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).expect("valid plane")), matte(0.8))
}

/// A point of the floor, from above.
fn looking_down(objects: Vec<SceneObject>, sky: EnvironmentMap) -> Scene {
    let projection = Projection::Orthographic { height: 1e-3 };
    let camera = Camera::new(DVec3::new(0.0, 0.5, 0.0), DVec3::ZERO, DVec3::X, projection);
    let mut scene = Scene::new(objects, camera.expect("valid camera")).expect("valid scene");
    scene.background = Background::Environment(Arc::new(sky));
    scene
}

fn settings(light_sampling: LightSampling, spp: u32) -> Settings {
    Settings { size: [6; 2], spp, integrator: Integrator::Path, light_sampling, ..Settings::default() }
}

const ALL: [LightSampling; 3] = [LightSampling::Mis, LightSampling::Lights, LightSampling::Bsdf];

/// A picture of two rows, white above black: radiance is 1 down to 45 degrees from straight up and falls linearly in the angle to
/// 0 at 135. The irradiance of a floor is the integral of that times sin θ cos θ over the upper half, π (3/4 + 1/(2π)).
#[test]
fn a_floor_under_two_rows() {
    let texels = [vec![[1.0; 3]; 6], vec![[0.0; 3]; 6]].concat();
    let sky = EnvironmentMap::new(6, 2, texels, 0.3, 1.0).expect("valid");
    let scene = looking_down(vec![floor()], sky);
    let expected = 0.8 * (0.75 + 1.0 / TAU);
    for way in ALL {
        assert_mean(&format!("{way:?}"), &scene, &settings(way, 256), expected, 6e-4);
    }
}

/// A sun of uniform radiance on an otherwise grey sky.
fn under_a_sun(width: usize) -> EnvironmentMap {
    let height = width / 2;
    let radius: f64 = 0.03;
    let (elevation, azimuth) = (0.7_f64, 0.9_f64);
    let towards =
        DVec3::new(elevation.cos() * azimuth.sin(), elevation.sin(), -elevation.cos() * azimuth.cos());
    let texel = |at: usize| {
        let phi = TAU * (((at % width) as f64 + 0.5) / width as f64 - 0.5);
        let theta = PI * ((at / width) as f64 + 0.5) / height as f64;
        let direction = DVec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
        if direction.dot(towards) > radius.cos() { [300.0; 3] } else { [0.3; 3] }
    };
    EnvironmentMap::new(width, height, (0..width * height).map(texel).collect(), 0.0, 1.0).expect("valid")
}

/// The irradiance that the program says its sun has, times the cosine of its height, is what the floor gets beside that of the
/// grey sky.
#[test]
fn a_floor_in_the_sun() {
    let sky = under_a_sun(512);
    let [sun] = sky.suns()[..] else { panic!("one sun") };
    // A disk of a radiance of 300: texels are in it or not, so that its edge is known to half a texel of 0.012 on 0.03.
    let disk = 300.0 * TAU * (1.0 - 0.03_f64.cos());
    assert!((sun.irradiance / disk - 1.0).abs() < 0.2, "{} for {disk}", sun.irradiance);
    let solid_angle = sun.irradiance / 300.0;
    let expected = 0.8 * (0.3 + (sun.irradiance - 0.3 * solid_angle) * sun.towards.y / PI);
    let scene = looking_down(vec![floor()], sky);
    for way in [LightSampling::Mis, LightSampling::Lights] {
        let found = means(&scene, &settings(way, 256), 16);
        // The region of the sun holds some grey, and its middle is that of the block: a few parts in a thousand.
        let apart = found.mean() / expected - 1.0;
        assert!(
            apart.abs() < 1e-2 && found.standard_error() < 3e-3 * expected,
            "{way:?}: {found:?}, {expected}"
        );
    }
}

/// Light is found by asking, by meeting and by both to the same amount: on a floor, in the shadow of a disk, behind a ball of
/// glass, with a lamp beside the sky.
#[test]
fn every_way_of_finding_light_finds_the_same() {
    let ball = Shape::Sphere(Sphere::new(DVec3::new(0.7, 0.6, 0.0), 0.4).expect("valid sphere"));
    let shade = Shape::Disk(Disk::new(DVec3::new(0.0, 1.0, 0.2), DVec3::Y, 0.8).expect("valid disk"));
    let lamp = Shape::Sphere(Sphere::new(DVec3::new(-2.0, 1.5, 0.0), 0.3).expect("valid sphere"));
    let shining = Material::Emissive { radiance: Texture::Constant(Rgb::splat(8.0)) };
    let glass = crate::stage::clear_glass(0.1, 0.9, 1.0, 1.5);
    let objects = vec![
        floor(),
        object("ball", ball, glass),
        object("shade", shade, matte(0.5)),
        object("lamp", lamp, shining),
    ];
    let scene = looking_down(objects, under_a_sun(128));
    let reference = means(&scene, &settings(LightSampling::Mis, 512), 16);
    for branching in [Branching::One, Branching::Tree] {
        for (way, spp) in [(LightSampling::Lights, 512), (LightSampling::Bsdf, 2048)] {
            let found = means(&scene, &Settings { branching, ..settings(way, spp) }, 16);
            let error = reference.standard_error().hypot(found.standard_error());
            let z = (found.mean() - reference.mean()) / error;
            assert!(z.abs() < 4.5, "{way:?}, {branching:?}: {found:?} instead of {reference:?}");
            assert!(error < 0.03 * reference.mean(), "{way:?}, {branching:?}: {error} says nothing");
        }
    }
}

/// Behind panes light is found by asking through them and by meeting it.
#[test]
fn a_sky_shines_through_panes() {
    let text = include_str!("../scenes/pane.toml");
    let loaded = scene_text("pane", text, Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    let mut scene = loaded.scene;
    scene.background = Background::Environment(Arc::new(under_a_sun(128)));
    let of = |light_sampling, spp| {
        let settings = Settings { size: [16; 2], light_sampling, spp, ..loaded.settings };
        means(&scene, &settings, 16)
    };
    let reference = of(LightSampling::Mis, 128);
    for (way, spp) in [(LightSampling::Lights, 128), (LightSampling::Bsdf, 512)] {
        let found = of(way, spp);
        let error = reference.standard_error().hypot(found.standard_error());
        assert!((found.mean() - reference.mean()).abs() < 4.5 * error, "{way:?}: {found:?}, {reference:?}");
    }
}
