//! A ray with its history: where it started, and what it has passed.

use crate::shape::{Crossing, Crossings, Leaving};
use vitrum_math::Ray;

/// The surface that a ray starts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// The object.
    pub object: u32,
    /// The face of the object.
    pub face: u32,
    /// True when the ray goes to the side that the shape's own normal points away from.
    pub behind: bool,
    /// For meshes: a bound on the distance between the origin and the true point of the face, in units of the mesh's own
    /// frame. Zero for other shapes.
    pub error: f64,
}

/// A question to the [`Aggregate`](crate::Aggregate).
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// The ray, with a unit direction.
    pub ray: Ray,
    /// The surface that it starts on, if it does.
    pub departed: Option<Departure>,
    /// What it has passed without being changed: only hits beyond count.
    passed: (f64, u32, u32),
}

impl Query {
    /// A ray from free space, such as a camera's.
    #[inline]
    pub fn new(ray: Ray) -> Self {
        Self { ray, departed: None, passed: (f64::NEG_INFINITY, 0, 0) }
    }

    /// A ray that leaves a surface.
    #[inline]
    pub fn leaving(ray: Ray, departed: Departure) -> Self {
        Self { departed: Some(departed), ..Self::new(ray) }
    }

    /// The same ray beyond a hit that it passed straight through: origin and direction stay, only hits that come after
    /// (t, object, face) count from now on.
    #[inline]
    pub fn pass(&mut self, t: f64, object: u32, face: u32) {
        self.passed = (t, object, face);
    }

    /// True when the ray has gone straight through something: it may be anywhere by now.
    #[inline]
    pub(crate) fn has_passed(&self) -> bool {
        self.passed.0 > f64::NEG_INFINITY
    }

    /// How far it has got so.
    #[inline]
    pub(crate) fn passed_at(&self) -> Option<f64> {
        self.has_passed().then_some(self.passed.0)
    }

    /// True for a hit that lies ahead and has not been passed.
    #[inline]
    pub(crate) fn admits(&self, t: f64, object: u32, face: u32) -> bool {
        let (passed, passed_object, passed_face) = self.passed;
        t >= 0.0 && (t > passed || t == passed && (object, face) > (passed_object, passed_face))
    }

    /// The first of the crossings of `object` that counts; at infinity when none does.
    #[inline]
    pub(crate) fn first(&self, Crossings([near, far]): Crossings, object: u32) -> Crossing {
        if self.admits(near.t, object, near.face) {
            near
        } else if self.admits(far.t, object, far.face) {
            far
        } else {
            Crossing::MISSING
        }
    }

    /// The face and side of an analytic `object` that the ray leaves, if it leaves that object.
    #[inline]
    pub(crate) fn face_left(&self, object: u32) -> Option<Leaving> {
        self.departed_from(object).map(|d| Leaving { face: d.face, behind: d.behind })
    }

    /// The departure, when it is from `object`.
    #[inline]
    pub(crate) fn departed_from(&self, object: u32) -> Option<&Departure> {
        self.departed.as_ref().filter(|d| d.object == object)
    }
}
