//! A flat disk.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `centre` | metres | finite |
//! | `normal` | points to its outside | not zero |
//! | `radius` | metres | > 0 |

use super::{Crossings, Leaving, ShapeError, SurfacePoint, direction, finite, plane_distance, radius};
use crate::uv::{in_square, tangents};
use vitrum_math::{Bounds, DVec2, DVec3, Ray};

/// A flat disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    centre: DVec3,
    normal: DVec3,
    radius: f64,
}

impl Disk {
    /// The disk around `centre` that faces `normal` (of any length).
    ///
    /// # Errors
    /// [`ShapeError`] for parameters that are not finite, a zero normal or a radius that is not positive.
    pub fn new(centre: DVec3, normal: DVec3, r: f64) -> Result<Self, ShapeError> {
        Ok(Self {
            centre: finite(centre, "centre")?,
            normal: direction(normal, "normal")?,
            radius: radius(r)?,
        })
    }

    /// The middle, in metres.
    pub const fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Towards its outside, unit length.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The radius, in metres.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    pub(crate) fn bounds(&self) -> Bounds {
        // The half extent along an axis is r √(1 − n²).
        let half = (DVec3::ONE - self.normal * self.normal).max(DVec3::ZERO);
        let half = DVec3::new(half.x.sqrt(), half.y.sqrt(), half.z.sqrt()) * self.radius;
        Bounds { min: self.centre - half, max: self.centre + half }
    }

    /// Where the line of `ray` crosses the disk.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        match plane_distance(ray, self.centre, self.normal) {
            Some(t) if leaving.is_none() => {
                let offset = self.surface_point(ray, t).point - self.centre;
                if offset.dot(offset) <= self.radius * self.radius {
                    Crossings::one(t, 0)
                } else {
                    Crossings::NONE
                }
            }
            _ => Crossings::NONE,
        }
    }

    /// The point at distance `t`, moved onto the disk's plane.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64) -> SurfacePoint {
        let p = ray.at(t);
        SurfacePoint { point: p - self.normal * self.normal.dot(p - self.centre), normal: self.normal }
    }

    /// The place of a point in the square around the disk.
    pub(crate) fn uv(&self, point: DVec3) -> DVec2 {
        let [right, up] = tangents(self.normal);
        let offset = (point - self.centre) / self.radius;
        in_square(right.dot(offset), up.dot(offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_at_its_radius() {
        let disk = Disk::new(DVec3::Y, DVec3::Y, 2.0).expect("valid");
        let down = |x: f64| disk.crossings(&Ray::new(DVec3::new(x, 3.0, 0.0), -DVec3::Y), None);
        assert_eq!(down(1.999), Crossings::one(2.0, 0));
        assert_eq!(down(2.001), Crossings::NONE);
        assert_eq!(
            disk.bounds(),
            Bounds { min: DVec3::new(-2.0, 1.0, -2.0), max: DVec3::new(2.0, 1.0, 2.0) }
        );
    }
}
