//! What can be hit: one shape per file, and the contract between them.
//!
//! An analytic shape answers one question: where does the *line* of a ray cross it? It returns up to two crossings, in
//! order, each with the face that is crossed; whoever asks picks the first that counts. A ray that starts on the shape
//! itself passes the face and the side that it leaves to, and gets only what it can still reach.
//!
//! Rays come in the shape's frame, with directions of any length, and `t` is in units of that length.

mod crossings;
mod cuboid;
mod cylinder;
mod disk;
mod plane;
mod rectangle;
mod sphere;

pub use crossings::{Crossing, Crossings, Leaving};
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use plane::Plane;
pub use rectangle::Rectangle;
pub use sphere::Sphere;

use crate::mesh::TriangleMesh;
use std::sync::Arc;
use vitrum_math::{Bounds, DVec3, Ray};

/// The closed family of shapes.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A flat disk.
    Disk(Disk),
    /// A parallelogram.
    Rectangle(Rectangle),
    /// An axis-aligned box.
    Cuboid(Cuboid),
    /// A cylinder, capped or open.
    Cylinder(Cylinder),
    /// A triangle mesh, shared between its instances.
    Mesh(Arc<TriangleMesh>),
}

/// Parameters that make no shape.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A radius that is not positive and finite.
    #[error("the radius must be positive and finite, found {0}")]
    Radius(f64),
    /// A direction or edge of length zero, or not finite.
    #[error("the {0} must be a finite vector that is not zero")]
    Direction(&'static str),
    /// A position that is not finite.
    #[error("the {0} must be finite")]
    Position(&'static str),
    /// Edges of a rectangle that are parallel.
    #[error("the two edges are parallel, so the rectangle has no area")]
    ParallelEdges,
    /// A box whose corners do not span a volume.
    #[error("each coordinate of `min` must be less than that of `max`")]
    EmptyBox,
}

impl Shape {
    /// The box around the shape in its own frame; `None` when it is infinite.
    pub fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Sphere(s) => Some(s.bounds()),
            Self::Plane(_) => None,
            Self::Disk(s) => Some(s.bounds()),
            Self::Rectangle(s) => Some(s.bounds()),
            Self::Cuboid(s) => Some(s.bounds()),
            Self::Cylinder(s) => Some(s.bounds()),
            Self::Mesh(s) => Some(s.bounds()),
        }
    }

    /// Its name in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere(_) => "sphere",
            Self::Plane(_) => "plane",
            Self::Disk(_) => "disk",
            Self::Rectangle(_) => "rectangle",
            Self::Cuboid(_) => "box",
            Self::Cylinder(_) => "cylinder",
            Self::Mesh(_) => "mesh",
        }
    }
}

/// The point of a surface at a crossing, in the shape's frame: on the surface to the last bits, with the outward normal
/// (unit length).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: DVec3,
    /// The shape's own normal.
    pub normal: DVec3,
}

pub(crate) fn finite(v: DVec3, what: &'static str) -> Result<DVec3, ShapeError> {
    if v.is_finite() { Ok(v) } else { Err(ShapeError::Position(what)) }
}

pub(crate) fn direction(v: DVec3, what: &'static str) -> Result<DVec3, ShapeError> {
    let length = v.length();
    if length > 0.0 && length.is_finite() { Ok(v / length) } else { Err(ShapeError::Direction(what)) }
}

pub(crate) fn radius(r: f64) -> Result<f64, ShapeError> {
    if r > 0.0 && r.is_finite() { Ok(r) } else { Err(ShapeError::Radius(r)) }
}

/// Where the line of `ray` crosses the plane through `on` with `normal`; `None` when it runs along it.
#[inline]
pub(crate) fn plane_distance(ray: &Ray, on: DVec3, normal: DVec3) -> Option<f64> {
    let slope = normal.dot(ray.direction);
    (slope != 0.0).then(|| normal.dot(on - ray.origin) / slope)
}
