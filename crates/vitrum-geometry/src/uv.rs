//! Texture coordinates: where on an image a point of a surface lies.
//!
//! `u` goes to the right of the image and `v` from its bottom to its top, seen from outside; one image reaches from 0 to 1. They
//! belong to the shape as it is described, before its transform, so that an image moves with its object.
//!
//! | shape | u | v |
//! |---|---|---|
//! | sphere | longitude: 1/2 towards +z, 3/4 towards +x | latitude: 0 at the bottom (−y), 1 at the top |
//! | plane | metres along the first tangent from its point | metres along the second |
//! | disk | the square around it: 1/2 in the middle | the same |
//! | rectangle | along its first edge | along its second |
//! | box | each face along its first tangent | and its second |
//! | cylinder, wall | angle: 1/2 in front | height: 0 at the bottom, 1 at the top |
//! | cylinder, caps | the square around the disk | the same |
//! | mesh | the file's | the file's |
//!
//! Nothing here runs unless a material shows an image: these functions are asked for by a texture, and by nothing else.

use vitrum_math::{DVec2, DVec3};

/// Two directions in the surface with the unit normal `n`, to the right and up as seen against it: x and y, turned with z by the
/// shortest way until z is `n`. On upright walls the second is y; on a floor (normal y) they are x and −z; on a wall that faces −z
/// they are −x and y.
pub(crate) fn tangents(n: DVec3) -> [DVec3; 2] {
    let across = n.x * n.x + n.y * n.y;
    if n.z < 0.0 && across == 0.0 {
        return [-DVec3::X, DVec3::Y];
    }
    // 1/(1 + z), without the difference of equals next to −1.
    let s = if n.z < 0.0 { (1.0 - n.z) / across } else { 1.0 / (1.0 + n.z) };
    let mixed = -n.x * n.y * s;
    [DVec3::new(1.0 - n.x * n.x * s, mixed, -n.x), DVec3::new(mixed, 1.0 - n.y * n.y * s, -n.y)]
}

/// The front and the right of an upright cylinder, z and x, turned with y by the shortest way until y is the unit vector `axis`;
/// upside down they are −z and x.
pub(crate) fn front_and_right(axis: DVec3) -> [DVec3; 2] {
    tangents(DVec3::new(axis.z, axis.x, axis.y)).map(|t| DVec3::new(t.y, t.z, t.x))
}

/// An angle around an axis, from what points to the right and to the front: 1/2 in front, 3/4 to the right, from 0 to 1.
pub(crate) fn turn(right: f64, front: f64) -> f64 {
    0.5 + libm::atan2(right, front) / std::f64::consts::TAU
}

/// A point of a disk in the square around it, from its offset along two tangents over the radius.
pub(crate) fn in_square(right: f64, up: f64) -> DVec2 {
    DVec2::new(0.5 + 0.5 * right, 0.5 + 0.5 * up)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aggregate::{Aggregate, Counters, Hit};
    use crate::departure::Query;
    use crate::mesh::{MeshData, TriangleMesh};
    use crate::object::Object;
    use crate::shape::{Cuboid, Cylinder, Disk, Plane, Rectangle, Shape, Sphere};
    use std::sync::Arc;
    use vitrum_math::{Ray, Transform, unit};

    fn aggregate(shape: Shape, transform: &Transform) -> Aggregate {
        Aggregate::new(vec![Object::with_uvs(shape, transform, false).expect("valid")])
    }

    /// The coordinates where a ray from outside meets a shape.
    fn seen(all: &Aggregate, from: DVec3, towards: DVec3) -> DVec2 {
        let query = Query::new(Ray::new(from, unit(towards)));
        let hit = all.closest(&query, &mut Counters::default()).expect("it is met");
        let point = all.interaction(&query, &hit, &mut Counters::default()).point;
        let uv = all.uv(&hit, point);
        let again = all.uv_at(hit.object, hit.face, point);
        assert!((again - uv).length() < 1e-12, "{again} {uv}: the same from the point alone");
        uv
    }

    fn assert_uv(found: DVec2, u: f64, v: f64) {
        assert!((found - DVec2::new(u, v)).length() < 1e-12, "{found}, expected ({u}, {v})");
    }

    const PLAIN: Transform = Transform::IDENTITY;

    #[test]
    fn tangents_are_orthonormal_upright_and_right_handed() {
        let near_back = unit(DVec3::new(1e-9, -2e-9, -1.0));
        let tiny = DVec3::new(1e-200, 0.0, -1.0);
        let slanted = unit(DVec3::new(-0.3, 0.4, -0.8));
        for n in [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z, near_back, tiny, slanted] {
            let [a, b] = tangents(n);
            for (product, expected) in [(a.dot(a), 1.0), (b.dot(b), 1.0), (a.dot(b), 0.0), (a.dot(n), 0.0)] {
                assert!((product - expected).abs() < 1e-15, "{n}");
            }
            assert!((a.cross(b) - n).length() < 1e-15, "{n}");
        }
        assert_eq!(tangents(DVec3::Y), [DVec3::X, -DVec3::Z]);
        assert_eq!(tangents(-DVec3::X), [DVec3::Z, DVec3::Y]);
        assert_eq!(tangents(-DVec3::Z), [-DVec3::X, DVec3::Y]);
        assert_eq!(front_and_right(DVec3::Y), [DVec3::Z, DVec3::X]);
        assert_eq!(front_and_right(DVec3::Z), [-DVec3::Y, DVec3::X]);
    }

    #[test]
    fn a_sphere_has_longitude_and_latitude() {
        let centre = DVec3::new(1.0, 2.0, 3.0);
        let globe = Shape::Sphere(Sphere::new(centre, 2.0).expect("valid"));
        let all = aggregate(globe.clone(), &PLAIN);
        // 60 degrees east and 30 degrees up: cos 30 (sin 60, ., cos 60), sin 30.
        let (c30, s60) = (0.75_f64.sqrt(), 0.75_f64.sqrt());
        let outward = |d: DVec3| seen(&all, centre + d * 10.0, -d);
        assert_uv(outward(DVec3::Z), 0.5, 0.5);
        assert_uv(outward(DVec3::X), 0.75, 0.5);
        assert_uv(outward(-DVec3::X), 0.25, 0.5);
        assert_uv(outward(DVec3::new(c30 * s60, 0.5, c30 * 0.5)), 0.5 + 60.0 / 360.0, 0.5 + 30.0 / 180.0);
        assert_eq!((outward(DVec3::Y).y, outward(-DVec3::Y).y), (1.0, 0.0));
        // Turned about y by 90 degrees, what faced z faces x; spheres take up their transform, the image goes along.
        let turned = Transform::rotate(DVec3::Y, std::f64::consts::FRAC_PI_2);
        let moved = turned.then(&Transform::translate(DVec3::new(0.0, 5.0, 0.0))).expect("invertible");
        let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).expect("valid"));
        let all = aggregate(ball, &moved);
        assert_uv(seen(&all, DVec3::new(9.0, 5.0, 0.0), -DVec3::X), 0.5, 0.5);
        assert!(Object::new(globe, &moved, false).expect("valid").as_sphere().is_some());
    }

    #[test]
    fn rectangles_go_along_their_edges_mirrored_or_not() {
        let (corner, u, v) =
            (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0));
        let shape = Shape::Rectangle(Rectangle::new(corner, u, v).expect("valid"));
        let at = |all: &Aggregate, x: f64, y: f64| seen(all, DVec3::new(x, y, 5.0), -DVec3::Z);
        let all = aggregate(shape.clone(), &PLAIN);
        assert_uv(at(&all, 0.0, 0.5), 0.25, 0.25);
        assert_uv(at(&all, 2.0, 1.5), 0.75, 0.75);
        let mirrored = Transform::scale(DVec3::new(-1.0, 1.0, 1.0)).expect("invertible");
        let all = aggregate(shape, &mirrored);
        assert_uv(at(&all, 0.0, 0.5), 0.25, 0.25);
        assert_uv(at(&all, -2.0, 1.5), 0.75, 0.75);
    }

    #[test]
    fn a_plane_counts_metres_and_a_disk_fills_its_square() {
        let floor = Shape::Plane(Plane::new(DVec3::new(1.0, 1.0, 1.0), DVec3::Y).expect("valid"));
        let all = aggregate(floor, &PLAIN);
        assert_uv(seen(&all, DVec3::new(3.5, 4.0, -2.0), -DVec3::Y), 2.5, 3.0);
        let disk = Shape::Disk(Disk::new(DVec3::new(0.0, 0.0, 1.0), DVec3::Z, 2.0).expect("valid"));
        let all = aggregate(disk, &PLAIN);
        assert_uv(seen(&all, DVec3::new(1.0, -1.0, 9.0), -DVec3::Z), 0.75, 0.25);
    }

    #[test]
    fn the_faces_of_a_box_are_upright_as_seen_from_outside() {
        let (min, max) = (DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 2.0, 8.0));
        let all = aggregate(Shape::Cuboid(Cuboid::new(min, max).expect("valid")), &PLAIN);
        // The point that lies at (1/4, 3/4) of each face.
        let cases = [
            (DVec3::Z, DVec3::new(1.0, 1.5, 8.0)),
            (-DVec3::Z, DVec3::new(3.0, 1.5, 0.0)),
            (DVec3::X, DVec3::new(4.0, 1.5, 6.0)),
            (-DVec3::X, DVec3::new(0.0, 1.5, 2.0)),
            (DVec3::Y, DVec3::new(1.0, 2.0, 2.0)),
            (-DVec3::Y, DVec3::new(1.0, 0.0, 6.0)),
        ];
        for (outward, point) in cases {
            assert_uv(seen(&all, point + outward * 5.0, -outward), 0.25, 0.75);
        }
    }

    #[test]
    fn a_cylinder_is_a_label_between_two_lids() {
        let upright = Cylinder::new(DVec3::Y, DVec3::new(0.0, 3.0, 0.0), 0.5, true).expect("valid");
        let all = aggregate(Shape::Cylinder(upright), &PLAIN);
        assert_uv(seen(&all, DVec3::new(0.0, 1.5, 9.0), -DVec3::Z), 0.5, 0.25);
        assert_uv(seen(&all, DVec3::new(9.0, 2.5, 0.0), -DVec3::X), 0.75, 0.75);
        // From above, the image's bottom is in front; from below, its top.
        assert_uv(seen(&all, DVec3::new(0.25, 9.0, 0.25), -DVec3::Y), 0.75, 0.25);
        assert_uv(seen(&all, DVec3::new(0.25, -9.0, 0.25), DVec3::Y), 0.75, 0.75);
    }

    #[test]
    fn meshes_interpolate_what_the_file_says() {
        let data = MeshData {
            positions: vec![DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0],
            triangles: vec![[0, 1, 2]],
            uvs: vec![DVec2::new(0.5, 0.0), DVec2::new(2.5, 0.0), DVec2::new(0.5, -4.0)],
            uv_triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        };
        let without = TriangleMesh::new(MeshData { uv_triangles: vec![], ..data.clone() }).expect("valid");
        let mesh = TriangleMesh::new(data.clone()).expect("valid");
        assert!(mesh.has_uvs() && !without.has_uvs());
        // Three corners of two floats, and three indices.
        assert_eq!(mesh.memory() - without.memory(), 3 * 8 + 12);
        let far = Transform::translate(DVec3::new(1e6, -3e6, 7.0));
        for transform in [PLAIN, far] {
            let all = aggregate(Shape::Mesh(Arc::new(mesh.clone())), &transform);
            let from = transform.world_point(DVec3::new(1.0, 2.0, 3.0));
            let query = Query::new(Ray::new(from, -DVec3::Z));
            let hit = all.closest(&query, &mut Counters::default()).expect("it is met");
            let point = all.interaction(&query, &hit, &mut Counters::default()).point;
            // A quarter of the way to the second corner, half of the way to the third.
            assert_uv(all.uv(&hit, point), 1.0, -2.0);
            assert!((all.uv_at(0, 0, point) - DVec2::new(1.0, -2.0)).length() < 1e-8);
        }
        let broken = MeshData { uv_triangles: vec![[0, 1, 3]], ..data };
        assert!(TriangleMesh::new(broken).is_err());
        // A mesh without any has one point of the image everywhere.
        let all = aggregate(Shape::Mesh(Arc::new(without)), &PLAIN);
        let hit = Hit { t: 1.0, object: 0, face: 0, barycentrics: [0.2, 0.3] };
        assert_eq!(all.uv(&hit, DVec3::ZERO), DVec2::ZERO);
    }
}
