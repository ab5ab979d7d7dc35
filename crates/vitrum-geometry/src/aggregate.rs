//! All objects of a scene, and the two questions asked of them: what is hit first, and is anything in the way?

use crate::departure::Query;
use crate::interaction::SurfaceInteraction;
use crate::object::Object;
use crate::shape::{Crossing, Sphere};
use crate::tree::{BoxTree, UnitFrame};
use std::ops::ControlFlow;
use vitrum_math::Bounds;

/// Up to this many bounded objects are tried one by one; more stand in a tree.
const FLAT_LIMIT: usize = 16;

/// What a ray hits first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in metres.
    pub t: f64,
    /// Position of the object in the aggregate.
    pub object: u32,
    /// The face of the object.
    pub face: u32,
    /// On a mesh, the weights of the triangle's second and third corner.
    pub barycentrics: [f64; 2],
}

/// Rare events. They are harmless; many of them hint at a mesh with needles or overlaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Faces within the rounding error of a ray's origin that the ray can't cross, given the face that it leaves; they were
    /// ignored.
    pub contradictions: u64,
}

/// The nearest hit so far: the smallest (t, object, face).
pub(crate) struct Nearest(Hit);

impl Default for Nearest {
    fn default() -> Self {
        Self(Hit { t: f64::INFINITY, object: u32::MAX, face: u32::MAX, barycentrics: [0.0; 2] })
    }
}

impl Nearest {
    /// Beyond this distance nothing is of interest.
    #[inline]
    pub(crate) fn limit(&self) -> f64 {
        self.0.t
    }

    /// What was found.
    #[inline]
    pub(crate) fn found(&self) -> Option<Hit> {
        (self.0.t < f64::INFINITY).then_some(self.0)
    }

    /// Takes `hit`, which is finite, if it comes before what stands here; true if it did.
    #[inline]
    pub(crate) fn offer(&mut self, hit: Hit) -> bool {
        let best = &self.0;
        let better = hit.t < best.t || hit.t == best.t && (hit.object, hit.face) < (best.object, best.face);
        if better {
            self.0 = hit;
        }
        better
    }
}

/// All objects of a scene.
#[derive(Clone, Debug)]
pub struct Aggregate {
    objects: Vec<Object>,
    /// Tried for every ray, while bounded objects are few: spheres, side by side in memory.
    spheres: Vec<(u32, Sphere)>,
    /// Tried for every ray: infinite objects, and all others while bounded objects are few.
    flat: Vec<u32>,
    /// The rest.
    tree: Option<ObjectTree>,
    bounds: Bounds,
}

#[derive(Clone, Debug)]
struct ObjectTree {
    frame: UnitFrame,
    boxes: BoxTree,
    /// The object of each box.
    objects: Vec<u32>,
}

impl Aggregate {
    /// Objects in the order of their ids.
    pub fn new(objects: Vec<Object>) -> Self {
        let bounded: Vec<(u32, Bounds)> =
            (0u32..).zip(&objects).filter_map(|(id, o)| o.bounds().map(|b| (id, b))).collect();
        let bounds = bounded.iter().fold(Bounds::EMPTY, |all, (_, b)| all.union(*b));
        let is_flat = bounded.len() <= FLAT_LIMIT;
        let (mut spheres, mut flat) = (Vec::new(), Vec::new());
        for (id, object) in (0u32..).zip(&objects).filter(|(_, o)| is_flat || o.bounds().is_none()) {
            match object.as_sphere() {
                Some(sphere) => spheres.push((id, *sphere)),
                None => flat.push(id),
            }
        }
        let tree = (!is_flat).then(|| {
            let frame = UnitFrame::around(&bounds);
            let boxes = BoxTree::build(
                bounded.iter().map(|(_, b)| (frame.inward(b.min).as_vec3(), frame.inward(b.max).as_vec3())),
            );
            ObjectTree { frame, boxes, objects: bounded.iter().map(|(id, _)| *id).collect() }
        });
        Self { objects, spheres, flat, tree, bounds }
    }

    /// The objects, by id.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The box around all bounded objects; empty without any.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// True when the bounded objects stand in a tree, false when they are tried one by one.
    pub fn uses_tree(&self) -> bool {
        self.tree.is_some()
    }

    /// What the ray hits first: the smallest (t, object, face) that counts.
    #[inline]
    pub fn closest(&self, query: &Query, counters: &mut Counters) -> Option<Hit> {
        let mut nearest = Nearest::default();
        for (id, sphere) in &self.spheres {
            let Crossing { t, face } = query.first(sphere.crossings(&query.ray, query.face_left(*id)), *id);
            if t <= nearest.limit() && t < f64::INFINITY {
                nearest.offer(Hit { t, object: *id, face, barycentrics: [0.0; 2] });
            }
        }
        for &id in &self.flat {
            self.objects[id as usize].closest(query, id, &mut nearest, counters);
        }
        if let Some(tree) = &self.tree
            && let Some(ray) = tree.frame.enter(&query.ray, nearest.limit())
        {
            tree.boxes.traverse(&ray, ray.box_limit(nearest.limit()), |item, _| {
                let id = tree.objects[item as usize];
                self.objects[id as usize].closest(query, id, &mut nearest, counters);
                ControlFlow::Continue(ray.box_limit(nearest.limit()))
            });
        }
        nearest.found()
    }

    /// True when anything is hit nearer than `limit` metres.
    #[inline]
    pub fn occluded(&self, query: &Query, limit: f64, counters: &mut Counters) -> bool {
        let blocks = |(id, sphere): &(u32, Sphere)| {
            query.first(sphere.crossings(&query.ray, query.face_left(*id)), *id).t < limit
        };
        if self.spheres.iter().any(blocks) {
            return true;
        }
        if self.flat.iter().any(|&id| self.objects[id as usize].any(query, id, limit, counters)) {
            return true;
        }
        let mut found = false;
        if let Some(tree) = &self.tree
            && let Some(ray) = tree.frame.enter(&query.ray, limit)
        {
            let box_limit = ray.box_limit(limit);
            tree.boxes.traverse(&ray, box_limit, |item, _| {
                let id = tree.objects[item as usize];
                found = self.objects[id as usize].any(query, id, limit, counters);
                if found { ControlFlow::Break(()) } else { ControlFlow::Continue(box_limit) }
            });
        }
        found
    }

    /// The point of a hit that [`closest`](Self::closest) found for the same query.
    #[inline]
    pub fn interaction(&self, query: &Query, hit: &Hit) -> SurfaceInteraction {
        self.objects[hit.object as usize].interaction(query, hit)
    }
}
