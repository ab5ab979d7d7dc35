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
//! a closed form; a convex solid that is left outward is not tested at all. On a mesh, a hit on *another* face within
//! the rounding error of the origin is ignored when its sense contradicts the departure: entering what the ray is already
//! in, or leaving what it is already out of. Such hits are neighbours at an edge, and they are counted.
//!
//! # Meshes
//!
//! Vertices are `f32` in a unit frame of their own; a ray is brought into that frame in `f64`, advanced to the bounds,
//! and only then rounded. The tree finds candidates in `f32` with a watertight test and padded boxes; every candidate is
//! settled in `f64`. What is returned is the smallest (t, object, face), whatever the shape of the tree.

mod aggregate;
mod departure;
mod interaction;
pub mod mesh;
mod object;
pub mod shape;
mod tree;

pub use aggregate::{Aggregate, Counters, Hit};
pub use departure::{Departure, Query};
pub use interaction::{Side, SurfaceInteraction};
pub use object::Object;
pub use shape::Shape;
