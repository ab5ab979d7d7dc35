//! One triangle and one ray: a conservative test in single precision that throws out nearly all candidates, and a
//! watertight one in double precision that decides.
//!
//! Both project the triangle along the ray and look at the signs of three edge functions (S. Woop, C. Benthin and I. Wald,
//! Watertight Ray/Triangle Intersection, 2013). Two triangles that share an edge compute the same number for it, up to the
//! sign and exactly, so no ray slips between them. Deciding in single precision would be watertight too, but within 1e-7 of
//! the mesh's size around an edge it decides for a ray that is not the one asked for; a ray that goes on from there can
//! meet a third triangle that the exact ray never touches.

use vitrum_math::{DVec3, Ray, Vec3};

/// What the conservative test needs to know of a ray: the axis of its largest component, and the shear that lays it along
/// that axis.
pub(crate) struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: [f32; 2],
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

impl Sheared {
    #[inline]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let [x, y, z] = axes(direction.as_dvec3().to_array());
        Self { origin, axes: [x, y, z], shear: [direction[x] / direction[z], direction[y] / direction[z]] }
    }

    /// False when the ray's line misses the triangle for certain.
    ///
    /// In a unit frame, the roundings of the ray and of the projection displace a projected corner by less than 5e-7. With
    /// corners at most `m` from the ray that moves an edge function by less than 4 · 5e-7 · m + 2 (5e-7)².
    #[inline]
    pub(crate) fn may_meet(&self, corners: &[Vec3; 3]) -> bool {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            [p[x] - self.shear[0] * p[z], p[y] - self.shear[1] * p[z]]
        });
        let edge = |p: [f32; 2], q: [f32; 2]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let m = [a, b, c].iter().flatten().fold(0.0f32, |m, x| m.max(x.abs()));
        let margin = 2e-6 * m + 1e-12;
        !((u < -margin || v < -margin || w < -margin) && (u > margin || v > margin || w > margin))
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

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.5, 0.0, 0.5), Vec3::new(0.0, 0.5, 0.5)];

    fn corners() -> [DVec3; 3] {
        CORNERS.map(|c| c.as_dvec3())
    }

    #[test]
    fn corners_and_edges_belong_to_the_triangle() {
        for target in
            [CORNERS[0], CORNERS[1], CORNERS[2], Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.25, 0.0, 0.5)]
        {
            let ray = Ray::new(DVec3::new(f64::from(target.x), f64::from(target.y), -0.5), DVec3::Z);
            assert!(Sheared::new(ray.origin.as_vec3(), Vec3::Z).may_meet(&CORNERS));
            assert_eq!(meet(&ray, &corners()).expect("on the border").t, 1.0);
        }
        let beside = Ray::new(DVec3::new(0.3, 0.3, -0.5), DVec3::Z);
        assert!(!Sheared::new(beside.origin.as_vec3(), Vec3::Z).may_meet(&CORNERS));
        assert!(meet(&beside, &corners()).is_none());
    }

    #[test]
    fn the_point_is_exact() {
        let ray = Ray::new(DVec3::new(0.1, 0.2, -0.5), DVec3::new(0.01, -0.02, 0.9));
        let met = meet(&ray, &corners()).expect("hit");
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
            if meet(&ray, &corners()).is_some() {
                assert!(Sheared::new(origin.as_vec3(), ray.direction.as_vec3()).may_meet(&CORNERS));
            }
        }
    }
}
