//! The unit frame that a tree lives in, and rays there.
//!
//! v' = (v − centre) · 2^k with the largest extent in [0.5, 1). A ray is brought into it in double precision and, from afar,
//! advanced to the bounds before it is rounded to single precision, so that neither the size of the scene nor its distance from the
//! origin costs accuracy.

use super::PAD;
use glam::Vec3A;
use vitrum_math::{Bounds, DVec3, Ray, power_of_two_above};

/// A frame in which some bounds have an extent in [0.5, 1) around the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitFrame {
    centre: DVec3,
    /// A power of two, so that scaling is exact.
    scale: f64,
    /// Half of the bounds, padded.
    half_extent: DVec3,
}

/// A ray in a unit frame, advanced and rounded.
#[derive(Clone, Copy)]
pub(crate) struct FrameRay {
    pub(crate) origin: Vec3A,
    /// The largest component has a magnitude between one half and one.
    pub(crate) direction: Vec3A,
    /// One over the direction, finite.
    pub(crate) reciprocal: Vec3A,
    /// The axis of the largest component last.
    pub(crate) axes: [Axis; 3],
    pub(crate) scale: RayScale,
}

/// How distances along a ray are counted in a unit frame.
#[derive(Clone, Copy)]
pub(crate) struct RayScale {
    /// `t` of the ray that entered the frame times this, which is a power of two, is `t` there.
    per_t: f64,
    /// Where the advanced ray starts.
    start: f64,
}

/// A coordinate: 0, 1 or 2.
#[derive(Clone, Copy)]
pub(crate) struct Axis(usize);

impl Axis {
    /// The axes in cyclic order, the largest of these magnitudes last.
    #[inline(always)]
    pub(crate) fn towards_largest<T: Copy + PartialOrd>(x: T, y: T, z: T) -> [Self; 3] {
        const CYCLES: [[Axis; 3]; 3] =
            [[Axis(1), Axis(2), Axis(0)], [Axis(2), Axis(0), Axis(1)], [Axis(0), Axis(1), Axis(2)]];
        let (largest, of_two) = if y >= x { (1, y) } else { (0, x) };
        CYCLES[if z >= of_two { 2 } else { largest }]
    }

    /// As an index, which the compiler knows to be less than three.
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(crate) fn index(self) -> usize {
        // SAFETY: there are no others (see above).
        unsafe { std::hint::assert_unchecked(self.0 < 3) };
        self.0
    }
}

impl UnitFrame {
    pub(crate) fn around(bounds: &Bounds) -> Self {
        let extent = bounds.extent().max_element();
        let scale = if extent > 0.0 { 1.0 / power_of_two_above(extent) } else { 1.0 };
        let half_extent = bounds.extent() * (0.5 * scale) + DVec3::splat(f64::from(PAD));
        Self { centre: bounds.centre(), scale, half_extent }
    }

    /// A point of the mesh or scene in this frame.
    #[inline(always)]
    pub(crate) fn inward(&self, p: DVec3) -> DVec3 {
        (p - self.centre) * self.scale
    }

    /// A point of this frame in the mesh or scene.
    pub(crate) fn outward(&self, p: DVec3) -> DVec3 {
        p / self.scale + self.centre
    }

    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// The ray in this frame, or `None` when it comes from afar and misses the bounds or reaches them only beyond `limit` (in
    /// units of `ray`).
    #[inline(always)]
    pub(crate) fn enter(&self, ray: &Ray, limit: f64) -> Option<FrameRay> {
        let mut direction = ray.direction.as_vec3a();
        let mut scale = RayScale { per_t: self.scale, start: 0.0 };
        // Unit vectors nearly always pass; the others are of rays in the frames of transformed objects.
        if !(0.5..=1.0).contains(&direction.abs().max_element()) {
            scale.per_t = power_of_two_above((ray.direction * self.scale).abs().max_element());
            direction = self.direction(ray, scale).as_vec3a();
        }
        let exact = self.inward(ray.origin);
        let mut origin = exact.as_vec3a();
        // Origins near the bounds have small coordinates already.
        if !origin.abs().cmple(Vec3A::ONE).all() {
            let direction = self.direction(ray, scale);
            scale.start = self.advance(exact, direction, limit * scale.per_t + f64::from(PAD))?;
            origin = (exact + direction * scale.start).as_vec3a();
        }
        // A component that is (nearly) zero stands for a tiny one: no infinity times zero in the box tests, and the
        // displacement of 1e-20 vanishes in the padding.
        let tiny = Vec3A::splat(1e-20);
        let reciprocal =
            Vec3A::select(direction.abs().cmplt(tiny), tiny.copysign(direction), direction).recip();
        let magnitude = direction.abs();
        let axes = Axis::towards_largest(magnitude.x, magnitude.y, magnitude.z);
        Some(FrameRay { origin, direction, reciprocal, axes, scale })
    }

    /// The direction that belongs to a scale of `t`.
    #[inline(always)]
    fn direction(&self, ray: &Ray, scale: RayScale) -> DVec3 {
        // Both are powers of two: exact, unless the direction is tinier than anything that transforms make.
        ray.direction * (self.scale / scale.per_t)
    }

    /// The ray as it is, in double precision, from its true origin.
    #[inline(always)]
    pub(crate) fn exact(&self, ray: &Ray, scale: RayScale) -> Ray {
        Ray::new(self.inward(ray.origin), self.direction(ray, scale))
    }

    /// Where a ray comes within the bounds, or `None` when it does not before `limit`.
    #[inline(always)]
    fn advance(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<f64> {
        let (mut start, mut end) = (0.0, limit);
        for axis in 0..3 {
            let (o, d) = (origin[axis], direction[axis]);
            // Along a plane: infinities of the right signs, or nothing that compares.
            let (half, per_d) = (self.half_extent[axis].copysign(d), 1.0 / d);
            let (enter, exit) = ((-half - o) * per_d, (half - o) * per_d);
            start = if enter > start { enter } else { start };
            end = if exit < end { exit } else { end };
        }
        (start <= end).then_some(start)
    }
}

impl RayScale {
    /// A limit of `t` (in units of the ray that entered the frame), for box tests: never too small.
    #[inline(always)]
    pub(crate) fn box_limit(self, t: f64) -> f32 {
        let from_start = t * self.per_t - self.start;
        (from_start as f32 + PAD) * (1.0 + 1e-6)
    }

    /// `t` of the exact ray in the units of the ray that entered the frame.
    #[inline(always)]
    pub(crate) fn outward(self, t: f64) -> f64 {
        t * (1.0 / self.per_t)
    }
}
