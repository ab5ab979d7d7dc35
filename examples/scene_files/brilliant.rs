//! The standard round brilliant: 57 facets and a culet point, and a girdle of many sides. The girdle's diameter
//! is 1 m, y is up, and the stone is centred on the origin.
//!
//! | facets | number | direction in the plan |
//! |---|---|---|
//! | table | 1 | |
//! | stars | 8 | between the bezels |
//! | bezels (kites) | 8 | every eighth of a turn |
//! | upper girdle | 16 | beside each bezel |
//! | lower girdle | 16 | beside each main |
//! | pavilion mains | 8 | under the bezels |
//!
//! Proportions, in the terms of the laboratories, are those of Tolkowsky's angles with the wider table of
//! today: crown angle 34.5° and pavilion angle 40.75° (M. Tolkowsky, *Diamond Design*, 1919), table 57 %,
//! star length 50 %, lower girdle length 75 %, girdle 2.5 % where it is thickest. All lie inside the ranges
//! of GIA's highest cut grade: table 52 % to 62 %, crown 31.5° to 36.5°, pavilion 40.6° to 41.8°, star length
//! 45 % to 65 %, lower girdle 70 % to 85 % (T. Moses and others, "A Foundation for Grading the Overall Cut
//! Quality of Round Brilliant Cut Diamonds", *Gems & Gemology*, 2004). Lengths of stars and lower girdle
//! facets are measured in the plan, from the table's side or the girdle.
//!
//! Every vertex is where its facets' planes cut a vertical line, so facets are planar to rounding. The girdle
//! is vertical and scalloped: thickest under the bezels and between them, thinnest in the middle of each
//! girdle facet. Normals are flat, one for each facet.

use std::{array, iter};

use glam::DVec3;
use vitrum_geometry::mesh::MeshData;

use crate::circle;

/// Name of the object and, with `.obj`, of the file.
pub(crate) const NAME: &str = "brilliant";
/// What the head of the file says.
pub(crate) const ABOUT: &str =
    "Round brilliant: 57 facets and 64 girdle faces, diameter 1 m, closed, flat normals.
Table 57 %, crown 34.5 deg, pavilion 40.75 deg, girdle 2.5 %, star 50 %, lower girdle 75 %.";

const RADIUS: f64 = 0.5;
const TABLE_RADIUS: f64 = 0.57 * RADIUS;
const CROWN_DEGREES: f64 = 34.5;
const PAVILION_DEGREES: f64 = 40.75;
const GIRDLE_THICKNESS: f64 = 0.025;
const STAR_LENGTH: f64 = 0.50;
const LOWER_LENGTH: f64 = 0.75;
/// Sides of the girdle, in the gallery.
pub(crate) const GIRDLE_SIDES: usize = 64;

/// The stone, with so many sides of the girdle: a multiple of 16, so that vertices stand where two girdle facets meet.
pub(crate) fn mesh(sides: usize) -> MeshData {
    // Girdle sides under one girdle facet.
    let span = sides / 16;
    let crown = libm::tan(CROWN_DEGREES.to_radians());
    let pavilion = libm::tan(PAVILION_DEGREES.to_radians());
    let crown_height = crown * (RADIUS - TABLE_RADIUS);
    let pavilion_height = pavilion * RADIUS;
    let table_y = (crown_height + GIRDLE_THICKNESS + pavilion_height) / 2.0;
    let culet_y = -table_y;

    // Between two bezels, and between two mains, their planes meet. They fall by the cosine of π/8 less than
    // under the middle of the facet, and the table's side is as much nearer than its corners.
    let cosine = circle::point(1, 16).x;
    let table_side = TABLE_RADIUS * cosine;
    let star_radius = table_side + STAR_LENGTH * (RADIUS - table_side);
    let star_y = table_y - crown * (star_radius * cosine - TABLE_RADIUS);
    let deep_radius = (1.0 - LOWER_LENGTH) * RADIUS;
    let deep_y = culet_y + pavilion * deep_radius * cosine;

    let mut stone = Stone::default();
    let table = stone.octagon(0, TABLE_RADIUS, table_y);
    let stars = stone.octagon(1, star_radius, star_y);
    let upper = stone.girdle(sides, stars, table_y - crown_height);
    let deeps = stone.octagon(1, deep_radius, deep_y);
    let lower = stone.girdle(sides, deeps, culet_y + pavilion_height);
    let culet = stone.vertex(DVec3::Y * culet_y);

    stone.facets.push(table.to_vec());
    for k in 0..8 {
        let (before, next, tip) = ((k + 7) % 8, (k + 1) % 8, 2 * k * span);
        stone.facets.push(vec![table[k], stars[k], table[next]]);
        stone.facets.push(vec![table[k], stars[before], upper[tip], stars[k]]);
        stone.facets.push(vec![culet, deeps[k], lower[tip], deeps[before]]);
    }
    for sixteenth in 0..16 {
        let side = |ring: &[u32], step: usize| ring[(sixteenth * span + step) % sides];
        let above = (0..=span).map(|step| side(&upper, step));
        stone.facets.push(iter::once(stars[sixteenth / 2]).chain(above).collect());
        let below = (0..=span).rev().map(|step| side(&lower, step));
        stone.facets.push(iter::once(deeps[sixteenth / 2]).chain(below).collect());
    }
    for side in 0..sides {
        let next = (side + 1) % sides;
        stone.facets.push(vec![lower[side], lower[next], upper[next], upper[side]]);
    }
    stone.mesh()
}

/// Vertices, and facets as their corners, anticlockwise seen from outside.
#[derive(Default)]
struct Stone {
    positions: Vec<DVec3>,
    facets: Vec<Vec<u32>>,
}

impl Stone {
    fn vertex(&mut self, position: DVec3) -> u32 {
        self.positions.push(position);
        self.positions.len() as u32 - 1
    }

    /// Eight vertices at a height: in the middle of the bezels (`first` = 0), or half-way between them (1).
    fn octagon(&mut self, first: usize, radius: f64, y: f64) -> [u32; 8] {
        array::from_fn(|k| self.vertex(circle::around_y(2 * k + first, 16, radius, y)))
    }

    /// One edge of the girdle. It has height `y` where two girdle facets meet, every sixteenth of a turn;
    /// between, it lies on the plane of the facet, which its two ends and one of the `apexes` span.
    fn girdle(&mut self, sides: usize, apexes: [u32; 8], y: f64) -> Vec<u32> {
        let span = sides / 16;
        let rim = |side: usize| circle::around_y(side, sides, RADIUS, y);
        let mut ring = Vec::new();
        for side in 0..sides {
            let mut position = rim(side);
            let (sixteenth, step) = (side / span, side % span);
            if step > 0 {
                let end = rim(sixteenth * span);
                let apex = self.positions[apexes[sixteenth / 2] as usize];
                let normal = (rim((sixteenth + 1) * span) - end).cross(apex - end);
                let from_end = position - end;
                position.y -= normal.dot(from_end) / normal.y;
            }
            ring.push(self.vertex(position));
        }
        ring
    }

    /// Facets as fans around their first corner, each with its own normal.
    fn mesh(self) -> MeshData {
        let mut mesh = MeshData { positions: self.positions, ..MeshData::default() };
        for (facet, corners) in (0..).zip(&self.facets) {
            let [first, second, last] = [corners[0], corners[1], corners[corners.len() - 1]]
                .map(|corner| mesh.positions[corner as usize]);
            mesh.normals.push((second - first).cross(last - first).normalize());
            for pair in corners[1..].windows(2) {
                mesh.triangles.push([corners[0], pair[0], pair[1]]);
                mesh.normal_triangles.push([facet; 3]);
            }
        }
        mesh
    }
}
