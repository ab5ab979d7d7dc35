//! Shapes, triangle meshes and the structure that finds what a ray hits.
//!
//! Knows nothing of light, materials or files. Read in this order: [`Shape`] (what can be hit), [`Object`] (a shape in its
//! place), [`Aggregate`] (all objects, and the two questions asked of them), [`Query`] (a ray with its history),
//! [`SurfaceInteraction`] (the point that was found).
//!
//! # Leaving a surface
//!
//! There is no scene-wide epsilon. A ray that starts on a surface carries a [`Departure`]: the object and face that it
//! leaves, and the side that it goes to. Planar faces are excluded by identity; on spheres and cylinders the other root is
//! a closed form; a convex solid that is left outward is not tested at all. On a mesh, a hit on *another* face within the
//! rounding error of the origin (a neighbour at an edge) counts only if the two faces stand so that the ray can cross it:
//! outward at a convex edge, inward at a concave one. Those that don't count are counted.
//!
//! # Meshes
//!
//! Vertices are `f32` in a unit frame of their own; a ray is brought into that frame in `f64`, advanced to the bounds if it
//! comes from afar, and only then rounded. The tree and a first test of each triangle work in `f32` and are conservative; where
//! that test is not certain, a watertight one in `f64` decides, and the nearest hit is worked out in `f64` in any case. What is
//! returned is the smallest (t, object, face), whatever the shape of the tree.

mod aggregate;
mod area_sampler;
mod departure;
mod interaction;
pub mod mesh;
mod nearness;
mod object;
mod overlap;
mod patches;
pub mod shape;
mod solids;
mod spheres;
mod spherical_triangle;
mod uv;
mod wide;

pub use aggregate::{Aggregate, Counters, Hit};
pub use area_sampler::{AreaSample, AreaSampler, NormalCone};
pub use departure::{Departure, Query};
pub use interaction::{Side, SurfaceInteraction};
pub use nearness::Nearness;
pub use object::Object;
pub use shape::Shape;
