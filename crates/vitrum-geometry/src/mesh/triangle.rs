//! One triangle and one ray: a watertight test in single precision that finds candidates, and the intersection in double
//! precision that settles them.
//!
//! The test projects the triangle along the ray and looks at the signs of three edge functions. Two triangles that share
//! an edge compute the same number for it, so no ray slips between them; a function that is exactly zero is evaluated
//! again in double precision, where products of single-precision numbers are exact (S. Woop, C. Benthin and I. Wald,
//! Watertight Ray/Triangle Intersection, 2013).

use vitrum_math::{DVec3, Ray, Vec3};

/// What the test needs to know of a ray: the axis of its largest component, and the shear that lays it along that axis.
pub(crate) struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: [f32; 2],
}

/// Weights of the three corners; they sum to one.
pub(crate) type Barycentrics = [f64; 3];

/// A triangle settled in double precision.
pub(crate) struct Settled {
    /// Where on the ray.
    pub(crate) t: f64,
    pub(crate) barycentrics: Barycentrics,
    /// True when double precision put the point (by rounding) outside and it was moved to the border.
    pub(crate) clamped: bool,
}

/// The axis of the largest component, and the two others in cyclic order.
#[inline]
fn axes(direction: Vec3) -> [usize; 3] {
    let d = direction.abs();
    let z = if d.x > d.y { if d.x > d.z { 0 } else { 2 } } else if d.y > d.z { 1 } else { 2 };
    [(z + 1) % 3, (z + 2) % 3, z]
}

impl Sheared {
    #[inline]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let [x, y, z] = axes(direction);
        Self { origin, axes: [x, y, z], shear: [direction[x] / direction[z], direction[y] / direction[z]] }
    }

    /// A corner relative to the ray, in the plane across it.
    #[inline]
    fn project(&self, corner: Vec3) -> [f32; 2] {
        let [x, y, z] = self.axes;
        let p = corner - self.origin;
        [p[x] - self.shear[0] * p[z], p[y] - self.shear[1] * p[z]]
    }

    /// The weights of the corners when the ray's line meets the triangle (border included), from either side.
    #[inline]
    pub(crate) fn test(&self, corners: &[Vec3; 3]) -> Option<Barycentrics> {
        let [a, b, c] = [self.project(corners[0]), self.project(corners[1]), self.project(corners[2])];
        let edge = |p: [f32; 2], q: [f32; 2]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let (u, v, w) = (f64::from(u), f64::from(v), f64::from(w));
        let (u, v, w) = if u == 0.0 || v == 0.0 || w == 0.0 {
            let edge = |p: [f32; 2], q: [f32; 2]| {
                f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0])
            };
            let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
            if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
                return None;
            }
            (u, v, w)
        } else {
            (u, v, w)
        };
        let sum = u + v + w;
        // Seen exactly edge on: the neighbours are hit instead.
        (sum != 0.0).then(|| [u / sum, v / sum, w / sum])
    }
}

/// Intersects again in double precision a triangle that the test has found. `found` are the weights of the test: they stand
/// where double precision sees the triangle edge on.
#[inline]
pub(crate) fn settle(ray: &Ray, corners: &[DVec3; 3], found: Barycentrics) -> Settled {
    let [x, y, z] = axes(ray.direction.as_vec3());
    let d = ray.direction;
    let shear = [d[x] / d[z], d[y] / d[z]];
    let relative = corners.map(|c| c - ray.origin);
    let project = |p: DVec3| [p[x] - shear[0] * p[z], p[y] - shear[1] * p[z]];
    let [a, b, c] = relative.map(project);
    let edge = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    let sum = u + v + w;
    let exact = if sum == 0.0 { found } else { [u / sum, v / sum, w / sum] };
    let clamped = exact.iter().any(|&b| b < 0.0);
    let barycentrics = if clamped { clamp(exact) } else { exact };
    let p = relative[0] * barycentrics[0] + relative[1] * barycentrics[1] + relative[2] * barycentrics[2];
    Settled { t: p.dot(d) / d.dot(d), barycentrics, clamped }
}

/// The weights with negative ones set to zero, summing to one again.
fn clamp(b: Barycentrics) -> Barycentrics {
    let b = b.map(|x| x.max(0.0));
    let sum = b[0] + b[1] + b[2];
    b.map(|x| x / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.5, 0.0, 0.5), Vec3::new(0.0, 0.5, 0.5)];

    #[test]
    fn corners_and_edges_belong_to_the_triangle() {
        for target in [CORNERS[0], CORNERS[1], CORNERS[2], Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.25, 0.0, 0.5)] {
            let sheared = Sheared::new(Vec3::new(target.x, target.y, -0.5), Vec3::Z);
            let b = sheared.test(&CORNERS).expect("on the border");
            assert!((b[0] + b[1] + b[2] - 1.0).abs() < 1e-15);
        }
        assert!(Sheared::new(Vec3::new(0.3, 0.3, -0.5), Vec3::Z).test(&CORNERS).is_none());
    }

    #[test]
    fn settling_gives_the_exact_point() {
        let ray = Ray::new(DVec3::new(0.1, 0.2, -0.5), DVec3::new(0.01, -0.02, 0.9));
        let corners = CORNERS.map(|c| c.as_dvec3());
        let found = Sheared::new(ray.origin.as_vec3(), ray.direction.as_vec3()).test(&CORNERS).expect("hit");
        let settled = settle(&ray, &corners, found);
        assert!((settled.t - 1.0 / 0.9).abs() < 1e-15 && !settled.clamped);
        let p: DVec3 = (0..3).map(|i| corners[i] * settled.barycentrics[i]).fold(DVec3::ZERO, |a, b| a + b);
        assert!((p - ray.at(settled.t)).length() < 2e-16);
    }

    #[test]
    fn a_point_beside_the_triangle_is_moved_to_its_border() {
        let ray = Ray::new(DVec3::new(-1e-9, 0.1, 0.0), DVec3::Z);
        let settled = settle(&ray, &CORNERS.map(|c| c.as_dvec3()), [0.8, 0.0, 0.2]);
        assert!(settled.clamped && settled.barycentrics[1] == 0.0 && (settled.t - 0.5).abs() < 1e-15);
    }
}
