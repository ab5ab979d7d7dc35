//! The nodes of one sample's ray tree that wait to be followed, the last one first.
//!
//! A node is written field by field where it is followed from, and never moved: its children come to stand behind it, and when
//! they are done its place is free again. A node is too large for registers, and copying in large pieces what was just written in
//! small ones makes the processor wait (measured: ARCHITECTURE.md).

use crate::whereabouts::Whereabouts;
use vitrum_geometry::Query;
use vitrum_math::Rgb;

/// A hit has so many children at most: mirrored, transmitted, scattered.
const MOST_CHILDREN: usize = 3;

/// So many free places one after the other are used again, though that moves a node: a long chain, in which each node has one child,
/// would leave one for each.
const FAR: u32 = 32;

/// A ray, and what its radiance counts for.
#[derive(Clone, Copy)]
pub(crate) struct Node<M, W> {
    pub(crate) query: Query,
    pub(crate) throughput: Rgb,
    /// Product of eta² over the crossings so far: throughput times this is the weight without the radiance factor, by which
    /// subtrees are judged.
    pub(crate) eta_squared: f64,
    pub(crate) depth: u32,
    /// What it goes through.
    pub(crate) media: W,
    pub(crate) memory: M,
}

/// The nodes that wait.
pub(crate) struct RayTree<M, W> {
    places: Vec<Place<M, W>>,
    /// The place of the last one.
    last: Option<u32>,
    waiting: usize,
}

#[derive(Clone, Copy)]
struct Place<M, W> {
    node: Node<M, W>,
    /// The place of the one that waited before it.
    before: Option<u32>,
}

/// A node that is followed, and where its children are put.
type Taken<'t, M, W> = (&'t mut Node<M, W>, Children<'t, M, W>);

/// Where the children of a node are put.
pub(crate) struct Children<'t, M, W> {
    free: &'t mut [Place<M, W>],
    /// The place of the first of them.
    first: u32,
    count: u32,
    last: &'t mut Option<u32>,
    waiting: &'t mut usize,
}

impl<M, W> Default for RayTree<M, W> {
    fn default() -> Self {
        Self { places: Vec::new(), last: None, waiting: 0 }
    }
}

impl<M: Copy, W: Whereabouts> RayTree<M, W> {
    /// Begins a tree with a camera ray.
    #[inline]
    pub(crate) fn plant(&mut self, query: Query, media: W, memory: M) {
        if self.places.is_empty() {
            let (throughput, eta_squared, depth) = (Rgb::ONE, 1.0, 0);
            let node = Node { query, throughput, eta_squared, depth, media, memory };
            self.places.resize(1 + MOST_CHILDREN, Place { node, before: None });
        }
        let Place { node, before } = &mut self.places[0];
        node.query = query;
        node.throughput = Rgb::ONE;
        node.eta_squared = 1.0;
        node.depth = 0;
        node.media = media;
        node.memory = memory;
        *before = None;
        (self.last, self.waiting) = (Some(0), 1);
    }

    /// The next node, and where its children are put.
    // Always: there are six walkers, and with so many callers the compiler would not. All these together cost 2 %.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<Taken<'_, M, W>> {
        let mut at = self.last?;
        let lowest = self.places[at as usize].before.map_or(0, |before| before + 1);
        if at - lowest >= FAR {
            self.places[lowest as usize] = self.places[at as usize];
            at = lowest;
        }
        let first = at + 1;
        let enough = first as usize + MOST_CHILDREN;
        if self.places.len() < enough {
            self.places.resize(2 * enough, self.places[0]);
        }
        let (taken, free) = self.places.split_at_mut(first as usize);
        let Place { node, before } = taken.last_mut()?;
        self.last = *before;
        self.waiting -= 1;
        Some((node, Children { free, first, count: 0, last: &mut self.last, waiting: &mut self.waiting }))
    }
}

impl<M, W> Children<'_, M, W> {
    /// Adds one that is to be written, and is followed next.
    #[inline]
    pub(crate) fn push(&mut self) -> &mut Node<M, W> {
        let Place { node, before } = &mut self.free[self.count as usize];
        *before = *self.last;
        *self.last = Some(self.first + self.count);
        self.count += 1;
        *self.waiting += 1;
        node
    }

    /// How many nodes of the tree wait.
    #[inline]
    pub(crate) fn waiting(&self) -> usize {
        *self.waiting
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vitrum_math::{DVec3, Ray};

    fn tree() -> RayTree<u32, ()> {
        let mut tree = RayTree::default();
        tree.plant(Query::new(Ray::new(DVec3::ZERO, DVec3::Z)), (), 0);
        tree
    }

    /// Names of the nodes of a tree in the order in which they are followed; `children` names those of a node.
    fn followed(children: impl Fn(u32) -> Vec<u32>) -> (Vec<u32>, usize) {
        let (mut tree, mut order) = (tree(), Vec::new());
        let mut waiting = 1;
        while let Some((node, mut free)) = tree.next() {
            let name = node.memory;
            order.push(name);
            waiting -= 1;
            for child in children(name) {
                free.push().memory = child;
                waiting += 1;
            }
            assert_eq!(free.waiting(), waiting);
        }
        (order, tree.places.len())
    }

    #[test]
    fn the_last_child_is_followed_first() {
        let children = |name| match name {
            0 => vec![1, 2, 3],
            3 => vec![4],
            2 => vec![5, 6],
            _ => vec![],
        };
        assert_eq!(followed(children).0, [0, 3, 4, 2, 6, 5, 1]);
    }

    /// A chain of a hundred thousand nodes needs no more room than one of a hundred, and nothing that waits below it is lost.
    #[test]
    fn long_chains_use_places_again() {
        let chain = |length: u32| {
            move |name| match name {
                0 => vec![length + 1, 1],
                name if name < length => vec![name + 1],
                name if name > length && name < length + 50 => vec![name + 100, name + 1],
                _ => vec![],
            }
        };
        let (order, room) = followed(chain(100));
        let (longer, same) = followed(chain(100_000));
        assert_eq!(longer.len() - order.len(), 99_900);
        assert!(longer.iter().take(100_001).copied().eq(0..=100_000));
        assert_eq!(room, same);
    }
}
