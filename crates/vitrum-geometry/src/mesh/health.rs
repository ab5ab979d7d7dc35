//! Mesh health: is a triangle mesh the surface of a solid, and if not, what is wrong and where?
//!
//! Light inside glass has to come out again, so a mesh of solid glass must be *closed*: every edge has
//! exactly two faces, and they run along it in opposite directions. [`health`] counts what breaks this and
//! names the first place of each kind; [`mend`] repairs what can be repaired without guessing.
//!
//! Conventions:
//! - Vertices are welded only where positions are *exactly* equal (-0 is +0), so that a file which repeats a
//!   vertex for each normal or texture coordinate is still one surface. No tolerance anywhere: a crack is a
//!   crack.
//! - Faces with an index out of range or a corner that is not finite, and faces that weld to an edge or a
//!   point, belong to no edge and to no body. A face of three different but collinear corners does: it is
//!   what closes the seam between one long edge and two short ones.
//! - A *body* ([`Component`]) is a set of faces connected through edges. A face index counts in the mesh as
//!   given.
//! - Volumes are in cubed units of the mesh, positive when the faces wind anticlockwise seen from outside.
//!
//! Everything is done by sorting: n log n, and the same result everywhere.

mod bodies;
mod crossings;
mod mend;
mod nesting;
mod surface;
#[cfg(test)]
mod tests;
mod weld;

use std::fmt;

use glam::DVec3;

use super::MeshData;
use bodies::Bodies;
use surface::{FaceKind, Surface};

pub use mend::{Mended, Remedy, mend};

/// Something that a mesh of solid glass should not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Defect {
    /// A vertex with a coordinate that is NaN or infinite.
    NonFiniteVertex,
    /// A face that names a vertex, normal or texture coordinate that is not there.
    IndexOutOfRange,
    /// A face without area: two corners in one place, or all three on a line.
    DegenerateFace,
    /// A face with the corners and the winding of an earlier one.
    DuplicateFace,
    /// A face with the corners of an earlier one and the opposite winding: a sheet with two sides and no
    /// inside.
    DoubledFace,
    /// An edge of one face: the rim of a hole.
    OpenEdge,
    /// An edge of more than two faces.
    NonManifoldEdge,
    /// An edge whose two faces run along it in the same direction: one of them is turned.
    ClashingEdge,
    /// A closed body that encloses a negative volume and lies inside no other: its faces are turned inside
    /// out.
    InsideOut,
    /// A vertex that no face uses; looked for by [`examine`] alone, as is what follows.
    UnusedVertex,
    /// A face that another one of the mesh goes through.
    CrossingFace,
}

/// Where something is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The vertex ([`Defect::NonFiniteVertex`], [`Defect::UnusedVertex`]) or the lowest face concerned.
    pub index: usize,
    /// The vertex, the middle of the edge, or the centroid of the face. Not finite where the mesh has no such
    /// point.
    pub position: DVec3,
}

/// One kind of defect: how often, and where first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// What is wrong.
    pub defect: Defect,
    /// How many vertices, faces, edges or bodies have it; at least 1.
    pub count: usize,
    /// The one with the lowest index.
    pub first: Place,
}

/// A body: a set of faces connected through edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// Number of faces.
    pub triangles: usize,
    /// Its lowest face.
    pub first: Place,
    /// Corners of its bounding box, lowest and highest.
    pub bounds: (DVec3, DVec3),
    /// Every edge has exactly two faces, whatever their winding.
    pub closed: bool,
    /// No edge has two faces of clashing winding.
    pub oriented: bool,
    /// Its faces could be turned so that none clash (a Möbius strip's cannot).
    pub orientable: bool,
    /// Signed volume, summed about the centre of the bounding box; means something when `closed` and
    /// `oriented`. Exactly 0 where the sum is no larger than its rounding error.
    pub volume: f64,
    /// How many other closed bodies it lies inside; 0 for a body that is not closed.
    pub depth: usize,
}

/// What [`health`] found.
#[derive(Clone, Debug, PartialEq)]
pub struct Health {
    /// Number of faces, unusable ones included.
    pub triangles: usize,
    /// Number of faces without a usable place: a corner that is out of range or not finite.
    pub unusable: usize,
    /// The defects, each kind once, in the order of [`Defect`].
    pub findings: Vec<Finding>,
    /// The bodies, in the order of their lowest faces.
    pub components: Vec<Component>,
}

/// Examines a mesh. Accepts anything, broken indices included; never panics.
#[must_use]
pub fn health(data: &MeshData) -> Health {
    found(&Surface::new(data), Tally::default())
}

/// The same, and looks for faces that cross others, which takes as long again as everything else, and for vertices that no face uses.
#[must_use]
pub fn examine(data: &MeshData) -> Health {
    let surface = Surface::new(data);
    let mut tally = Tally::default();
    let mut used = vec![false; data.positions.len()];
    for index in data.triangles.iter().flatten() {
        if let Some(used) = used.get_mut(*index as usize) {
            *used = true;
        }
    }
    for (index, _) in used.iter().enumerate().filter(|(_, used)| !**used) {
        tally.add(Defect::UnusedVertex, Place { index, position: data.positions[index] });
    }
    for face in crossings::crossing_faces(&surface) {
        tally.add(Defect::CrossingFace, surface.place(face));
    }
    found(&surface, tally)
}

fn found(surface: &Surface<'_>, mut tally: Tally) -> Health {
    let data = surface.data;
    for (index, &position) in data.positions.iter().enumerate() {
        if !position.is_finite() {
            tally.add(Defect::NonFiniteVertex, Place { index, position });
        }
    }
    for (face, kind) in surface.kinds.iter().enumerate() {
        if !surface.in_range(face) {
            tally.add(Defect::IndexOutOfRange, surface.place(face));
        }
        if matches!(kind, FaceKind::Collapsed | FaceKind::Flat) {
            tally.add(Defect::DegenerateFace, surface.place(face));
        }
    }
    for repeat in surface.repeated_faces() {
        let defect = if repeat.same_winding { Defect::DuplicateFace } else { Defect::DoubledFace };
        tally.add(defect, surface.place(repeat.face));
    }
    for edge in surface.edges() {
        let defect = match edge {
            [_] => Defect::OpenEdge,
            [a, b] if a.forward == b.forward => Defect::ClashingEdge,
            [_, _] => continue,
            _ => Defect::NonManifoldEdge,
        };
        tally.add(defect, surface.edge_place(&edge[0]));
    }
    let components = Bodies::new(surface).components;
    for body in components.iter().filter(|body| body.is_inside_out()) {
        tally.add(Defect::InsideOut, body.first);
    }
    let unusable = surface.kinds.iter().filter(|&&kind| kind == FaceKind::Unusable).count();
    Health { triangles: data.triangles.len(), unusable, findings: tally.sorted(), components }
}

impl Component {
    /// Closed and consistently oriented: it has an inside.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        self.closed && self.oriented
    }

    /// Solid, outermost, and with the faces turned to its inside.
    #[must_use]
    pub fn is_inside_out(&self) -> bool {
        self.is_solid() && self.depth == 0 && self.volume < 0.0
    }
}

impl Health {
    /// Every edge has exactly two faces, in opposite directions, and every face is usable. An empty mesh is
    /// not closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        let usable = self.unusable == 0 && self.count(Defect::IndexOutOfRange) == 0;
        usable && !self.components.is_empty() && self.components.iter().all(Component::is_solid)
    }

    /// True where two solid bodies of positive volume are so near that one may reach into the other, as far as their boxes tell.
    #[must_use]
    pub fn bodies_may_overlap(&self) -> bool {
        let is_filled = |body: &&Component| body.is_solid() && body.volume > 0.0;
        let filled: Vec<&Component> = self.components.iter().filter(is_filled).collect();
        let touch = |a: &Component, b: &Component| {
            a.bounds.0.cmple(b.bounds.1).all() && b.bounds.0.cmple(a.bounds.1).all()
        };
        let mut order = filled;
        order.sort_by(|a, b| a.bounds.0.x.total_cmp(&b.bounds.0.x));
        order.iter().enumerate().any(|(i, a)| {
            let near = order[i + 1..].iter().take_while(|b| b.bounds.0.x <= a.bounds.1.x);
            near.into_iter().any(|b| touch(a, b))
        })
    }

    /// How often a defect occurs.
    #[must_use]
    pub fn count(&self, defect: Defect) -> usize {
        self.find(defect).map_or(0, |finding| finding.count)
    }

    /// The finding of one kind, if there is any.
    #[must_use]
    pub fn find(&self, defect: Defect) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.defect == defect)
    }

    /// Volume enclosed by all bodies together, a bubble (a nested body of negative volume) subtracted; `None`
    /// unless the mesh is closed.
    #[must_use]
    pub fn volume(&self) -> Option<f64> {
        self.is_closed().then(|| self.components.iter().map(|body| body.volume).sum())
    }
}

/// Findings as they are gathered.
#[derive(Default)]
struct Tally(Vec<Finding>);

impl Tally {
    fn add(&mut self, defect: Defect, place: Place) {
        match self.0.iter_mut().find(|finding| finding.defect == defect) {
            None => self.0.push(Finding { defect, count: 1, first: place }),
            Some(finding) => {
                finding.count += 1;
                if place.index < finding.first.index {
                    finding.first = place;
                }
            }
        }
    }

    fn sorted(mut self) -> Vec<Finding> {
        self.0.sort_by_key(|finding| finding.defect);
        self.0
    }
}

/// One line: size, bodies, then the volume of a closed mesh, or everything that is wrong.
impl fmt::Display for Health {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bodies = self.components.len();
        write!(f, "{}, {}", counted(self.triangles, "triangle"), counted_as(bodies, "body", "bodies"))?;
        match self.volume() {
            Some(volume) => write!(f, ", closed, volume {}", short(volume))?,
            None => write!(f, ", not closed")?,
        }
        for (index, finding) in self.findings.iter().enumerate() {
            write!(f, "{} {finding}", if index == 0 { ":" } else { "," })?;
        }
        Ok(())
    }
}

/// For example `12 open edges (first at (0.5, 0, -1))`.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.defect {
            Defect::NonFiniteVertex => counted_as(self.count, "vertex not finite", "vertices not finite"),
            Defect::IndexOutOfRange => {
                counted_as(self.count, "face with an index out of range", "faces with an index out of range")
            }
            Defect::DegenerateFace => counted(self.count, "degenerate face"),
            Defect::DuplicateFace => counted(self.count, "duplicate face"),
            Defect::DoubledFace => counted_as(
                self.count,
                "face doubled the other way round",
                "faces doubled the other way round",
            ),
            Defect::OpenEdge => counted(self.count, "open edge"),
            Defect::NonManifoldEdge => counted(self.count, "edge") + " of more than two faces",
            Defect::ClashingEdge => counted(self.count, "edge") + " of clashing winding",
            Defect::InsideOut => counted_as(self.count, "inside-out body", "inside-out bodies"),
            Defect::UnusedVertex => {
                counted_as(self.count, "vertex that no face uses", "vertices that no face uses")
            }
            Defect::CrossingFace => {
                counted_as(self.count, "face that another goes through", "faces that others go through")
            }
        };
        write!(f, "{what} (first ")?;
        match self.defect {
            Defect::NonFiniteVertex | Defect::UnusedVertex => write!(f, "is vertex {})", self.first.index),
            Defect::IndexOutOfRange => write!(f, "is face {})", self.first.index),
            _ => write!(f, "{})", self.first),
        }
    }
}

/// `at (x, y, z)`, to six digits.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.position;
        write!(f, "at ({}, {}, {})", short(x), short(y), short(z))
    }
}

fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

fn counted_as(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A number rounded to six digits, in its shortest form.
fn short(value: f64) -> String {
    // Printing digits and reading them back is exact, so the shortest form of the result is those digits.
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}
