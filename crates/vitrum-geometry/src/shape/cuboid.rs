//! An axis-aligned box.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `min`, `max` | opposite corners, metres | min < max in each coordinate |
//!
//! Outward normals; face `2 · axis + (1 for the larger coordinate)`. Slabs (T. Kay and J. Kajiya, Ray Tracing Complex
//! Scenes, 1986). The box is convex, so a ray that leaves it outward never comes back, and one that leaves a face inward
//! meets exactly one other.

use super::{Crossing, Crossings, Leaving, ShapeError, SurfacePoint, finite};
use crate::uv::tangents;
use vitrum_math::{Bounds, DVec2, DVec3, Ray};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    min: DVec3,
    max: DVec3,
}

impl Cuboid {
    /// The box between two opposite corners.
    ///
    /// # Errors
    /// [`ShapeError`] unless both are finite and `min` is less than `max` in each coordinate.
    pub fn new(min: DVec3, max: DVec3) -> Result<Self, ShapeError> {
        let (min, max) = (finite(min, "min")?, finite(max, "max")?);
        if min.cmplt(max).all() { Ok(Self { min, max }) } else { Err(ShapeError::EmptyBox) }
    }

    /// Opposite corners: the smallest and the largest coordinates, in metres.
    pub const fn corners(&self) -> (DVec3, DVec3) {
        (self.min, self.max)
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds { min: self.min, max: self.max }
    }

    /// True for points inside, not on its sides.
    pub(crate) fn holds(&self, point: DVec3) -> bool {
        self.min.cmplt(point).all() && point.cmplt(self.max).all()
    }

    /// Where the line of `ray` crosses the box.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        if leaving.is_some_and(|l| !l.behind) {
            return Crossings::NONE;
        }
        let mut near = Crossing { t: f64::NEG_INFINITY, face: 0 };
        let mut far = Crossing { t: f64::INFINITY, face: 0 };
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (2 * axis as u32, 2 * axis as u32 + 1);
            if d == 0.0 {
                // Along this slab: inside it, or never. A ray that left a face inward is inside whatever rounding says.
                if leaving.is_none() && !(self.min[axis]..=self.max[axis]).contains(&o) {
                    return Crossings::NONE;
                }
                continue;
            }
            let (t_low, t_high) = ((self.min[axis] - o) / d, (self.max[axis] - o) / d);
            let (enter, exit) =
                if d > 0.0 { ((t_low, low), (t_high, high)) } else { ((t_high, high), (t_low, low)) };
            if enter.0 > near.t {
                near = Crossing { t: enter.0, face: enter.1 };
            }
            // The face that is being left can't be the exit: a ray that grazes along it would stop at once.
            if exit.0 < far.t && leaving.is_none_or(|l| l.face != exit.1) {
                far = Crossing { t: exit.0, face: exit.1 };
            }
        }
        if leaving.is_some() {
            Crossings::one(far.t.max(0.0), far.face)
        } else if near.t <= far.t {
            Crossings::two(near, far)
        } else {
            Crossings::NONE
        }
    }

    /// The point at distance `t` on `face`.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64, face: u32) -> SurfacePoint {
        let mut point = ray.at(t).clamp(self.min, self.max);
        let mut normal = DVec3::ZERO;
        let axis = (face / 2) as usize;
        let upper = face % 2 == 1;
        point[axis] = if upper { self.max[axis] } else { self.min[axis] };
        normal[axis] = if upper { 1.0 } else { -1.0 };
        SurfacePoint { point, normal }
    }

    /// The place of a point on `face`, each face from 0 to 1 along its tangents.
    pub(crate) fn uv(&self, point: DVec3, face: u32) -> DVec2 {
        let mut normal = DVec3::ZERO;
        normal[(face / 2) as usize] = if face % 2 == 1 { 1.0 } else { -1.0 };
        // Along the axes a tangent picks one coordinate; backwards, it counts from the other end.
        let place = (point - self.min) / (self.max - self.min);
        let along = |tangent: DVec3| {
            let share = tangent.dot(place);
            if tangent.dot(DVec3::ONE) < 0.0 { 1.0 + share } else { share }
        };
        let [right, up] = tangents(normal);
        DVec2::new(along(right), along(up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vitrum_math::unit;

    fn cuboid() -> Cuboid {
        Cuboid::new(DVec3::new(-1.0, 0.0, -2.0), DVec3::new(1.0, 1.0, 2.0)).expect("valid")
    }

    #[test]
    fn enters_and_leaves_by_the_right_faces() {
        let ray = Ray::new(DVec3::new(-3.0, 0.5, 0.0), DVec3::X);
        let Crossings([near, far]) = cuboid().crossings(&ray, None);
        assert_eq!((near.t, near.face, far.t, far.face), (2.0, 0, 4.0, 1));
        assert_eq!(cuboid().surface_point(&ray, 2.0, 0).normal, -DVec3::X);
        let above = Ray::new(DVec3::new(-3.0, 1.5, 0.0), DVec3::X);
        assert_eq!(cuboid().crossings(&above, None), Crossings::NONE);
        let diagonal = Ray::new(DVec3::new(-2.0, 0.5, 0.0), unit(DVec3::new(1.0, 1.0, 0.0)));
        assert_eq!(cuboid().crossings(&diagonal, None), Crossings::NONE);
    }

    #[test]
    fn a_ray_that_leaves_a_face_inward_meets_exactly_one_other() {
        let start = DVec3::new(-1.0, 0.25, 0.5);
        let leaving = |behind| Some(Leaving { face: 0, behind });
        let ray = Ray::new(start, unit(DVec3::new(1.0, 2.0, 0.0)));
        let Crossings([exit, none]) = cuboid().crossings(&ray, leaving(true));
        assert_eq!((exit.face, none.t), (3, f64::INFINITY));
        assert!((ray.at(exit.t).y - 1.0).abs() < 1e-15);
        assert_eq!(cuboid().crossings(&ray, leaving(false)), Crossings::NONE);
        // Grazing along the face that it leaves, even if rounding points it outward.
        let grazing = Ray::new(start, unit(DVec3::new(-1e-17, 1.0, 0.0)));
        let Crossings([exit, _]) = cuboid().crossings(&grazing, leaving(true));
        assert_eq!(exit.face, 3);
    }
}
