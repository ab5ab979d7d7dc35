//! All objects of a scene, and the two questions asked of them: what is hit first, and is anything in the way?

use crate::departure::Query;
use crate::interaction::SurfaceInteraction;
use crate::mesh::{AnyHit, ClosestHit, TriangleMesh};
use crate::object::Object;
use crate::solids::Solids;
use crate::spheres::Spheres;
use crate::wide::{
    Build, FrameRay, Isa, Items, Lanes, NONE, Numbers, Part, Processor, Task, UnitFrame, Visitor, WideTree,
};
use std::ops::ControlFlow;
use std::sync::Arc;
use vitrum_math::{Bounds, DVec2, DVec3, Ray, unit};

/// Bounded objects are tried one by one while their costs sum to at most this; more stand in a tree. Measured: spheres, of
/// which four are tried at a time, are worth sweeping up to about 24, others up to 2, with spheres beside them (`benches/README.md`).
const FLAT_LIMIT: usize = 24;
const SPHERE_COST: usize = 1;
const OTHER_COST: usize = 10;

/// An object costs about as much as a node, and has an answer of its own.
const OBJECTS: Items = Items::OneByOne(0.7);

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

/// Rare events, which are harmless (many of them hint at a mesh with needles or overlaps), and uses of what not every scene has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Faces within the rounding error of a ray's origin that the ray can't cross, given the face that it leaves; they were
    /// ignored.
    pub neighbours_ignored: u64,
    /// Questions to the tree of a mesh; counted in builds with debug assertions alone, like what follows.
    pub mesh_searches: u64,
    /// Questions to the tree of the objects.
    pub tree_searches: u64,
    /// Rays inside a solid that were asked of it first.
    pub inner_searches: u64,
    /// Points whose normal is one between those of corners.
    pub interpolated_normals: u64,
}

impl Counters {
    /// Adds what others have counted.
    pub fn merge(&mut self, other: &Self) {
        self.neighbours_ignored += other.neighbours_ignored;
        self.mesh_searches += other.mesh_searches;
        self.tree_searches += other.tree_searches;
        self.inner_searches += other.inner_searches;
        self.interpolated_normals += other.interpolated_normals;
    }

    /// Counts one where that is of use to tests, and is nothing elsewhere.
    #[inline(always)]
    pub(crate) fn count(which: &mut u64) {
        if cfg!(debug_assertions) {
            *which += 1;
        }
    }
}

/// The nearest hit so far: the smallest (t, object, face).
pub(crate) struct Nearest(Hit);

impl Default for Nearest {
    fn default() -> Self {
        Self(Hit { t: f64::INFINITY, object: u32::MAX, face: u32::MAX, barycentrics: [0.0; 2] })
    }
}

impl Nearest {
    /// Nothing is of interest but what lies nearer than `limit`.
    fn within(limit: f64) -> Self {
        Self(Hit { t: limit, ..Self::default().0 })
    }

    /// Beyond this distance nothing is of interest.
    #[inline]
    pub(crate) fn limit(&self) -> f64 {
        self.0.t
    }

    /// What was found.
    #[inline]
    pub(crate) fn found(&self) -> Option<Hit> {
        (self.0.object != u32::MAX).then_some(self.0)
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
    /// Tried for every ray, while bounded objects are few: spheres, several at a time.
    spheres: Spheres,
    /// And meshes, which are asked at once.
    meshes: Vec<(u32, Arc<TriangleMesh>)>,
    /// Tried for every ray: infinite objects, and all others while bounded objects are few.
    flat: Vec<u32>,
    /// The rest.
    tree: Option<ObjectTree>,
    solids: Solids,
    bounds: Bounds,
    isa: Isa,
}

#[derive(Clone, Debug)]
struct ObjectTree {
    frame: UnitFrame,
    boxes: WideTree<Numbers>,
    /// The object of each box.
    objects: Vec<u32>,
}

/// Offers the first hits of all objects that a ray can meet.
struct Closest<'a> {
    all: &'a Aggregate,
    query: &'a Query,
    nearest: &'a mut Nearest,
    counters: &'a mut Counters,
}

impl Task for Closest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let Self { all, query, nearest, counters } = self;
        if let Some((solid, others)) = all.solids.around(query) {
            Counters::count(&mut counters.inner_searches);
            all.objects[solid as usize].closest(query, solid, nearest, counters);
            // Unless the ray got out through a gap, the way to the hit lies within the bounds of the solid.
            if nearest.found().is_some() {
                if !others.is_empty() {
                    offer_others(others, &all.objects, query, nearest, counters);
                }
                return;
            }
        }
        if !all.spheres.is_empty() {
            all.spheres.closest(query, nearest);
        }
        for (id, mesh) in &all.meshes {
            ClosestHit { mesh, ray: &query.ray, is_unit: true, query, object: *id, nearest, counters }
                .run::<P>();
        }
        if !all.flat.is_empty() {
            offer_others(&all.flat, &all.objects, query, nearest, counters);
        }
        if let Some(tree) = &all.tree {
            offer_tree(tree, &all.objects, query, nearest, counters);
        }
    }
}

// None of these is inlined: the compiler would prepare for spheres and trees before it looks whether there are any.

#[inline(never)]
fn offer_others(
    flat: &[u32],
    objects: &[Object],
    query: &Query,
    nearest: &mut Nearest,
    counters: &mut Counters,
) {
    for &id in flat {
        objects[id as usize].closest(query, id, nearest, counters);
    }
}

#[inline(never)]
fn offer_tree(
    tree: &ObjectTree,
    objects: &[Object],
    query: &Query,
    nearest: &mut Nearest,
    counters: &mut Counters,
) {
    Counters::count(&mut counters.tree_searches);
    tree.boxes.run(&mut ClosestObject { tree, objects, query, nearest, counters });
}

/// Looks for anything nearer than a limit.
struct Occluded<'a> {
    all: &'a Aggregate,
    query: &'a Query,
    limit: f64,
    counters: &'a mut Counters,
}

impl Task for Occluded<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let &mut Self { all, query, limit, ref mut counters } = self;
        if !all.spheres.is_empty() && all.spheres.any(query, limit) {
            return true;
        }
        for (id, mesh) in &all.meshes {
            let mut search =
                AnyHit { mesh, ray: &query.ray, is_unit: true, query, object: *id, limit, counters };
            if search.run::<P>() {
                return true;
            }
        }
        !all.flat.is_empty() && any_other(&all.flat, &all.objects, query, limit, counters)
            || all.tree.as_ref().is_some_and(|tree| any_in_tree(tree, &all.objects, query, limit, counters))
    }
}

#[inline(never)]
fn any_other(flat: &[u32], objects: &[Object], query: &Query, limit: f64, counters: &mut Counters) -> bool {
    flat.iter().any(|&id| objects[id as usize].any(query, id, limit, counters))
}

#[inline(never)]
fn any_in_tree(
    tree: &ObjectTree,
    objects: &[Object],
    query: &Query,
    limit: f64,
    counters: &mut Counters,
) -> bool {
    Counters::count(&mut counters.tree_searches);
    tree.boxes.run(&mut AnyObject { tree, objects, query, limit, found: false, counters })
}

/// Asks the objects whose boxes a ray meets, near boxes first, for the first hit.
struct ClosestObject<'a> {
    tree: &'a ObjectTree,
    objects: &'a [Object],
    query: &'a Query,
    nearest: &'a mut Nearest,
    counters: &'a mut Counters,
}

impl Task for ClosestObject<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let limit = self.nearest.limit();
        let Some(ray) = self.tree.frame.enter::<P>(&self.query.ray, true, limit) else { return };
        self.tree.boxes.walk::<P, _>(&ray, ray.scale.box_limit(limit), &mut Among { task: self, ray });
    }
}

/// Asks the objects whose boxes a ray meets for any hit nearer than a limit.
struct AnyObject<'a> {
    tree: &'a ObjectTree,
    objects: &'a [Object],
    query: &'a Query,
    limit: f64,
    found: bool,
    counters: &'a mut Counters,
}

impl Task for AnyObject<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let Some(ray) = self.tree.frame.enter::<P>(&self.query.ray, true, self.limit) else { return false };
        self.tree.boxes.walk::<P, _>(&ray, ray.scale.box_limit(self.limit), &mut Among { task: self, ray });
        self.found
    }
}

/// A task on its way through the tree.
struct Among<'t, T> {
    task: &'t mut T,
    ray: FrameRay,
}

impl Visitor<Numbers> for Among<'_, ClosestObject<'_>> {
    const ORDERED: bool = true;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, Numbers>, _: f32) -> ControlFlow<(), f32> {
        let task = &mut *self.task;
        for &item in part.block[part.from..][..P::Leaf::COUNT].iter().take_while(|item| **item != NONE) {
            let id = task.tree.objects[item as usize];
            task.objects[id as usize].closest(task.query, id, task.nearest, task.counters);
        }
        ControlFlow::Continue(self.ray.scale.box_limit(task.nearest.limit()))
    }
}

impl Visitor<Numbers> for Among<'_, AnyObject<'_>> {
    const ORDERED: bool = false;

    #[inline(always)]
    fn visit<P: Processor>(&mut self, part: Part<'_, Numbers>, limit: f32) -> ControlFlow<(), f32> {
        let task = &mut *self.task;
        for &item in part.block[part.from..][..P::Leaf::COUNT].iter().take_while(|item| **item != NONE) {
            let id = task.tree.objects[item as usize];
            if task.objects[id as usize].any(task.query, id, task.limit, task.counters) {
                task.found = true;
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(limit)
    }
}

impl Aggregate {
    /// Objects in the order of their ids.
    pub fn new(objects: Vec<Object>) -> Self {
        Self::with_limit(objects, FLAT_LIMIT)
    }

    /// The same objects without what spares work. With `in_tree` all that are bounded stand in the tree, however few they are; with
    /// `in_solids` a ray inside a solid searches everything. Finds the same.
    pub fn searched_in_full(&self, in_tree: bool, in_solids: bool) -> Self {
        let limit = if in_tree { 0 } else { FLAT_LIMIT };
        let all = Self::with_limit(self.objects.clone(), limit);
        if in_solids { Self { solids: Solids::none(self.objects.len()), ..all } } else { all }
    }

    fn with_limit(objects: Vec<Object>, flat_limit: usize) -> Self {
        let bounded: Vec<(u32, Bounds)> =
            (0u32..).zip(&objects).filter_map(|(id, o)| o.bounds().map(|b| (id, b))).collect();
        let bounds = bounded.iter().fold(Bounds::EMPTY, |all, (_, b)| all.union(*b));
        let solids = Solids::new(&objects, &bounded);
        let cost =
            |id: u32| if objects[id as usize].as_sphere().is_some() { SPHERE_COST } else { OTHER_COST };
        let is_flat = bounded.iter().map(|(id, _)| cost(*id)).sum::<usize>() <= flat_limit;
        let (mut spheres, mut meshes, mut flat) = (Vec::new(), Vec::new(), Vec::new());
        for (id, object) in (0u32..).zip(&objects).filter(|(_, o)| is_flat || o.bounds().is_none()) {
            if let Some(sphere) = object.as_sphere() {
                spheres.push((id, *sphere));
            } else if let Some(mesh) = object.as_mesh() {
                meshes.push((id, Arc::clone(mesh)));
            } else {
                flat.push(id);
            }
        }
        let tree = (!is_flat).then(|| {
            let frame = UnitFrame::around(&bounds);
            let boxes =
                bounded.iter().map(|(_, b)| (frame.inward(b.min).as_vec3(), frame.inward(b.max).as_vec3()));
            let boxes = WideTree::build(boxes, OBJECTS, Build::default())
                .expect("fewer objects than fit into memory");
            ObjectTree { frame, boxes, objects: bounded.iter().map(|(id, _)| *id).collect() }
        });
        let spheres = Spheres::new(&spheres);
        Self { objects, spheres, meshes, flat, tree, solids, bounds, isa: Isa::best() }
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
        self.isa.run(&mut Closest { all: self, query, nearest: &mut nearest, counters });
        nearest.found()
    }

    /// What the ray hits first, at most `limit` metres away.
    pub fn closest_within(&self, query: &Query, limit: f64, counters: &mut Counters) -> Option<Hit> {
        let mut nearest = Nearest::within(limit);
        self.isa.run(&mut Closest { all: self, query, nearest: &mut nearest, counters });
        nearest.found()
    }

    /// What of one object the ray hits first, at most `limit` metres away.
    pub fn closest_of(&self, object: u32, query: &Query, limit: f64, counters: &mut Counters) -> Option<Hit> {
        let mut nearest = Nearest::within(limit);
        self.objects[object as usize].closest(query, object, &mut nearest, counters);
        nearest.found()
    }

    /// True when the ray hits anything of one object nearer than `limit` metres.
    pub fn meets(&self, object: u32, query: &Query, limit: f64, counters: &mut Counters) -> bool {
        self.objects[object as usize].any(query, object, limit, counters)
    }

    /// How often the surface of a closed object winds around a point: 1 inside and 0 outside, more where the surface overlaps itself.
    /// In closed form for spheres. For others, rays in three directions count what they leave against what they enter; where they
    /// do not agree, which takes a ray along a surface, two outvote the third.
    pub fn winding(&self, object: u32, point: DVec3) -> i32 {
        // Off the axes, along which models have edges and seams.
        const DIRECTIONS: [DVec3; 3] =
            [DVec3::new(0.91, 0.17, -0.29), DVec3::new(-0.37, 0.89, 0.23), DVec3::new(0.19, -0.31, 0.93)];
        let whole = &self.objects[object as usize];
        if let Some(sphere) = whole.as_sphere() {
            let inside = (point - sphere.centre()).length() < sphere.radius();
            return i32::from(inside);
        }
        let mut counters = Counters::default();
        let mut counts = DIRECTIONS.map(|direction| {
            let mut query = Query::new(Ray::new(point, unit(direction)));
            let mut count = 0;
            while let Some(hit) = self.closest_of(object, &query, f64::INFINITY, &mut counters) {
                count += if whole.interaction(&query, &hit, &mut counters).front { -1 } else { 1 };
                query.pass(hit.t, object, hit.face);
            }
            count
        });
        counts.sort_unstable();
        counts[1]
    }

    /// True when anything is hit nearer than `limit` metres.
    #[inline]
    pub fn occluded(&self, query: &Query, limit: f64, counters: &mut Counters) -> bool {
        self.isa.run(&mut Occluded { all: self, query, limit, counters })
    }

    /// The point of a hit that [`closest`](Self::closest) found for the same query.
    #[inline]
    pub fn interaction(&self, query: &Query, hit: &Hit, counters: &mut Counters) -> SurfaceInteraction {
        self.objects[hit.object as usize].interaction(query, hit, counters)
    }

    /// The texture coordinates of a hit, whose [point](Self::interaction) is given. For objects [with](Object::with_uvs) any.
    // Never inlined: most scenes have no images, and must not carry this through their loop.
    #[inline(never)]
    pub fn uv(&self, hit: &Hit, point: DVec3) -> DVec2 {
        self.objects[hit.object as usize].uv(hit.face, Some(hit.barycentrics), point)
    }

    /// The texture coordinates of a point that no ray has found: on a face of an object.
    #[inline(never)]
    pub fn uv_at(&self, object: u32, face: u32, point: DVec3) -> DVec2 {
        self.objects[object as usize].uv(face, None, point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interaction::Side;
    use crate::shape::{Shape, Sphere};
    use vitrum_math::Transform;

    fn object(shape: Shape) -> Object {
        Object::new(shape, &Transform::IDENTITY, false).expect("valid")
    }

    fn sphere(x: f64, y: f64) -> Object {
        object(Shape::Sphere(Sphere::new(DVec3::new(x, y, 0.0), 1.0).expect("valid")))
    }

    /// A ray that goes straight through the wall of a solid apart from all others meets what stands beyond it.
    #[test]
    fn beyond_a_solid_the_world_goes_on() {
        let aggregate = Aggregate::new(vec![sphere(0.0, 1.5), sphere(8.0, 1.5)]);
        let mut counters = Counters::default();
        let camera = Query::new(Ray::new(DVec3::new(-5.0, 1.5, 0.0), DVec3::X));
        let hit = aggregate.closest(&camera, &mut counters).expect("the first sphere");
        let mut query =
            aggregate.interaction(&camera, &hit, &mut Counters::default()).leave(DVec3::X, Side::Transmitted);
        let exit = aggregate.closest(&query, &mut counters).expect("its far wall");
        assert_eq!((exit.object, exit.t), (0, 2.0));
        query.pass(exit.t, exit.object, exit.face);
        let next = aggregate.closest(&query, &mut counters).expect("the second sphere");
        assert_eq!((next.object, next.t), (1, 8.0));
    }
}
