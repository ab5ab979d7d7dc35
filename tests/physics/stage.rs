//! Small scenes in memory.

use vitrum::geometry::shape::{Shape, Sphere};
use vitrum::geometry::{Object, Side};
use vitrum::materials::{IndexOfRefraction, Material, Media, Medium, Phong, Transparent};
use vitrum::math::{DVec3, Rgb, Transform};
use vitrum::tracer::{Background, Camera, Projection, Scene, SceneObject, Settings, render};

pub(crate) fn clear_glass(kr: f64, kt: f64, outside: f64, inside: f64) -> Material {
    let medium = |n: f64| Medium::clear(IndexOfRefraction::new(n).expect("a valid index"));
    Material::Transparent(Transparent {
        phong: Phong::NONE,
        kr: Rgb::splat(kr),
        kt: Rgb::splat(kt),
        media: Media::new(medium(outside), medium(inside)),
    })
}

pub(crate) fn object(name: &str, shape: Shape, material: Material) -> SceneObject {
    SceneObject {
        name: name.to_owned(),
        object: Object::new(shape, &Transform::IDENTITY, false).expect("valid shape"),
        materials: vec![material],
    }
}

pub(crate) fn unit_sphere() -> Shape {
    Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).expect("valid sphere"))
}

/// Looks down the z axis at the origin from a distance of `distance`.
pub(crate) fn camera(projection: Projection, distance: f64) -> Camera {
    Camera::new(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, DVec3::Y, projection).expect("valid camera")
}

/// The objects in white surroundings.
pub(crate) fn white(objects: Vec<SceneObject>, camera: Camera) -> Scene {
    let mut scene = Scene::new(objects, camera).expect("valid scene");
    scene.background = Background::Constant(Rgb::ONE);
    scene
}

pub(crate) fn picture(scene: &Scene, settings: &Settings) -> Vec<[f32; 3]> {
    let rendering = render(scene, settings, &()).expect("valid settings");
    assert_eq!(rendering.stats.dropped, 0);
    rendering.film.image()
}

/// The side that a transmitted ray goes to, named for reading.
pub(crate) const THROUGH: Side = Side::Transmitted;
