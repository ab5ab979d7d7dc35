//! A tree of boxes with eight children a node, over anything that has bounds: the triangles of a mesh, the objects of a
//! scene.
//!
//! The boxes live in a *unit frame* (see [`UnitFrame`](frame::UnitFrame)); all roundings of a ray and of a box test there
//! displace a point by less than 1e-6, and every box is padded by [`PAD`], twice that. Boxes are therefore conservative:
//! traversal finds every item whose bounds the exact ray meets, and neither the shape of the tree nor the instructions that
//! walk it have a say in what is hit.
//!
//! obvhs builds a binary tree, big ones in [`parts`] (PLOC with reinsertion; D. Meister and J. Bittner, Parallel Locally-Ordered Clustering for
//! Bounding Volume Hierarchy Construction, 2018), [`collapse`] makes it wide, [`walk`](WideTree::walk) traverses it with
//! the [`Lanes`] of the processor.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod collapse;
mod frame;
mod isa;
mod lanes;
mod parts;
mod traverse;

pub(crate) use frame::{ExactRay, FrameRay, Row, UnitFrame};
pub(crate) use isa::{Isa, Task};
pub(crate) use lanes::{Doubles, Lanes, Portable, Processor};
pub(crate) use traverse::{Part, Visitor};

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::{Boundable, BvhBuildParams};
use std::time::Duration;
use vitrum_math::Vec3;

/// How much time goes into building a tree. What is hit does not depend on it. The numbers are of meshes of 10, 70 and 200
/// thousand triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Build {
    /// The least, for looking at a big mesh once: two thirds of what `Medium` takes, for rays that are 2 to 4 % slower.
    Fast,
    /// As much as most pictures earn back.
    #[default]
    Medium,
    /// Five to seven times as much, for rays that are 2 to 4 % faster: for long renders.
    Best,
}

impl Build {
    fn parameters(self) -> BvhBuildParams {
        let preset = match self {
            Self::Fast => BvhBuildParams::fast_build(),
            Self::Medium => BvhBuildParams::medium_build(),
            Self::Best => BvhBuildParams::very_slow_build(),
        };
        BvhBuildParams { max_prims_per_leaf: 1, pre_split: false, ..preset }
    }
}

/// Padding of every box, in units of the frame.
const PAD: f32 = 2e-6;

/// Trees over more items are built in parts.
const MANY: usize = if cfg!(test) { 1000 } else { 1 << 17 };

/// Children of a node.
const WIDTH: usize = 8;

/// Items in a block of a leaf.
pub(crate) const BLOCK: usize = 16;

/// What processors without AVX-512 look at together.
const HALF: usize = BLOCK / 2;

/// What a slot of a node leads to: the number of a node, or bits of a leaf.
///
/// From the highest bit: one for a leaf; three for the number of halves of blocks; five for its reach, as a power of two,
/// where the exponent of a float stands; the number of the first block.
#[derive(Clone, Copy, Debug)]
struct Child(u32);

/// What a child is.
enum Kind {
    Node(usize),
    Leaf(Leaf),
}

/// Some items.
#[derive(Clone, Copy)]
struct Leaf {
    /// The first block that they stand in.
    first: usize,
    /// One to eight halves of blocks.
    halves: usize,
    /// No item has bounds with a diagonal longer than this, which is 2^-22 or more.
    reach: f32,
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const HALVES: u32 = 28;
    const REACH: u32 = 23;
    /// Blocks are at most so many: enough for a hundred million triangles.
    const BLOCKS: usize = 1 << Self::REACH;
    /// The exponent (biased, as in a float) of the smallest reach.
    const SMALLEST: u32 = 127 - 22;

    fn node(index: usize) -> Self {
        Self(u32::try_from(index).expect("fewer nodes than items"))
    }

    /// One to eight halves of blocks, of items whose bounds have a diagonal of `longest` at most.
    fn leaf(first: usize, halves: usize, longest: f32) -> Self {
        assert!((1..=8).contains(&halves) && first < Self::BLOCKS);
        let exponent = (longest.to_bits() >> 23) + 1;
        let reach = exponent.clamp(Self::SMALLEST, Self::SMALLEST + 31) - Self::SMALLEST;
        Self(Self::LEAF | reach << Self::REACH | (halves as u32 - 1) << Self::HALVES | first as u32)
    }

    #[inline(always)]
    fn kind(self) -> Kind {
        if self.0 & Self::LEAF == 0 {
            Kind::Node(self.0 as usize)
        } else {
            Kind::Leaf(Leaf {
                first: self.0 as usize & (Self::BLOCKS - 1),
                halves: 1 + (self.0 >> Self::HALVES & 7) as usize,
                reach: f32::from_bits((self.0 & 31 << Self::REACH) + (Self::SMALLEST << Self::REACH)),
            })
        }
    }
}

/// Eight boxes. Four lines of the cache, so that no row lies across two and an address is a shift away.
#[derive(Clone, Debug)]
#[repr(C, align(256))]
struct Node {
    /// By axis, and by child the lower and then the upper sides.
    bounds: [[f32; 2 * WIDTH]; 3],
    children: [Child; WIDTH],
}

impl Node {
    /// Boxes that no ray meets.
    const EMPTY: Self = {
        let mut none = [f32::INFINITY; 2 * WIDTH];
        let mut slot = WIDTH;
        while slot < 2 * WIDTH {
            none[slot] = f32::NEG_INFINITY;
            slot += 1;
        }
        Self { bounds: [none; 3], children: [Child(0); WIDTH] }
    };

    fn set(&mut self, slot: usize, min: Vec3, max: Vec3, child: Child) {
        for axis in 0..3 {
            self.bounds[axis][slot] = min[axis];
            self.bounds[axis][WIDTH + slot] = max[axis];
        }
        self.children[slot] = child;
    }
}

/// A tree over items, which stand in blocks of up to [`BLOCK`].
#[derive(Clone, Debug)]
pub(crate) struct WideTree<B> {
    nodes: Vec<Node>,
    blocks: Vec<B>,
    depth: usize,
    isa: Isa,
}

/// The numbers of the items in a block; [`NONE`] where it is not full.
pub(crate) type Numbers = [u32; BLOCK];

/// No item.
pub(crate) const NONE: u32 = u32::MAX;

struct Item(Aabb);

impl Boundable for Item {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// What looking at the items of a leaf costs, next to a node.
#[derive(Clone, Copy)]
pub(crate) enum Items {
    /// A block of them at a time.
    Together(f32),
    /// Each by itself.
    OneByOne(f32),
}

impl WideTree<Numbers> {
    /// The tree over boxes in a unit frame; `None` if there are too many.
    pub(crate) fn build(
        boxes: impl Iterator<Item = (Vec3, Vec3)>,
        items: Items,
        build: Build,
    ) -> Option<Self> {
        let boxes: Vec<Item> =
            boxes.map(|(min, max)| Item(Aabb { min: min.into(), max: max.into() })).collect();
        if boxes.is_empty() {
            return Some(Self { nodes: vec![Node::EMPTY], blocks: Vec::new(), depth: 1, isa: Isa::best() });
        }
        let binary =
            if boxes.len() > MANY { parts::build(&boxes, build) } else { build_at_once(&boxes, build) };
        drop(boxes);
        collapse::collapse(&binary, items)
    }
}

fn build_at_once(boxes: &[Item], build: Build) -> Bvh2 {
    obvhs::bvh2::builder::build_bvh2(boxes, build.parameters(), &mut Duration::default())
}

impl<B> WideTree<B> {
    /// The same tree with something else in its blocks.
    pub(crate) fn map<C: Send>(self, block: impl Fn(B) -> C + Sync + Send) -> WideTree<C>
    where
        B: Send,
    {
        let Self { nodes, blocks, depth, isa } = self;
        WideTree { nodes, blocks: parts::each(blocks, block), depth, isa }
    }

    /// All blocks.
    pub(crate) fn blocks(&self) -> &[B] {
        &self.blocks
    }

    /// Bytes on the heap.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.blocks)
    }

    /// The same tree, walked with these instructions.
    #[cfg(test)]
    pub(crate) fn with_instructions(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// Does some work with the instructions that the tree is to be walked with.
    #[inline(always)]
    pub(crate) fn run<T: Task>(&self, task: &mut T) -> T::Output {
        self.isa.run(task)
    }
}
