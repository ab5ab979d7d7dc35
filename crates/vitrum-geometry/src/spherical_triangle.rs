//! A triangle as a point sees it: how large it is there, and points of it, uniform in solid angle.
//!
//! The solid angle Ω of corners at the offsets A, B and C is that of A. van Oosterom and J. Strackee (The Solid Angle of a Plane
//! Triangle, 1983): tan Ω/2 = |A·(B × C)| / (|A||B||C| + (A·B)|C| + (B·C)|A| + (C·A)|B|). The numerator is taken as the product of
//! A and the triangle's normal, which the edges give without loss however far away the point is.
//!
//! A point is chosen as by J. Arvo (Stratified Sampling of Spherical Triangles, 1995): first a corner C' on the arc from A to C,
//! so that A, B and C' enclose the share u of the solid angle, then a point of the arc from B to C'. Arvo finds C' from the angles
//! of the spherical triangle, which say nothing about it where it is small. Here the formula above is solved for it: with the unit
//! vectors a and b, t square to a towards c, and C' at the angle θ from a,
//!
//! tan θ/2 = sin(uΩ/2) (1 + a·b) / (cos(uΩ/2) a·(b × t) − sin(uΩ/2) b·t).
//!
//! Everything after that is ratios of sines, which become the point's barycentric coordinates, so that it never leaves the
//! triangle. Against 60 digits, from a size of one to 1e-8 of the distance, these are wrong by 2e-15 at most, and Ω by 1e-14; what is left of it seen
//! edge on loses its digits with the sine of the elevation, which is why [`SphericalTriangle::new`] refuses that.

use std::f64::consts::PI;
use vitrum_math::DVec3;

/// The sine of the angle between the plane of the triangle and the line of sight below which its solid angle is taken for unknown:
/// it is good to 1e-9 there.
const EDGE_ON: f64 = 1e-7;

/// A triangle around a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphericalTriangle {
    corners: [DVec3; 3],
    lengths: [f64; 3],
    /// |A·(B × C)|
    volume: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The triangle with a corner at the offset `corner` from the point that looks and edges from there; `normal` is their product.
    /// `None` where it is seen edge on.
    #[inline]
    pub(crate) fn new(corner: DVec3, edges: [DVec3; 2], normal: DVec3) -> Option<Self> {
        let corners = [corner, corner + edges[0], corner + edges[1]];
        let lengths = corners.map(DVec3::length);
        let [a, b, c] = corners;
        let [la, lb, lc] = lengths;
        let volume = a.dot(normal).abs();
        let beside = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        // What fills half of the view is known however flat it is.
        if !(beside < 0.0 || volume > EDGE_ON * la * normal.length()) {
            return None;
        }
        let solid_angle = 2.0 * libm::atan2(volume, beside);
        (solid_angle > 0.0 && solid_angle < 2.0 * PI).then_some(Self {
            corners,
            lengths,
            volume,
            solid_angle,
        })
    }

    /// Steradians.
    #[inline]
    pub(crate) fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The shares of both edges in a point of the triangle, for a point of the unit square.
    #[inline]
    pub(crate) fn sample(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [la, lb, lc] = self.lengths;
        let [a, b, c] = [self.corners[0] / la, self.corners[1] / lb, self.corners[2] / lc];
        // The arc from a to c: 1 − cos, sin, and the direction t in which it leaves a.
        let chord = c - a;
        let versine_ac = 0.5 * chord.dot(chord);
        let across = chord + a * versine_ac;
        let sin_ac = across.length();
        let t = across / sin_ac;
        // The arc from a to C'.
        let (sin, cos) = libm::sincos(0.5 * u * self.solid_angle);
        let over = sin * (1.0 + a.dot(b));
        let under = (cos * (self.volume / (la * lb * lc * sin_ac)) - sin * b.dot(t)).max(0.0);
        let squares = over * over + under * under;
        let (sin_theta, versine_theta) = (2.0 * over * under / squares, 2.0 * over * over / squares);
        let of_c = sin_theta / sin_ac;
        let of_a = ((1.0 - versine_theta) - (1.0 - versine_ac) * of_c).max(0.0);
        // The arc from b to C', and how far along it the point lies: uniform in 1 − cos.
        let chord = (a - b) + t * sin_theta - a * versine_theta;
        let versine = 0.5 * chord.dot(chord);
        let sine = |versine: f64| (versine * (2.0 - versine)).max(0.0).sqrt();
        let along = v * versine;
        let (sin_all, sin_along) = (sine(versine), sine(along));
        let of_b = (sin_all * (1.0 - along) - (1.0 - versine) * sin_along).max(0.0);
        let [of_a, of_b, of_c] = [sin_along * of_a / la, of_b / lb, sin_along * of_c / lc];
        let sum = of_a + of_b + of_c;
        if sum > 0.0 { [of_b / sum, of_c / sum] } else { [1.0, 0.0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vitrum_math::unit;
    use vitrum_testkit::Uniform;

    fn seen(corners: [DVec3; 3]) -> Option<SphericalTriangle> {
        let [a, b, c] = corners;
        SphericalTriangle::new(a, [b - a, c - a], (b - a).cross(c - a))
    }

    fn random_direction(uniform: &mut Uniform) -> DVec3 {
        let [u, v] = uniform.pair();
        let z = 1.0 - 2.0 * u;
        let (sin, cos) = libm::sincos(2.0 * PI * v);
        let r = (1.0 - z * z).max(0.0).sqrt();
        unit(DVec3::new(r * cos, r * sin, z))
    }

    /// An octant is an eighth of the sphere; two corners and nearly the opposite of both leave nearly half of it; far away it is
    /// area over the square of the distance, with what the next order of that adds.
    #[test]
    fn solid_angles_have_their_closed_forms() {
        let octant = seen([DVec3::X, DVec3::Y * 3.0, DVec3::Z * 0.2]).expect("in view").solid_angle();
        assert!((octant / (PI / 2.0) - 1.0).abs() < 1e-15);
        let far = 1e6;
        for size in [1.0, 1e-3, 1e-6] {
            let d = DVec3::Z * far;
            let tiny = seen([d, d + DVec3::X * size, d + DVec3::Y * size]).expect("in view").solid_angle();
            assert!((tiny / (0.5 * size * size / (far * far)) - 1.0).abs() < 1e-11, "{size}: {tiny}");
        }
        for height in [1e-2, 1e-4] {
            let corner = |angle: f64| DVec3::new(1e3 * libm::cos(angle), 1e3 * libm::sin(angle), height);
            let huge = seen([0.0, 2.0, 4.0].map(corner)).expect("in view").solid_angle();
            assert!(huge < 2.0 * PI && huge > 2.0 * PI - 1e-2, "{huge}");
        }
        assert!(
            seen([DVec3::X, DVec3::Y, -DVec3::X + DVec3::Y]).is_none(),
            "its plane goes through the point"
        );
        assert!(seen([DVec3::ZERO, DVec3::Y, DVec3::Z]).is_none(), "the point is a corner of it");
    }

    /// The flux through a triangle per unit radiance is a sum over its edges (J. Lambert, 1760): each its angle, times the cosine
    /// between the receiver's normal and the plane of edge and point. The same by directions that are uniform in solid angle: the
    /// midpoints of a grid, in the square root of the second number, which their smoothness is in; they leave an error of the order of
    /// their squared step.
    #[test]
    fn the_flux_through_a_triangle_is_lamberts() {
        let mut uniform = Uniform::new(12);
        let mut tried = 0;
        for number in 0..200 {
            // Sizes from a tenth of the sphere to a thousandth of the distance, needles among them.
            let size = [3.0, 1.0, 0.1, 1e-3][number % 4];
            let thin = if number % 3 == 0 { 1e-3 } else { 1.0 };
            let middle = random_direction(&mut uniform);
            let edges = [random_direction(&mut uniform) * size, random_direction(&mut uniform) * size * thin];
            let corners = [middle, middle + edges[0], middle + edges[1]];
            let Some(triangle) = seen(corners) else { continue };
            // The receiver sees all of it.
            let normal = unit(corners.iter().map(|c| unit(*c)).sum::<DVec3>());
            if corners.iter().any(|corner| unit(*corner).dot(normal) < 0.05) {
                continue;
            }
            tried += 1;
            let lambert: f64 = (0..3)
                .map(|i| {
                    let (a, b) = (unit(corners[i]), unit(corners[(i + 1) % 3]));
                    let across = a.cross(b);
                    let sin = across.length();
                    0.5 * libm::atan2(sin, a.dot(b)) * across.dot(normal) / sin
                })
                .sum::<f64>()
                .abs();
            let edge = 200;
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(edge);
            let mut sum = 0.0;
            for i in 0..edge {
                for j in 0..edge {
                    let [s, t] = triangle.sample([at(i), at(j) * at(j)]);
                    let point = corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * t;
                    sum += unit(point).dot(normal) * 2.0 * at(j);
                }
            }
            let found = sum * triangle.solid_angle() / f64::from(edge * edge);
            // Lambert's sum loses digits where the triangle is small.
            let tolerance = 1e-5 + 1e-14 / triangle.solid_angle();
            assert!((found / lambert - 1.0).abs() < tolerance, "{number}: {found} {lambert} {corners:?}");
        }
        assert!(tried > 100, "{tried}");
    }

    /// Of any share of the unit square, the part with `u` below it fills the same share of the solid angle: the triangle between
    /// the first edge and the point for v = 1.
    #[test]
    fn the_first_number_divides_the_solid_angle() {
        let mut uniform = Uniform::new(5);
        for number in 0..300 {
            let size = [10.0, 1.0, 1e-2, 1e-5, 1e-8][number % 5];
            let middle = random_direction(&mut uniform);
            let edges = [random_direction(&mut uniform), random_direction(&mut uniform)].map(|e| e * size);
            let Some(triangle) = SphericalTriangle::new(middle, edges, edges[0].cross(edges[1])) else {
                continue;
            };
            for u in [0.001, 0.25, 0.5, 0.9, 0.999] {
                let [s, t] = triangle.sample([u, 1.0]);
                // On the edge from the first corner to the third.
                assert!(s.abs() < 1e-7 && (-1e-12..=1.0 + 1e-12).contains(&t), "{number}: {s} {t}");
                let within =
                    SphericalTriangle::new(middle, [edges[0], edges[1] * t], edges[0].cross(edges[1]) * t);
                let share = within.expect("in view").solid_angle() / triangle.solid_angle();
                assert!((share - u).abs() < 1e-7, "{number} {size}: {share} instead of {u}");
            }
        }
    }
}
