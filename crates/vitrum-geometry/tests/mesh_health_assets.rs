//! Mesh health on real files: the counts of an independent program (the index of the assets), and what
//! mending does.
//!
//! The index counts the wall with a hole without the lines that continue another (57 faces, 15 open edges);
//! with them its eleven faces without area, left by fans over collinear corners, are what closes it. It
//! counts duplicate and doubled faces together, and as one body what touches in a vertex; here bodies are
//! connected through edges, so that the teapot's parts come apart, the monkey's eyes and the dragon's crumbs.

use std::path::Path;

use glam::DVec3;
use vitrum_geometry::mesh::{Defect, Health, MeshData, Remedy, health, mend};

/// What is expected of one file.
#[derive(Debug, Default, PartialEq)]
struct Expected {
    triangles: usize,
    bodies: usize,
    open: usize,
    non_manifold: usize,
    clashing: usize,
    /// Duplicate and doubled faces.
    repeated: usize,
    degenerate: usize,
    non_finite: usize,
}

impl Expected {
    fn found(health: &Health) -> Self {
        Self {
            triangles: health.triangles,
            bodies: health.components.len(),
            open: health.count(Defect::OpenEdge),
            non_manifold: health.count(Defect::NonManifoldEdge),
            clashing: health.count(Defect::ClashingEdge),
            repeated: health.count(Defect::DuplicateFace) + health.count(Defect::DoubledFace),
            degenerate: health.count(Defect::DegenerateFace),
            non_finite: health.count(Defect::NonFiniteVertex),
        }
    }
}

/// Positions and faces of an OBJ file, polygons as fans; nothing else.
fn read(path: &Path) -> MeshData {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let text = String::from_utf8_lossy(&bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let mut mesh = MeshData::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let coordinates: Vec<f64> =
                    words.take(3).map(|word| word.parse().unwrap_or(f64::NAN)).collect();
                mesh.positions.push(DVec3::from_slice(&coordinates));
            }
            Some("f") => {
                let corner = |word: &str| {
                    let index =
                        word.split('/').next().and_then(|index| index.parse::<i64>().ok()).expect("an index");
                    let past = i64::try_from(mesh.positions.len()).expect("a short list");
                    u32::try_from(if index < 0 { past + index } else { index - 1 }).expect("a vertex before")
                };
                let corners: Vec<_> = words.map(corner).collect();
                mesh.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    mesh
}

#[test]
fn counts_are_those_of_the_index() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let one = Expected { bodies: 1, ..Expected::default() };
    let table = [
        ("obj/stanford-bunny", Expected { triangles: 69451, open: 223, ..one }),
        ("obj/spot", Expected { triangles: 5856, ..one }),
        ("obj/teapot", Expected { triangles: 2256, open: 96, bodies: 4, ..one }),
        ("obj/fandisk", Expected { triangles: 5750, ..one }),
        ("obj/monkey", Expected { triangles: 968, open: 62, bodies: 3, ..one }),
        ("obj/quadknot", Expected { triangles: 2880, ..one }),
        ("obj/cornell_box", Expected { triangles: 36, open: 8, bodies: 4, ..one }),
        (
            "obj/chair_model",
            Expected { triangles: 12756, non_manifold: 9518, repeated: 6382, bodies: 3, ..one },
        ),
        ("obj/rabbit", Expected { triangles: 1252, bodies: 9, ..one }),
        (
            "obj/stanford-dragon",
            Expected { triangles: 202_520, non_manifold: 2534, repeated: 1489, bodies: 12, ..one },
        ),
        ("bad-mesh/moebius", Expected { triangles: 448, open: 112, clashing: 4, ..one }),
        ("bad-mesh/fan3", Expected { triangles: 3, open: 6, non_manifold: 1, ..one }),
        ("bad-mesh/boxNotManifold", Expected { triangles: 12, open: 4, ..one }),
        ("bad-mesh/self_intersectA", Expected { triangles: 17160, ..one }),
        (
            "bad-mesh/openscad-nonmanifold-crash",
            Expected { triangles: 1442, non_manifold: 18, repeated: 3, degenerate: 1, bodies: 2, ..one },
        ),
        ("bad-mesh/Havocglass8_left", Expected { triangles: 164, ..one }),
        ("bad-mesh/Havocglass8_right", Expected { triangles: 12, ..one }),
        (
            "bad-mesh/wallhole",
            Expected { triangles: 66, non_manifold: 1, repeated: 1, degenerate: 11, ..one },
        ),
        ("bad-mesh/joined_tetrahedra", Expected { triangles: 8, non_manifold: 3, repeated: 1, ..one }),
        ("bad-mesh/nancolor", Expected { triangles: 12, ..one }),
        ("bad-mesh/test-nan", Expected { triangles: 36, open: 10, non_finite: 4, bodies: 4, ..one }),
        ("bad-mesh/issue-319-003", Expected { triangles: 8, open: 10, ..one }),
        (
            "bad-mesh/concave_polygon",
            Expected { triangles: 64, open: 63, non_manifold: 2, repeated: 1, ..one },
        ),
    ];
    for (name, expected) in table {
        let report = health(&read(&assets.join(name).with_extension("obj")));
        assert_eq!(Expected::found(&report), expected, "{name}: {report}");
    }
}

#[test]
fn closed_files_enclose_their_volume() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    // To the four digits of the index; it says nothing of self-intersection, nor does health.
    for (name, volume) in [
        ("obj/spot", 0.7183),
        ("obj/fandisk", 0.6794),
        ("obj/quadknot", 1.057e6),
        ("obj/rabbit", 6.649),
        ("bad-mesh/self_intersectA", 0.148),
        ("bad-mesh/Havocglass8_left", 2.779e6),
        ("bad-mesh/Havocglass8_right", 3.49e5),
        ("bad-mesh/nancolor", 1.0),
    ] {
        let mesh = read(&assets.join(name).with_extension("obj"));
        let report = health(&mesh);
        let found = report.volume().unwrap_or_else(|| panic!("{name}: {report}"));
        assert!((found / volume - 1.0).abs() < 5e-4, "{name}: {found}, expected {volume}");
        assert_eq!(mend(mesh.clone()), (mesh, vec![]), "{name} needs no mending");
    }
}

#[test]
fn mending_leaves_nothing_that_it_can_mend() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    for (name, dropped) in [
        ("obj/chair_model", 8),
        ("obj/stanford-dragon", 86),
        ("bad-mesh/openscad-nonmanifold-crash", 1),
        ("bad-mesh/wallhole", 0),
        ("bad-mesh/test-nan", 0),
    ] {
        let mesh = read(&assets.join(name).with_extension("obj"));
        let before = mesh.triangles.len();
        let (mended, report) = mend(mesh);
        assert_eq!(before - mended.triangles.len(), dropped, "{name}: {report:?}");
        let after = health(&mended);
        assert_eq!(after.count(Defect::DuplicateFace), 0, "{name}: {after}");
        assert_eq!(after.count(Defect::InsideOut), 0, "{name}: {after}");
        let (again, report) = mend(mended.clone());
        assert_eq!(again.triangles, mended.triangles, "{name}");
        assert!(report.iter().all(|mended| mended.remedy == Remedy::LeftBubble), "{name}: {report:?}");
    }
}
