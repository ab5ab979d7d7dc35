//! Scenes, and rays of four kinds to ask them about. Of each kind there are up to 4096, in the order in which a render asks
//! them:
//!
//! | kind | what it is | question |
//! |---|---|---|
//! | primary | a picture of 64 × 64 pixels, row by row | closest |
//! | inner | where a primary ray hits, refracted into glass of n = 1.5 | closest |
//! | random | from anywhere within the bounds to anywhere; no two alike | closest |
//! | shadow | where a primary ray hits, towards a lamp | occluded |

use crate::bumpy::bumpy;
use crate::directions::{INPUTS, direction};
use std::path::Path;
use std::sync::Arc;
use vitrum::bxdf::{Interface, Refraction};
use vitrum::geometry::mesh::{MeshData, TriangleMesh};
use vitrum::geometry::shape::{Cuboid, Cylinder, Plane, Sphere};
use vitrum::geometry::{Aggregate, Counters, Object, Query, Shape, Side, SurfaceInteraction};
use vitrum::math::{DVec3, Frame, Ray, Transform, unit};
use vitrum::tracer::{Camera, Projection};
use vitrum_testkit::Uniform;

/// Edge of the picture of the primary rays.
const EDGE: u32 = 64;
const _: () = assert!((EDGE * EDGE) as usize == INPUTS);

fn aggregate(shapes: impl IntoIterator<Item = Shape>) -> Aggregate {
    let object = |shape| Object::new(shape, &Transform::IDENTITY, false).expect("the shape is valid");
    Aggregate::new(shapes.into_iter().map(object).collect())
}

fn sphere(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).expect("the radius is positive"))
}

/// A tetrahedron of spheres that stand apart, so that a ray inside one can meet nothing else.
fn four_spheres() -> Aggregate {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    aggregate(corners.map(|c| sphere(DVec3::from_array(c), 0.95)))
}

/// A thousand small spheres in a cube, more than half of them overlapping a neighbour.
fn thousand_spheres() -> Aggregate {
    let mut uniform = Uniform::new(1);
    let mut number = || uniform.number() * 2.0 - 1.0;
    aggregate((0..1000).map(|_| sphere(DVec3::new(number(), number(), number()), 0.06)))
}

/// A dozen shapes of three kinds, like a scene that somebody wrote by hand.
fn twelve_shapes() -> Aggregate {
    let mut uniform = Uniform::new(3);
    let mut point = || DVec3::new(uniform.number(), uniform.number(), uniform.number()) * 2.0 - DVec3::ONE;
    let valid = "the shape has a volume";
    aggregate((0..12).map(|i| {
        let (centre, half) = (point(), DVec3::splat(0.25));
        match i % 3 {
            0 => sphere(centre, 0.3),
            1 => Shape::Cuboid(Cuboid::new(centre - half, centre + half).expect(valid)),
            _ => Shape::Cylinder(Cylinder::new(centre - half, centre + half, 0.2, true).expect(valid)),
        }
    }))
}

/// A mesh of the gallery.
pub(crate) fn gallery(name: &str) -> MeshData {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/meshes");
    let mut file = vitrum::io::obj::read(&meshes.join(name)).expect("the mesh is part of the repository");
    file.parts.remove(0).mesh
}

pub(crate) fn trace(mesh: &MeshData) -> Shape {
    Shape::Mesh(Arc::new(TriangleMesh::new(mesh.clone()).expect("the mesh is valid")))
}

/// A table laid for twenty-five: wine glasses that stand apart on a plane.
fn glasses() -> Aggregate {
    let glass = trace(&gallery("wine_glass.obj"));
    let valid = "the object is valid";
    let table = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).expect("it has a normal"));
    let mut objects = vec![Object::new(table, &Transform::IDENTITY, false).expect(valid)];
    objects.extend((0..25).map(|i| {
        let place = DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5)) * 0.12;
        Object::new(glass.clone(), &Transform::translate(place), false).expect(valid)
    }));
    Aggregate::new(objects)
}

/// The scenes, by name: the knot has 12 288 triangles, the wine glass 9984, the gem 302.
pub(crate) fn scene(name: &str) -> Aggregate {
    match name {
        "4 spheres" => four_spheres(),
        "12 shapes" => twelve_shapes(),
        "1000 spheres" => thousand_spheres(),
        "knot" => aggregate([trace(&gallery("torus_knot.obj"))]),
        "wine glass" => aggregate([trace(&gallery("wine_glass.obj"))]),
        "25 glasses" => glasses(),
        "gem" => aggregate([trace(&gallery("brilliant.obj"))]),
        "100 000 triangles" => aggregate([trace(&bumpy(201, 250))]),
        "1 000 000 triangles" => aggregate([trace(&bumpy(501, 1000))]),
        _ => unreachable!("no scene is called {name}"),
    }
}

/// The rays of a scene.
pub(crate) struct Rays {
    pub(crate) primary: Vec<Query>,
    pub(crate) inner: Vec<Query>,
    pub(crate) random: Vec<Query>,
    /// Each with the distance of the lamp.
    pub(crate) shadow: Vec<(Query, f64)>,
}

impl Rays {
    pub(crate) fn of(scene: &Aggregate) -> Self {
        let primary = primary(scene);
        let surfaces = surfaces(scene, &primary);
        let inner = surfaces.iter().map(refracted).collect();
        Self { primary, inner, random: random(scene), shadow: shadows(scene, &surfaces) }
    }
}

/// A picture that the bounds just fill.
fn primary(scene: &Aggregate) -> Vec<Query> {
    let (centre, size) = (scene.bounds().centre(), scene.bounds().extent().length());
    let position = centre + unit(DVec3::new(0.35, 0.35, 1.0)) * (2.0 * size);
    let camera = Camera::new(position, centre, DVec3::Y, Projection::Pinhole { fov: 0.35 });
    let camera = camera.expect("it looks at the centre");
    let ray = |x, y| {
        let at = |pixel| f64::from(pixel) + 0.5;
        camera.ray(at(x), at(y), [EDGE; 2], || unreachable!("a pinhole has no lens"))
    };
    (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| Query::new(ray(x, y)))).collect()
}

fn surfaces(scene: &Aggregate, rays: &[Query]) -> Vec<SurfaceInteraction> {
    let hit = |ray| {
        scene
            .closest(ray, &mut Counters::default())
            .map(|hit| scene.interaction(ray, &hit, &mut Counters::default()))
    };
    rays.iter().filter_map(hit).collect()
}

fn refracted(surface: &SurfaceInteraction) -> Query {
    let glass = Interface::new(1.0, 1.5).expect("both indices are positive");
    let frame = Frame::around(surface.ng);
    let Refraction::Refracted { wt, .. } = glass.refract(frame.to_local(surface.wo)) else {
        unreachable!("rays from outside are not totally reflected")
    };
    surface.leave(frame.to_world(wt), Side::Transmitted)
}

fn random(scene: &Aggregate) -> Vec<Query> {
    let mut uniform = Uniform::new(2);
    let bounds = scene.bounds();
    (0..INPUTS)
        .map(|_| {
            let within = DVec3::new(uniform.number(), uniform.number(), uniform.number());
            Query::new(Ray::new(bounds.min + within * bounds.extent(), direction(&mut uniform)))
        })
        .collect()
}

/// Rays towards a lamp from what faces it, each with the distance of the lamp.
fn shadows(scene: &Aggregate, surfaces: &[SurfaceInteraction]) -> Vec<(Query, f64)> {
    let size = scene.bounds().extent().length();
    let lamp = scene.bounds().centre() + DVec3::new(-0.6, 1.2, 0.8) * size;
    surfaces
        .iter()
        .filter_map(|surface| {
            let towards = unit(lamp - surface.point);
            let faces = surface.side_of(towards) == Side::Incident;
            faces.then(|| (surface.leave(towards, Side::Incident), (lamp - surface.point).length()))
        })
        .collect()
}
