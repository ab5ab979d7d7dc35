//! An infinite plane.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `point` | any point of it, metres | finite |
//! | `normal` | points to its outside | not zero |
//!
//! One face, never hit again by a ray that leaves it.

use super::{Crossings, Leaving, ShapeError, SurfacePoint, direction, finite, plane_distance};
use crate::uv::tangents;
use vitrum_math::{DVec2, DVec3, Ray};

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Plane {
    /// The plane through `point` that faces `normal` (of any length).
    ///
    /// # Errors
    /// [`ShapeError`] unless both are finite and the normal is not zero.
    pub fn new(point: DVec3, normal: DVec3) -> Result<Self, ShapeError> {
        Ok(Self { point: finite(point, "point")?, normal: direction(normal, "normal")? })
    }

    /// A point of it.
    pub const fn point(&self) -> DVec3 {
        self.point
    }

    /// Its normal, unit length.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Where the line of `ray` crosses the plane.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        match plane_distance(ray, self.point, self.normal) {
            Some(t) if leaving.is_none() => Crossings::one(t, 0),
            _ => Crossings::NONE,
        }
    }

    /// The point at distance `t`, moved onto the plane.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64) -> SurfacePoint {
        let p = ray.at(t);
        SurfacePoint { point: p - self.normal * self.normal.dot(p - self.point), normal: self.normal }
    }

    /// Metres from its point along the tangents.
    pub(crate) fn uv(&self, point: DVec3) -> DVec2 {
        let [right, up] = tangents(self.normal);
        let offset = point - self.point;
        DVec2::new(right.dot(offset), up.dot(offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_crossed_once_and_not_left_twice() {
        let plane = Plane::new(DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, 3.0, 0.0)).expect("valid");
        let ray = Ray::new(DVec3::new(5.0, 4.0, 0.0), DVec3::new(0.0, -2.0, 0.0));
        assert_eq!(plane.crossings(&ray, None), Crossings::one(1.5, 0));
        assert_eq!(plane.surface_point(&ray, 1.5).point, DVec3::new(5.0, 1.0, 0.0));
        assert_eq!(plane.crossings(&ray, Some(Leaving { face: 0, behind: true })), Crossings::NONE);
        let along = Ray::new(DVec3::new(5.0, 1.0, 0.0), DVec3::X);
        assert_eq!(plane.crossings(&along, None), Crossings::NONE);
    }
}
