//! A glass of water with ice, for the bench, modelled twice. Metres; it stands on y = 0.01.
//!
//! A tumbler with straight walls, all its edges rounded, filled to two thirds. Its surface is cut where the water ends: glass
//! against air outside, over the lip and down to the water (`OUTSIDE`), glass against water below (`BELOW`), and water against
//! air (`SURFACE`). Together they are closed, and each faces away from the denser medium, `BELOW` into the water.
//!
//! Or it is two solids, the glass (`WHOLE`) and the water (`WATER`), which reaches into the wall of the glass: what is seen are the same
//! surfaces, if the glass is stronger.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use vitrum_geometry::mesh::MeshData;

use crate::circle;

/// Names of the surfaces, and what the heads of their files say.
pub(crate) const OUTSIDE: (&str, &str) =
    ("tumbler_air", "Tumbler against air: outside, lip, and inside above the water.");
pub(crate) const BELOW: (&str, &str) = ("tumbler_water", "Tumbler against the water in it.");
pub(crate) const SURFACE: (&str, &str) = ("water_air", "Surface of the water in the tumbler.");
pub(crate) const WHOLE: (&str, &str) = ("tumbler", "Tumbler, all of it.");
pub(crate) const WATER: (&str, &str) = ("water", "Water in the tumbler, 0.03 m larger than the room for it.");
/// A cube of ice around the origin, 0.3 m wide.
pub(crate) const ICE: (&str, &str) = ("ice", "Cube of ice, 0.3 m wide, around the origin.");

const SEGMENTS: usize = 96;
const BOTTOM: f64 = 0.01;
const GROUND: f64 = 0.13;
const LEVEL: f64 = 0.85;
const TOP: f64 = 1.30;
const OUTER: f64 = 0.55;
const INNER: f64 = 0.47;
const ROUNDED: f64 = 0.10;
/// How far the water reaches into the glass.
const REACH: f64 = 0.03;
/// Pieces of a quarter of a circle.
const PIECES: usize = 6;

/// A point of a profile (radius, height), and its normal.
type Corner = (DVec2, DVec2);

/// Glass against air.
pub(crate) fn outside() -> MeshData {
    turned(&outside_profile())
}

fn outside_profile() -> Vec<Corner> {
    let lip = 0.5 * (OUTER - INNER);
    let mut profile = vec![on_axis(BOTTOM, -1.0)];
    profile.extend(arc(DVec2::new(OUTER - ROUNDED, BOTTOM + ROUNDED), ROUNDED, -0.5 * PI, 0.0, PIECES));
    profile.extend(arc(DVec2::new(INNER + lip, TOP), lip, 0.0, PI, 2 * PIECES));
    profile.push((DVec2::new(INNER, LEVEL), DVec2::NEG_X));
    profile
}

/// Glass against water: what is inside turns towards the water.
pub(crate) fn below() -> MeshData {
    turned(&below_profile())
}

fn below_profile() -> Vec<Corner> {
    let mut profile = vec![(DVec2::new(INNER, LEVEL), DVec2::NEG_X)];
    let corner = arc(DVec2::new(INNER - ROUNDED, GROUND + ROUNDED), ROUNDED, 0.0, -0.5 * PI, PIECES);
    profile.extend(corner.into_iter().map(|(point, normal)| (point, -normal)));
    profile.push(on_axis(GROUND, 1.0));
    profile
}

/// All of the glass.
pub(crate) fn whole() -> MeshData {
    let mut profile = outside_profile();
    profile.extend(&below_profile()[1..]);
    turned(&profile)
}

/// All of the water, with flat faces.
pub(crate) fn water() -> MeshData {
    let mut profile = vec![on_axis(GROUND - REACH, -1.0)];
    let centre = DVec2::new(INNER - ROUNDED, GROUND + ROUNDED);
    profile.extend(arc(centre, ROUNDED + REACH, -0.5 * PI, 0.0, PIECES));
    profile.extend([(DVec2::new(INNER + REACH, LEVEL), DVec2::X), on_axis(LEVEL, 1.0)]);
    MeshData { normals: vec![], normal_triangles: vec![], ..turned(&profile) }
}

/// Water against air: a disk, as long as nobody stirs.
pub(crate) fn surface() -> MeshData {
    turned(&[(DVec2::new(INNER, LEVEL), DVec2::Y), on_axis(LEVEL, 1.0)])
}

/// The ice.
pub(crate) fn ice() -> MeshData {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.3 - 0.15;
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    MeshData {
        positions: (0..8).map(corner).collect(),
        triangles: faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..MeshData::default()
    }
}

fn on_axis(height: f64, up: f64) -> Corner {
    (DVec2::new(0.0, height), DVec2::new(0.0, up))
}

/// Points of a circle from one angle to another, and its outward normals.
fn arc(centre: DVec2, radius: f64, from: f64, to: f64, pieces: usize) -> Vec<Corner> {
    let at = |piece: usize| {
        let angle = from + (to - from) * piece as f64 / pieces as f64;
        DVec2::new(libm::cos(angle), libm::sin(angle))
    };
    (0..=pieces).map(|piece| (centre + radius * at(piece), at(piece))).collect()
}

/// A profile turned around the axis y. Its normals lie to the right of its direction; at its ends it may meet the axis.
fn turned(profile: &[Corner]) -> MeshData {
    let mut mesh = MeshData::default();
    let mut rings: Vec<Vec<u32>> = Vec::new();
    for (point, normal) in profile {
        let count = if point.x == 0.0 { 1 } else { SEGMENTS };
        let first = mesh.positions.len() as u32;
        for segment in 0..count {
            mesh.positions.push(circle::around_y(segment, SEGMENTS, point.x, point.y));
            mesh.normals.push(circle::around_y(segment, SEGMENTS, normal.x, normal.y));
        }
        rings.push((0..SEGMENTS).map(|segment| first + (segment % count) as u32).collect());
    }
    for pair in rings.windows(2) {
        for segment in 0..SEGMENTS {
            let next = (segment + 1) % SEGMENTS;
            let [a, b, c, d] = [pair[0][segment], pair[0][next], pair[1][next], pair[1][segment]];
            // A ring on the axis is a point: one of the two triangles has no area.
            mesh.triangles
                .extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
        }
    }
    mesh.normal_triangles.clone_from(&mesh.triangles);
    mesh
}
