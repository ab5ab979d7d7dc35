//! A tree of boxes with eight children a node, over anything that has bounds: the triangles of a mesh, the objects of a
//! scene.
//!
//! The boxes live in a *unit frame* (see [`UnitFrame`](frame::UnitFrame)); all roundings of a ray there displace a point by
//! less than 1e-6, and every box is padded by [`PAD`], twice that. Boxes are therefore conservative: traversal finds every
//! item whose bounds the exact ray meets, and neither the shape of the tree nor the instructions that walk it have a say in
//! what is hit.
//!
//! obvhs builds a binary tree (PLOC with reinsertion; D. Meister and J. Bittner, Parallel Locally-Ordered Clustering for
//! Bounding Volume Hierarchy Construction, 2018), [`collapse`] makes it wide, [`walk`](WideTree::walk) traverses it with
//! the [`Lanes`] of the processor.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod collapse;
mod frame;
mod lanes;

pub(crate) use frame::{FrameRay, UnitFrame};
pub(crate) use lanes::{Lanes, Portable};

use obvhs::aabb::Aabb;
use obvhs::{Boundable, BvhBuildParams};
use std::mem::MaybeUninit;
use std::ops::ControlFlow;
use std::time::Duration;
use vitrum_math::Vec3;

/// Padding of every box, in units of the frame.
const PAD: f32 = 2e-6;

/// Children of a node.
const WIDTH: usize = 8;

/// Items in a block of a leaf.
pub(crate) const BLOCK: usize = 8;

/// Levels whose nodes fit on the machine's stack while they wait; deeper trees (which only pathological input makes) use
/// the heap.
const SHALLOW: usize = 9;

/// The instructions that a tree is walked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Isa {
    /// Any processor.
    Portable,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Isa {
    /// The widest that this processor has.
    fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return Self::Avx2;
        }
        Self::Portable
    }
}

/// What a slot of a node leads to.
#[derive(Clone, Copy, Debug)]
struct Child(u32);

/// What a child is.
enum Kind {
    Node(usize),
    Leaf { first: usize, blocks: usize },
}

impl Child {
    const LEAF: u32 = 1 << 31;

    fn node(index: usize) -> Self {
        Self(u32::try_from(index).expect("fewer nodes than items"))
    }

    /// One or two blocks.
    fn leaf(first: usize, blocks: usize) -> Self {
        debug_assert!(blocks == 1 || blocks == 2);
        let first = u32::try_from(first).expect("fewer blocks than items");
        Self(Self::LEAF | first << 1 | u32::from(blocks == 2))
    }

    #[inline(always)]
    fn kind(self) -> Kind {
        if self.0 & Self::LEAF == 0 {
            Kind::Node(self.0 as usize)
        } else {
            let first = (self.0 & !Self::LEAF) >> 1;
            Kind::Leaf { first: first as usize, blocks: 1 + (self.0 & 1) as usize }
        }
    }
}

/// Eight boxes.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
struct Node {
    /// min x, max x, min y, max y, min z, max z.
    bounds: [[f32; WIDTH]; 6],
    children: [Child; WIDTH],
}

impl Node {
    /// Boxes that no ray meets.
    const EMPTY: Self = {
        const LOW: [f32; WIDTH] = [f32::INFINITY; WIDTH];
        const HIGH: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
        Self { bounds: [LOW, HIGH, LOW, HIGH, LOW, HIGH], children: [Child(0); WIDTH] }
    };

    fn set(&mut self, slot: usize, min: Vec3, max: Vec3, child: Child) {
        for axis in 0..3 {
            self.bounds[2 * axis][slot] = min[axis];
            self.bounds[2 * axis + 1][slot] = max[axis];
        }
        self.children[slot] = child;
    }
}

/// A tree over numbered items.
#[derive(Clone, Debug)]
pub(crate) struct WideTree {
    nodes: Vec<Node>,
    /// The items of the leaves; [`WideTree::NONE`] where a block is not full.
    blocks: Vec<[u32; BLOCK]>,
    depth: usize,
    isa: Isa,
}

struct Item(Aabb);

impl Boundable for Item {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// What happens at the leaves.
///
/// A trait and not a closure: closures are compiled for any processor, whatever function they are called from, unless the
/// compiler happens to inline them.
pub(crate) trait Visitor {
    /// Looks at a block whose box the ray meets before the limit; returns the new limit (see [`FrameRay::box_limit`]), or
    /// breaks off.
    fn visit<L: Lanes>(&mut self, block: usize, limit: f32) -> ControlFlow<(), f32>;
}

/// A node or leaf that waits, after the distance to it: distances are not negative, so their bits compare as they do.
#[derive(Clone, Copy)]
struct Waiting(u64);

impl Waiting {
    #[inline(always)]
    fn new(distance: f32, child: Child) -> Self {
        Self(u64::from(distance.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn distance(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

impl WideTree {
    /// No item.
    pub(crate) const NONE: u32 = u32::MAX;

    /// The tree over boxes in a unit frame.
    pub(crate) fn build(boxes: impl Iterator<Item = (Vec3, Vec3)>) -> Self {
        let items: Vec<Item> =
            boxes.map(|(min, max)| Item(Aabb { min: min.into(), max: max.into() })).collect();
        if items.is_empty() {
            return Self { nodes: vec![Node::EMPTY], blocks: Vec::new(), depth: 1, isa: Isa::best() };
        }
        let one_item_a_leaf = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        let binary = obvhs::bvh2::builder::build_bvh2(&items, one_item_a_leaf, &mut Duration::default());
        collapse::collapse(&binary)
    }

    /// Which items stand in which block.
    pub(crate) fn blocks(&self) -> &[[u32; BLOCK]] {
        &self.blocks
    }

    /// Bytes on the heap.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.blocks)
    }

    /// The tree without its items, for those that keep them themselves.
    pub(crate) fn take_blocks(&mut self) -> Vec<[u32; BLOCK]> {
        std::mem::take(&mut self.blocks)
    }

    /// The same tree, walked with the instructions of any processor.
    #[cfg(test)]
    pub(crate) fn with_portable_instructions(self) -> Self {
        Self { isa: Isa::Portable, ..self }
    }

    /// Shows `visitor` the blocks whose boxes the ray meets before the limit, near boxes first, with the instructions of the
    /// processor.
    #[inline(always)]
    pub(crate) fn walk(&self, ray: &FrameRay, limit: f32, visitor: &mut impl Visitor) {
        match self.isa {
            Isa::Portable => self.walk_in::<Portable>(ray, limit, visitor),
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            // SAFETY: `Isa::Avx2` stands only where the processor was asked for these instructions.
            Isa::Avx2 => unsafe { avx2::walk(self, ray, limit, visitor) },
        }
    }

    #[inline(always)]
    fn walk_in<L: Lanes>(&self, ray: &FrameRay, limit: f32, visitor: &mut impl Visitor) {
        // Not filled with anything: that would take longer than a ray that misses.
        if self.depth <= SHALLOW {
            let mut stack = [MaybeUninit::uninit(); SHALLOW * (WIDTH - 1) + 1];
            self.walk_with::<L>(&mut Stack::new(&mut stack), ray, limit, visitor);
        } else {
            let mut stack = vec![MaybeUninit::uninit(); self.depth * (WIDTH - 1) + 1];
            self.walk_with::<L>(&mut Stack::new(&mut stack), ray, limit, visitor);
        }
    }

    #[inline(always)]
    fn walk_with<L: Lanes>(
        &self,
        stack: &mut Stack<'_>,
        ray: &FrameRay,
        mut limit: f32,
        visitor: &mut impl Visitor,
    ) {
        let slabs = Slabs::<L>::new(ray);
        let mut current = Child(0);
        loop {
            match current.kind() {
                Kind::Node(index) => {
                    let node = &self.nodes[index];
                    let (enter, exit) = slabs.cut(node);
                    let mut met = enter.at_most(exit.min(L::splat(limit)));
                    if met != 0 {
                        let mut distances = [0.0; WIDTH];
                        enter.store(&mut distances);
                        let mut next = || {
                            let slot = met.trailing_zeros() as usize & (WIDTH - 1);
                            met &= met - 1;
                            (Waiting::new(distances[slot], node.children[slot]), met != 0)
                        };
                        let (mut first, more) = next();
                        if !more {
                            current = first.child();
                            continue;
                        }
                        let (mut second, more) = next();
                        if second.0 < first.0 {
                            (first, second) = (second, first);
                        }
                        if !more {
                            stack.push(second);
                            current = first.child();
                            continue;
                        }
                        // Three or more: sorted by insertion, the farthest first.
                        let bottom = stack.height;
                        stack.push(second);
                        stack.push(first);
                        loop {
                            let (entry, more) = next();
                            stack.insert(entry, bottom);
                            if !more {
                                break;
                            }
                        }
                    }
                }
                Kind::Leaf { first, blocks } => {
                    for block in first..first + blocks {
                        match visitor.visit::<L>(block, limit) {
                            ControlFlow::Continue(new_limit) => limit = new_limit,
                            ControlFlow::Break(()) => return,
                        }
                    }
                }
            }
            // The nearest of what waits, unless something nearer has been found since.
            loop {
                let Some(next) = stack.pop() else { return };
                if next.distance() <= limit {
                    current = next.child();
                    break;
                }
            }
        }
    }
}

/// What waits, the nearest on top.
struct Stack<'s> {
    entries: &'s mut [MaybeUninit<Waiting>],
    /// So many from the first on are initialised.
    height: usize,
}

impl<'s> Stack<'s> {
    fn new(entries: &'s mut [MaybeUninit<Waiting>]) -> Self {
        Self { entries, height: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: Waiting) {
        self.entries[self.height].write(entry);
        self.height += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Waiting> {
        self.height = self.height.checked_sub(1)?;
        Some(self.read(self.height))
    }

    /// Below the nearer ones of those above `bottom`.
    #[inline(always)]
    fn insert(&mut self, entry: Waiting, bottom: usize) {
        let mut place = self.height;
        while place > bottom && self.read(place - 1).0 < entry.0 {
            self.entries[place] = self.entries[place - 1];
            place -= 1;
        }
        self.entries[place].write(entry);
        self.height += 1;
    }

    /// One of those that were pushed, or the one on top that was just popped.
    #[inline(always)]
    #[allow(unsafe_code)]
    fn read(&self, place: usize) -> Waiting {
        // SAFETY: places below the height have been written by `push` or `insert`, and `pop` only lowers the height.
        unsafe { self.entries[place].assume_init() }
    }
}

/// What the box tests need to know of a ray.
struct Slabs<L> {
    reciprocal: [L; 3],
    offset: [L; 3],
    /// The rows of a node's bounds where the ray enters.
    near: [usize; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    fn new(ray: &FrameRay) -> Self {
        let (r, o) = (ray.reciprocal, -ray.origin * ray.reciprocal);
        Self {
            reciprocal: [L::splat(r.x), L::splat(r.y), L::splat(r.z)],
            offset: [L::splat(o.x), L::splat(o.y), L::splat(o.z)],
            near: [usize::from(r.x < 0.0), 2 + usize::from(r.y < 0.0), 4 + usize::from(r.z < 0.0)],
        }
    }

    /// Where the ray enters the boxes of a node, not before it starts, and where it leaves them, padded.
    #[inline(always)]
    fn cut(&self, node: &Node) -> (L, L) {
        let [x, y, z] = self.near;
        let enter =
            self.along(node, 0, x).max(self.along(node, 1, y)).max(self.along(node, 2, z).max(L::splat(0.0)));
        let exit = self.along(node, 0, x ^ 1).min(self.along(node, 1, y ^ 1)).min(self.along(node, 2, z ^ 1));
        // A hit may stand in front of the advanced origin by the rounding of that origin.
        (enter, exit.mul_add(L::splat(1.0 + 1e-6), L::splat(PAD)))
    }

    #[inline(always)]
    fn along(&self, node: &Node, axis: usize, row: usize) -> L {
        L::load(&node.bounds[row]).mul_add(self.reciprocal[axis], self.offset[axis])
    }
}
