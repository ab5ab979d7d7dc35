//! Repairs that need no guess.
//!
//! - Faces that weld to an edge or a point are dropped, and faces that repeat an earlier one with the same
//!   winding. A face of three different collinear corners is dropped only if that leaves no more bad edges
//!   than before: in a closed surface it closes a seam, and no ray hits it anyway.
//! - In a closed body whose faces clash, faces are turned until none do, if that is possible.
//! - A closed body that lies in no other and encloses a negative volume is turned outward. If bodies inside
//!   it alternate as in a mirrored model (a bubble turned outward in a solid turned inward), they turn with
//!   it.
//! - A body inside another may be a bubble: it is left as it is otherwise, and said.
//!
//! Where a face is turned, normals that agreed with it before agree with it after. Corners that are not
//! finite, holes and non-manifold edges stay. A mesh that has an index out of range comes back untouched.

use std::{collections::BTreeMap, fmt};

use super::{
    Component, Place,
    bodies::{Bodies, signed_volume},
    counted, counted_as,
    surface::{FaceKind, Surface},
};
use crate::mesh::{MeshData, Triangle};

/// What [`mend`] did, or left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// Faces without area were dropped.
    DroppedDegenerate,
    /// Faces with the corners and the winding of an earlier one were dropped.
    DroppedDuplicate,
    /// Faces of closed bodies that clashed with their neighbours were turned.
    Oriented,
    /// Closed bodies that were inside out were turned.
    TurnedOutward,
    /// Inside-out bodies inside another were left: bubbles.
    LeftBubble,
}

/// One kind of repair.
#[derive(Clone, Debug, PartialEq)]
pub struct Mended {
    /// What was done.
    pub remedy: Remedy,
    /// The faces concerned, ascending, as numbered in the mesh *before* mending.
    pub triangles: Vec<usize>,
    /// How many bodies they belong to; 0 where faces were dropped.
    pub bodies: usize,
    /// The first of the faces.
    pub first: Place,
}

/// Mends a mesh and says how: drops, then turns. A healthy mesh comes back as it was, with an empty list.
/// Unless faces were dropped, every face keeps its number; see [`Mended::triangles`].
#[must_use]
pub fn mend(data: MeshData) -> (MeshData, Vec<Mended>) {
    let mut report = Vec::new();
    let surface = Surface::new(&data);
    if !(0..data.triangles.len()).all(|face| surface.in_range(face)) {
        return (data, report);
    }
    let (data, kept) = drop_faces(data, &mut report);
    let data = turn_faces(data, &kept, &mut report);
    (data, report)
}

/// Drops what [`mend`] says, and returns the former number of every face that is left.
fn drop_faces(mut data: MeshData, report: &mut Vec<Mended>) -> (MeshData, Vec<usize>) {
    let surface = Surface::new(&data);
    let count = surface.kinds.len();
    let mut dropped = vec![false; count];
    let mut duplicates: Vec<_> = surface
        .repeated_faces()
        .iter()
        .filter(|repeat| repeat.same_winding)
        .map(|repeat| repeat.face)
        .collect();
    duplicates.sort_unstable();
    for &face in &duplicates {
        dropped[face] = true;
    }
    let mut degenerate = removable_flat_faces(&surface, &dropped);
    degenerate.extend((0..count).filter(|&face| surface.kinds[face] == FaceKind::Collapsed));
    degenerate.sort_unstable();
    for &face in &degenerate {
        dropped[face] = true;
    }

    for (remedy, triangles) in
        [(Remedy::DroppedDegenerate, degenerate), (Remedy::DroppedDuplicate, duplicates)]
    {
        if let Some(&first) = triangles.first() {
            report.push(Mended { remedy, bodies: 0, first: surface.place(first), triangles });
        }
    }
    let kept: Vec<_> = (0..count).filter(|&face| !dropped[face]).collect();
    if kept.len() < count {
        for triangles in [&mut data.triangles, &mut data.normal_triangles, &mut data.uv_triangles] {
            let mut dropped = dropped.iter();
            triangles.retain(|_| dropped.next() != Some(&true));
        }
        let mut dropped = dropped.iter();
        data.materials.retain(|_| dropped.next() != Some(&true));
    }
    (data, kept)
}

/// Flat faces without which there are no more edges of one face, or of more than two, than with them.
fn removable_flat_faces(surface: &Surface<'_>, dropped: &[bool]) -> Vec<usize> {
    let is_flat = |face: u32| surface.kinds[face as usize] == FaceKind::Flat;
    // For each edge of a flat face how many faces it has, and which of them are flat.
    let mut edges: Vec<(usize, Vec<u32>)> = Vec::new();
    let mut edges_of_face = BTreeMap::<u32, Vec<usize>>::new();
    for edge in surface.edges() {
        let present = edge.iter().map(|half_edge| half_edge.face).filter(|&face| !dropped[face as usize]);
        let flat: Vec<u32> = present.clone().filter(|&face| is_flat(face)).collect();
        if !flat.is_empty() {
            for &face in &flat {
                edges_of_face.entry(face).or_default().push(edges.len());
            }
            edges.push((present.count(), flat));
        }
    }

    let mut removable = Vec::new();
    let mut open: Vec<u32> = edges_of_face.keys().rev().copied().collect();
    while let Some(face) = open.pop() {
        let Some(own) = edges_of_face.get(&face) else { continue };
        let spoiled = own.iter().filter(|&&edge| edges[edge].0 == 2).count();
        let relieved = own.iter().filter(|&&edge| matches!(edges[edge].0, 1 | 3)).count();
        if spoiled <= relieved {
            removable.push(face as usize);
            for edge in edges_of_face.remove(&face).unwrap_or_default() {
                edges[edge].0 -= 1;
                // What was needed beside this face may not be needed without it.
                open.extend(&edges[edge].1);
            }
        }
    }
    removable
}

/// Turns what [`mend`] says. `kept` gives the number that the report uses for a face.
fn turn_faces(mut data: MeshData, kept: &[usize], report: &mut Vec<Mended>) -> MeshData {
    let surface = Surface::new(&data);
    let bodies = Bodies::new(&surface);
    let faces = bodies.faces();
    let verdicts = judge(&surface, &bodies, &faces);

    let mut turned = Vec::new();
    for remedy in [Remedy::Oriented, Remedy::TurnedOutward, Remedy::LeftBubble] {
        let mut triangles = Vec::new();
        let mut concerned = 0;
        for (body, verdict) in
            verdicts.iter().enumerate().filter(|(_, verdict)| verdict.remedy == Some(remedy))
        {
            concerned += 1;
            triangles.extend(faces[body].iter().filter(|&&face| match remedy {
                Remedy::Oriented => bodies.turned[face] != verdict.turn,
                _ => true,
            }));
        }
        triangles.sort_unstable();
        let Some(&first) = triangles.first() else { continue };
        if remedy != Remedy::LeftBubble {
            turned.extend(&triangles);
        }
        let first = Place { index: kept[first], ..surface.place(first) };
        let triangles = triangles.into_iter().map(|face| kept[face]).collect();
        report.push(Mended { remedy, triangles, bodies: concerned, first });
    }
    turn(&mut data, &turned);
    data
}

/// What happens to a body.
#[derive(Clone, Copy, Default)]
struct Verdict {
    remedy: Option<Remedy>,
    /// The body's lowest face is turned.
    turn: bool,
}

fn judge(surface: &Surface<'_>, bodies: &Bodies, faces: &[Vec<usize>]) -> Vec<Verdict> {
    let components = &bodies.components;
    let mut verdicts = vec![Verdict::default(); components.len()];
    for (index, body) in components.iter().enumerate() {
        if !body.closed || !body.orientable {
            continue;
        }
        let outermost =
            bodies.containers[index].iter().map(|&outer| &components[outer]).find(|outer| outer.depth == 0);
        verdicts[index] = if !body.oriented {
            // Outward, or for a body inside another whatever turns fewer faces.
            let contrary = faces[index].iter().filter(|&&face| bodies.turned[face]).count();
            let turn = if body.depth == 0 {
                oriented_volume(surface, bodies, &faces[index], body) < 0.0
            } else {
                2 * contrary > body.triangles
            };
            Verdict { remedy: Some(Remedy::Oriented), turn }
        } else if body.is_inside_out()
            || outermost.is_some_and(|outer| outer.is_inside_out() && mirrored(body))
        {
            Verdict { remedy: Some(Remedy::TurnedOutward), turn: true }
        } else if body.volume < 0.0 {
            Verdict { remedy: Some(Remedy::LeftBubble), turn: false }
        } else {
            Verdict::default()
        };
    }
    verdicts
}

/// Whether a body has the sign that its depth has in a mirrored model: solids negative, their bubbles
/// positive.
fn mirrored(body: &Component) -> bool {
    body.depth.is_multiple_of(2) == (body.volume < 0.0)
}

/// The volume of a closed body once its faces are turned like its lowest one.
fn oriented_volume(surface: &Surface<'_>, bodies: &Bodies, faces: &[usize], body: &Component) -> f64 {
    let volume = |&face: &usize| {
        let volume = signed_volume(surface.points(face), body.centre());
        if bodies.turned[face] { -volume } else { volume }
    };
    faces.iter().map(volume).sum()
}

/// Reverses the winding of faces. Their normals follow, if they agreed with the winding before.
fn turn(data: &mut MeshData, faces: &[usize]) {
    // The negated copy of each normal, made when first needed: faces that stay may use the normal itself.
    let mut negated = vec![None; data.normals.len()];
    for &face in faces {
        if let Some(&normals) = data.normal_triangles.get(face)
            && agree(data, face, normals)
        {
            data.normal_triangles[face] = normals.map(|index| {
                *negated[index as usize].get_or_insert_with(|| {
                    data.normals.push(-data.normals[index as usize]);
                    u32::try_from(data.normals.len() - 1).expect("normals are fewer than u32 can count")
                })
            });
        }
        for triangles in [&mut data.triangles, &mut data.normal_triangles, &mut data.uv_triangles] {
            if let Some(triangle) = triangles.get_mut(face) {
                triangle.swap(1, 2);
            }
        }
    }
}

/// Whether the normals of a face, taken together, point to the side from which it is anticlockwise.
fn agree(data: &MeshData, face: usize, normals: Triangle) -> bool {
    let [a, b, c] = data.triangles[face].map(|vertex| data.positions[vertex as usize]);
    let [i, j, k] = normals.map(|index| data.normals[index as usize]);
    (i + j + k).dot((b - a).cross(c - a)) > 0.0
}

/// For example `dropped 3 duplicate faces (first at (0.5, 0, -1))`.
impl fmt::Display for Mended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.triangles.len();
        let bodies = self.bodies;
        match self.remedy {
            Remedy::DroppedDegenerate => write!(f, "dropped {}", counted(count, "degenerate face"))?,
            Remedy::DroppedDuplicate => write!(f, "dropped {}", counted(count, "duplicate face"))?,
            Remedy::Oriented => {
                let bodies = counted_as(bodies, "body", "bodies");
                write!(f, "turned {} of {bodies} to match the rest", counted(count, "face"))?;
            }
            Remedy::TurnedOutward => {
                write!(f, "turned {} outward", counted_as(bodies, "inside-out body", "inside-out bodies"))?;
            }
            Remedy::LeftBubble => {
                let bodies = counted_as(
                    bodies,
                    "inside-out body as it is, a bubble inside another body",
                    "inside-out bodies as they are, bubbles inside other bodies",
                );
                write!(f, "left {bodies}")?;
            }
        }
        write!(f, " (first {})", self.first)
    }
}
