//! A tree of boxes over anything that has bounds: the triangles of a mesh, the objects of a scene.
//!
//! The boxes live in a *unit frame*, v' = (v − centre) · 2^k with the largest extent in [0.5, 1). A ray is brought into it
//! in double precision and advanced to the bounds before it is rounded to single precision, so that neither the size of
//! the scene nor its distance from the origin costs accuracy. All roundings from there on displace a point by less than
//! 1e-6; every box is padded by [`PAD`], which is twice that. Boxes are therefore conservative: traversal finds every item
//! whose bounds the exact ray meets, and the shape of the tree has no say in what is hit.
//!
//! obvhs builds the tree (PLOC with reinsertion; D. Meister and J. Bittner, Parallel Locally-Ordered Clustering for Bounding
//! Volume Hierarchy Construction, 2018).

use obvhs::aabb::Aabb;
use obvhs::{Boundable, BvhBuildParams};
use std::ops::ControlFlow;
use std::time::Duration;
use vitrum_math::{Bounds, DVec3, Ray, Vec3, power_of_two_above};

/// Padding of every box, in units of the frame.
const PAD: f32 = 2e-6;

/// Levels that a traversal keeps on the machine's stack; deeper trees (which only pathological input makes) use the heap.
const SHALLOW: usize = 64;

/// A frame in which some bounds have an extent in [0.5, 1) around the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitFrame {
    centre: DVec3,
    /// A power of two, so that scaling is exact.
    scale: f64,
    half_extent: DVec3,
}

/// A ray in a unit frame.
pub(crate) struct FrameRay {
    /// In double precision, as it is; `t` of the world times `t_scale` is `t` here.
    pub(crate) exact: Ray,
    /// A power of two.
    pub(crate) t_scale: f64,
    /// Where the ray comes within the bounds: the origin below stands there.
    t_start: f64,
    /// Advanced and rounded.
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    reciprocal: Vec3,
}

impl UnitFrame {
    pub(crate) fn around(bounds: &Bounds) -> Self {
        let extent = bounds.extent().max_element();
        let scale = if extent > 0.0 { 1.0 / power_of_two_above(extent) } else { 1.0 };
        let half_extent = bounds.extent() * (0.5 * scale);
        Self { centre: bounds.centre(), scale, half_extent }
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

    /// The ray in this frame, or `None` when it misses the bounds or reaches them only beyond `limit` (in units of `ray`).
    #[inline]
    pub(crate) fn enter(&self, ray: &Ray, limit: f64) -> Option<FrameRay> {
        let direction = ray.direction * self.scale;
        let t_scale = power_of_two_above(direction.abs().max_element());
        let exact = Ray::new(self.inward(ray.origin), direction / t_scale);
        let half = self.half_extent + DVec3::splat(f64::from(PAD));
        let (mut t_start, mut t_end) = (0.0f64, limit * t_scale + f64::from(PAD));
        for axis in 0..3 {
            let (o, d) = (exact.origin[axis], exact.direction[axis]);
            if d == 0.0 {
                if o.abs() > half[axis] {
                    return None;
                }
            } else {
                let (a, b) = ((-half[axis] - o) / d, (half[axis] - o) / d);
                t_start = t_start.max(a.min(b));
                t_end = t_end.min(a.max(b));
            }
        }
        if t_start > t_end {
            return None;
        }
        let direction = exact.direction.as_vec3();
        // A component that is (nearly) zero stands for a tiny one: no infinity times zero below, and the displacement of
        // 1e-20 vanishes in the padding.
        let away_from_zero = |d: f32| if d.abs() < 1e-20 { 1e-20f32.copysign(d) } else { d };
        let reciprocal =
            Vec3::new(away_from_zero(direction.x), away_from_zero(direction.y), away_from_zero(direction.z))
                .recip();
        let origin = exact.at(t_start).as_vec3();
        Some(FrameRay { exact, t_scale, t_start, origin, direction, reciprocal })
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

/// One box: of two children at `first` and `first + 1` when `count` is zero, else of `count` items from `first` on.
#[derive(Clone, Copy, Debug)]
struct Node {
    min: Vec3,
    first: u32,
    max: Vec3,
    count: u32,
}

/// A binary tree of boxes.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    nodes: Vec<Node>,
    items: Vec<u32>,
    depth: usize,
}

struct Item(Aabb);

impl Boundable for Item {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl BoxTree {
    /// The tree over boxes in a unit frame.
    pub(crate) fn build(boxes: impl Iterator<Item = (Vec3, Vec3)>) -> Self {
        let items: Vec<Item> =
            boxes.map(|(min, max)| Item(Aabb { min: min.into(), max: max.into() })).collect();
        if items.is_empty() {
            return Self { nodes: Vec::new(), items: Vec::new(), depth: 0 };
        }
        let built = obvhs::bvh2::builder::build_bvh2(
            &items,
            BvhBuildParams::medium_build(),
            &mut Duration::default(),
        );
        let nodes: Vec<Node> = built
            .nodes
            .iter()
            .map(|n| Node {
                min: Vec3::from(n.aabb().min) - Vec3::splat(PAD),
                first: n.first_index,
                max: Vec3::from(n.aabb().max) + Vec3::splat(PAD),
                count: n.prim_count,
            })
            .collect();
        let depth = depth(&nodes);
        Self { nodes, items: built.primitive_indices, depth }
    }

    /// Bytes on the heap.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.items)
    }

    /// Calls `visit` for the items whose boxes the ray meets before the limit, near boxes first. `visit` returns the new
    /// limit (see [`FrameRay::box_limit`]), or breaks off.
    #[inline]
    pub(crate) fn traverse(
        &self,
        ray: &FrameRay,
        limit: f32,
        visit: impl FnMut(u32, f32) -> ControlFlow<(), f32>,
    ) {
        if self.nodes.is_empty() {
        } else if self.depth < SHALLOW {
            self.traverse_with(&mut [(0, 0.0); SHALLOW], ray, limit, visit);
        } else {
            self.traverse_with(&mut vec![(0, 0.0); self.depth + 1], ray, limit, visit);
        }
    }

    #[inline]
    fn traverse_with(
        &self,
        stack: &mut [(u32, f32)],
        ray: &FrameRay,
        mut limit: f32,
        mut visit: impl FnMut(u32, f32) -> ControlFlow<(), f32>,
    ) {
        let mut waiting = 0;
        let mut current = 0u32;
        loop {
            let node = &self.nodes[current as usize];
            if node.count == 0 {
                let (a, b) = (node.first, node.first + 1);
                let (t_a, t_b) =
                    (self.nodes[a as usize].reach(ray, limit), self.nodes[b as usize].reach(ray, limit));
                let (near, far, t_far) = if t_a <= t_b { (a, b, t_b) } else { (b, a, t_a) };
                if t_a.min(t_b) < f32::INFINITY {
                    if t_far < f32::INFINITY {
                        stack[waiting] = (far, t_far);
                        waiting += 1;
                    }
                    current = near;
                    continue;
                }
            } else {
                for item in &self.items[node.first as usize..(node.first + node.count) as usize] {
                    match visit(*item, limit) {
                        ControlFlow::Continue(new_limit) => limit = new_limit,
                        ControlFlow::Break(()) => return,
                    }
                }
            }
            // The nearest of the boxes that were put off, unless something nearer has been found since.
            loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (node, t) = stack[waiting];
                if t <= limit {
                    current = node;
                    break;
                }
            }
        }
    }
}

impl Node {
    /// Where the ray enters the box, or infinity when it does not before `limit`.
    #[inline]
    fn reach(&self, ray: &FrameRay, limit: f32) -> f32 {
        let a = (self.min - ray.origin) * ray.reciprocal;
        let b = (self.max - ray.origin) * ray.reciprocal;
        let near = a.min(b);
        let far = a.max(b);
        let enter = near.x.max(near.y).max(near.z);
        let exit = far.x.min(far.y).min(far.z);
        // A hit may stand in front of the advanced origin by the rounding of that origin.
        let ahead = exit >= -PAD && enter <= exit * (1.0 + 1e-6) + PAD && enter * (1.0 - 1e-6) <= limit;
        if ahead { enter.max(-PAD) } else { f32::INFINITY }
    }
}

fn depth(nodes: &[Node]) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0u32, 1usize)];
    while let Some((index, level)) = open.pop() {
        deepest = deepest.max(level);
        let node = &nodes[index as usize];
        if node.count == 0 {
            open.extend([(node.first, level + 1), (node.first + 1, level + 1)]);
        }
    }
    deepest
}
