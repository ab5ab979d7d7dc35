//! Objects and where they stand.

use std::path::PathBuf;

use vitrum_geometry::mesh::Build;
use vitrum_math::DVec3;

use super::{Material, Name};
use crate::diagnostic::Span;

/// A shape of some material, put somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The table's header.
    pub span: Span,
    /// Its name, if it has one.
    pub name: Option<Name>,
    /// Its shape, before the transform.
    pub shape: Shape,
    /// What it is made of. None only for a mesh (the file's materials) and an instance (the original's).
    pub material: Option<MaterialChoice>,
    /// Where it is put.
    pub transform: Transform,
    /// Whether its outward normals are turned inward.
    pub flip: bool,
}

/// The material of an object.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialChoice {
    /// One of the scene's.
    Named(Name),
    /// Its own.
    Inline(Box<Material>),
}

/// A shape in its own coordinates, metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A plane without end.
    Plane {
        /// Any point on it.
        point: DVec3,
        /// Of any length.
        normal: DVec3,
    },
    /// A flat disk.
    Disk {
        /// Its centre.
        center: DVec3,
        /// Of any length.
        normal: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A flat parallelogram; its normal is that of `edge_u` × `edge_v`.
    Rectangle {
        /// One corner.
        corner: DVec3,
        /// From there to the next.
        edge_u: DVec3,
        /// From there to the other neighbour.
        edge_v: DVec3,
    },
    /// A box along the axes.
    Box {
        /// Least x, y and z.
        min: DVec3,
        /// Greatest x, y and z.
        max: DVec3,
    },
    /// A round cylinder.
    Cylinder {
        /// One end of its axis.
        bottom: DVec3,
        /// The other end.
        top: DVec3,
        /// Its radius.
        radius: f64,
        /// Whether disks close its ends.
        capped: bool,
    },
    /// Triangles from a file.
    Mesh {
        /// As written: relative to the scene file.
        file: PathBuf,
        /// Where the path stands.
        file_span: Span,
        /// How it is shaded.
        normals: Normals,
        /// How much time goes into its tree.
        build: Build,
        /// The one object or group of the file to take; none takes all.
        group: Option<Name>,
        /// Whether an open or damaged mesh is taken as solid glass.
        force: bool,
    },
    /// The shape of another object, without that object's transform and `flip`.
    Instance {
        /// That object, which is not itself an instance.
        of: Name,
    },
}

/// The normals that a mesh is shaded with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// Averaged at vertices.
    Smooth,
    /// Of each triangle.
    Flat,
    /// The file's, and flat where it has none.
    File,
}

/// Steps that put a shape in its place, the first acts first. The default leaves it where it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transform {
    /// Where it stands.
    pub span: Span,
    /// The steps.
    pub steps: Vec<Step>,
}

/// One step of a transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Moves by this much, metres.
    Translate(DVec3),
    /// Turns about an axis through the origin.
    Rotate {
        /// Of any length.
        axis: DVec3,
        /// Degrees, counterclockwise seen from where the axis points to.
        angle: f64,
    },
    /// Stretches away from the origin; no factor is zero, negative ones mirror.
    Scale(DVec3),
}
