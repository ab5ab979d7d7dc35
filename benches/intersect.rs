//! One ray against one shape.
//!
//! Elements are rays. They start on a sphere of radius 4 and aim at points spread evenly in one of radius 1.2 around a
//! shape of radius about 1, so that most hit and many miss. `leaving` rays start on the shape and go inward: what a ray
//! inside glass asks.

use crate::directions::{INPUTS, direction};
use crate::measure::Harness;
use std::hint::black_box;
use std::sync::Arc;
use vitrum::geometry::mesh::{MeshData, TriangleMesh};
use vitrum::geometry::shape::{Crossings, Cuboid, Cylinder, Disk, Leaving, Plane, Rectangle, Sphere};
use vitrum::geometry::{Aggregate, Counters, Object, Query, Shape};
use vitrum::math::{DVec3, Ray, Transform, unit};
use vitrum_testkit::Uniform;

pub(crate) fn bench(harness: &mut Harness) {
    shapes(harness);
    triangles(harness);
}

/// Rays from outside.
fn arriving() -> Vec<Ray> {
    let mut uniform = Uniform::new(1);
    (0..INPUTS)
        .map(|_| {
            let origin = direction(&mut uniform) * 4.0;
            let target = direction(&mut uniform) * (1.2 * libm::cbrt(uniform.number()));
            Ray::new(origin, unit(target - origin))
        })
        .collect()
}

/// Rays that leave the unit sphere inward.
fn leaving() -> Vec<Ray> {
    let mut uniform = Uniform::new(2);
    (0..INPUTS)
        .map(|_| {
            let (normal, d) = (direction(&mut uniform), direction(&mut uniform));
            Ray::new(normal, if d.dot(normal) > 0.0 { -d } else { d })
        })
        .collect()
}

fn shapes(harness: &mut Harness) {
    fn shape(harness: &mut Harness, name: &str, rays: &[Ray], crossings: impl Fn(&Ray) -> Crossings) {
        harness.measure(&format!("intersect/{name}"), INPUTS, || {
            for ray in rays {
                black_box(crossings(ray));
            }
        });
    }
    let (arriving, leaving) = (arriving(), leaving());
    let valid = "the shape is valid";
    let sphere = Sphere::new(DVec3::ZERO, 1.0).expect(valid);
    shape(harness, "sphere", &arriving, |ray| sphere.crossings(ray, None));
    let inward = Some(Leaving { face: 0, behind: true });
    shape(harness, "sphere, leaving", &leaving, |ray| sphere.crossings(ray, inward));
    let plane = Plane::new(DVec3::ZERO, DVec3::Y).expect(valid);
    shape(harness, "plane", &arriving, |ray| plane.crossings(ray, None));
    let disk = Disk::new(DVec3::ZERO, DVec3::Y, 1.0).expect(valid);
    shape(harness, "disk", &arriving, |ray| disk.crossings(ray, None));
    let corner = DVec3::new(-0.9, 0.0, -0.9);
    let rectangle = Rectangle::new(corner, DVec3::Z * 1.8, DVec3::X * 1.8).expect(valid);
    shape(harness, "rectangle", &arriving, |ray| rectangle.crossings(ray, None));
    let cuboid = Cuboid::new(DVec3::splat(-0.8), DVec3::splat(0.8)).expect(valid);
    shape(harness, "box", &arriving, |ray| cuboid.crossings(ray, None));
    let cylinder = Cylinder::new(DVec3::Y * -0.9, DVec3::Y * 0.9, 0.8, true).expect(valid);
    shape(harness, "cylinder", &arriving, |ray| cylinder.crossings(ray, None));
}

/// The least that a mesh costs: into its frame, one leaf, two triangles (a square in the plane y = 0).
fn triangles(harness: &mut Harness) {
    let corner = |x, z| DVec3::new(x, 0.0, z) * 0.9;
    let positions = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let data = MeshData { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..MeshData::default() };
    let mesh = Shape::Mesh(Arc::new(TriangleMesh::new(data).expect("the mesh is valid")));
    let object = Object::new(mesh, &Transform::IDENTITY, false).expect("the mesh is valid");
    let aggregate = Aggregate::new(vec![object]);
    let rays = arriving();
    harness.measure("intersect/mesh of 2 triangles", INPUTS, || {
        for ray in &rays {
            black_box(aggregate.closest(&Query::new(*ray), &mut Counters::default()));
        }
    });
}
