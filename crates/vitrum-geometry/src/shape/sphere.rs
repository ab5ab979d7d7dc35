//! A sphere.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `centre` | metres | finite |
//! | `radius` | metres | > 0 |
//!
//! Outward normal; one face. The discriminant is formed from the perpendicular foot of the centre on the ray, which does
//! not cancel for far or large spheres, and the roots without a difference of equals (E. Haines, J. Günther and T.
//! Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, Ray Tracing Gems, 2019). Points are re-projected
//! onto the sphere. A ray that leaves the sphere inward starts on it, so the other crossing is `t = −2 f·d / d·d`.

use super::{Crossing, Crossings, Leaving, ShapeError, SurfacePoint, finite, radius};
use crate::uv::turn;
use std::f64::consts::PI;
use vitrum_math::{Bounds, DVec2, DVec3, Ray};

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: DVec3,
    radius: f64,
}

impl Sphere {
    /// A sphere around `centre`, in metres.
    ///
    /// # Errors
    /// [`ShapeError`] unless the centre is finite and the radius positive and finite.
    pub fn new(centre: DVec3, r: f64) -> Result<Self, ShapeError> {
        Ok(Self { centre: finite(centre, "centre")?, radius: radius(r)? })
    }

    /// The middle, in metres.
    pub const fn centre(&self) -> DVec3 {
        self.centre
    }

    /// The radius, in metres.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds::around([self.centre]).padded(self.radius)
    }

    /// Where the line of `ray` crosses the sphere.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        let d = ray.direction;
        let from_centre = ray.origin - self.centre;
        let length_squared = d.dot(d);
        let towards = -from_centre.dot(d);
        if let Some(leaving) = leaving {
            // On a grazing chord rounding may turn the sign; such a ray leaves where it is.
            let other = (2.0 * towards / length_squared).max(0.0);
            return if leaving.behind { Crossings::one(other, 0) } else { Crossings::NONE };
        }
        let foot = from_centre + d * (towards / length_squared);
        let discriminant = self.radius * self.radius - foot.dot(foot);
        if discriminant < 0.0 {
            return Crossings::NONE;
        }
        let q = towards + (discriminant * length_squared).sqrt().copysign(towards);
        let (a, b) = ((from_centre.dot(from_centre) - self.radius * self.radius) / q, q / length_squared);
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        Crossings::two(Crossing { t: near, face: 0 }, Crossing { t: far, face: 0 })
    }

    /// The point at distance `t`.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64) -> SurfacePoint {
        let from_centre = (ray.origin - self.centre) + ray.direction * t;
        let normal = from_centre / from_centre.dot(from_centre).sqrt();
        SurfacePoint { point: self.centre + normal * self.radius, normal }
    }

    /// Longitude and latitude of a point, each from 0 to 1.
    pub(crate) fn uv(&self, point: DVec3) -> DVec2 {
        let p = point - self.centre;
        let latitude = libm::atan2(p.y, (p.x * p.x + p.z * p.z).sqrt());
        DVec2::new(turn(p.x, p.z), 0.5 + latitude / PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vitrum_math::unit;

    fn sphere() -> Sphere {
        Sphere::new(DVec3::new(1.0, 2.0, 3.0), 0.5).expect("valid")
    }

    #[test]
    fn a_line_through_the_centre_crosses_a_diameter_apart() {
        let ray = Ray::new(DVec3::new(1.0, 2.0, 0.0), DVec3::Z);
        let Crossings([near, far]) = sphere().crossings(&ray, None);
        assert_eq!((near.t, far.t), (2.5, 3.5));
        assert_eq!(sphere().surface_point(&ray, 2.5).normal, -DVec3::Z);
    }

    #[test]
    fn lines_beside_it_miss() {
        let ray = Ray::new(DVec3::new(1.0, 2.0 + 0.5 + 1e-12, 0.0), DVec3::Z);
        assert_eq!(sphere().crossings(&ray, None), Crossings::NONE);
    }

    /// Residual of the point and hits at all, for impact parameters up to the rim, from distances of 10 to 10⁶ radii.
    #[test]
    fn far_spheres_are_hit_where_they_are() {
        for distance in [1e1, 1e3, 1e6] {
            for i in 0..1000 {
                let b = 0.999 * f64::from(i) / 1000.0;
                let target = sphere().centre + DVec3::new(b * 0.5, 0.0, 0.0);
                let direction = unit(DVec3::new(0.0, 0.3, 1.0));
                let ray = Ray::new(target - direction * distance * 0.5, direction);
                let Crossings([near, _]) = sphere().crossings(&ray, None);
                assert!(near.t.is_finite(), "missed at b = {b}, distance {distance}");
                let p = sphere().surface_point(&ray, near.t).point;
                assert!(((p - sphere().centre).length() / 0.5 - 1.0).abs() < 4e-15);
            }
        }
    }

    #[test]
    fn leaving_inward_the_other_root_is_a_chord() {
        let s = sphere();
        let start = s.centre + DVec3::new(0.0, 0.0, -0.5);
        let ray = Ray::new(start, unit(DVec3::new(0.2, 0.1, 1.0)));
        let Crossings([next, none]) = s.crossings(&ray, Some(Leaving { face: 0, behind: true }));
        assert!((next.t - 2.0 * 0.5 * ray.direction.z).abs() < 1e-15 && none.t.is_infinite());
        assert_eq!(s.crossings(&ray, Some(Leaving { face: 0, behind: false })), Crossings::NONE);
    }
}
