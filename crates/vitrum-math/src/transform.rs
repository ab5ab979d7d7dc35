//! Affine transforms with their inverse.

use crate::{Bounds, DVec3, Ray, gamma};

/// An affine map `world = linear · object + translation` and its inverse. Rows and dot products instead of a matrix
/// type, so that the order of every addition stands in this file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: Affine,
    inverse: Affine,
}

/// Three rows and a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Affine {
    rows: [DVec3; 3],
    translation: DVec3,
}

/// A transform that can't be undone: some direction is scaled to nothing, or to infinity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularTransform;

impl core::fmt::Display for SingularTransform {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the transform is singular: it flattens the object, so it has no inverse")
    }
}

impl core::error::Error for SingularTransform {}

impl Affine {
    const IDENTITY: Self = Self { rows: [DVec3::X, DVec3::Y, DVec3::Z], translation: DVec3::ZERO };

    #[inline]
    fn vector(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }

    #[inline]
    fn point(&self, p: DVec3) -> DVec3 {
        self.vector(p) + self.translation
    }

    /// The transposed linear part applied to `v`.
    #[inline]
    fn transposed(&self, v: DVec3) -> DVec3 {
        self.rows[0] * v.x + self.rows[1] * v.y + self.rows[2] * v.z
    }

    /// Three products and three additions per coordinate: four roundings on the longest chain.
    fn point_error(&self, p: DVec3, error: f64) -> f64 {
        let row = |i: usize| {
            let row = self.rows[i].abs();
            gamma(4) * (row.dot(p.abs()) + self.translation[i].abs())
                + row.dot(DVec3::splat(error)) * (1.0 + gamma(4))
        };
        row(0).max(row(1)).max(row(2))
    }

    fn then(&self, next: &Self) -> Self {
        Self { rows: next.rows.map(|row| self.transposed(row)), translation: next.point(self.translation) }
    }

    fn inverse(&self) -> Result<Self, SingularTransform> {
        let [a, b, c] = self.rows;
        let determinant = a.dot(b.cross(c));
        let columns = [b.cross(c) / determinant, c.cross(a) / determinant, a.cross(b) / determinant];
        let linear = Self {
            rows: core::array::from_fn(|i| DVec3::new(columns[0][i], columns[1][i], columns[2][i])),
            translation: DVec3::ZERO,
        };
        let inverse = Self { rows: linear.rows, translation: -linear.vector(self.translation) };
        let finite = inverse.rows.iter().all(|r| r.is_finite()) && inverse.translation.is_finite();
        if determinant != 0.0 && finite { Ok(inverse) } else { Err(SingularTransform) }
    }
}

impl Transform {
    /// The map that moves nothing.
    pub const IDENTITY: Self = Self { forward: Affine::IDENTITY, inverse: Affine::IDENTITY };

    /// Moves by `offset` metres.
    pub fn translate(offset: DVec3) -> Self {
        Self {
            forward: Affine { translation: offset, ..Affine::IDENTITY },
            inverse: Affine { translation: -offset, ..Affine::IDENTITY },
        }
    }

    /// Scales each axis by its factor; negative factors mirror.
    ///
    /// # Errors
    /// [`SingularTransform`] when a factor is zero or its reciprocal overflows.
    pub fn scale(factors: DVec3) -> Result<Self, SingularTransform> {
        let diagonal =
            |d: DVec3| Affine { rows: [DVec3::X * d.x, DVec3::Y * d.y, DVec3::Z * d.z], ..Affine::IDENTITY };
        let reciprocal = factors.recip();
        if factors.is_finite() && reciprocal.is_finite() && factors.cmpne(DVec3::ZERO).all() {
            Ok(Self { forward: diagonal(factors), inverse: diagonal(reciprocal) })
        } else {
            Err(SingularTransform)
        }
    }

    /// Turns anticlockwise by `angle` radians around the unit vector `axis` through the origin (Rodrigues' formula).
    pub fn rotate(axis: DVec3, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let turned = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
        let (x, y, z) = (turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z));
        let rows = core::array::from_fn(|i| DVec3::new(x[i], y[i], z[i]));
        Self {
            forward: Affine { rows, translation: DVec3::ZERO },
            inverse: Affine { rows: [x, y, z], translation: DVec3::ZERO },
        }
    }

    /// This transform first, then `next`.
    ///
    /// # Errors
    /// [`SingularTransform`] when the product can no longer be inverted in double precision.
    pub fn then(&self, next: &Self) -> Result<Self, SingularTransform> {
        let forward = self.forward.then(&next.forward);
        Ok(Self { forward, inverse: forward.inverse()? })
    }

    /// A point of the object in the world.
    #[inline]
    pub fn world_point(&self, p: DVec3) -> DVec3 {
        self.forward.point(p)
    }

    /// A vector of the object in the world; its length changes with the scale.
    #[inline]
    pub fn world_vector(&self, v: DVec3) -> DVec3 {
        self.forward.vector(v)
    }

    /// A normal of the object in the world, not unit length: the inverse transposed, with the sign that keeps it on
    /// the same side of its surface.
    #[inline]
    pub fn world_normal(&self, n: DVec3) -> DVec3 {
        self.inverse.transposed(n)
    }

    /// A ray of the world in object space; `t` stays the same number.
    #[inline]
    pub fn object_ray(&self, ray: &Ray) -> Ray {
        Ray::new(self.object_point(ray.origin), self.object_vector(ray.direction))
    }

    /// A point of the world in the object's frame.
    #[inline]
    pub fn object_point(&self, p: DVec3) -> DVec3 {
        self.inverse.point(p)
    }

    /// A vector of the world in the object's frame; its length changes with the scale.
    #[inline]
    pub fn object_vector(&self, v: DVec3) -> DVec3 {
        self.inverse.vector(v)
    }

    /// A bound, per axis and in metres of the world, on the error of [`world_point`](Self::world_point) when every
    /// coordinate of `p` is off by at most `error`.
    pub fn world_error(&self, p: DVec3, error: f64) -> f64 {
        self.forward.point_error(p, error)
    }

    /// The same for [`object_point`](Self::object_point), in units of the object.
    pub fn object_error(&self, p: DVec3, error: f64) -> f64 {
        self.inverse.point_error(p, error)
    }

    /// The uniform scale factor of a similarity (rotation, mirroring, uniform scale, translation); `None` for any
    /// other transform.
    pub fn similarity(&self) -> Option<f64> {
        let [a, b, c] = self.forward.rows;
        let square = a.dot(a);
        let equal = |x: f64, y: f64| (x - y).abs() <= 8.0 * f64::EPSILON * square;
        let similar = equal(b.dot(b), square)
            && equal(c.dot(c), square)
            && equal(a.dot(b), 0.0)
            && equal(b.dot(c), 0.0)
            && equal(c.dot(a), 0.0);
        similar.then(|| square.sqrt())
    }

    /// The box in the world around a box of the object.
    pub fn world_bounds(&self, bounds: &Bounds) -> Bounds {
        Bounds::around(bounds.corners().map(|c| self.world_point(c)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::unit;

    fn composed() -> Transform {
        Transform::scale(DVec3::new(2.0, -3.0, 0.5))
            .and_then(|s| s.then(&Transform::rotate(unit(DVec3::new(1.0, 2.0, -1.0)), 0.7)))
            .and_then(|t| t.then(&Transform::translate(DVec3::new(10.0, -4.0, 1.0))))
            .expect("invertible")
    }

    #[test]
    fn the_first_one_written_is_applied_first() {
        let t =
            Transform::scale(DVec3::splat(2.0)).expect("invertible").then(&Transform::translate(DVec3::X));
        assert_eq!(t.expect("invertible").world_point(DVec3::X), DVec3::new(3.0, 0.0, 0.0));
    }

    #[test]
    fn object_undoes_world() {
        let t = composed();
        let p = DVec3::new(0.3, -0.2, 0.9);
        assert!((t.object_point(t.world_point(p)) - p).length() < 1e-14);
        assert!((t.object_vector(t.world_vector(p)) - p).length() < 1e-14);
    }

    #[test]
    fn normals_stay_perpendicular_and_on_their_side() {
        let t = composed();
        let (n, tangent) = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.7, 0.0, -0.4));
        assert!(t.world_normal(n).dot(t.world_vector(tangent)).abs() < 1e-14);
        assert!(t.world_normal(n).dot(t.world_vector(n)) > 0.0);
    }

    #[test]
    fn rotation_turns_anticlockwise() {
        let quarter = Transform::rotate(DVec3::Y, core::f64::consts::FRAC_PI_2);
        assert!((quarter.world_vector(DVec3::Z) - DVec3::X).length() < 1e-15);
    }

    #[test]
    fn flattening_is_refused() {
        assert_eq!(Transform::scale(DVec3::new(1.0, 0.0, 1.0)), Err(SingularTransform));
        assert_eq!(Transform::scale(DVec3::new(1.0, f64::NAN, 1.0)), Err(SingularTransform));
    }

    #[test]
    fn similarities_are_recognised() {
        let similar = Transform::scale(DVec3::new(-2.0, 2.0, 2.0)).expect("invertible");
        let similar =
            similar.then(&Transform::rotate(unit(DVec3::new(3.0, 1.0, 2.0)), 1.1)).expect("invertible");
        assert!((similar.similarity().expect("a similarity") - 2.0).abs() < 1e-14);
        assert_eq!(composed().similarity(), None);
    }
}
