//! A triangle mesh in the form that rays are traced against.

use super::MeshData;
use super::search::{AnyHit, ClosestHit};
use super::triangle::{Corners, TriangleBlock, meet};
use crate::aggregate::{Counters, Hit, Nearest};
use crate::departure::{Departure, Query};
use crate::wide::{Build, FrameRay, Items, UnitFrame, WideTree};
#[cfg(test)]
use crate::wide::{Isa, Portable};
use vitrum_math::{Bounds, DVec2, DVec3, Ray, Vec3, gamma};

/// Triangles in a unit frame of their own (single precision), with the tree that finds them.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    pub(super) frame: UnitFrame,
    bounds: Bounds,
    open: bool,
    overlaps_itself: bool,
    /// Corner positions in the unit frame.
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Corner normals for shading, unit length in the mesh's frame; empty for a mesh with flat faces.
    normals: Vec<Vec3>,
    normal_triangles: Vec<[u32; 3]>,
    /// Texture coordinates; empty where the mesh has none, or nothing shows an image.
    uvs: Vec<[f32; 2]>,
    uv_triangles: Vec<[u32; 3]>,
    /// Number of the material of each triangle; empty when all have the same.
    materials: Vec<u32>,
    pub(super) tree: WideTree<TriangleBlock>,
}

/// Measured next to Embree: from 0.2 to 0.45 rays take the same time within 3 %. A node ends in a branch that can't be
/// foreseen, most blocks in one that can.
const BLOCKS_OF_TRIANGLES: Items = Items::Together(0.3);

/// Largest coordinate of a mesh, in its own units.
const LARGEST: f64 = 1e100;

/// A mesh that can't be traced.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// No triangle with an area.
    #[error("the mesh has no triangle with an area")]
    Empty,
    /// A vertex with a coordinate that is NaN or infinite.
    #[error("{count} vertices are not finite, the first is number {first}")]
    NotFinite {
        /// How many.
        count: usize,
        /// Index of the first, from 0.
        first: usize,
    },
    /// A coordinate so large that products of a few of them overflow.
    #[error(
        "vertex {first} has the coordinate {coordinate:e}, the largest is {LARGEST:e}; scale the mesh down"
    )]
    TooFar {
        /// Index of the first such vertex, from 0.
        first: usize,
        /// Its largest coordinate, in magnitude.
        coordinate: f64,
    },
    /// A corner that names a vertex, normal or texture coordinate that does not exist.
    #[error("triangle {triangle} names a vertex, normal or texture coordinate that does not exist")]
    Index {
        /// Index of the first such triangle, from 0.
        triangle: usize,
    },
    /// More triangles than the numbers in its tree can count.
    #[error("the mesh has {0} triangles, more than its tree can hold (about a hundred million); split it")]
    TooLarge(usize),
}

/// A triangle that may be hit.
pub(super) struct Candidate {
    pub(super) face: u32,
    /// In the unit frame.
    pub(super) corners: Corners,
}

/// A point of a mesh in its own frame.
pub(crate) struct MeshPoint {
    pub(crate) point: DVec3,
    /// Geometric normal, unit length.
    pub(crate) ng: DVec3,
    /// Shading normal, not unit length; zero where the mesh has flat faces.
    pub(crate) ns: DVec3,
    /// Bound on the error of `point` per coordinate, in the units of the mesh.
    pub(crate) error: f64,
}

/// Only what is to be kept; nothing, of nothing.
fn keep<T>(all: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    all.retain(|_| *kept.next().expect("as many as triangles"));
    all.shrink_to_fit();
}

impl TriangleMesh {
    /// Prepares a mesh for tracing. Its normals, where it has any, are used for shading, its texture coordinates for images; what
    /// nobody needs is better emptied before. What is taken is used or freed before the tree is built, so that there is no second
    /// copy of the mesh beside it.
    ///
    /// # Errors
    /// [`MeshError`] for a mesh that is empty, not finite, too large, or has indices out of range.
    pub fn new(data: MeshData) -> Result<Self, MeshError> {
        Self::with_build(data, Build::default())
    }

    /// The same with more or less time for the tree. The parts of big ones (more than 131072 triangles) are built in parallel
    /// when this is called from within a pool of threads of rayon; the tree is the same.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_build(data: MeshData, build: Build) -> Result<Self, MeshError> {
        Self::check_positions(&data)?;
        if u32::try_from(data.triangles.len()).is_err() {
            return Err(MeshError::TooLarge(data.triangles.len()));
        }
        let in_range = |t: &[u32; 3], len: usize| t.iter().all(|&i| (i as usize) < len);
        let smooth = data.normal_triangles.len() == data.triangles.len();
        let bad_position = data.triangles.iter().position(|t| !in_range(t, data.positions.len()));
        let bad_normal = data
            .normal_triangles
            .iter()
            .take_while(|_| smooth)
            .position(|t| !in_range(t, data.normals.len()));
        let mapped = data.uv_triangles.len() == data.triangles.len();
        let bad_uv =
            data.uv_triangles.iter().take_while(|_| mapped).position(|t| !in_range(t, data.uvs.len()));
        if let Some(triangle) = bad_position.or(bad_normal).or(bad_uv) {
            return Err(MeshError::Index { triangle });
        }

        let MeshData {
            positions,
            mut triangles,
            normals,
            mut normal_triangles,
            uvs,
            mut uv_triangles,
            mut materials,
        } = data;
        let used = triangles.iter().flatten().map(|&i| positions[i as usize]);
        let bounds = Bounds::around(used);
        let frame = UnitFrame::around(&bounds);
        let vertices: Vec<Vec3> = positions.into_iter().map(|p| frame.inward(p).as_vec3()).collect();
        let normals: Vec<Vec3> = if smooth {
            normals.into_iter().map(|n| n.normalize_or_zero().as_vec3()).collect()
        } else {
            normal_triangles.clear();
            vec![]
        };
        let uvs: Vec<[f32; 2]> = if mapped {
            uvs.into_iter().map(|uv| uv.as_vec2().to_array()).collect()
        } else {
            uv_triangles.clear();
            vec![]
        };
        if materials.len() != triangles.len() {
            materials.clear();
        }

        // A triangle without area in the rounded frame can't be hit; its neighbours close the surface.
        let has_area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| vertices[i as usize].as_dvec3());
            (b - a).cross(c - a) != DVec3::ZERO
        };
        let kept: Vec<bool> = triangles.iter().map(has_area).collect();
        keep(&mut triangles, &kept);
        keep(&mut normal_triangles, &kept);
        keep(&mut uv_triangles, &kept);
        keep(&mut materials, &kept);
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }

        let corners = |t: &[u32; 3]| t.map(|i| vertices[i as usize]);
        let boxes = triangles.iter().map(|t| {
            let [a, b, c] = corners(t);
            (a.min(b).min(c), a.max(b).max(c))
        });
        let too_large = || MeshError::TooLarge(triangles.len());
        let tree = WideTree::build(boxes, BLOCKS_OF_TRIANGLES, build).ok_or_else(too_large)?;
        let tree = tree.map(|faces| TriangleBlock::new(faces, |face| corners(&triangles[face as usize])));
        Ok(Self {
            frame,
            bounds,
            open: false,
            overlaps_itself: false,
            vertices,
            triangles,
            normals,
            normal_triangles,
            uvs,
            uv_triangles,
            materials,
            tree,
        })
    }

    /// The same mesh, said to be open: it has no inside. A mesh is taken to be closed otherwise, for to find out costs more than to
    /// prepare it (see [`health`](super::health)).
    #[must_use]
    pub fn left_open(self) -> Self {
        Self { open: true, ..self }
    }

    /// True when it was said to be open.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// The same mesh, said to have bodies that may reach into each other: within, its surface winds around more than once.
    #[must_use]
    pub fn with_bodies_that_overlap(self) -> Self {
        Self { overlaps_itself: true, ..self }
    }

    /// True when bodies of it were said to reach into each other.
    pub fn overlaps_itself(&self) -> bool {
        self.overlaps_itself
    }

    /// False where none of its triangles has a point of a box, given in its own units.
    pub(crate) fn may_meet(&self, bounds: &Bounds) -> bool {
        let around = |face: u32| Bounds::around(self.triangle(face));
        self.bounds.touches(bounds)
            && (0..self.triangle_count() as u32).any(|face| around(face).touches(bounds))
    }

    /// What one is in its unit frame, in its own units: between its largest extent and twice that.
    pub(crate) fn unit(&self) -> f64 {
        1.0 / self.frame.scale()
    }

    /// Looks at the vertices alone: what comes before any arithmetic with them.
    ///
    /// # Errors
    /// [`MeshError`] for a vertex that is not finite, or too far away.
    pub fn check_positions(data: &MeshData) -> Result<(), MeshError> {
        let count = data.positions.iter().filter(|p| !p.is_finite()).count();
        if let Some(first) = data.positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { count, first });
        }
        let farthest = |p: &DVec3| p.abs().max_element();
        match data.positions.iter().position(|p| farthest(p) > LARGEST) {
            Some(first) => Err(MeshError::TooFar { first, coordinate: farthest(&data.positions[first]) }),
            None => Ok(()),
        }
    }

    /// The box around it, in its own units.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// How many triangles can be hit.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of a triangle, in the units of the mesh, as rays meet them.
    pub fn triangle(&self, face: u32) -> [DVec3; 3] {
        self.corners(face).map(|corner| self.frame.outward(corner.as_dvec3()))
    }

    /// The number of the material of a triangle; 0 when all have the same.
    #[inline]
    pub fn material(&self, face: u32) -> u32 {
        self.materials.get(face as usize).copied().unwrap_or(0)
    }

    /// True when its normals are interpolated.
    pub fn is_smooth(&self) -> bool {
        !self.normals.is_empty()
    }

    /// True when it has texture coordinates.
    pub fn has_uvs(&self) -> bool {
        !self.uvs.is_empty()
    }

    /// Bytes on the heap.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.vertices)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.normals)
            + size_of_val(&*self.normal_triangles)
            + size_of_val(&*self.uvs)
            + size_of_val(&*self.uv_triangles)
            + size_of_val(&*self.materials)
            + self.tree.memory()
    }

    #[inline]
    fn corners(&self, face: u32) -> [Vec3; 3] {
        self.triangles[face as usize].map(|i| self.vertices[i as usize])
    }

    /// Offers the first triangle that counts, if it is nearer than what was found before.
    #[inline]
    pub(crate) fn closest(
        &self,
        ray: &Ray,
        query: &Query,
        object: u32,
        nearest: &mut Nearest,
        counters: &mut Counters,
    ) {
        self.tree.run(&mut ClosestHit { mesh: self, ray, is_unit: false, query, object, nearest, counters });
    }

    /// True when some triangle counts and lies nearer than `limit`.
    #[inline]
    pub(crate) fn any(
        &self,
        ray: &Ray,
        query: &Query,
        object: u32,
        limit: f64,
        counters: &mut Counters,
    ) -> bool {
        self.tree.run(&mut AnyHit { mesh: self, ray, is_unit: false, query, object, limit, counters })
    }

    /// The same mesh, searched with these instructions.
    #[cfg(test)]
    pub(crate) fn with_instructions(self, isa: Isa) -> Self {
        Self { tree: self.tree.with_instructions(isa), ..self }
    }

    /// The same as [`closest`](Self::closest) by trying every triangle in double precision: the oracle that the tree is
    /// tested against.
    #[cfg(test)]
    pub(crate) fn closest_of_all(&self, ray: &Ray, query: &Query, nearest: &mut Nearest) {
        let Some(framed) = self.frame.enter::<Portable>(ray, false, f64::INFINITY) else { return };
        for face in 0..self.triangles.len() as u32 {
            let candidate = Candidate { face, corners: Corners::new(self.corners(face)) };
            if let Some(hit) = self.settle(&framed, query, 0, &candidate, &mut Counters::default()) {
                nearest.offer(hit);
            }
        }
    }

    /// Tests one triangle in double precision and asks whether it counts.
    pub(super) fn settle(
        &self,
        ray: &FrameRay,
        query: &Query,
        object: u32,
        &Candidate { face, ref corners }: &Candidate,
        counters: &mut Counters,
    ) -> Option<Hit> {
        let departed = query.departed_from(object);
        if departed.is_some_and(|d| d.face == face) {
            return None;
        }
        let met = meet(&ray.exact, corners)?;
        let mut t = ray.scale.outward(met.t);
        if let Some(departed) = departed {
            // A neighbour within the rounding error of the origin. Whether it seems to lie before or behind says nothing.
            let corners = &corners.points();
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let along = ray.exact.along().dot(normal);
            let distance = (met.t * along).abs() / normal.dot(normal).sqrt();
            if distance <= departed.error {
                if !self.goes_through_neighbour(departed, ray.exact.from(), corners, along < 0.0) {
                    counters.neighbours_ignored += 1;
                    return None;
                }
                t = t.max(0.0);
            }
        }
        query.admits(t, object, face).then_some(Hit { t, object, face, barycentrics: met.barycentrics })
    }

    /// Whether a ray that leaves a face from a point on its edge really crosses the face beyond the edge.
    ///
    /// Where the two faces meet like those of a convex solid, only a ray that is inside can cross the neighbour, on its way
    /// out; where they meet like the walls of a corner, only one that is outside, on its way in. Anything else is the rounding
    /// of the origin.
    fn goes_through_neighbour(
        &self,
        left: &Departure,
        origin: DVec3,
        corners: &[DVec3; 3],
        entering: bool,
    ) -> bool {
        let [a, b, c] = self.corners(left.face).map(|c| c.as_dvec3());
        let towards_neighbour = corners[0] + corners[1] + corners[2] - origin * 3.0;
        let convex = (b - a).cross(c - a).dot(towards_neighbour) < 0.0;
        if left.behind { convex && !entering } else { !convex && entering }
    }

    /// The point of `face` with the given weights of its second and third corner.
    #[inline(never)]
    pub(crate) fn point(&self, face: u32, [b1, b2]: [f64; 2]) -> MeshPoint {
        let [v0, v1, v2] = self.corners(face).map(|c| c.as_dvec3());
        let weights = [1.0 - b1 - b2, b1, b2];
        let p = v0 * weights[0] + v1 * weights[1] + v2 * weights[2];
        let normal = (v1 - v0).cross(v2 - v0);
        let ns = if self.is_smooth() {
            let [n0, n1, n2] =
                self.normal_triangles[face as usize].map(|i| self.normals[i as usize].as_dvec3());
            n0 * weights[0] + n1 * weights[1] + n2 * weights[2]
        } else {
            DVec3::ZERO
        };
        let point = self.frame.outward(p);
        // Interpolation rounds five times on coordinates of at most one half; then the frame's centre is added.
        let error = gamma(6) / self.frame.scale() + gamma(1) * point.abs().max_element();
        MeshPoint { point, ng: normal / normal.dot(normal).sqrt(), ns, error }
    }

    /// The texture coordinates of `face` with the given weights of its second and third corner; zero where it has none.
    pub(crate) fn uv(&self, face: u32, [b1, b2]: [f64; 2]) -> DVec2 {
        let Some(corners) = self.uv_triangles.get(face as usize) else { return DVec2::ZERO };
        let [a, b, c] = corners.map(|i| {
            let [u, v] = self.uvs[i as usize];
            DVec2::new(f64::from(u), f64::from(v))
        });
        a * (1.0 - b1 - b2) + b * b1 + c * b2
    }

    /// The weights of the second and third corner of `face` at a point of it, given in the units of the mesh.
    pub(crate) fn barycentrics(&self, face: u32, point: DVec3) -> [f64; 2] {
        let [a, b, c] = self.triangle(face);
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let (offset, area_squared) = (point - a, normal.dot(normal));
        [offset.cross(ac).dot(normal) / area_squared, ab.cross(offset).dot(normal) / area_squared]
    }

    /// An error of a point, given in the units of the mesh, in units of its unit frame: what a ray that starts there
    /// carries with it. The conversion back adds its own rounding.
    pub(crate) fn frame_error(&self, point: DVec3, error: f64) -> f64 {
        (error + gamma(2) * point.abs().max_element()) * self.frame.scale()
    }
}
