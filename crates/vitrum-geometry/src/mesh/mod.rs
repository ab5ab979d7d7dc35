//! Triangle meshes: what a file holds, what is wrong with it, and the form that rays are traced against.

mod data;
mod health;
mod normals;
mod search;
mod triangle;
mod triangle_mesh;

#[cfg(test)]
mod tests;

pub use data::{MeshData, Triangle};
pub use health::{Component, Defect, Finding, Health, Mended, Place, Remedy, examine, health, mend};
pub use normals::{flat_normals, smooth_normals};
pub(crate) use search::{AnyHit, ClosestHit};
pub(crate) use triangle_mesh::MeshPoint;
pub use triangle_mesh::{MeshError, TriangleMesh};

pub use crate::wide::Build;
