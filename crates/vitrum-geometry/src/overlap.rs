//! Which objects reach into each other, as far as their bounds tell; of spheres exactly.

use crate::aggregate::Aggregate;
use crate::object::Object;
use crate::shape::Shape;
use vitrum_math::{Bounds, DVec3, gamma};

/// Half an ulp of coordinates up to a half in single precision, 2^-26, along all three axes: how far the surface of a mesh may be
/// from where it was described, in its unit frame.
const ROUNDED: f64 = 1.0 / (1 << 25) as f64;

/// Calls `meets` with the places of all pairs of boxes that touch, the place of the box that starts first along the longest axis of all
/// coming first.
pub(crate) fn touching(boxes: &[Bounds], mut meets: impl FnMut(usize, usize)) {
    // A sweep: boxes that overlap along the axis are compared in full.
    let extent = boxes.iter().fold(Bounds::EMPTY, |all, b| all.union(*b)).extent();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a].min[axis].total_cmp(&boxes[b].min[axis]));
    for (rank, &a) in order.iter().enumerate() {
        for &b in &order[rank + 1..] {
            if boxes[b].min[axis] > boxes[a].max[axis] {
                break;
            }
            if boxes[a].touches(&boxes[b]) {
                meets(a, b);
            }
        }
    }
}

impl Object {
    /// True when it has an inside: a shape that is closed, or a mesh that nobody has [said](crate::mesh::TriangleMesh::left_open) to
    /// be open.
    pub fn is_closed(&self) -> bool {
        match self.shape() {
            Shape::Mesh(mesh) => !mesh.is_open(),
            _ => self.is_convex_solid(),
        }
    }

    /// A bound on the distance, in metres, between its surface as rays meet it and as it was described: what rounding moves it by.
    pub fn surface_error(&self) -> f64 {
        let (Some(own), Some(world)) = (self.shape().bounds(), self.bounds()) else { return 0.0 };
        let largest = |b: &Bounds| b.min.abs().max(b.max.abs()).max_element();
        let rounded = match self.shape() {
            Shape::Mesh(mesh) => ROUNDED * mesh.unit(),
            _ => 0.0,
        };
        let rounded = rounded + gamma(16) * largest(&own);
        let in_world = self.transform().map_or(rounded, |t| {
            let errors = own.corners().map(|corner| t.world_error(corner, rounded));
            3.0_f64.sqrt() * errors.into_iter().fold(0.0, f64::max)
        });
        in_world + gamma(16) * largest(&world)
    }

    /// False when no point of its surface is within another object, which it may hold: of two spheres exactly, else as far as the box of
    /// the other tells, and of a mesh the boxes of its triangles.
    pub fn surface_may_meet(&self, other: &Self) -> bool {
        let Some(bounds) = other.bounds() else { return true };
        let near = self.surface_error() + other.surface_error();
        match (self.as_sphere(), other.as_sphere()) {
            (Some(own), Some(held)) => {
                let apart = (own.centre() - held.centre()).length();
                apart + held.radius() + near >= own.radius() && apart <= own.radius() + held.radius() + near
            }
            _ => self.surface_may_meet_box(&bounds.padded(near)),
        }
    }

    fn surface_may_meet_box(&self, bounds: &Bounds) -> bool {
        let corners =
            bounds.corners().map(|corner| self.transform().map_or(corner, |t| t.object_point(corner)));
        let inside: &dyn Fn(DVec3) -> bool = match self.shape() {
            Shape::Sphere(s) => &|p| (p - s.centre()).length() < s.radius(),
            Shape::Cuboid(s) => &|p| s.holds(p),
            Shape::Cylinder(s) => &|p| s.holds(p),
            Shape::Mesh(mesh) => return mesh.may_meet(&Bounds::around(corners)),
            Shape::Plane(_) | Shape::Disk(_) | Shape::Rectangle(_) => return true,
        };
        // What is convex holds a box if it holds its corners.
        !corners.into_iter().all(inside)
    }

    /// False when two bounded objects certainly don't share a point. Spheres are compared as they are, others by their boxes.
    pub fn may_overlap(&self, other: &Self) -> bool {
        let (Some(a), Some(b)) = (self.bounds(), other.bounds()) else { return true };
        let near = self.surface_error() + other.surface_error();
        match (self.as_sphere(), other.as_sphere()) {
            (Some(a), Some(b)) => (a.centre() - b.centre()).length() <= a.radius() + b.radius() + near,
            (Some(a), None) => from_box(a.centre(), &b) <= a.radius() + near,
            (None, Some(b)) => from_box(b.centre(), &a) <= b.radius() + near,
            (None, None) => a.padded(near).touches(&b),
        }
    }
}

impl Aggregate {
    /// All pairs of these bounded objects that may overlap, each as (lower, higher), in order.
    pub fn overlaps(&self, among: &[u32]) -> Vec<(u32, u32)> {
        let objects = self.objects();
        let near = |id: &u32| {
            objects[*id as usize].bounds().map(|b| (*id, b.padded(objects[*id as usize].surface_error())))
        };
        let bounded: Vec<(u32, Bounds)> = among.iter().filter_map(near).collect();
        let boxes: Vec<Bounds> = bounded.iter().map(|(_, bounds)| *bounds).collect();
        let mut pairs = Vec::new();
        touching(&boxes, |a, b| {
            let (a, b) = (bounded[a].0, bounded[b].0);
            if objects[a as usize].may_overlap(&objects[b as usize]) {
                pairs.push((a.min(b), a.max(b)));
            }
        });
        pairs.sort_unstable();
        pairs
    }
}

/// The distance of a point from a box; 0 inside.
fn from_box(point: DVec3, b: &Bounds) -> f64 {
    (point - point.clamp(b.min, b.max)).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{MeshData, TriangleMesh};
    use crate::shape::{Cuboid, Cylinder, Plane, Sphere};
    use std::sync::Arc;
    use vitrum_math::Transform;

    fn object(shape: Shape) -> Object {
        Object::new(shape, &Transform::IDENTITY, false).expect("valid")
    }

    fn sphere(centre: [f64; 3], radius: f64) -> Object {
        object(Shape::Sphere(Sphere::new(centre.into(), radius).expect("valid")))
    }

    #[test]
    fn spheres_overlap_where_they_do() {
        let ball = sphere([0.0; 3], 1.0);
        assert!(ball.may_overlap(&sphere([0.2, 0.0, 0.0], 0.1)), "one inside the other");
        assert!(ball.may_overlap(&sphere([2.0, 0.0, 0.0], 1.0)), "touching");
        // Their boxes share a corner.
        assert!(!ball.may_overlap(&sphere([1.5, 1.5, 0.0], 1.0)));
        let at = |x: f64| {
            let (low, high) = (DVec3::new(x, x, x), DVec3::new(x + 1.0, x + 1.0, x + 1.0));
            object(Shape::Cuboid(Cuboid::new(low, high).expect("valid")))
        };
        assert!(!ball.may_overlap(&at(0.6)) && ball.may_overlap(&at(0.57)));
        assert!(at(0.6).may_overlap(&at(1.6)) && !at(0.6).may_overlap(&at(1.6 + 1e-9)));
        let floor = object(Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).expect("valid")));
        assert!(ball.may_overlap(&floor), "what has no bounds may be anywhere");
    }

    #[test]
    fn surfaces_stay_out_of_boxes_that_they_hold() {
        let small = |x: f64| Bounds { min: DVec3::new(x, -0.1, -0.1), max: DVec3::new(x + 0.2, 0.1, 0.1) };
        let ball = sphere([0.0; 3], 1.0);
        let cube = object(Shape::Cuboid(Cuboid::new(-DVec3::ONE, DVec3::ONE).expect("valid")));
        let rod = Cylinder::new(DVec3::NEG_X, DVec3::X, 0.5, true).expect("valid");
        let stretch = Transform::scale(DVec3::new(1.0, 2.0, 2.0)).expect("valid");
        let rod = Object::new(Shape::Cylinder(rod), &stretch, false).expect("valid");
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let corners =
            [[-3.0, -2.0, -2.0], [3.0, -2.0, -2.0], [0.0, -2.0, 4.0], [0.0, 3.0, 0.0]].map(DVec3::from);
        let data = MeshData { positions: corners.to_vec(), triangles: faces.to_vec(), ..MeshData::default() };
        let tetrahedron = object(Shape::Mesh(Arc::new(TriangleMesh::new(data).expect("valid"))));
        for solid in [&ball, &cube, &rod] {
            assert!(!solid.surface_may_meet_box(&small(0.0)) && solid.surface_may_meet_box(&small(0.9)));
        }
        // The boxes of slanted triangles fill more than they do.
        assert!(
            tetrahedron.surface_may_meet_box(&small(0.0)) && !tetrahedron.surface_may_meet_box(&small(9.0))
        );
        // A sphere may hold another whose box reaches out of it.
        let held = sphere([0.5, 0.0, 0.0], 0.49);
        assert!(!ball.surface_may_meet(&held) && held.surface_may_meet(&ball));
        assert!(ball.surface_may_meet(&sphere([0.5, 0.0, 0.0], 0.51)));
        assert!(!ball.surface_may_meet(&sphere([3.0, 0.0, 0.0], 1.0)), "they are apart");
    }

    /// Vertices of a mesh move by less than the bound, at any size and place, and by more than a tenth of it.
    #[test]
    fn the_surface_is_where_the_bound_says() {
        let corners =
            |k: f64| [0.1, 0.7, 1.3, 2.9].map(|s| DVec3::new(s * k, (s * 7.0).sin() * k, 1.1 - s * k));
        let mut worst: f64 = 0.0;
        for step in 1..200 {
            let positions = corners(1.0 + f64::from(step) * 0.013).to_vec();
            let triangles = vec![[0, 1, 2], [0, 2, 3]];
            let data = MeshData { positions: positions.clone(), triangles, ..MeshData::default() };
            let mesh = Arc::new(TriangleMesh::new(data).expect("valid"));
            let transform = Transform::scale(DVec3::new(1.0, 3.0, 0.5)).expect("valid");
            let object = Object::new(Shape::Mesh(Arc::clone(&mesh)), &transform, false).expect("valid");
            for (face, corners) in [[0, 1, 2], [0, 2, 3]].into_iter().enumerate() {
                for (met, described) in mesh.triangle(face as u32).into_iter().zip(corners) {
                    let moved = transform.world_point(met) - transform.world_point(positions[described]);
                    worst = worst.max(moved.length() / object.surface_error());
                }
            }
        }
        assert!(worst <= 1.0 && worst > 0.1, "{worst}");
    }
}
