//! Triangles and one ray: a conservative test in single precision that throws out nearly all candidates, eight at a time,
//! and a watertight one in double precision that decides.
//!
//! Both project the triangle along the ray and look at the signs of three edge functions (S. Woop, C. Benthin and I. Wald,
//! Watertight Ray/Triangle Intersection, 2013). Two triangles that share an edge compute the same number for it, up to the
//! sign and exactly, so no ray slips between them. Deciding in single precision would be watertight too, but within 1e-7 of
//! the mesh's size around an edge it decides for a ray that is not the one asked for; a ray that goes on from there can
//! meet a third triangle that the exact ray never touches.

use crate::wide::{BLOCK, Lanes, WideTree};
use vitrum_math::{DVec3, Ray, Vec3};

/// The corners of eight triangles, and which they are.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(crate) struct TriangleBlock {
    /// By corner, axis and triangle.
    corners: [[[f32; BLOCK]; 3]; 3],
    /// [`WideTree::NONE`] where there is no triangle.
    pub(crate) faces: [u32; BLOCK],
}

impl TriangleBlock {
    /// The triangles with these numbers.
    pub(crate) fn new(faces: [u32; BLOCK], corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        // Places without a triangle hold one that is out of the way.
        let mut block = Self { corners: [[[8.0; BLOCK]; 3]; 3], faces };
        block.corners[1][0] = [9.0; BLOCK];
        block.corners[2][1] = [9.0; BLOCK];
        for (lane, &face) in faces.iter().enumerate().filter(|(_, face)| **face != WideTree::NONE) {
            for (corner, position) in corners(face).into_iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis][lane] = position[axis];
                }
            }
        }
        block
    }

    /// The corners of one.
    #[inline(always)]
    pub(crate) fn corners(&self, lane: usize) -> [DVec3; 3] {
        self.corners.map(|axes| {
            let [x, y, z] = axes.map(|lanes| f64::from(lanes[lane]));
            DVec3::new(x, y, z)
        })
    }
}

/// What the conservative test needs to know of a ray: the axis of its largest component, and the shear that lays it along
/// that axis.
pub(crate) struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: [f32; 2],
    per_depth: f32,
}

/// A triangle that the ray's line meets.
pub(crate) struct Met {
    /// Where on the ray.
    pub(crate) t: f64,
    /// Weights of the second and third corner.
    pub(crate) barycentrics: [f64; 2],
}

/// The axis of the largest component, and the two others in cyclic order.
#[inline]
fn axes(d: [f64; 3]) -> [usize; 3] {
    let [x, y, z] = d.map(f64::abs);
    let largest = if x > y {
        if x > z { 0 } else { 2 }
    } else if y > z {
        1
    } else {
        2
    };
    [(largest + 1) % 3, (largest + 2) % 3, largest]
}

/// How far the roundings of the ray may move a point along it, in units of the frame.
const DEPTH_PAD: f32 = 4e-6;

impl Sheared {
    /// A ray that was advanced and rounded.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let d = direction.abs();
        let largest = if d.x > d.y {
            if d.x > d.z { 0 } else { 2 }
        } else if d.y > d.z {
            1
        } else {
            2
        };
        let [x, y, z] = [(largest + 1) % 3, (largest + 2) % 3, largest];
        let per_depth = 1.0 / direction[z];
        Self {
            origin,
            axes: [x, y, z],
            shear: [direction[x] * per_depth, direction[y] * per_depth],
            per_depth,
        }
    }

    /// A bit for each triangle of the block that the ray may meet before `limit`; the others it misses for certain.
    ///
    /// In a unit frame, the roundings of the ray and of the projection displace a projected corner by less than 5e-7. With
    /// corners at most `m` from the ray that moves an edge function by less than 4 · 5e-7 · m + 2 (5e-7)². The point that is
    /// met lies no nearer than the nearest corner and no farther than the farthest.
    #[inline(always)]
    pub(crate) fn may_meet<L: Lanes>(&self, block: &TriangleBlock, limit: f32) -> u32 {
        // No closures here: they would be compiled for any processor.
        let project = Projection {
            axes: self.axes,
            shear: [L::splat(-self.shear[0]), L::splat(-self.shear[1])],
            origin: [
                L::splat(self.origin[self.axes[0]]),
                L::splat(self.origin[self.axes[1]]),
                L::splat(self.origin[self.axes[2]]),
            ],
        };
        let a = project.corner(&block.corners[0]);
        let b = project.corner(&block.corners[1]);
        let c = project.corner(&block.corners[2]);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let m = largest(a).max(largest(b)).max(largest(c));
        let margin = m.mul_add(L::splat(2e-6), L::splat(1e-12));
        let least = u.min(v).min(w);
        let most = u.max(v).max(w);
        // Misses where one is surely negative and another surely positive.
        let crossed = L::splat(0.0).sub(margin).at_most(least) | most.at_most(margin);

        let per_depth = L::splat(self.per_depth);
        let (a, b, c) = (a[2].mul(per_depth), b[2].mul(per_depth), c[2].mul(per_depth));
        let (nearest, farthest) = (a.min(b).min(c), a.max(b).max(c));
        let ahead = L::splat(-DEPTH_PAD).at_most(farthest) & nearest.at_most(L::splat(limit + DEPTH_PAD));
        crossed & ahead
    }
}

/// Where the ray's line meets the triangle, border included, from either side; `None` when it misses, or sees the triangle
/// exactly edge on: then it meets the neighbours instead.
#[inline]
pub(crate) fn meet(ray: &Ray, corners: &[DVec3; 3]) -> Option<Met> {
    let d = ray.direction;
    let [x, y, z] = axes(d.to_array());
    let shear = [d[x] / d[z], d[y] / d[z]];
    let relative = corners.map(|c| c - ray.origin);
    let [a, b, c] = relative.map(|p| [p[x] - shear[0] * p[z], p[y] - shear[1] * p[z]]);
    let edge = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    let sum = u + v + w;
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) || sum == 0.0 {
        return None;
    }
    let (u, v, w) = (u / sum, v / sum, w / sum);
    let p = relative[0] * u + relative[1] * v + relative[2] * w;
    Some(Met { t: p.dot(d) / d.dot(d), barycentrics: [v, w] })
}

/// How corners are laid along the ray.
struct Projection<L> {
    axes: [usize; 3],
    /// Negative.
    shear: [L; 2],
    origin: [L; 3],
}

impl<L: Lanes> Projection<L> {
    /// Across the ray, twice, and along it.
    #[inline(always)]
    fn corner(&self, axes: &[[f32; BLOCK]; 3]) -> [L; 3] {
        let x = L::load(&axes[self.axes[0]]).sub(self.origin[0]);
        let y = L::load(&axes[self.axes[1]]).sub(self.origin[1]);
        let z = L::load(&axes[self.axes[2]]).sub(self.origin[2]);
        [z.mul_add(self.shear[0], x), z.mul_add(self.shear[1], y), z]
    }
}

#[inline(always)]
fn edge<L: Lanes>(p: [L; 3], q: [L; 3]) -> L {
    p[0].mul(q[1]).sub(p[1].mul(q[0]))
}

#[inline(always)]
fn largest<L: Lanes>(p: [L; 3]) -> L {
    p[0].abs().max(p[1].abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::Portable;

    const CORNERS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.5, 0.0, 0.5), Vec3::new(0.0, 0.5, 0.5)];

    fn corners() -> [DVec3; 3] {
        CORNERS.map(|c| c.as_dvec3())
    }

    /// The triangle in one place of a block that is otherwise empty.
    fn block(lane: usize) -> TriangleBlock {
        let mut faces = [WideTree::NONE; BLOCK];
        faces[lane] = 3;
        TriangleBlock::new(faces, |_| CORNERS)
    }

    fn may_meet(ray: &Ray, limit: f32) -> bool {
        let sheared = Sheared::new(ray.origin.as_vec3(), ray.direction.as_vec3());
        let found = [0, 5].map(|lane| sheared.may_meet::<Portable>(&block(lane), limit) >> lane & 1 == 1);
        assert_eq!(found[0], found[1], "every lane is alike");
        found[0]
    }

    fn meet(ray: &Ray) -> Option<Met> {
        super::meet(ray, &corners())
    }

    #[test]
    fn corners_and_edges_belong_to_the_triangle() {
        for target in
            [CORNERS[0], CORNERS[1], CORNERS[2], Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.25, 0.0, 0.5)]
        {
            let ray = Ray::new(DVec3::new(f64::from(target.x), f64::from(target.y), -0.5), DVec3::Z);
            assert!(may_meet(&ray, f32::INFINITY));
            assert_eq!(meet(&ray).expect("on the border").t, 1.0);
        }
        let beside = Ray::new(DVec3::new(0.3, 0.3, -0.5), DVec3::Z);
        assert!(!may_meet(&beside, f32::INFINITY));
        assert!(meet(&beside).is_none());
    }

    #[test]
    fn what_lies_behind_or_beyond_the_limit_is_thrown_out() {
        let towards = Ray::new(DVec3::new(0.1, 0.1, -0.5), DVec3::Z);
        assert!(may_meet(&towards, 1.0) && !may_meet(&towards, 0.99));
        let away = Ray::new(towards.origin, -DVec3::Z);
        assert!(!may_meet(&away, f32::INFINITY));
        let on_it = Ray::new(DVec3::new(0.1, 0.1, 0.5), DVec3::Z);
        assert!(may_meet(&on_it, 0.0));
    }

    #[test]
    fn the_point_is_exact() {
        let ray = Ray::new(DVec3::new(0.1, 0.2, -0.5), DVec3::new(0.01, -0.02, 0.9));
        let met = meet(&ray).expect("hit");
        assert!((met.t - 1.0 / 0.9).abs() < 1e-15);
        let [v, w] = met.barycentrics;
        let p = corners()[0] * (1.0 - v - w) + corners()[1] * v + corners()[2] * w;
        assert!((p - ray.at(met.t)).length() < 2e-16);
    }

    /// Whatever double precision meets, the conservative test lets through, also for rays within a rounding of the border.
    #[test]
    fn the_conservative_test_loses_nothing() {
        let n = 400;
        for i in 0..n * n {
            let (s, t) = (f64::from(i % n) / f64::from(n), f64::from(i / n) / f64::from(n));
            let on_edge = DVec3::new(0.5 * s, 0.5 * (1.0 - s), 0.5) * (1.0 - 1e-15);
            let origin = DVec3::new(0.3 - t, t - 0.6, -0.45);
            let ray = Ray::new(origin, on_edge - origin);
            if let Some(met) = meet(&ray) {
                assert!(may_meet(&ray, met.t as f32));
            }
        }
    }
}
