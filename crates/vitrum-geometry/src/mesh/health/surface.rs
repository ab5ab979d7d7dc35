//! The welded faces of a mesh and their edges, found by sorting half-edges.

use glam::DVec3;

use super::{Place, weld::weld};
use crate::mesh::{MeshData, Triangle};

/// What a face is worth to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FaceKind {
    /// A corner is out of range or not finite.
    Unusable,
    /// Two corners are in one place.
    Collapsed,
    /// Three different corners on a line.
    Flat,
    /// A triangle.
    Sound,
}

impl FaceKind {
    /// Whether faces of this kind have edges.
    pub(super) fn has_edges(self) -> bool {
        matches!(self, Self::Flat | Self::Sound)
    }
}

/// One face's use of one edge. Sorted by the edge first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    /// The lower and the higher of the edge's welded vertices.
    edge: [u32; 2],
    pub(super) face: u32,
    /// The face runs from the lower vertex to the higher.
    pub(super) forward: bool,
}

/// A face that has the welded corners of a face before it.
pub(super) struct RepeatedFace {
    pub(super) face: usize,
    /// Some face before it has the same winding too.
    pub(super) same_winding: bool,
}

/// A mesh after welding.
pub(super) struct Surface<'a> {
    pub(super) data: &'a MeshData,
    /// Welded corners of each face; those of an unusable face mean nothing.
    pub(super) corners: Vec<Triangle>,
    pub(super) kinds: Vec<FaceKind>,
    half_edges: Vec<HalfEdge>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(data: &'a MeshData) -> Self {
        let welded = weld(&data.positions);
        let (corners, kinds): (Vec<_>, Vec<_>) =
            data.triangles.iter().map(|triangle| classify(*triangle, &data.positions, &welded)).unzip();
        let mut half_edges: Vec<_> = (0..)
            .zip(corners.iter().zip(&kinds))
            .filter(|(_, (_, kind))| kind.has_edges())
            .flat_map(|(face, (&[a, b, c], _))| {
                [(a, b), (b, c), (c, a)].map(|(from, to)| HalfEdge {
                    edge: [from.min(to), from.max(to)],
                    face,
                    forward: from < to,
                })
            })
            .collect();
        half_edges.sort_unstable();
        Self { data, corners, kinds, half_edges }
    }

    /// The edges, each as its faces' uses of it, in the order of their vertices.
    pub(super) fn edges(&self) -> impl Iterator<Item = &[HalfEdge]> {
        self.half_edges.chunk_by(|a, b| a.edge == b.edge)
    }

    /// Faces that have the corners of an earlier face, in no particular order.
    pub(super) fn repeated_faces(&self) -> Vec<RepeatedFace> {
        let mut order: Vec<_> = (0..)
            .zip(self.corners.iter().zip(&self.kinds))
            .filter(|(_, (_, kind))| kind.has_edges())
            .map(|(face, (corners, _))| {
                let (sorted, even) = sort_corners(*corners);
                (sorted, face, even)
            })
            .collect();
        order.sort_unstable();
        let mut repeated = Vec::new();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            let mut seen = [false; 2];
            for &(_, face, even) in group {
                if seen != [false; 2] {
                    repeated.push(RepeatedFace { face, same_winding: seen[usize::from(even)] });
                }
                seen[usize::from(even)] = true;
            }
        }
        repeated
    }

    /// Whether all indices of a face, those of its normals and texture coordinates too, name something.
    pub(super) fn in_range(&self, face: usize) -> bool {
        let data = self.data;
        let within = |triangle: Option<&Triangle>, count| {
            triangle.is_some_and(|triangle| triangle.iter().all(|&index| (index as usize) < count))
        };
        within(data.triangles.get(face), data.positions.len())
            && (data.normal_triangles.is_empty()
                || within(data.normal_triangles.get(face), data.normals.len()))
            && (data.uv_triangles.is_empty() || within(data.uv_triangles.get(face), data.uvs.len()))
    }

    /// The corners of a face that has edges.
    pub(super) fn points(&self, face: usize) -> [DVec3; 3] {
        self.corners[face].map(|vertex| self.data.positions[vertex as usize])
    }

    /// A face and its centroid, not finite where a corner is missing.
    pub(super) fn place(&self, face: usize) -> Place {
        let corner = |&index: &u32| self.data.positions.get(index as usize).copied().unwrap_or(DVec3::NAN);
        let position = self.data.triangles[face].iter().map(|index| corner(index) / 3.0).sum();
        Place { index: face, position }
    }

    /// The face that uses an edge, and the middle of the edge.
    pub(super) fn edge_place(&self, half_edge: &HalfEdge) -> Place {
        let [a, b] = half_edge.edge.map(|vertex| self.data.positions[vertex as usize]);
        Place { index: half_edge.face as usize, position: a * 0.5 + b * 0.5 }
    }
}

fn classify(triangle: Triangle, positions: &[DVec3], welded: &[u32]) -> (Triangle, FaceKind) {
    let usable = |&index: &u32| positions.get(index as usize).is_some_and(|position| position.is_finite());
    if !triangle.iter().all(usable) {
        return (triangle, FaceKind::Unusable);
    }
    let corners = triangle.map(|index| welded[index as usize]);
    let [a, b, c] = corners;
    let kind = if a == b || b == c || c == a {
        FaceKind::Collapsed
    } else if has_no_area(corners.map(|vertex| positions[vertex as usize])) {
        FaceKind::Flat
    } else {
        FaceKind::Sound
    };
    (corners, kind)
}

fn has_no_area([a, b, c]: [DVec3; 3]) -> bool {
    // Scaled to lengths near 1, so that the products neither underflow nor overflow.
    let scaled = |edge: DVec3| edge / edge.abs().max_element();
    scaled(b - a).cross(scaled(c - a)) == DVec3::ZERO
}

/// Corners in ascending order, and whether an even permutation leads there.
fn sort_corners([a, b, c]: Triangle) -> (Triangle, bool) {
    let [low, next, last] = if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    };
    if next < last { ([low, next, last], true) } else { ([low, last, next], false) }
}
