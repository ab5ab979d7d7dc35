//! Matched index, nothing reflected, everything transmitted: the object is not there, to the last bit.

use crate::stage::{camera, clear_glass, object, picture, unit_sphere};
use vitrum::geometry::shape::{Plane, Shape, Sphere};
use vitrum::materials::{Axes, Checker, Material, Phong, Texture};
use vitrum::math::{DVec3, Rgb};
use vitrum::tracer::{Background, Falloff, Light, Projection, Scene, SceneObject, Settings, ShadowMode};

fn room(with: Option<SceneObject>) -> Scene {
    let axes = Axes { x: true, y: false, z: true };
    let checker =
        Checker { even: Rgb::splat(0.9), odd: Rgb::splat(0.1), size: 0.5, origin: DVec3::ZERO, axes };
    let floor = Material::Matte(Phong { colour: Texture::Checker(checker), ka: 1.0, kd: 0.8, ..Phong::NONE });
    let plane = Shape::Plane(Plane::new(DVec3::new(0.0, -1.0, 0.0), DVec3::Y).expect("valid plane"));
    let ball = Shape::Sphere(Sphere::new(DVec3::new(-1.5, 0.0, -2.0), 1.0).expect("valid sphere"));
    let mut objects =
        vec![object("floor", plane, floor), object("other", ball, clear_glass(0.1, 0.9, 1.0, 1.5))];
    objects.extend(with);
    let mut scene = Scene::new(objects, camera(Projection::Pinhole { fov: 0.8 }, 6.0)).expect("valid scene");
    scene.background = Background::Gradient { bottom: Rgb::splat(0.2), top: Rgb::new(0.4, 0.6, 0.9) };
    scene.ambient = Rgb::splat(0.1);
    scene.lights = vec![Light::Point {
        position: DVec3::new(2.0, 4.0, 3.0),
        intensity: Rgb::splat(30.0),
        falloff: Falloff::InverseSquare,
        shadows: true,
    }];
    scene
}

#[test]
fn a_matched_sphere_changes_no_bit_of_the_picture_and_casts_no_shadow() {
    for shadow in [ShadowMode::Opaque, ShadowMode::Straight] {
        let settings = Settings { size: [64, 48], spp: 8, shadow, ..Settings::default() };
        let without = picture(&room(None), &settings);
        // In the middle of the view, above the floor, in the light's way; also in another medium than air.
        for (outside, inside) in [(1.0, 1.0), (1.33, 1.33)] {
            let ghost = object("ghost", unit_sphere(), clear_glass(0.0, 1.0, outside, inside));
            let scene = room(Some(ghost));
            assert_eq!(scene.invisible(), ["ghost"]);
            assert_eq!(picture(&scene, &settings), without);
        }
        // The same sphere is seen as soon as it dims.
        let seen = object("seen", unit_sphere(), clear_glass(0.1, 0.9, 1.0, 1.0));
        assert_ne!(picture(&room(Some(seen)), &settings), without);
    }
}

/// A straight shadow through a sphere that only dims is the light times kt for each of its two surfaces.
#[test]
fn straight_shadows_lose_kt_at_each_surface() {
    let settings = |shadow| Settings { size: [96, 72], spp: 4, shadow, ..Settings::default() };
    let ball = |kt| object("seen", unit_sphere(), clear_glass(0.0, kt, 1.0, 1.0));
    let mut dim = room(Some(ball(0.5)));
    let mut clear = room(None);
    for scene in [&mut dim, &mut clear] {
        scene.ambient = Rgb::ZERO;
        scene.background = Background::Constant(Rgb::ZERO);
    }
    let dimmed = picture(&dim, &settings(ShadowMode::Straight));
    let lit = picture(&clear, &settings(ShadowMode::Straight));
    let ratios: Vec<f32> =
        dimmed.iter().zip(&lit).filter(|(_, l)| l[0] > 0.0).map(|(d, l)| d[0] / l[0]).collect();
    // Floor in the sphere's shadow, seen past the sphere: a quarter. Nothing is brighter than without the sphere.
    assert!(ratios.iter().filter(|&&r| (r - 0.25).abs() < 1e-6).count() > 50);
    assert!(ratios.iter().all(|&r| r <= 1.0 + 1e-6));
    let opaque = picture(&dim, &settings(ShadowMode::Opaque));
    assert!(
        opaque.iter().zip(&lit).filter(|(o, l)| l[0] > 0.0 && o[0] == 0.0).count() > 50,
        "opaque shadows are black"
    );
}
