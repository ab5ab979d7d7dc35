//! A right circular cylinder, capped (a solid) or open (a tube without thickness).
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `bottom`, `top` | ends of the axis, metres | apart |
//! | `radius` | metres | > 0 |
//! | `capped` | closed by two disks | |
//!
//! Outward normals; face 0 is the wall, 1 the bottom cap, 2 the top cap. The roots on the wall use the perpendicular foot
//! on the axis, as on a sphere. A capped cylinder is convex: a ray that leaves it outward never comes back, and one that
//! leaves inward meets exactly one face.

use super::{Crossing, Crossings, Leaving, ShapeError, SurfacePoint, direction, finite, radius};
use crate::uv::{front_and_right, in_square, turn};
use vitrum_math::{Bounds, DVec2, DVec3, Ray};

const WALL: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// A right circular cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    bottom: DVec3,
    axis: DVec3,
    height: f64,
    radius: f64,
    capped: bool,
}

impl Cylinder {
    /// The cylinder around the axis from `bottom` to `top`.
    ///
    /// # Errors
    /// [`ShapeError`] for parameters that are not finite, ends that coincide or a radius that is not positive.
    pub fn new(bottom: DVec3, top: DVec3, r: f64, capped: bool) -> Result<Self, ShapeError> {
        let (bottom, top) = (finite(bottom, "bottom")?, finite(top, "top")?);
        let axis = direction(top - bottom, "axis from `bottom` to `top`")?;
        Ok(Self { bottom, axis, height: (top - bottom).length(), radius: radius(r)?, capped })
    }

    /// True for a solid.
    pub const fn is_capped(&self) -> bool {
        self.capped
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let half = (DVec3::ONE - self.axis * self.axis).max(DVec3::ZERO);
        let half = DVec3::new(half.x.sqrt(), half.y.sqrt(), half.z.sqrt()) * self.radius;
        let top = self.bottom + self.axis * self.height;
        let disk = |c: DVec3| Bounds { min: c - half, max: c + half };
        disk(self.bottom).union(disk(top))
    }

    /// True for points inside, not on its surface.
    pub(crate) fn holds(&self, point: DVec3) -> bool {
        let offset = point - self.bottom;
        let along = offset.dot(self.axis);
        along > 0.0 && along < self.height && (offset - self.axis * along).length() < self.radius
    }

    /// Where the line of `ray` crosses the cylinder.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        match leaving {
            // An open tube seen from outside, or a solid that is left: no way back, since both are convex.
            Some(Leaving { behind: false, .. }) => Crossings::NONE,
            Some(leaving) => self.next_inside(ray, leaving.face),
            None => self.along_line(ray),
        }
    }

    /// The crossings of the infinite wall; `None` when the line runs beside it, or inside it along the axis (then with
    /// infinite ends).
    #[inline]
    fn wall(&self, ray: &Ray) -> Option<(f64, f64)> {
        let offset = ray.origin - self.bottom;
        let across = |v: DVec3| v - self.axis * self.axis.dot(v);
        let (o, d) = (across(offset), across(ray.direction));
        let length_squared = d.dot(d);
        let radius_squared = self.radius * self.radius;
        if length_squared == 0.0 {
            return (o.dot(o) <= radius_squared).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let towards = -o.dot(d);
        let foot = o + d * (towards / length_squared);
        let discriminant = radius_squared - foot.dot(foot);
        if discriminant < 0.0 {
            return None;
        }
        let q = towards + (discriminant * length_squared).sqrt().copysign(towards);
        let (a, b) = ((o.dot(o) - radius_squared) / q, q / length_squared);
        Some(if a < b { (a, b) } else { (b, a) })
    }

    /// Where the line enters and leaves the slab between the planes of the caps; `None` when it runs beside them.
    #[inline]
    fn slab(&self, ray: &Ray) -> Option<(Crossing, Crossing)> {
        let (height, climb) = (self.axis.dot(ray.origin - self.bottom), self.axis.dot(ray.direction));
        if climb == 0.0 {
            let everywhere =
                (Crossing { t: f64::NEG_INFINITY, face: BOTTOM }, Crossing { t: f64::INFINITY, face: TOP });
            return (0.0..=self.height).contains(&height).then_some(everywhere);
        }
        let bottom = Crossing { t: -height / climb, face: BOTTOM };
        let top = Crossing { t: (self.height - height) / climb, face: TOP };
        Some(if climb > 0.0 { (bottom, top) } else { (top, bottom) })
    }

    #[inline]
    fn along_line(&self, ray: &Ray) -> Crossings {
        let (Some((wall_near, wall_far)), Some((slab_near, slab_far))) = (self.wall(ray), self.slab(ray))
        else {
            return Crossings::NONE;
        };
        let wall = |t: f64| Crossing { t, face: WALL };
        if self.capped {
            let near = if slab_near.t > wall_near { slab_near } else { wall(wall_near) };
            let far = if slab_far.t < wall_far { slab_far } else { wall(wall_far) };
            return if near.t <= far.t { Crossings::two(near, far) } else { Crossings::NONE };
        }
        let within = |t: f64| t.is_finite() && (slab_near.t..=slab_far.t).contains(&t);
        match (within(wall_near), within(wall_far)) {
            (true, true) => Crossings::two(wall(wall_near), wall(wall_far)),
            (true, false) => Crossings::one(wall_near, WALL),
            (false, true) => Crossings::one(wall_far, WALL),
            (false, false) => Crossings::NONE,
        }
    }

    /// The next crossing of a ray that left `face` to the inside.
    #[inline]
    fn next_inside(&self, ray: &Ray, face: u32) -> Crossings {
        let offset = ray.origin - self.bottom;
        let across = |v: DVec3| v - self.axis * self.axis.dot(v);
        let (o, d) = (across(offset), across(ray.direction));
        let length_squared = d.dot(d);
        let wall_t = if length_squared == 0.0 {
            f64::INFINITY
        } else if face == WALL {
            // The origin is on the wall, so the other root needs no square root.
            (-2.0 * o.dot(d) / length_squared).max(0.0)
        } else {
            self.wall(ray).map_or(0.0, |(_, far)| far.max(0.0))
        };
        let climb = self.axis.dot(ray.direction);
        let height = self.axis.dot(offset);
        let (cap_t, cap) =
            if climb > 0.0 { ((self.height - height) / climb, TOP) } else { (-height / climb, BOTTOM) };
        let reaches_cap = climb != 0.0 && cap_t < wall_t;
        match (self.capped, reaches_cap) {
            // The face that is left can't be met again, even if rounding points a grazing ray at it.
            (true, true) if cap != face => Crossings::one(cap_t.max(0.0), cap),
            (false, true) => Crossings::NONE,
            _ => Crossings::one(wall_t, WALL),
        }
    }

    /// The point at distance `t` on `face`.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64, face: u32) -> SurfacePoint {
        let offset = (ray.origin - self.bottom) + ray.direction * t;
        let height = self.axis.dot(offset);
        let across = offset - self.axis * height;
        match face {
            BOTTOM => SurfacePoint { point: self.bottom + across, normal: -self.axis },
            TOP => SurfacePoint { point: self.bottom + self.axis * self.height + across, normal: self.axis },
            _ => {
                let normal = across / across.dot(across).sqrt();
                let height = height.clamp(0.0, self.height);
                SurfacePoint { point: self.bottom + self.axis * height + normal * self.radius, normal }
            }
        }
    }

    /// Angle and height of a point of the wall; the place of a point of a cap in the square around it.
    pub(crate) fn uv(&self, point: DVec3, face: u32) -> DVec2 {
        let [front, right] = front_and_right(self.axis);
        let offset = point - self.bottom;
        let (front, right) = (front.dot(offset), right.dot(offset));
        match face {
            BOTTOM => in_square(right / self.radius, front / self.radius),
            TOP => in_square(right / self.radius, -front / self.radius),
            _ => DVec2::new(turn(right, front), self.axis.dot(offset) / self.height),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vitrum_math::unit;

    fn cylinder(capped: bool) -> Cylinder {
        Cylinder::new(DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0), 0.5, capped).expect("valid")
    }

    fn faces(c: &Cylinder, ray: &Ray) -> Vec<(f64, u32)> {
        c.crossings(ray, None).0.iter().filter(|c| c.t.is_finite()).map(|c| (c.t, c.face)).collect()
    }

    #[test]
    fn caps_close_it() {
        let down = Ray::new(DVec3::new(0.1, 3.0, 0.0), -DVec3::Y);
        assert_eq!(faces(&cylinder(true), &down), [(1.0, TOP), (3.0, BOTTOM)]);
        assert_eq!(faces(&cylinder(false), &down), []);
        let side = Ray::new(DVec3::new(-2.0, 1.0, 0.0), DVec3::X);
        assert_eq!(faces(&cylinder(true), &side), [(1.5, WALL), (2.5, WALL)]);
        assert_eq!(faces(&cylinder(false), &side), [(1.5, WALL), (2.5, WALL)]);
        let slanted = Ray::new(DVec3::new(-1.5, 1.0, 0.0), unit(DVec3::new(1.0, 0.7, 0.0)));
        let hits = faces(&cylinder(true), &slanted);
        assert_eq!((hits[0].1, hits[1].1), (WALL, TOP));
        assert_eq!(faces(&cylinder(false), &slanted).len(), 1);
    }

    #[test]
    fn inside_exactly_one_face_is_next() {
        let c = cylinder(true);
        let from_wall = Ray::new(DVec3::new(-0.5, 1.0, 0.0), unit(DVec3::new(1.0, 0.1, 0.2)));
        let next = c.crossings(&from_wall, Some(Leaving { face: WALL, behind: true })).0[0];
        assert_eq!(next.face, WALL);
        let p = c.surface_point(&from_wall, next.t, WALL).point;
        assert!((p.x.hypot(p.z) - 0.5).abs() < 1e-15);
        let from_cap = Ray::new(DVec3::new(0.2, 2.0, 0.0), unit(DVec3::new(0.01, -1.0, 0.0)));
        assert_eq!(c.crossings(&from_cap, Some(Leaving { face: TOP, behind: true })).0[0].face, BOTTOM);
        assert_eq!(c.crossings(&from_cap, Some(Leaving { face: TOP, behind: false })), Crossings::NONE);
        let grazing = Ray::new(DVec3::new(0.0, 2.0, 0.0), unit(DVec3::new(1.0, 1e-17, 0.0)));
        assert_eq!(c.crossings(&grazing, Some(Leaving { face: TOP, behind: true })).0[0].face, WALL);
    }

    #[test]
    fn bounds_hold_a_slanted_one() {
        let c = Cylinder::new(DVec3::ZERO, DVec3::ONE, 0.5, true).expect("valid");
        let b = c.bounds();
        for angle in 0..100 {
            let (sin, cos) = (f64::from(angle) * 0.0628).sin_cos();
            let (x, y) = (unit(DVec3::new(1.0, -1.0, 0.0)), unit(DVec3::new(1.0, 1.0, -2.0)));
            for end in [DVec3::ZERO, DVec3::ONE] {
                let p = end + (x * cos + y * sin) * 0.5;
                assert!(p.cmpge(b.min - 1e-15).all() && p.cmple(b.max + 1e-15).all());
            }
        }
    }
}
