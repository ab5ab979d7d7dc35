//! The unit frame that a tree lives in, and rays there.
//!
//! v' = (v − centre) · 2^k with the largest extent in [0.5, 1). A ray is brought into it in double precision and, from afar,
//! advanced to the bounds before it is rounded to single precision, so that neither the size of the scene nor its distance from the
//! origin costs accuracy.

use super::lanes::{Doubles, Processor};
use super::{BLOCK, PAD};
use glam::Vec3A;
use vitrum_math::{Bounds, DVec3, Ray, power_of_two_above};

/// A frame in which some bounds have an extent in [0.5, 1) around the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitFrame {
    /// Then zero.
    centre: [f64; 4],
    /// A power of two, so that scaling is exact.
    scale: f64,
    /// One over it.
    unit: f64,
    /// Half of the bounds, padded; then zero.
    half_extent: [f64; 4],
}

/// A ray in a unit frame: as it is, from its true origin, and advanced and rounded.
#[derive(Clone, Copy)]
pub(crate) struct FrameRay {
    pub(crate) exact: ExactRay,
    pub(crate) origin: Vec3A,
    /// The largest component has a magnitude between one half and one.
    pub(crate) direction: Vec3A,
    /// One over the direction, finite.
    pub(crate) reciprocal: Vec3A,
    pub(crate) scale: RayScale,
}

/// A ray in double precision.
#[derive(Clone, Copy)]
pub(crate) struct ExactRay {
    /// Then zero.
    pub(crate) origin: [f64; 4],
    /// Then zero.
    pub(crate) direction: [f64; 4],
    /// As `axes()` has them.
    axes: &'static [Axis; 3],
}

impl ExactRay {
    /// The axes in cyclic order, that of the direction's largest component (after rounding it) last.
    #[inline(always)]
    pub(crate) fn axes(&self) -> [usize; 3] {
        let [x, y, z] = self.axes;
        [x.index(), y.index(), z.index()]
    }

    /// The same as rows of a block of items.
    #[inline(always)]
    pub(crate) fn rows(&self) -> [Row; 3] {
        let [x, y, z] = self.axes();
        [Row(x * BLOCK), Row(y * BLOCK), Row(z * BLOCK)]
    }

    /// The direction as a vector.
    #[inline(always)]
    pub(crate) fn along(&self) -> DVec3 {
        let [x, y, z, _] = self.direction;
        DVec3::new(x, y, z)
    }

    /// The origin as a point.
    #[inline(always)]
    pub(crate) fn from(&self) -> DVec3 {
        let [x, y, z, _] = self.origin;
        DVec3::new(x, y, z)
    }
}

/// The numbers of a block's items along an axis: one row of three.
#[derive(Clone, Copy)]
pub(crate) struct Row(usize);

impl Row {
    /// Where it begins, which the compiler knows to leave room for all of it.
    #[inline(always)]
    #[allow(unsafe_code)]
    pub(crate) fn start(self) -> usize {
        // SAFETY: `ExactRay::rows`, which alone makes them, makes these three.
        unsafe { std::hint::assert_unchecked(self.0 <= 2 * BLOCK) };
        self.0
    }
}

/// How distances along a ray are counted in a unit frame.
#[derive(Clone, Copy)]
pub(crate) struct RayScale {
    /// `t` of the ray that entered the frame times this, which is a power of two, is `t` there.
    per_t: f64,
    /// One over it.
    unit: f64,
    /// Where the advanced ray starts.
    start: f64,
}

/// A coordinate: 0, 1 or 2.
#[derive(Clone, Copy)]
struct Axis(usize);

impl Axis {
    /// The axes in cyclic order, the largest of these magnitudes last.
    #[inline(always)]
    fn towards_largest(x: f32, y: f32, z: f32) -> &'static [Self; 3] {
        static CYCLES: [[Axis; 3]; 3] =
            [[Axis(1), Axis(2), Axis(0)], [Axis(2), Axis(0), Axis(1)], [Axis(0), Axis(1), Axis(2)]];
        let (largest, of_two) = if y >= x { (1, y) } else { (0, x) };
        &CYCLES[if z >= of_two { 2 } else { largest }]
    }

    /// As an index, which the compiler knows to be less than three.
    #[inline(always)]
    #[allow(unsafe_code)]
    fn index(self) -> usize {
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
        Self { centre: four(bounds.centre()), scale, unit: 1.0 / scale, half_extent: four(half_extent) }
    }

    /// A point of the mesh or scene in this frame.
    pub(crate) fn inward(&self, p: DVec3) -> DVec3 {
        (p - self.centre()) * self.scale
    }

    /// A point of this frame in the mesh or scene.
    pub(crate) fn outward(&self, p: DVec3) -> DVec3 {
        p / self.scale + self.centre()
    }

    fn centre(&self) -> DVec3 {
        let [x, y, z, _] = self.centre;
        DVec3::new(x, y, z)
    }

    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// The ray in this frame, or `None` when it comes from afar and misses the bounds or reaches them only beyond `limit` (in
    /// units of `ray`). Directions of unit length are not looked at again.
    #[inline(always)]
    pub(crate) fn enter<P: Processor>(&self, ray: &Ray, is_unit: bool, limit: f64) -> Option<FrameRay> {
        let mut along = P::Exact::new(four(ray.direction));
        let mut direction = along.narrow();
        let mut scale = RayScale { per_t: self.scale, unit: self.unit, start: 0.0 };
        // Unit vectors nearly always pass; the others are of rays in the frames of transformed objects.
        if !is_unit && !(0.5..=1.0).contains(&direction.abs().max_element()) {
            let factor;
            (scale, factor) = self.scale_of(ray.direction);
            along = along.mul(P::Exact::splat(factor));
            direction = along.narrow();
        }
        let from =
            P::Exact::new(four(ray.origin)).sub(P::Exact::new(self.centre)).mul(P::Exact::splat(self.scale));
        let mut origin = from.narrow();
        // Origins near the bounds have small coordinates already.
        if !origin.abs().cmple(Vec3A::ONE).all() {
            scale.start = self.advance(from, along, limit * scale.per_t + f64::from(PAD))?;
            origin = from.add(along.mul(P::Exact::splat(scale.start))).narrow();
        }
        // A component that is (nearly) zero stands for a tiny one: no infinity times zero in the box tests, and the
        // displacement of 1e-20 vanishes in the padding.
        let reciprocal = direction.recip().clamp(Vec3A::splat(-1e20), Vec3A::splat(1e20));
        let magnitude = direction.abs();
        let axes = Axis::towards_largest(magnitude.x, magnitude.y, magnitude.z);
        let exact = ExactRay { origin: from.numbers(), direction: along.numbers(), axes };
        Some(FrameRay { exact, origin, direction, reciprocal, scale })
    }

    /// How distances are counted along a ray with this direction, and what takes the direction into the frame.
    #[cold]
    #[inline(never)]
    fn scale_of(&self, direction: DVec3) -> (RayScale, f64) {
        let per_t = power_of_two_above((direction * self.scale).abs().max_element());
        // Both are powers of two: exact, unless the direction is tinier than anything that transforms make.
        (RayScale { per_t, unit: 1.0 / per_t, start: 0.0 }, self.scale / per_t)
    }

    /// Where a ray comes within the bounds, or `None` when it does not before `limit`.
    #[inline(always)]
    fn advance<D: Doubles>(&self, origin: D, direction: D, limit: f64) -> Option<f64> {
        let half = D::new(self.half_extent).with_signs_of(direction);
        let per_direction = D::splat(1.0).div(direction);
        // Along a plane: infinities of the right signs, or nothing that compares.
        let enter = D::splat(0.0).sub(half).sub(origin).mul(per_direction).max(D::splat(0.0));
        let exit = half.sub(origin).mul(per_direction).min(D::splat(limit));
        let (start, end) = (enter.largest(), exit.least());
        (start <= end).then_some(start)
    }
}

/// A vector and zero.
#[inline(always)]
fn four(v: DVec3) -> [f64; 4] {
    [v.x, v.y, v.z, 0.0]
}

impl RayScale {
    /// A limit of `t` (in units of the ray that entered the frame), for box tests: never too small.
    #[inline(always)]
    pub(crate) fn box_limit(self, t: f64) -> f32 {
        let from_start = t * self.per_t - self.start;
        (from_start as f32 + PAD) * (1.0 + 1e-6)
    }

    /// The same, never too large, by more than what distances to triangles may be wrong.
    #[inline(always)]
    pub(crate) fn sure_limit(self, t: f64) -> f32 {
        let from_start = t * self.per_t - self.start;
        from_start as f32 * (1.0 - 4e-6) - 8e-6
    }

    /// Whether `t` (in units of the ray that entered the frame) is no more than `limit` of the advanced ray.
    pub(crate) fn is_within(self, t: f64, limit: f32) -> bool {
        t * self.per_t - self.start <= f64::from(limit)
    }

    /// `t` of the exact ray in the units of the ray that entered the frame.
    #[inline(always)]
    pub(crate) fn outward(self, t: f64) -> f64 {
        t * self.unit
    }
}
