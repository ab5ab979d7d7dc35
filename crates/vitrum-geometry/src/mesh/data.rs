//! A mesh as a file gives it: f64 positions, and separate index triples for positions, normals and texture
//! coordinates, so that splitting a vertex for its normal never tears the surface.

use glam::{DVec2, DVec3};

/// Three indices into one of the arrays of a [`MeshData`], anticlockwise seen from outside.
pub type Triangle = [u32; 3];

/// An indexed triangle mesh in its own frame, any units, nothing checked yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    /// Corners of each triangle, as indices into `positions`.
    pub triangles: Vec<Triangle>,
    /// Normals; need not be unit length.
    pub normals: Vec<DVec3>,
    /// Normals of the corners of each triangle; empty when the file has none, else as long as `triangles`.
    pub normal_triangles: Vec<Triangle>,
    /// Texture coordinates.
    pub uvs: Vec<DVec2>,
    /// Texture coordinates of the corners of each triangle; empty or as long as `triangles`.
    pub uv_triangles: Vec<Triangle>,
    /// Number of the material of each triangle; empty when all have the same.
    pub materials: Vec<u32>,
}
