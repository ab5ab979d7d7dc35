//! Faces that cross others of the same mesh: an edge of one goes through the inside of the other.
//!
//! Candidates are faces whose boxes touch, found by joining a tree of boxes with itself. A crossing counts only where it is beyond the
//! rounding of the five determinants that decide it (J. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates, 1997, for the error bound of orient3d): faces that only touch, as neighbours do, are never taken for crossing.

use glam::DVec3;

use super::surface::{FaceKind, Surface};
use vitrum_math::Bounds;

/// Faces in a leaf of the tree: fewer cost more boxes, more cost more pairs.
const LEAF: usize = 8;

/// Of the sum of the magnitudes of all products in a determinant, what its rounding can be: (7 + 56 ε) ε, ε = 2^-53.
const ORIENT_ERROR: f64 = (7.0 + 56.0 * 1.11e-16) * 1.110_223_024_625_156_5e-16;

/// The faces that cross another, ascending.
pub(super) fn crossing_faces(surface: &Surface<'_>) -> Vec<usize> {
    let faces: Vec<u32> = (0..)
        .zip(&surface.kinds)
        .filter(|(_, kind)| **kind == FaceKind::Sound)
        .map(|(face, _)| face)
        .collect();
    let tree = Tree::new(surface, faces);
    let mut crossing = vec![false; surface.kinds.len()];
    tree.join_with_itself(0, &mut |a, b| {
        let (a, b) = (a as usize, b as usize);
        if !(crossing[a] && crossing[b]) && cross(surface, a, b) {
            (crossing[a], crossing[b]) = (true, true);
        }
    });
    (0..crossing.len()).filter(|face| crossing[*face]).collect()
}

/// A binary tree of boxes around faces, halved at the median.
struct Tree {
    nodes: Vec<Node>,
    faces: Vec<u32>,
    boxes: Vec<Bounds>,
}

struct Node {
    bounds: Bounds,
    from: usize,
    to: usize,
    /// The second child; the first stands right behind its parent. `None` in a leaf.
    second: Option<usize>,
}

impl Tree {
    fn new(surface: &Surface<'_>, faces: Vec<u32>) -> Self {
        let boxes = faces.iter().map(|face| Bounds::around(surface.points(*face as usize))).collect();
        let mut tree = Self { nodes: vec![], faces, boxes };
        let mut order: Vec<usize> = (0..tree.faces.len()).collect();
        tree.halve(&mut order, 0);
        tree.faces = order.iter().map(|at| tree.faces[*at]).collect();
        tree.boxes = order.iter().map(|at| tree.boxes[*at]).collect();
        tree
    }

    /// Adds the node of a part of the faces, which starts at a place among all of them.
    fn halve(&mut self, order: &mut [usize], from: usize) {
        let bounds = order.iter().fold(Bounds::EMPTY, |all, at| all.union(self.boxes[*at]));
        let (place, to) = (self.nodes.len(), from + order.len());
        self.nodes.push(Node { bounds, from, to, second: None });
        if order.len() <= LEAF {
            return;
        }
        let extent = bounds.extent();
        let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
        let middle = |at: &usize| self.boxes[*at].min[axis] + self.boxes[*at].max[axis];
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        let (low, high) = order.split_at_mut(half);
        self.halve(low, from);
        self.nodes[place].second = Some(self.nodes.len());
        self.halve(high, from + half);
    }

    /// Calls `meets` with each pair of faces below a node whose boxes touch.
    fn join_with_itself(&self, node: usize, meets: &mut impl FnMut(u32, u32)) {
        let Some(Node { from, to, second, .. }) = self.nodes.get(node) else { return };
        match *second {
            Some(second) => {
                self.join_with_itself(node + 1, meets);
                self.join_with_itself(second, meets);
                self.join(node + 1, second, meets);
            }
            None => (*from..*to).for_each(|a| self.pairs(a, a + 1..*to, meets)),
        }
    }

    /// The same with one face below each of two nodes.
    fn join(&self, a: usize, b: usize, meets: &mut impl FnMut(u32, u32)) {
        let (first, other) = (&self.nodes[a], &self.nodes[b]);
        if !first.bounds.touches(&other.bounds) {
            return;
        }
        let larger = first.to - first.from >= other.to - other.from;
        match (first.second, other.second) {
            (Some(second), _) if larger || other.second.is_none() => {
                self.join(a + 1, b, meets);
                self.join(second, b, meets);
            }
            (_, Some(second)) => {
                self.join(a, b + 1, meets);
                self.join(a, second, meets);
            }
            (_, None) => {
                (first.from..first.to).for_each(|face| self.pairs(face, other.from..other.to, meets));
            }
        }
    }

    fn pairs(&self, a: usize, others: std::ops::Range<usize>, meets: &mut impl FnMut(u32, u32)) {
        for b in others {
            if self.boxes[a].touches(&self.boxes[b]) {
                meets(self.faces[a], self.faces[b]);
            }
        }
    }
}

/// Whether an edge of one face certainly goes through the inside of the other. Edges that the faces share don't.
fn cross(surface: &Surface<'_>, a: usize, b: usize) -> bool {
    let (p, q) = (surface.points(a), surface.points(b));
    goes_through(&p, &q) || goes_through(&q, &p)
}

fn goes_through(edges: &[DVec3; 3], [a, b, c]: &[DVec3; 3]) -> bool {
    let sides = edges.map(|p| side(p, *a, *b, *c));
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        if sides[i] * sides[j] >= 0 {
            return false;
        }
        let (p, q) = (edges[i], edges[j]);
        let around = [side(p, q, *a, *b), side(p, q, *b, *c), side(p, q, *c, *a)];
        around == [1; 3] || around == [-1; 3]
    })
}

/// The sign of the volume of the tetrahedron of `d` over the triangle `a`, `b`, `c`; 0 where rounding decides.
fn side(d: DVec3, a: DVec3, b: DVec3, c: DVec3) -> i32 {
    let (u, v, w) = (a - d, b - d, c - d);
    let determinant = u.dot(v.cross(w));
    let cross = DVec3::new(
        (v.y * w.z).abs() + (v.z * w.y).abs(),
        (v.z * w.x).abs() + (v.x * w.z).abs(),
        (v.x * w.y).abs() + (v.y * w.x).abs(),
    );
    if determinant.abs() <= ORIENT_ERROR * u.abs().dot(cross) { 0 } else { determinant.signum() as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshData;

    /// Triangles whose corners are drawn from a small grid, so that many touch: what the tree finds is what trying all pairs finds.
    #[test]
    fn the_tree_finds_all_pairs() {
        let mut state = 1_u64;
        let mut draw = |below: u64| {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 33) % below
        };
        for grid in [12, 14] {
            // Small triangles, so that some cross and some don't.
            let mut positions = Vec::new();
            for _ in 0..300 {
                let centre = [0; 3].map(|_| draw(grid) as f64);
                positions
                    .extend((0..3).map(|_| DVec3::from(centre.map(|c| (c + draw(4) as f64) / grid as f64))));
            }
            let triangles = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let data = MeshData { positions, triangles, ..MeshData::default() };
            let surface = Surface::new(&data);
            let sound: Vec<usize> = (0..300).filter(|f| surface.kinds[*f] == FaceKind::Sound).collect();
            let crosses = |a: &usize| sound.iter().any(|b| a != b && cross(&surface, *a, *b));
            let expected: Vec<usize> = sound.iter().copied().filter(crosses).collect();
            assert!(expected.len() > 20 && expected.len() < 300, "{}", expected.len());
            assert_eq!(crossing_faces(&surface), expected);
        }
    }

    #[test]
    fn touching_is_not_crossing() {
        let wall = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        let fin = |y: f64, z: f64| [DVec3::new(0.0, y, z), DVec3::new(0.1, y, 1.0), DVec3::new(-0.1, y, 1.0)];
        assert!(goes_through(&fin(0.0, -1e-9), &wall), "a tip that looks out behind");
        assert!(!goes_through(&fin(0.0, 0.0), &wall) && !goes_through(&wall, &fin(0.0, 0.0)), "a tip on it");
        assert!(!goes_through(&fin(2.0, -1.0), &wall), "beside it");
    }
}
