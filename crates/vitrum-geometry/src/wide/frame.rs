//! The unit frame that a tree lives in, and rays there.
//!
//! v' = (v − centre) · 2^k with the largest extent in [0.5, 1). A ray is brought into it in double precision and, from afar,
//! advanced to the bounds before it is rounded to single precision, so that neither the size of the scene nor its distance from the
//! origin costs accuracy.

use super::PAD;
use vitrum_math::{Bounds, DVec3, Ray, Vec3, power_of_two_above};

/// A frame in which some bounds have an extent in [0.5, 1) around the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitFrame {
    centre: DVec3,
    /// A power of two, so that scaling is exact.
    scale: f64,
    /// Half of the bounds, padded.
    half_extent: DVec3,
    /// Of the ball around them.
    radius_squared: f64,
}

/// A ray in a unit frame.
pub(crate) struct FrameRay {
    /// In double precision, as it is; `t` of the world times `t_scale` is `t` here.
    pub(crate) exact: Ray,
    /// A power of two.
    pub(crate) t_scale: f64,
    /// Where the ray comes within the bounds, if it starts far from them: the origin below stands there.
    t_start: f64,
    /// Advanced and rounded.
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    /// One over the direction, finite.
    pub(super) reciprocal: Vec3,
}

impl UnitFrame {
    pub(crate) fn around(bounds: &Bounds) -> Self {
        let extent = bounds.extent().max_element();
        let scale = if extent > 0.0 { 1.0 / power_of_two_above(extent) } else { 1.0 };
        let half_extent = bounds.extent() * (0.5 * scale) + DVec3::splat(f64::from(PAD));
        Self { centre: bounds.centre(), scale, half_extent, radius_squared: half_extent.dot(half_extent) }
    }

    /// A point of the mesh or scene in this frame.
    pub(crate) fn inward(self, p: DVec3) -> DVec3 {
        (p - self.centre) * self.scale
    }

    /// A point of this frame in the mesh or scene.
    pub(crate) fn outward(self, p: DVec3) -> DVec3 {
        p / self.scale + self.centre
    }

    pub(crate) fn scale(self) -> f64 {
        self.scale
    }

    /// The ray in this frame, or `None` when it comes from afar and misses the bounds or reaches them only beyond `limit` (in
    /// units of `ray`).
    #[inline]
    pub(crate) fn enter(&self, ray: &Ray, limit: f64) -> Option<FrameRay> {
        let scaled = ray.direction * self.scale;
        let t_scale = power_of_two_above(scaled.abs().max_element());
        let exact = Ray::new(self.inward(ray.origin), scaled * (1.0 / t_scale));
        // Origins near the bounds have small coordinates already: rays that leave a surface go no further.
        let near = exact.origin.dot(exact.origin) <= self.radius_squared;
        let t_start = if near { 0.0 } else { self.advance(&exact, limit * t_scale + f64::from(PAD))? };
        let direction = exact.direction.as_vec3();
        // A component that is (nearly) zero stands for a tiny one: no infinity times zero below, and the displacement of
        // 1e-20 vanishes in the padding.
        let away_from_zero = |d: f32| if d.abs() < 1e-20 { 1e-20f32.copysign(d) } else { d };
        let reciprocal =
            Vec3::new(away_from_zero(direction.x), away_from_zero(direction.y), away_from_zero(direction.z))
                .recip();
        Some(FrameRay { exact, t_scale, t_start, origin: exact.at(t_start).as_vec3(), direction, reciprocal })
    }
}

impl UnitFrame {
    /// Where a ray comes within the bounds, or `None` when it does not before `limit`.
    #[inline]
    fn advance(&self, ray: &Ray, limit: f64) -> Option<f64> {
        let (mut start, mut end) = (0.0f64, limit);
        for axis in 0..3 {
            let (o, d, half) = (ray.origin[axis], ray.direction[axis], self.half_extent[axis]);
            if d == 0.0 {
                if o.abs() > half {
                    return None;
                }
            } else {
                let r = 1.0 / d;
                let (a, b) = ((-half - o) * r, (half - o) * r);
                start = start.max(a.min(b));
                end = end.min(a.max(b));
            }
        }
        (start <= end).then_some(start)
    }
}

impl FrameRay {
    /// A limit of `t` (in units of the ray that entered the frame), for box tests: never too small.
    #[inline]
    pub(crate) fn box_limit(&self, t: f64) -> f32 {
        let from_start = t * self.t_scale - self.t_start;
        (from_start as f32 + PAD) * (1.0 + 1e-6)
    }
}
