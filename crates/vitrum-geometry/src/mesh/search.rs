//! The two searches for triangles that a ray hits: for the nearest, and for any.
//!
//! What single precision is certain of (see [`triangle`](super::triangle)) needs no more than that while the search goes
//! on. Everything else is settled in double precision at once: triangles met near their borders, close to where the ray
//! starts, behind what it has passed, or no farther apart than the bounds on their distances.

use super::TriangleMesh;
use super::triangle::{Sheared, TriangleBlock, meet_for_certain};
use super::triangle_mesh::Candidate;
use crate::aggregate::{Counters, Hit, Nearest};
use crate::departure::Query;
use crate::wide::{BLOCK, FrameRay, Part, Processor, RayScale, Task, Visitor};
use std::ops::ControlFlow;
use vitrum_math::Ray;

/// Looks for the first triangle that counts.
pub(super) struct ClosestHit<'a> {
    pub(super) mesh: &'a TriangleMesh,
    pub(super) ray: &'a Ray,
    pub(super) query: &'a Query,
    pub(super) object: u32,
    pub(super) nearest: &'a mut Nearest,
    pub(super) counters: &'a mut Counters,
}

/// Looks for a triangle nearer than a limit.
pub(super) struct AnyHit<'a> {
    pub(super) mesh: &'a TriangleMesh,
    pub(super) ray: &'a Ray,
    pub(super) query: &'a Query,
    pub(super) object: u32,
    pub(super) limit: f64,
    pub(super) counters: &'a mut Counters,
}

/// What a search knows of its ray.
struct Known {
    sheared: Sheared,
    scale: RayScale,
    /// The face that the ray leaves.
    left: u32,
    /// Beyond this what is certainly met certainly counts.
    sure_from: f32,
}

impl Known {
    #[inline(always)]
    fn new(framed: &FrameRay, query: &Query, object: u32) -> Self {
        let (mut left, mut sure_from) = (u32::MAX, 0.0);
        if let Some(departed) = &query.departed
            && departed.object == object
        {
            left = departed.face;
            // The rule for neighbours of the face that was left looks at the distance of the origin from their plane. What is
            // certainly met is not seen edge on: the sine of the angle to its plane is more than 3.5e-7.
            sure_from = departed.error as f32 * 3e6;
        }
        if query.has_passed() {
            sure_from = f32::INFINITY;
        }
        Self { sheared: Sheared::new(framed), scale: framed.scale, left, sure_from }
    }
}

/// A triangle that is certainly met.
#[derive(Clone, Copy)]
struct Pending {
    block: usize,
    item: usize,
    /// Bounds on where.
    near: f32,
    far: f32,
}

impl Pending {
    const NONE: Self = Self { block: usize::MAX, item: 0, near: f32::INFINITY, far: f32::INFINITY };
}

struct Closest<'t, 'a> {
    task: &'t mut ClosestHit<'a>,
    known: Known,
    pending: Pending,
}

impl Task for ClosestHit<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let (mesh, limit) = (self.mesh, self.nearest.limit());
        let Some(framed) = mesh.frame.enter(self.ray, limit) else { return };
        let scale = framed.scale;
        let known = Known::new(&framed, self.query, self.object);
        let mut closest = Closest { task: self, known, pending: Pending::NONE };
        mesh.tree.walk::<P, _>(&framed, scale.box_limit(limit), &mut closest);
        let Pending { block, item, .. } = closest.pending;
        if let Some(block) = mesh.tree.blocks().get(block) {
            let exact = mesh.frame.exact(self.ray, scale);
            let met = meet_for_certain(&exact, &block.corners(item & (BLOCK - 1)));
            let t = scale.outward(met.t);
            let face = block.faces[item & (BLOCK - 1)];
            self.nearest.offer(Hit { t, object: self.object, face, barycentrics: met.barycentrics });
        }
    }
}

impl ClosestHit<'_> {
    /// Asks double precision; returns the distance if that is the nearest so far.
    #[inline(always)]
    fn settle(&mut self, block: &TriangleBlock, lane: usize, scale: RayScale) -> Option<f64> {
        let candidate = Candidate { face: block.faces[lane], corners: &block.corners(lane) };
        let exact = self.mesh.frame.exact(self.ray, scale);
        let outward = |t| scale.outward(t);
        let hit = self.mesh.settle(&exact, outward, self.query, self.object, &candidate, self.counters)?;
        self.nearest.offer(hit).then_some(hit.t)
    }
}

impl Visitor<TriangleBlock> for Closest<'_, '_> {
    const ORDERED: bool = true;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, mut limit: f32) -> ControlFlow<(), f32> {
        let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) else {
            return ControlFlow::Continue(limit);
        };
        while let Some(lane) = seen.next_lane() {
            let item = (part.from + lane) & (BLOCK - 1);
            let (near, far) = (seen.near[lane], seen.far[lane]);
            if seen.certain >> lane & 1 == 1 && near > self.known.sure_from {
                if near > self.pending.far {
                    continue;
                }
                if far < self.pending.near {
                    self.pending = Pending { block: part.index, item, near, far };
                    limit = if far < limit { far } else { limit };
                    continue;
                }
            }
            if let Some(t) = self.task.settle(part.block, item, self.known.scale) {
                limit = limit.min(self.known.scale.box_limit(t));
            }
        }
        ControlFlow::Continue(limit)
    }
}

struct Any<'t, 'a> {
    task: &'t mut AnyHit<'a>,
    known: Known,
    /// Nearer than this is nearer than the limit.
    sure_to: f32,
    found: bool,
}

impl Task for AnyHit<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let mesh = self.mesh;
        let Some(framed) = mesh.frame.enter(self.ray, self.limit) else { return false };
        let limit = framed.scale.box_limit(self.limit);
        let known = Known::new(&framed, self.query, self.object);
        let sure_to = limit * (1.0 - 4e-6) - 8e-6;
        let mut any = Any { task: self, known, sure_to, found: false };
        mesh.tree.walk::<P, _>(&framed, limit, &mut any);
        any.found
    }
}

impl AnyHit<'_> {
    /// Asks double precision.
    #[inline(always)]
    fn settle(&mut self, block: &TriangleBlock, lane: usize, scale: RayScale) -> bool {
        let candidate = Candidate { face: block.faces[lane], corners: &block.corners(lane) };
        let exact = self.mesh.frame.exact(self.ray, scale);
        let outward = |t| scale.outward(t);
        let hit = self.mesh.settle(&exact, outward, self.query, self.object, &candidate, self.counters);
        hit.is_some_and(|hit| hit.t < self.limit)
    }
}

impl Visitor<TriangleBlock> for Any<'_, '_> {
    const ORDERED: bool = false;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, limit: f32) -> ControlFlow<(), f32> {
        let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) else {
            return ControlFlow::Continue(limit);
        };
        while let Some(lane) = seen.next_lane() {
            let item = (part.from + lane) & (BLOCK - 1);
            let surely = seen.certain >> lane & 1 == 1
                && seen.near[lane] > self.known.sure_from
                && seen.far[lane] < self.sure_to;
            if surely || self.task.settle(part.block, item, self.known.scale) {
                self.found = true;
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(limit)
    }
}
