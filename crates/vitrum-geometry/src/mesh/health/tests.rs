//! One hand-made mesh for each defect, with its counts worked out on paper.

use glam::DVec3;

use super::{Defect, Health, Remedy, health, mend};
use crate::mesh::{MeshData, Triangle};

/// A cube around a point, outward; two triangles a side, vertices shared.
fn cube(centre: DVec3, half: f64) -> MeshData {
    let corner = |i: u32| {
        let sign = |bit: u32| if i >> bit & 1 == 1 { half } else { -half };
        centre + DVec3::new(sign(0), sign(1), sign(2))
    };
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    MeshData {
        positions: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        ..MeshData::default()
    }
}

fn unit_cube() -> MeshData {
    cube(DVec3::ZERO, 0.5)
}

/// All meshes in one.
fn together(meshes: &[MeshData]) -> MeshData {
    let mut all = MeshData::default();
    for mesh in meshes {
        let shift = u32::try_from(all.positions.len()).unwrap();
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|triangle| triangle.map(|index| index + shift)));
    }
    all
}

fn inside_out(mut mesh: MeshData) -> MeshData {
    for triangle in &mut mesh.triangles {
        triangle.swap(1, 2);
    }
    mesh
}

/// Every triangle with its own three vertices, as STL has it.
fn soup(mesh: &MeshData) -> MeshData {
    MeshData {
        positions: mesh.triangles.iter().flatten().map(|&index| mesh.positions[index as usize]).collect(),
        triangles: (0..).step_by(3).map(|i| [i, i + 1, i + 2]).take(mesh.triangles.len()).collect(),
        ..MeshData::default()
    }
}

fn findings(health: &Health) -> Vec<(Defect, usize)> {
    health.findings.iter().map(|finding| (finding.defect, finding.count)).collect()
}

fn remedies(mesh: MeshData) -> (MeshData, Vec<(Remedy, Vec<usize>)>) {
    let (mesh, report) = mend(mesh);
    (mesh, report.into_iter().map(|mended| (mended.remedy, mended.triangles)).collect())
}

#[test]
fn a_cube_is_healthy() {
    for mesh in [unit_cube(), soup(&unit_cube())] {
        let report = health(&mesh);
        assert_eq!(findings(&report), []);
        assert!(report.is_closed());
        assert_eq!(report.components.len(), 1);
        assert_eq!(report.components[0].triangles, 12);
        assert!((report.volume().unwrap() - 1.0).abs() < 1e-15, "volume of a unit cube");
        assert_eq!(report.to_string(), "12 triangles, 1 body, closed, volume 1");
        assert_eq!(mend(mesh.clone()), (mesh, vec![]));
    }
}

#[test]
fn volume_holds_far_from_the_origin() {
    let volume = health(&cube(DVec3::splat(1e6), 0.5)).volume().unwrap();
    // The corners at 1e6 ± 0.5 are exact, and so are differences from the centre.
    assert!((volume - 1.0).abs() < 1e-15, "{volume}");
}

#[test]
fn negative_zero_is_zero() {
    let mut mesh = soup(&cube(DVec3::splat(0.5), 0.5));
    for position in mesh.positions.iter_mut().step_by(2) {
        *position = position.map(|coordinate| if coordinate == 0.0 { -0.0 } else { coordinate });
    }
    assert!(health(&mesh).is_closed());
}

#[test]
fn nothing_is_not_closed() {
    let report = health(&MeshData::default());
    assert!(!report.is_closed());
    assert_eq!(report.to_string(), "0 triangles, 0 bodies, not closed");
    assert_eq!(mend(MeshData::default()), (MeshData::default(), vec![]));
}

#[test]
fn a_hole_has_a_rim() {
    let mut mesh = unit_cube();
    mesh.triangles.pop();
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::OpenEdge, 3)]);
    assert!(!report.components[0].closed && report.components[0].oriented);
    assert_eq!(report.volume(), None);
    // The last side is z = 0.5; the lowest face beside it is the first, which meets it at x = -0.5.
    let first = report.find(Defect::OpenEdge).unwrap().first;
    assert_eq!((first.index, first.position), (0, DVec3::new(-0.5, 0.0, 0.5)));
    assert_eq!(
        report.to_string(),
        "11 triangles, 1 body, not closed: 3 open edges (first at (-0.5, 0, 0.5))"
    );
    assert_eq!(mend(mesh.clone()), (mesh, vec![]));
}

#[test]
fn a_vertex_that_is_not_finite_opens_the_surface() {
    let mut mesh = unit_cube();
    mesh.positions[7].y = f64::NAN;
    let report = health(&mesh);
    let around = mesh.triangles.iter().filter(|triangle| triangle.contains(&7)).count();
    assert_eq!(report.unusable, around);
    assert_eq!(report.count(Defect::NonFiniteVertex), 1);
    assert_eq!(report.find(Defect::NonFiniteVertex).unwrap().first.index, 7);
    assert!(!report.is_closed());
    assert!(report.to_string().contains("1 vertex not finite (first is vertex 7)"), "{report}");

    let mut unused = unit_cube();
    unused.positions.push(DVec3::splat(f64::INFINITY));
    let report = health(&unused);
    assert_eq!(findings(&report), [(Defect::NonFiniteVertex, 1)]);
    assert!(report.is_closed(), "no face uses it");
}

#[test]
fn indices_out_of_range_are_found_in_every_array() {
    let mut mesh = unit_cube();
    mesh.triangles.push([0, 8, u32::MAX]);
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::IndexOutOfRange, 1)]);
    assert_eq!((report.unusable, report.is_closed()), (1, false));
    assert!(report.to_string().ends_with("1 face with an index out of range (first is face 12)"), "{report}");
    assert_eq!(mend(mesh.clone()), (mesh, vec![]));

    let mut mesh = unit_cube();
    mesh.normals = vec![DVec3::X];
    mesh.normal_triangles = vec![[0, 0, 0]; 11];
    mesh.normal_triangles[3] = [0, 1, 0];
    mesh.uv_triangles = vec![[0, 0, 0]; 12];
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::IndexOutOfRange, 12)]);
    assert_eq!((report.unusable, report.is_closed()), (0, false));
}

#[test]
fn faces_without_area_are_dropped() {
    let mut mesh = soup(&unit_cube());
    // Both collapse only after welding: corners 0 and 3 are two triangles' copies of one vertex.
    assert_eq!(mesh.positions[0], mesh.positions[3]);
    mesh.triangles.insert(0, [0, 3, 1]);
    mesh.triangles.push([0, 3, 0]);
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::DegenerateFace, 2)]);
    assert!(report.is_closed());
    assert_eq!(remedies(mesh), (soup(&unit_cube()), vec![(Remedy::DroppedDegenerate, vec![0, 13])]));
}

#[test]
fn a_flat_face_stays_where_it_closes_a_seam() {
    // The edge from 0 to 1 of a cube, halved on one side only: vertex 8 in its middle, and a flat face in the
    // seam.
    let mut mesh = unit_cube();
    mesh.positions.push((mesh.positions[0] + mesh.positions[1]) / 2.0);
    let split = mesh.triangles.iter().position(|triangle| *triangle == [0, 1, 5]).unwrap();
    mesh.triangles[split] = [0, 8, 5];
    mesh.triangles.push([8, 1, 5]);
    assert_eq!(health(&mesh).count(Defect::OpenEdge), 3);
    mesh.triangles.push([0, 1, 8]);
    let report = health(&mesh);
    assert!(report.is_closed());
    assert_eq!(findings(&report), [(Defect::DegenerateFace, 1)]);
    assert_eq!(mend(mesh.clone()), (mesh.clone(), vec![]));

    // Another one that hangs from the surface has no such use, nor has one by itself.
    let end = u32::try_from(mesh.positions.len()).unwrap();
    mesh.positions.push(mesh.positions[0] * 3.0 - mesh.positions[1] * 2.0);
    mesh.triangles.push([0, 1, end]);
    let (mended, report) = remedies(mesh);
    assert_eq!(report, [(Remedy::DroppedDegenerate, vec![14])]);
    assert!(health(&mended).is_closed());
}

#[test]
fn duplicates_are_dropped_and_doubles_are_not() {
    let mut mesh = unit_cube();
    let [a, b, c] = mesh.triangles[4];
    mesh.triangles.extend([[b, c, a], [c, a, b]]);
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::DuplicateFace, 2), (Defect::NonManifoldEdge, 3)]);
    assert_eq!(report.find(Defect::DuplicateFace).unwrap().first.index, 12);
    assert_eq!(remedies(mesh), (unit_cube(), vec![(Remedy::DroppedDuplicate, vec![12, 13])]));

    let mut mesh = unit_cube();
    mesh.triangles.push([a, c, b]);
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::DoubledFace, 1), (Defect::NonManifoldEdge, 3)]);
    assert_eq!(mend(mesh.clone()), (mesh, vec![]));
}

#[test]
fn dropping_keeps_the_attributes_of_the_rest() {
    let mut mesh = unit_cube();
    mesh.normals = (0..12).map(|i| DVec3::splat(f64::from(i))).collect();
    mesh.normal_triangles = (0..12).map(|i| [i; 3]).collect();
    mesh.uvs = vec![glam::DVec2::ZERO; 12];
    mesh.uv_triangles = mesh.normal_triangles.clone();
    let collapsed = [0, 1, 1];
    mesh.triangles[5] = collapsed;
    let (mended, _) = mend(mesh);
    let expected: Vec<_> = (0..12).filter(|&i| i != 5).map(|i| [i; 3]).collect();
    assert_eq!(mended.normal_triangles, expected);
    assert_eq!(mended.uv_triangles, expected);
    assert_eq!(mended.triangles.len(), 11);
}

#[test]
fn three_faces_on_an_edge() {
    let positions = vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::Z, -DVec3::X];
    let mesh =
        MeshData { positions, triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]], ..MeshData::default() };
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::OpenEdge, 6), (Defect::NonManifoldEdge, 1)]);
    assert_eq!(report.components.len(), 1);
    assert_eq!(report.find(Defect::NonManifoldEdge).unwrap().first.position, DVec3::Y / 2.0);
}

#[test]
fn turned_faces_clash_and_are_turned_back() {
    // Whichever faces are turned, the lowest one included, a closed body ends outward.
    for turned in [vec![0], vec![4], vec![0, 1, 2, 3, 5, 6, 7, 8, 9], vec![2, 3, 7]] {
        let mut mesh = unit_cube();
        for &face in &turned {
            mesh.triangles[face].swap(1, 2);
        }
        let report = health(&mesh);
        assert!(report.count(Defect::ClashingEdge) > 0 && !report.is_closed());
        assert!(report.components[0].closed && report.components[0].orientable);
        let (mended, report) = remedies(mesh);
        assert_eq!(report, [(Remedy::Oriented, turned)]);
        assert_eq!(health(&mended), health(&unit_cube()));
    }
}

#[test]
fn an_open_sheet_and_a_moebius_strip_are_left() {
    let mut sheet = MeshData { positions: unit_cube().positions, ..MeshData::default() };
    sheet.triangles = vec![[0, 1, 2], [1, 2, 3]];
    let report = health(&sheet);
    assert_eq!(findings(&report), [(Defect::OpenEdge, 4), (Defect::ClashingEdge, 1)]);
    assert!(report.components[0].orientable);
    assert_eq!(mend(sheet.clone()), (sheet, vec![]));

    // Möbius's own: five triangles on five vertices, each on the next three (1858).
    let strip = MeshData {
        positions: unit_cube().positions[..5].to_vec(),
        triangles: (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect(),
        ..MeshData::default()
    };
    let report = health(&strip);
    assert_eq!(report.count(Defect::OpenEdge), 5);
    assert!(!report.components[0].orientable);
    assert_eq!(mend(strip.clone()), (strip, vec![]));
}

/// The projective plane on six vertices: closed, and no turning of faces helps.
#[test]
fn a_closed_surface_with_one_side_is_left() {
    let triangles: Vec<Triangle> = vec![
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let mesh = MeshData { positions: unit_cube().positions, triangles, ..MeshData::default() };
    let report = health(&mesh);
    assert!(report.components[0].closed && !report.components[0].orientable);
    assert!(!report.is_closed());
    assert_eq!(mend(mesh.clone()), (mesh, vec![]));
}

#[test]
fn an_inside_out_body_is_turned_and_its_normals_follow() {
    let mut mesh = inside_out(unit_cube());
    // Faces 0 to 5 have normals that agree with their winding, the others normals that point outward already.
    for (face, triangle) in mesh.triangles.clone().iter().enumerate() {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        let inward = (b - a).cross(c - a);
        mesh.normals.push(if face < 6 { inward } else { -inward });
        mesh.normal_triangles.push([u32::try_from(face).unwrap(); 3]);
    }
    let report = health(&mesh);
    assert_eq!(findings(&report), [(Defect::InsideOut, 1)]);
    assert_eq!(report.volume(), Some(-1.0));
    let (mended, report) = mend(mesh);
    assert_eq!(report.len(), 1);
    assert_eq!((report[0].remedy, report[0].bodies), (Remedy::TurnedOutward, 1));
    assert_eq!(report[0].triangles, (0..12).collect::<Vec<_>>());
    assert!(report[0].to_string().starts_with("turned 1 inside-out body outward (first at (-0.5, "));
    assert_eq!(health(&mended), health(&unit_cube()));
    for (triangle, normals) in mended.triangles.iter().zip(&mended.normal_triangles) {
        let [a, b, c] = triangle.map(|index| mended.positions[index as usize]);
        for index in normals {
            assert!((b - a).cross(c - a).dot(mended.normals[*index as usize]) > 0.0);
        }
    }
}

#[test]
fn bodies_beside_each_other_are_turned_one_by_one() {
    let beside = cube(DVec3::X * 3.0, 0.5);
    let (mended, report) = remedies(together(&[unit_cube(), inside_out(beside.clone())]));
    assert_eq!(report, [(Remedy::TurnedOutward, (12..24).collect())]);
    assert_eq!(health(&mended), health(&together(&[unit_cube(), beside])));
}

#[test]
fn a_bubble_is_left_and_said() {
    let outer = cube(DVec3::ZERO, 2.0);
    let bubble = inside_out(unit_cube());
    let mesh = together(&[outer.clone(), bubble]);
    let report = health(&mesh);
    assert!(report.is_closed());
    assert_eq!(findings(&report), []);
    assert_eq!(report.components.iter().map(|body| body.depth).collect::<Vec<_>>(), [0, 1]);
    assert!((report.volume().unwrap() - 63.0).abs() < 1e-13);
    let (mended, said) = mend(mesh.clone());
    assert_eq!(mended, mesh);
    assert_eq!(said.len(), 1);
    assert_eq!((said[0].remedy, said[0].bodies), (Remedy::LeftBubble, 1));
    assert!(
        said[0].to_string().starts_with("left 1 inside-out body as it is, a bubble inside another body (")
    );

    // A body turned outward in another is not touched either.
    let inclusion = together(&[unit_cube(), outer]);
    assert_eq!(mend(inclusion.clone()), (inclusion, vec![]));
}

#[test]
fn a_mirrored_solid_turns_with_its_bubble() {
    let (outer, bubble, drop) = (cube(DVec3::ZERO, 2.0), unit_cube(), cube(DVec3::splat(0.1), 0.2));
    let right = together(&[drop.clone(), outer.clone(), inside_out(bubble.clone())]);
    let mirrored = inside_out(right.clone());
    let (mended, report) = remedies(mirrored);
    assert_eq!(mended, right);
    assert_eq!(report, [(Remedy::TurnedOutward, (0..36).collect())]);
}

#[test]
fn boxes_that_touch_or_enclose_are_not_enough_for_nesting() {
    // A cube in the notch of an L: inside its box, not inside it.
    let l = extruded(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)], 4.0);
    let report = health(&l);
    assert!(report.is_closed());
    assert!((report.volume().unwrap() - 28.0).abs() < 1e-13);
    let notch = together(&[l, inside_out(cube(DVec3::new(2.5, 2.5, 2.0), 0.5))]);
    let report = health(&notch);
    assert_eq!(report.components[1].depth, 0);
    assert_eq!(report.count(Defect::InsideOut), 1);
}

/// A prism over a polygon in the xy plane that is a star seen from its first corner.
fn extruded(outline: &[(f64, f64)], height: f64) -> MeshData {
    let count = u32::try_from(outline.len()).unwrap();
    let level = |z: f64| outline.iter().map(move |&(x, y)| DVec3::new(x, y, z));
    let mut triangles = Vec::new();
    for i in 0..count {
        let next = (i + 1) % count;
        triangles.extend([[i, next, next + count], [i, next + count, i + count]]);
    }
    for i in 1..count - 1 {
        triangles.extend([[0, i + 1, i], [count, count + i, count + i + 1]]);
    }
    MeshData { positions: level(0.0).chain(level(height)).collect(), triangles, ..MeshData::default() }
}

#[test]
fn rays_through_vertices_and_edges_count_once() {
    // The samples of the inner cubes lie level with corners and edges of the outer octahedron along every
    // axis.
    let octahedron = MeshData {
        positions: vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z],
        triangles: vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
        ..MeshData::default()
    };
    assert!(health(&octahedron).is_closed());
    let tiny = MeshData {
        // A tetrahedron whose face centroids have y = 0 or z = 0.
        positions: [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, -0.3], [0.0, -0.3, 0.3]]
            .map(DVec3::from_array)
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
        ..MeshData::default()
    };
    for shift in [DVec3::ZERO, DVec3::X * 0.2, DVec3::X * -0.4, DVec3::X * 1.1, DVec3::X * -1.5] {
        let mut moved = tiny.clone();
        for position in &mut moved.positions {
            *position += shift;
        }
        let report = health(&together(&[octahedron.clone(), moved]));
        let inside = shift.x.abs() < 0.5;
        assert_eq!(report.components[1].depth, usize::from(inside), "shifted by {shift}");
    }
}
