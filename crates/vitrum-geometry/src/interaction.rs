//! The point where a ray meets a surface.

use crate::{Departure, Query};
use vitrum_math::{DVec3, Ray};

/// The two sides of a surface, as seen by the ray that arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side that the ray came from.
    Incident,
    /// The other one.
    Transmitted,
}

/// A point of a surface, built once for the closest hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point, on the surface to the last bits: re-projected or interpolated, never just `ray.at(t)`.
    pub point: DVec3,
    /// Towards where the ray came from, unit length.
    pub wo: DVec3,
    /// The geometric normal, unit length, outward for a closed solid; never turned towards the viewer.
    pub ng: DVec3,
    /// The shading normal, unit length: interpolated where a smooth mesh has one, else `ng`. On `ng`'s side.
    pub ns: DVec3,
    /// True when `wo` is on the side that `ng` points to.
    pub front: bool,
    /// The object.
    pub object: u32,
    /// The face of the object: 0 unless the shape has several; the triangle of a mesh.
    pub face: u32,
    /// True when the object's orientation is turned against its shape's.
    pub(crate) flipped: bool,
    /// For meshes: bound on the error of `point`, in units of the mesh's own frame.
    pub(crate) error: f64,
}

impl SurfaceInteraction {
    /// The ray that leaves this point along the unit vector `direction`, to the given side. The side is decided by what
    /// happens to the light, never by the sign of a product that rounding could turn.
    #[inline]
    pub fn leave(&self, direction: DVec3, side: Side) -> Query {
        let own_front = self.front != self.flipped;
        let behind = own_front == (side == Side::Transmitted);
        let departed = Departure { object: self.object, face: self.face, behind, error: self.error };
        Query::leaving(Ray::new(self.point, direction), departed)
    }

    /// The side of the surface that `direction` points to.
    #[inline]
    pub fn side_of(&self, direction: DVec3) -> Side {
        if (direction.dot(self.ng) > 0.0) == self.front { Side::Incident } else { Side::Transmitted }
    }
}
