//! Mesh health is quick enough to run on every mesh that is loaded: no step is slower than sorting.

use std::{hint::black_box, time::Instant};

use glam::DVec3;
use vitrum_geometry::mesh::{Defect, MeshData, Triangle, health};

/// Seconds allowed: five times and more what a busy machine of two cores needs, with assertions on.
const LIMIT: f64 = 3.0;

/// The least time of a few runs, in seconds: what else the machine does only adds to it.
#[expect(clippy::disallowed_methods, reason = "a test of time needs a clock")]
fn seconds(mesh: &MeshData) -> f64 {
    let run = |_| {
        let start = Instant::now();
        black_box(health(mesh));
        start.elapsed().as_secs_f64()
    };
    (0..5).map(run).fold(f64::INFINITY, f64::min)
}

/// A grid of quads that closes in both directions, with scattered positions.
fn torus(columns: u32, rows: u32) -> MeshData {
    let index = |i: u32, j: u32| (i % columns) * rows + j % rows;
    let quads = (0..columns * rows).map(|k| {
        let (i, j) = (k / rows, k % rows);
        [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)]
    });
    let position = |k: u32| DVec3::new(f64::from(k / rows), f64::from(k % rows), f64::from(k * 37 % 101));
    MeshData {
        positions: (0..columns * rows).map(position).collect(),
        triangles: quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..MeshData::default()
    }
}

/// Octahedra around points, outward.
fn octahedra(centres: impl Iterator<Item = (DVec3, f64)>) -> MeshData {
    const FACES: [Triangle; 8] =
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let mut mesh = MeshData::default();
    for ((centre, radius), first) in centres.zip((0..).step_by(6)) {
        for axis in DVec3::AXES {
            mesh.positions.extend([centre + radius * axis, centre - radius * axis]);
        }
        mesh.triangles.extend(FACES.map(|face| face.map(|corner| first + corner)));
    }
    mesh
}

#[test]
fn one_body_of_two_hundred_thousand_faces() {
    let mesh = torus(400, 250);
    let report = health(&mesh);
    assert!(report.is_closed() && report.components.len() == 1 && report.triangles == 200_000);
    let seconds = seconds(&mesh);
    assert!(seconds < LIMIT, "{seconds} s");
}

#[test]
fn twenty_five_thousand_bubbles_in_one_body() {
    // Bubbles in straight rows, the worst case for rays that look for the body around them.
    let bubbles = (0..25_000).map(|k| {
        let centre = DVec3::new(f64::from(k % 30), f64::from(k / 30 % 30), f64::from(k / 900));
        (centre, 0.4)
    });
    let mesh = octahedra(bubbles.chain([(DVec3::splat(15.0), 100.0)]));
    let report = health(&mesh);
    assert_eq!(report.components.iter().filter(|body| body.depth == 1).count(), 25_000);
    assert_eq!(report.count(Defect::InsideOut), 0);
    let seconds = seconds(&mesh);
    assert!(seconds < LIMIT, "{seconds} s");
}
