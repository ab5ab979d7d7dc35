//! The two searches for triangles that a ray hits: for the nearest, and for any.
//!
//! What single precision is certain of (see [`triangle`](super::triangle)) needs no more than that while the search goes
//! on. Everything else is put aside and settled in double precision at the end: triangles met near their borders, close to
//! where the ray starts or to what it has passed, or no farther apart than the bounds on their distances. Most rays meet
//! none, and the loop has the registers for itself. Should there be too many, they are settled on the way, in another search.

use super::TriangleMesh;
use super::triangle::{Sheared, TriangleBlock, meet_for_certain};
use super::triangle_mesh::Candidate;
use crate::aggregate::{Counters, Hit, Nearest};
use crate::departure::Query;
use crate::wide::{BLOCK, FrameRay, Part, Portable, Processor, Task, Visitor};
use std::ops::ControlFlow;
use vitrum_math::Ray;

/// Looks for the first triangle that counts.
pub(crate) struct ClosestHit<'a> {
    pub(crate) mesh: &'a TriangleMesh,
    pub(crate) ray: &'a Ray,
    /// Whether the ray's direction is known to have unit length.
    pub(crate) is_unit: bool,
    pub(crate) query: &'a Query,
    pub(crate) object: u32,
    pub(crate) nearest: &'a mut Nearest,
    pub(crate) counters: &'a mut Counters,
}

/// Looks for a triangle nearer than a limit.
pub(crate) struct AnyHit<'a> {
    pub(crate) mesh: &'a TriangleMesh,
    pub(crate) ray: &'a Ray,
    /// Whether the ray's direction is known to have unit length.
    pub(crate) is_unit: bool,
    pub(crate) query: &'a Query,
    pub(crate) object: u32,
    pub(crate) limit: f64,
    pub(crate) counters: &'a mut Counters,
}

/// What a search knows of its ray.
struct Known {
    sheared: Sheared,
    /// The face that the ray leaves.
    left: u32,
    /// Beyond this what is certainly met certainly counts.
    sure_from: f32,
    /// Before this everything has been passed.
    passed: f32,
}

impl Known {
    #[inline(always)]
    fn new(framed: &FrameRay, query: &Query, object: u32) -> Self {
        let (mut left, mut sure_from, mut passed) = (u32::MAX, 0.0f32, f32::NEG_INFINITY);
        if let Some(departed) = &query.departed
            && departed.object == object
        {
            left = departed.face;
            // The rule for neighbours of the face that was left looks at the distance of the origin from their plane. What is
            // certainly met is not seen edge on: the sine of the angle to its plane is more than 3.5e-7.
            sure_from = departed.error as f32 * 3e6;
        }
        if let Some(t) = query.passed_at() {
            sure_from = sure_from.max(framed.scale.box_limit(t));
            passed = framed.scale.sure_limit(t);
        }
        Self { sheared: Sheared::new(framed), left, sure_from, passed }
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

/// So many triangles are put aside.
const MOST: usize = if cfg!(test) { 2 } else { 8 };

/// Triangles that only double precision can decide on: their blocks and where they stand there.
struct Doubtful {
    /// So many of them are in use; more than there are, if there was no room for one.
    count: usize,
    items: [(u32, u32); MOST],
}

impl Doubtful {
    const NONE: Self = Self { count: 0, items: [(0, 0); MOST] };

    /// Breaks off if there is no room.
    #[inline(always)]
    fn put(&mut self, block: usize, item: usize) -> ControlFlow<()> {
        self.count += 1;
        match self.items.get_mut(self.count - 1) {
            Some(place) => {
                *place = (block as u32, item as u32);
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        }
    }
}

struct Closest {
    known: Known,
    pending: Pending,
    doubtful: Doubtful,
    /// No farther than this is the first hit, if the nearest of those put aside is one. It nearly always is, or its
    /// neighbour is, which is as far away.
    assumed: f32,
}

impl Task for ClosestHit<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let (mesh, limit) = (self.mesh, self.nearest.limit());
        Counters::count(&mut self.counters.mesh_searches);
        let Some(framed) = mesh.frame.enter::<P>(self.ray, self.is_unit, limit) else { return };
        let known = Known::new(&framed, self.query, self.object);
        let (pending, doubtful) = (Pending::NONE, Doubtful::NONE);
        let mut closest = Closest { known, pending, doubtful, assumed: f32::INFINITY };
        mesh.tree.walk::<P, _>(&framed, framed.scale.box_limit(limit), &mut closest);
        let Pending { block, item, .. } = closest.pending;
        if let Some(block) = mesh.tree.blocks().get(block) {
            let lane = item & (BLOCK - 1);
            let met = meet_for_certain::<P::Exact>(&framed.exact, block, lane);
            let t = framed.scale.outward(met.t);
            let face = block.faces[lane];
            self.nearest.offer(Hit { t, object: self.object, face, barycentrics: met.barycentrics });
        }
        if closest.doubtful.count > 0 {
            self.settle_all(&closest.doubtful, closest.assumed);
        }
    }
}

impl Visitor<TriangleBlock> for Closest {
    const ORDERED: bool = true;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, mut limit: f32) -> ControlFlow<(), f32> {
        let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) else {
            return ControlFlow::Continue(limit);
        };
        while let Some(lane) = seen.next_lane() {
            let item = (part.from + lane) & (BLOCK - 1);
            let (near, far) = (seen.near[lane], seen.far[lane]);
            if near > self.pending.far || far < self.known.passed {
                continue;
            }
            let counts = near > self.known.sure_from;
            if counts {
                limit = if far < limit { far } else { limit };
            }
            if counts && seen.certain >> lane & 1 == 1 && far < self.pending.near {
                self.pending = Pending { block: part.index, item, near, far };
            } else {
                self.assumed = if counts && far < self.assumed { far } else { self.assumed };
                self.doubtful.put(part.index, item)?;
            }
        }
        ControlFlow::Continue(limit)
    }
}

impl ClosestHit<'_> {
    /// Settles what was put aside; everything, if that was too much, or what was assumed is wrong.
    #[cold]
    #[inline(never)]
    fn settle_all(&mut self, doubtful: &Doubtful, assumed: f32) {
        // As before, and not kept since: that would be work for every ray.
        let framed = self.mesh.frame.enter::<Portable>(self.ray, self.is_unit, f64::INFINITY);
        let framed = &framed.expect("it was there before");
        let items = doubtful.items.get(..doubtful.count);
        for &(block, item) in items.unwrap_or_default() {
            self.settle(framed, &self.mesh.tree.blocks()[block as usize], item as usize);
        }
        if items.is_none() || !framed.scale.is_within(self.nearest.limit(), assumed) {
            let known = &Known::new(framed, self.query, self.object);
            let tree = &self.mesh.tree;
            tree.run(&mut Thorough { task: self, framed, known, found: false });
        }
    }

    /// Asks double precision.
    fn settle(&mut self, framed: &FrameRay, block: &TriangleBlock, item: usize) {
        let candidate = Candidate { face: block.faces[item], corners: block.corners(item) };
        if let Some(hit) = self.mesh.settle(framed, self.query, self.object, &candidate, self.counters) {
            self.nearest.offer(hit);
        }
    }
}

/// Looks for the first triangle, or any, and settles everything on the way.
struct Thorough<'t, T> {
    task: &'t mut T,
    framed: &'t FrameRay,
    known: &'t Known,
    /// Whether any was found, where any will do.
    found: bool,
}

impl Task for Thorough<'_, ClosestHit<'_>> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let (mesh, limit) = (self.task.mesh, self.framed.scale.box_limit(self.task.nearest.limit()));
        mesh.tree.walk::<P, _>(self.framed, limit, self);
    }
}

impl Visitor<TriangleBlock> for Thorough<'_, ClosestHit<'_>> {
    const ORDERED: bool = true;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, limit: f32) -> ControlFlow<(), f32> {
        if let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) {
            while let Some(lane) = seen.next_lane() {
                self.task.settle(self.framed, part.block, part.from + lane);
            }
        }
        ControlFlow::Continue(self.framed.scale.box_limit(self.task.nearest.limit()))
    }
}

struct Any {
    known: Known,
    /// Nearer than this is nearer than the limit.
    sure_to: f32,
    found: bool,
    doubtful: Doubtful,
}

impl Task for AnyHit<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let mesh = self.mesh;
        Counters::count(&mut self.counters.mesh_searches);
        let Some(framed) = mesh.frame.enter::<P>(self.ray, self.is_unit, self.limit) else { return false };
        let limit = framed.scale.box_limit(self.limit);
        let known = Known::new(&framed, self.query, self.object);
        let sure_to = framed.scale.sure_limit(self.limit);
        let mut any = Any { known, sure_to, found: false, doubtful: Doubtful::NONE };
        mesh.tree.walk::<P, _>(&framed, limit, &mut any);
        any.found || any.doubtful.count > 0 && self.settle_all(&any.doubtful)
    }
}

impl Visitor<TriangleBlock> for Any {
    const ORDERED: bool = false;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, limit: f32) -> ControlFlow<(), f32> {
        let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) else {
            return ControlFlow::Continue(limit);
        };
        while let Some(lane) = seen.next_lane() {
            let (near, far) = (seen.near[lane], seen.far[lane]);
            if far < self.known.passed {
                continue;
            }
            if seen.certain >> lane & 1 == 1 && near > self.known.sure_from && far < self.sure_to {
                self.found = true;
                return ControlFlow::Break(());
            }
            let item = (part.from + lane) & (BLOCK - 1);
            self.doubtful.put(part.index, item)?;
        }
        ControlFlow::Continue(limit)
    }
}

impl AnyHit<'_> {
    /// Settles what was put aside; everything, if that was too much.
    #[cold]
    #[inline(never)]
    fn settle_all(&mut self, doubtful: &Doubtful) -> bool {
        let framed = self.mesh.frame.enter::<Portable>(self.ray, self.is_unit, f64::INFINITY);
        let framed = &framed.expect("it was there before");
        match doubtful.items.get(..doubtful.count) {
            Some(items) => items.iter().any(|&(block, item)| {
                self.settle(framed, &self.mesh.tree.blocks()[block as usize], item as usize)
            }),
            None => {
                let known = &Known::new(framed, self.query, self.object);
                let tree = &self.mesh.tree;
                tree.run(&mut Thorough { task: self, framed, known, found: false })
            }
        }
    }

    /// Asks double precision.
    fn settle(&mut self, framed: &FrameRay, block: &TriangleBlock, item: usize) -> bool {
        let candidate = Candidate { face: block.faces[item], corners: block.corners(item) };
        let hit = self.mesh.settle(framed, self.query, self.object, &candidate, self.counters);
        hit.is_some_and(|hit| hit.t < self.limit)
    }
}

impl Task for Thorough<'_, AnyHit<'_>> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let (mesh, limit) = (self.task.mesh, self.framed.scale.box_limit(self.task.limit));
        mesh.tree.walk::<P, _>(self.framed, limit, self);
        self.found
    }
}

impl Visitor<TriangleBlock> for Thorough<'_, AnyHit<'_>> {
    const ORDERED: bool = false;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, TriangleBlock>, limit: f32) -> ControlFlow<(), f32> {
        if let Some(mut seen) = self.known.sheared.look::<P::Leaf>(&part, self.known.left, limit) {
            while let Some(lane) = seen.next_lane() {
                if self.task.settle(self.framed, part.block, part.from + lane) {
                    self.found = true;
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(limit)
    }
}
