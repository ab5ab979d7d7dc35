//! From obvhs's binary tree to the wide one.
//!
//! Which subtrees become the children of one wide node is chosen by dynamic programming over the surface area heuristic, as
//! for compressed wide trees (H. Ylitie, T. Karras and S. Laine, Efficient Incoherent Ray Traversal on GPUs Through
//! Compressed Wide BVHs, 2017, section 3.1): C(n, i) is the least cost of the subtree n laid out as a forest of at most i
//! wide subtrees.

use super::isa::Isa;
use super::{BLOCK, Child, HALF, Items, NONE, Node, Numbers, PAD, WIDTH, WideTree};
use obvhs::bvh2::Bvh2;
use vitrum_math::Vec3;

/// A leaf holds at most so many blocks. With four in the place of two, rays are up to 8 % faster in meshes, because there is
/// less to fetch from memory.
const LEAF_BLOCKS: usize = 4;

/// Costs of the forests of one to seven subtrees.
type Costs = [f32; WIDTH - 1];

struct Collapse<'b> {
    binary: &'b Bvh2,
    items: Items,
    /// Of each inner node, under the number of its pair of children; leaves are many and their costs soon counted.
    inner: Vec<Inner>,
}

#[derive(Clone, Copy)]
struct Inner {
    costs: Costs,
    /// Items below.
    size: u32,
}

/// `None` if there are more blocks than can be numbered.
pub(super) fn collapse(binary: &Bvh2, items: Items) -> Option<WideTree<Numbers>> {
    let none = Inner { costs: [0.0; WIDTH - 1], size: 0 };
    let mut collapse = Collapse { binary, items, inner: vec![none; binary.nodes.len() / 2] };
    collapse.count_costs();
    collapse.lay_out()
}

impl Collapse<'_> {
    fn children(&self, node: usize) -> Option<[usize; 2]> {
        let node = &self.binary.nodes[node];
        (node.prim_count == 0).then(|| [node.first_index as usize, node.first_index as usize + 1])
    }

    fn half_area(&self, node: usize) -> f32 {
        self.binary.nodes[node].aabb().half_area()
    }

    /// Where an inner node with these children keeps its costs: pairs begin at odd numbers, after the root.
    fn pair([left, _]: [usize; 2]) -> usize {
        debug_assert!(left % 2 == 1);
        left / 2
    }

    /// Costs of a node, and the items below.
    fn counted(&self, node: usize) -> Inner {
        match self.children(node) {
            Some(children) => self.inner[Self::pair(children)],
            None => {
                let size = self.binary.nodes[node].prim_count;
                Inner { costs: [self.leaf_cost(node, size); WIDTH - 1], size }
            }
        }
    }

    /// From the leaves up.
    fn count_costs(&mut self) {
        // Children stand after their parents here, whatever their order in memory.
        let mut order: Vec<u32> = Vec::with_capacity(self.inner.len());
        let mut open = vec![0];
        while let Some(node) = open.pop() {
            if let Some(children) = self.children(node) {
                order.push(node as u32);
                open.extend(children);
            }
        }
        for &node in order.iter().rev() {
            let node = node as usize;
            let Some([left, right]) = self.children(node) else { continue };
            let (left_below, right_below) = (self.counted(left), self.counted(right));
            let size = left_below.size + right_below.size;
            let both = (&left_below.costs, &right_below.costs);
            let inner = self.half_area(node) + split(both.0, both.1, WIDTH).0;
            let mut costs = [inner.min(self.leaf_cost(node, size)); WIDTH - 1];
            for roots in 2..WIDTH {
                costs[roots - 1] = costs[roots - 2].min(split(both.0, both.1, roots).0);
            }
            self.inner[Self::pair([left, right])] = Inner { costs, size };
        }
    }

    fn leaf_cost(&self, node: usize, items: u32) -> f32 {
        let blocks = (items as usize).div_ceil(BLOCK);
        if blocks > LEAF_BLOCKS {
            return f32::INFINITY;
        }
        self.half_area(node)
            * match self.items {
                Items::Together(cost) => cost * blocks as f32,
                Items::OneByOne(cost) => cost * items as f32,
            }
    }

    /// From the root down.
    fn lay_out(&self) -> Option<WideTree<Numbers>> {
        let mut tree = WideTree { nodes: vec![Node::EMPTY], blocks: Vec::new(), depth: 0, isa: Isa::best() };
        // Binary subtrees that wait to become wide nodes: where, and how deep.
        let mut open = vec![(0usize, 0usize, 1usize)];
        let mut roots = Vec::with_capacity(WIDTH);
        while let Some((binary, wide, depth)) = open.pop() {
            tree.depth = tree.depth.max(depth);
            roots.clear();
            match self.children(binary) {
                // A root that is a leaf already.
                None => roots.push(binary),
                Some(_) if binary == 0 && self.is_leaf(binary) => roots.push(binary),
                Some([left, right]) => {
                    let (_, to_left) = split(&self.counted(left).costs, &self.counted(right).costs, WIDTH);
                    self.forest(left, to_left, &mut roots);
                    self.forest(right, WIDTH - to_left, &mut roots);
                }
            }
            for (slot, &root) in roots.iter().enumerate() {
                let child = if self.is_leaf(root) {
                    let first = tree.blocks.len();
                    if first >= Child::BLOCKS {
                        return None;
                    }
                    let longest = self.fill_blocks(root, &mut tree.blocks);
                    Child::leaf(first, (self.counted(root).size as usize).div_ceil(HALF), longest)
                } else {
                    tree.nodes.push(Node::EMPTY);
                    open.push((root, tree.nodes.len() - 1, depth + 1));
                    Child::node(tree.nodes.len() - 1)
                };
                let aabb = self.binary.nodes[root].aabb();
                let (min, max) = (Vec3::from(aabb.min), Vec3::from(aabb.max));
                tree.nodes[wide].set(slot, min - Vec3::splat(PAD), max + Vec3::splat(PAD), child);
            }
        }
        Some(tree)
    }

    /// Whether the subtree costs least as one leaf.
    fn is_leaf(&self, node: usize) -> bool {
        let Inner { costs, size } = self.counted(node);
        self.children(node).is_none() || self.leaf_cost(node, size) <= costs[0]
    }

    /// The roots of the cheapest forest of at most `roots` subtrees.
    fn forest(&self, node: usize, roots: usize, into: &mut Vec<usize>) {
        let costs = self.counted(node).costs;
        // As few as cost no more.
        let roots = (1..=roots).find(|&fewer| costs[fewer - 1] <= costs[roots - 1]).unwrap_or(roots);
        match self.children(node) {
            Some([left, right]) if roots > 1 => {
                let (_, to_left) = split(&self.counted(left).costs, &self.counted(right).costs, roots);
                self.forest(left, to_left, into);
                self.forest(right, roots - to_left, into);
            }
            _ => into.push(node),
        }
    }

    /// Puts the items below `root` into new blocks; returns the longest diagonal of the boxes around them.
    fn fill_blocks(&self, root: usize, blocks: &mut Vec<Numbers>) -> f32 {
        let mut filled = BLOCK;
        let mut longest = 0.0f32;
        let mut open = vec![root];
        while let Some(node) = open.pop() {
            if let Some([left, right]) = self.children(node) {
                open.extend([right, left]);
                continue;
            }
            let node = &self.binary.nodes[node];
            longest = longest.max(node.aabb().diagonal().length());
            let items = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            for &item in &self.binary.primitive_indices[items] {
                if filled == BLOCK {
                    blocks.push([NONE; BLOCK]);
                    filled = 0;
                }
                blocks.last_mut().expect("just made")[filled] = item;
                filled += 1;
            }
        }
        longest
    }
}

/// The cheapest way to give `roots` ≥ 2 subtrees to two children, and how many the left one gets.
fn split(left: &Costs, right: &Costs, roots: usize) -> (f32, usize) {
    let mut best = (f32::INFINITY, 1);
    for to_left in 1..roots {
        let cost = left[to_left - 1] + right[roots - to_left - 1];
        if cost < best.0 {
            best = (cost, to_left);
        }
    }
    best
}
