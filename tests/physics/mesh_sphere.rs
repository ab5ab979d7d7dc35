//! A mesh sphere converges to the analytic one: hit distance and, with interpolated normals, refracted direction with the
//! square of the edge length, refracted direction with face normals with its first power.

use crate::chain::transmit;
use crate::stage::{camera, clear_glass, object, unit_sphere, white};
use std::collections::BTreeMap;
use std::sync::Arc;
use vitrum::geometry::mesh::{MeshData, TriangleMesh};
use vitrum::geometry::{Counters, Query, Shape};
use vitrum::math::{DVec3, Ray, unit};
use vitrum::tracer::{Projection, Scene};

/// The octahedron, each face divided `level` times into four, on the unit sphere.
pub(crate) fn subdivided(level: u32, smooth: bool) -> Shape {
    let mut positions = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push(unit(positions[a as usize] + positions[b as usize]));
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let (normals, normal_triangles) =
        if smooth { (positions.clone(), triangles.clone()) } else { (vec![], vec![]) };
    let data = MeshData { positions, triangles, normals, normal_triangles, ..MeshData::default() };
    Shape::Mesh(Arc::new(TriangleMesh::new(data).expect("valid mesh")))
}

fn scene(shape: Shape) -> Scene {
    white(
        vec![object("ball", shape, clear_glass(0.0, 1.0, 1.0, 1.5))],
        camera(Projection::Pinhole { fov: 1.0 }, 5.0),
    )
}

/// Rays that meet the sphere at up to 0.8 radii from its centre.
fn rays() -> impl Iterator<Item = Ray> {
    (0..400).map(|i| {
        let (r, phi) = (0.8 * (f64::from(i) / 400.0).sqrt(), f64::from(i) * 2.399_963);
        let direction = unit(DVec3::new(0.3, -0.5, -1.0));
        let across = unit(direction.cross(DVec3::Y));
        let target = across * (r * phi.cos()) + direction.cross(across) * (r * phi.sin());
        Ray::new(target - direction * 3.0, direction)
    })
}

/// Root mean square over the rays of the differences in hit distance and in direction after the first crossing.
fn errors(mesh: &Scene, sphere: &Scene) -> [f64; 2] {
    let distance = |scene: &Scene, ray: Ray| {
        scene.aggregate().closest(&Query::new(ray), &mut Counters::default()).expect("hit").t
    };
    let direction = |scene: &Scene, ray: Ray| transmit(scene, ray, 1).expect("refracted").direction;
    let mut squares = [0.0; 2];
    for ray in rays() {
        squares[0] += (distance(mesh, ray) - distance(sphere, ray)).powi(2);
        squares[1] += (direction(mesh, ray) - direction(sphere, ray)).length_squared();
    }
    squares.map(|s| (s / 400.0).sqrt())
}

#[test]
fn converges_at_the_orders_of_linear_interpolation() {
    let sphere = scene(unit_sphere());
    for (smooth, orders) in [(true, [2.0, 2.0]), (false, [2.0, 1.0])] {
        let errors: Vec<[f64; 2]> = (3..=6).map(|l| errors(&scene(subdivided(l, smooth)), &sphere)).collect();
        for pair in errors.windows(2) {
            for i in 0..2 {
                let order = (pair[0][i] / pair[1][i]).log2();
                println!("smooth {smooth}, quantity {i}: error {:.3e}, order {order:.2}", pair[1][i]);
                // Each division halves the edges only nearly, and the rays meet different parts of the faces.
                assert!((order - orders[i]).abs() < 0.2, "smooth {smooth}, quantity {i}: order {order}");
            }
        }
    }
}
