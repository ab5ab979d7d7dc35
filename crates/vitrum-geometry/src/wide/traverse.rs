//! From the root to the leaves that a ray meets.

use super::frame::FrameRay;
use super::lanes::{Lanes, Processor};
use super::{BLOCK, Child, HALF, Kind, Leaf, Node, WIDTH, WideTree};
use std::mem::MaybeUninit;
use std::ops::ControlFlow;

/// What happens at the leaves.
pub(crate) trait Visitor<B> {
    /// Whether near boxes come first. Looking for anything at all is faster without an order.
    const ORDERED: bool;

    /// Looks at a part of a leaf whose box the ray meets before the limit; returns the new limit (see
    /// [`RayScale::box_limit`](super::RayScale::box_limit)), or breaks off. Must be `#[inline(always)]`.
    fn visit<P: Processor>(&mut self, part: Part<'_, B>, limit: f32) -> ControlFlow<(), f32>;
}

/// The items of a leaf that a processor looks at together: a block, or half of one.
pub(crate) struct Part<'t, B> {
    pub(crate) block: &'t B,
    /// The number of the block.
    pub(crate) index: usize,
    /// The first item that belongs here: 0, or [`HALF`].
    pub(crate) from: usize,
    /// No item has bounds with a diagonal longer than this, which is 2^-22 or more.
    pub(crate) reach: f32,
}

/// Levels whose nodes fit on the machine's stack while they wait; deeper trees (which only pathological input makes) use
/// the heap. So few in tests that both are used.
const SHALLOW: usize = if cfg!(test) { 3 } else { 24 };

/// Room for what waits. Aligned, and with it the whole frame of the function that walks: otherwise half of the registers
/// that it puts away lie across two lines of the cache.
#[repr(align(64))]
struct Shallow([MaybeUninit<Waiting>; SHALLOW * (WIDTH - 1) + 1]);

/// A node or leaf that waits, after the distance to it: distances are not negative, so their bits compare as they do.
#[derive(Clone, Copy)]
struct Waiting(u64);

impl Waiting {
    #[inline(always)]
    fn new(distance: f32, child: Child) -> Self {
        Self(u64::from(distance.to_bits()) << 32 | u64::from(child.0))
    }

    /// Whether it is no farther than the limit (or anything, should that be negative).
    #[inline(always)]
    fn is_before(self, limit: f32) -> bool {
        (self.0 >> 32) as u32 <= limit.to_bits()
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// The nearer one first, without a branch: which one it is can't be foreseen.
#[inline(always)]
fn in_order(a: Waiting, b: Waiting) -> (Waiting, Waiting) {
    (Waiting(a.0.min(b.0)), Waiting(a.0.max(b.0)))
}

impl<B> WideTree<B> {
    /// Shows `visitor` the blocks whose boxes the ray meets before the limit.
    #[inline(always)]
    pub(crate) fn walk<P: Processor, V: Visitor<B>>(&self, ray: &FrameRay, mut limit: f32, visitor: &mut V) {
        // Not filled with anything: that would take longer than a ray that misses.
        let mut shallow = Shallow([MaybeUninit::uninit(); SHALLOW * (WIDTH - 1) + 1]);
        let mut deep;
        let mut stack = Stack::new(if self.depth <= SHALLOW {
            &mut shallow.0
        } else {
            deep = self.deep_stack();
            &mut deep
        });
        let slabs = Slabs::<P::Node>::new(ray);
        let mut current = Child(0);
        loop {
            match current.kind() {
                Kind::Node(index) => {
                    let node = self.node(index);
                    let (enter, exit) = slabs.cut(node, limit);
                    let met = enter.at_most(exit);
                    if met != 0 {
                        current = stack.descend(node, enter, met, V::ORDERED);
                        continue;
                    }
                }
                Kind::Leaf(leaf) => {
                    let Leaf { first, halves, reach } = leaf;
                    let whole = P::Leaf::COUNT == BLOCK;
                    for part in 0..if whole { halves.div_ceil(2) } else { halves } {
                        let (index, from) =
                            if whole { (first + part, 0) } else { (first + part / 2, part % 2 * HALF) };
                        let part = Part { block: self.block(index), index, from, reach };
                        match visitor.visit::<P>(part, limit) {
                            ControlFlow::Continue(new_limit) => limit = new_limit,
                            ControlFlow::Break(()) => return,
                        }
                    }
                }
            }
            // The nearest of what waits, unless something nearer has been found since.
            loop {
                let Some(next) = stack.pop() else { return };
                if next.is_before(limit) {
                    current = next.child();
                    break;
                }
            }
        }
    }

    // Far from the loop, which is to have the registers for itself.
    #[cold]
    #[inline(never)]
    fn deep_stack(&self) -> Vec<MaybeUninit<Waiting>> {
        vec![MaybeUninit::uninit(); self.depth * (WIDTH - 1) + 1]
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn node(&self, index: usize) -> &Node {
        debug_assert!(index < self.nodes.len());
        // SAFETY: `collapse` makes a child of the node that it puts there.
        unsafe { self.nodes.get_unchecked(index) }
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn block(&self, index: usize) -> &B {
        debug_assert!(index < self.blocks.len());
        // SAFETY: `collapse` makes a leaf of the blocks that it puts there, and `map` leaves them their number.
        unsafe { self.blocks.get_unchecked(index) }
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

    /// Puts away the children in `met` of a node, of which there is one at least, except for the nearest, which comes back.
    ///
    /// Most rays meet one to four. These are sorted in registers: a loop whose turns can't be foreseen costs more than
    /// comparing twice.
    #[inline(always)]
    fn descend<L: Lanes>(&mut self, node: &Node, enter: L, mut met: u32, ordered: bool) -> Child {
        let mut slot = first_of(met);
        met &= met - 1;
        if met == 0 {
            return node.children[slot];
        }
        if !ordered {
            while met != 0 {
                self.push(Waiting::new(0.0, node.children[slot]));
                slot = first_of(met);
                met &= met - 1;
            }
            return node.children[slot];
        }
        let mut distances = Distances([0.0; WIDTH]);
        enter.store(&mut distances.0);
        let Distances(distances) = &distances;
        let a = Waiting::new(distances[slot], node.children[slot]);
        slot = first_of(met);
        met &= met - 1;
        let b = Waiting::new(distances[slot], node.children[slot]);
        let (a, b) = in_order(a, b);
        if met == 0 {
            self.push(b);
            return a.child();
        }
        slot = first_of(met);
        met &= met - 1;
        let c = Waiting::new(distances[slot], node.children[slot]);
        let (b, c) = in_order(b, c);
        let (mut a, b) = in_order(a, b);
        let bottom = self.height;
        self.push(c);
        self.push(b);
        while met != 0 {
            slot = first_of(met);
            met &= met - 1;
            let farther;
            (a, farther) = in_order(a, Waiting::new(distances[slot], node.children[slot]));
            self.insert(farther, bottom);
        }
        a.child()
    }

    #[inline(always)]
    fn push(&mut self, entry: Waiting) {
        *self.place(self.height) = MaybeUninit::new(entry);
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
            *self.place(place) = MaybeUninit::new(self.read(place - 1));
            place -= 1;
        }
        *self.place(place) = MaybeUninit::new(entry);
        self.height += 1;
    }

    /// One of those that were pushed, or the one on top that was just popped.
    #[inline(always)]
    #[allow(unsafe_code)]
    fn read(&mut self, place: usize) -> Waiting {
        // SAFETY: places below the height have been written by `push` or `insert`, and `pop` only lowers the height.
        unsafe { self.place(place).assume_init() }
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn place(&mut self, place: usize) -> &mut MaybeUninit<Waiting> {
        debug_assert!(place < self.entries.len());
        // SAFETY: there is room for all children but one of a node on each level of the tree, which is as many as ever wait,
        // and for one more.
        unsafe { self.entries.get_unchecked_mut(place) }
    }
}

/// Aligned for the same reason.
#[repr(align(32))]
struct Distances([f32; WIDTH]);

/// The lowest bit of a mask that is set.
#[inline(always)]
fn first_of(mask: u32) -> usize {
    mask.trailing_zeros() as usize & (WIDTH - 1)
}

/// What the box tests need to know of a ray.
struct Slabs<L> {
    reciprocal: [L; 3],
    offset: [L; 3],
    /// Where in a node's bounds of each axis the sides begin that the ray enters by, and then those that it leaves by.
    sides: &'static [[usize; 3]; 2],
}

/// The sides for every combination of signs: 0 are the lower ones, [`WIDTH`] the upper ones.
const SIDES: [[[usize; 3]; 2]; 8] = {
    let mut all = [[[0; 3]; 2]; 8];
    let mut signs = 0;
    while signs < 8 {
        let mut axis = 0;
        while axis < 3 {
            all[signs][1 - (signs >> axis & 1)][axis] = WIDTH;
            axis += 1;
        }
        signs += 1;
    }
    all
};

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    fn new(ray: &FrameRay) -> Self {
        let (r, o) = (ray.reciprocal, -ray.origin * ray.reciprocal);
        Self {
            reciprocal: [L::splat(r.x), L::splat(r.y), L::splat(r.z)],
            offset: [L::splat(o.x), L::splat(o.y), L::splat(o.z)],
            sides: &SIDES[r.is_negative_bitmask() as usize & 7],
        }
    }

    /// Where the ray enters the boxes of a node, not before it starts, and where it leaves them, or ends.
    #[inline(always)]
    fn cut(&self, node: &Node, limit: f32) -> (L, L) {
        let [[x, y, z], [far_x, far_y, far_z]] = *self.sides;
        let enter =
            self.along(node, 0, x).max(self.along(node, 1, y)).max(self.along(node, 2, z).max(L::splat(0.0)));
        let exit = self
            .along(node, 0, far_x)
            .min(self.along(node, 1, far_y))
            .min(self.along(node, 2, far_z).min(L::splat(limit)));
        (enter, exit)
    }

    #[inline(always)]
    #[allow(unsafe_code)]
    fn along(&self, node: &Node, axis: usize, sides: usize) -> L {
        // SAFETY: there are no others in `SIDES`.
        unsafe { std::hint::assert_unchecked(sides <= WIDTH) };
        L::load(&node.bounds[axis][sides..]).mul_add(self.reciprocal[axis], self.offset[axis])
    }
}
