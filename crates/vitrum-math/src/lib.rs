//! The mathematics under the vitrum renderer: rays, transforms, frames, bounds, rounding errors, sample addresses
//! and the points that they give.
//!
//! Knows nothing of shapes, light or files. Conventions, for every crate above:
//!
//! - Right-handed, Y up, lengths in metres, angles in radians (files use degrees).
//! - Vectors are glam's scalar types; [`DVec3`] in everything that decides a pixel. No `Quat`, no `Vec3A`, no glam
//!   matrix products there: only + − × ÷ and square roots, whose results IEEE 754 fixes to the last bit, and
//!   transcendental functions of the `libm` crate, so that every machine gets the same bytes.
//! - Transforms are named `world_from_object`, so that compositions read from right to left.
//!
//! ```
//! use vitrum_math::{DVec3, Ray};
//! let ray = Ray::new(DVec3::ZERO, DVec3::Z);
//! assert_eq!(ray.at(2.0), DVec3::new(0.0, 0.0, 2.0));
//! ```

mod bounds;
mod float;
mod frame;
mod ray;
mod sampler;
mod transform;
mod warp;

pub use bounds::Bounds;
pub use float::{gamma, power_of_two_above};
pub use frame::Frame;
pub use glam::{DVec2, DVec3, Vec3};
pub use ray::{Ray, unit};
pub use sampler::{NodeKey, Purpose, SampleAddress, Sequence};
pub use transform::{SingularTransform, Transform};
pub use warp::concentric_disk;

/// Linear Rec.709 radiance, reflectance or transmittance, one number per channel: a plain vector, because every
/// operation on colours here is one on vectors (sum, product by channel, scaling).
pub type Rgb = DVec3;
