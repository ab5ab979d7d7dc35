//! OBJ files written by hand, one feature or mistake each.

use std::io;

use proptest::prelude::*;
use vitrum_io::obj::{self, Group, MtlMeaning, ObjError, ObjFile, Part};
use vitrum_math::{DVec2, DVec3, Rgb};

fn no_library(_: &str) -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

fn load(text: &str) -> ObjFile {
    obj::parse("test.obj", text.as_bytes(), no_library).expect("loads")
}

fn refuse(text: &str) -> String {
    obj::parse("test.obj", text.as_bytes(), no_library).expect_err("is refused").to_string()
}

/// The only part of a file that gives no warning.
fn one_part(text: &str) -> Part {
    let mut file = load(text);
    assert_eq!(file.warnings, Vec::<String>::new());
    assert_eq!(file.parts.len(), 1);
    file.parts.remove(0)
}

fn only_warning(file: &ObjFile) -> &str {
    assert_eq!(file.warnings.len(), 1, "{:?}", file.warnings);
    &file.warnings[0]
}

/// Sum of the triangles' area vectors: twice the area of a plane surface along its normal.
fn area_vector(part: &Part) -> DVec3 {
    let corner = |index: u32| part.mesh.positions[index as usize];
    let area = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0]));
    part.mesh.triangles.iter().map(area).sum()
}

/// Twice the area of each triangle along a direction.
fn areas_along(part: &Part, direction: DVec3) -> Vec<f64> {
    let corner = |index: u32| part.mesh.positions[index as usize];
    let area = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).dot(direction);
    part.mesh.triangles.iter().map(area).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn coordinates_are_read_in_double_precision() {
    let part = one_part("v 0.1 1e-300 12345678.901234567\nv 1 0 0\nv 0 1 0\nf 1 2 3");
    assert_eq!(part.mesh.positions[0], DVec3::new(0.1, 1e-300, 12_345_678.901_234_567));
    assert_eq!(part.mesh.triangles, [[0, 1, 2]]);
    assert!(part.mesh.normals.is_empty() && part.mesh.uvs.is_empty());
    assert_eq!((part.name.as_str(), part.material), ("", None));
}

#[test]
fn a_weight_divides_and_a_colour_does_nothing() {
    let part = one_part("v 2 4 6 2\nv 1 0 0\nv 0 1 0\nf 1 2 3");
    assert_eq!(part.mesh.positions[0], DVec3::new(1.0, 2.0, 3.0));
    let file = load("v 1 2 3 nan nan nan\nv 1 0 0 0.5 0.5 0.5 1\nv 0 1 0\nf 1 2 3");
    assert_eq!(file.parts[0].mesh.positions[0], DVec3::new(1.0, 2.0, 3.0));
    assert!(
        only_warning(&file)
            .contains("vertices with more than four numbers (vertex colours), of which three are used: 2")
    );
}

#[test]
fn indices_count_from_either_end_and_may_look_ahead() {
    let backwards = one_part(&format!("{SQUARE}f -4 -3 -2\nv 5 5 5\nf -5 -4 -3"));
    assert_eq!(backwards.mesh.triangles, [[0, 1, 2], [0, 1, 2]]);
    let ahead = one_part(&format!("f 1 2 3\n{SQUARE}"));
    assert_eq!(ahead.mesh.positions.len(), 3, "only the vertices that are used");
}

#[test]
fn positions_normals_and_texture_coordinates_keep_their_own_indices() {
    let part = one_part(&format!(
        "{SQUARE}vt 0 0\nvt 1 0.5 9\nvt 0.25\nvn 0 0 1\nvn 0 0 2\nf 1/1/1 2/2/2 3/3/1\nf 1/2/2 3/1/1 4/3/2"
    ));
    let mesh = &part.mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.uv_triangles, [[0, 1, 2], [1, 0, 2]]);
    assert_eq!(mesh.uvs, [DVec2::ZERO, DVec2::new(1.0, 0.5), DVec2::new(0.25, 0.0)]);
    assert_eq!(mesh.normal_triangles, [[0, 1, 0], [1, 0, 1]]);
    assert_eq!(mesh.normals, [DVec3::Z, 2.0 * DVec3::Z]);
}

#[test]
fn corners_without_a_usable_normal_take_the_face_normal() {
    let file = load(&format!("{SQUARE}vn 1 0 0\nf 1 2 3 4\nf 1//1 2//1 3//1"));
    let mesh = &file.parts[0].mesh;
    assert_eq!(mesh.normals, [DVec3::Z, DVec3::X]);
    assert_eq!(mesh.normal_triangles, [[0; 3], [0; 3], [1; 3]]);
    assert!(
        only_warning(&file).contains("faces without normals in parts where others have some, shaded flat: 1")
    );

    let file = load(&format!("{SQUARE}vn 0 0 0\nvn 1 0 0\nvn 0 nan 1.#INF\nf 1//1 2//2 3//3"));
    let mesh = &file.parts[0].mesh;
    assert_eq!(
        (&mesh.normals[..], &mesh.normal_triangles[..]),
        (&[DVec3::Z, DVec3::X][..], &[[0, 1, 0]][..])
    );
    assert!(
        only_warning(&file)
            .contains("normals that are zero or not finite, replaced by those of their faces: 2")
    );

    let file = load(&format!("{SQUARE}vn 0 0 0\nf 1//1 2//1 3//1"));
    assert!(file.parts[0].mesh.normals.is_empty() && file.parts[0].mesh.normal_triangles.is_empty());

    let file = load(&format!("{SQUARE}f 1//7 2//7 3//7\nf 1/2/3 3/2/1 4/0/0"));
    assert!(file.parts[0].mesh.normals.is_empty() && file.parts[0].mesh.uvs.is_empty());
    assert!(file.warnings[0].contains("texture coordinates which do not exist, and go without: 1"));
    assert!(file.warnings[1].contains("normals which do not exist, and go without: 2 (first at line 5)"));
}

#[test]
fn objects_are_parts_and_groups_are_ranges() {
    let file = load(&format!(
        "{SQUARE}f 1 2 3\no a\ng left right\nf 1 2 3 4\ng top\nf 1 2 3\nf 2 3 4\no b # 2\nf 1 2 3\no a\ng top\nf 4 3 2\no c"
    ));
    let names: Vec<_> = file.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["", "a", "b # 2"]);
    let group = |name: &str, triangles| Group { name: name.to_owned(), triangles };
    assert_eq!(file.parts[1].groups, [group("left", 0..2), group("right", 0..2), group("top", 2..5)]);
    assert_eq!(file.parts[2].groups, [group("top", 0..1)]);
    assert!(file.parts[0].groups.is_empty());
    assert_eq!(file.parts[1].mesh.triangles.len(), 5);
    assert_eq!(file.warnings, Vec::<String>::new());
}

#[test]
fn a_solid_of_several_materials_stays_in_one_piece() {
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let text = format!("{tetrahedron}f 1 3 2\nusemtl a\nf 1 2 4\nusemtl b\nf 1 4 3\nusemtl a\nf 2 3 4");
    let library = |_: &str| Ok(b"newmtl b\nKd 1 0 0\n".to_vec());
    let text = format!("{text}\nmtllib late.mtl");
    let file = obj::parse("test.obj", text.as_bytes(), library).expect("loads");
    let part = &file.parts[0];
    assert_eq!((file.parts.len(), part.mesh.positions.len(), part.mesh.triangles.len()), (1, 4, 4));
    let names: Vec<_> = file.materials.iter().map(|m| (m.name.as_str(), m.is_defined)).collect();
    assert_eq!(names, [("b", true), ("a", false), ("", false)]);
    assert_eq!((&part.mesh.materials[..], part.material), (&[2, 1, 0, 1][..], None));
    assert!(
        only_warning(&file)
            .contains("materials used but not defined, taken as plain grey: 1 (first `a` at line 6)")
    );
}

#[test]
fn materials_mean_what_they_say() {
    let library = |name: &str| match name {
        "a.mtl" => {
            Ok(b"newmtl clear\nillum 7\nNi 1.33\nTf 1 0.9 0.8\nnewmtl veil\nKd 1 1 1\nd 0.5\n".to_vec())
        }
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let text =
        format!("mtllib a.mtl\nmtllib b.mtl\n{SQUARE}usemtl clear\nf 1 2 3\no two\nusemtl veil\nf 1 3 4");
    let file = obj::parse("test.obj", text.as_bytes(), library).expect("loads");
    let meaning = |part: usize| file.materials[file.parts[part].material.expect("has one")].meaning();
    assert_eq!(meaning(0), MtlMeaning::Glass { ior: 1.33, tint: Rgb::new(1.0, 0.9, 0.8) });
    assert_eq!(meaning(1), MtlMeaning::Matte { color: Rgb::ONE });
    assert_eq!(file.warnings.len(), 2);
    assert!(file.warnings[0].contains("`b.mtl` (line 2) cannot be read"));
    assert!(file.warnings[1].contains("`veil` has d = 0.5") && file.warnings[1].contains("not transmission"));
}

#[test]
fn what_is_no_surface_is_left_out_and_said() {
    let file =
        load(&format!("{SQUARE}p 1 2\nl 1 2 3\nl 2 3\nf 1 2\nf 1\nf\nf 1 2 3\ncurv 0 1 1 2\ns 1\nbevel on"));
    assert_eq!(file.parts[0].mesh.triangles.len(), 1);
    let expected = [
        "point elements (p) left out, for only faces are rendered: 1 (first at line 5)",
        "line elements (l) left out, for only faces are rendered: 2 (first at line 6)",
        "faces with fewer than three corners left out: 3 (first at line 8)",
        "statements passed over, such as `curv`: 1 (first at line 12)",
    ];
    assert_eq!(file.warnings, expected);
}

#[test]
fn lines_go_on_and_end_anyhow() {
    let expected = one_part(&format!("{SQUARE}f 1 2 3 4"));
    assert_eq!(one_part(&format!("{SQUARE}f 1 2 \\\n3 4 # rim")), expected);
    assert_eq!(one_part(&format!("{}f 1 2 \\\r\n  3 4", SQUARE.replace('\n', "\r\n"))), expected);
    assert_eq!(one_part(&format!("{SQUARE}f 1 2 3 4").replace('\n', "\r")), expected);
    assert_eq!(one_part(&format!("\u{feff}# caf\u{e9}\n{SQUARE}f 1 2 3 4")), expected);
    let latin1 = [b"# caf\xe9\ng caf\xe9\n", format!("{SQUARE}f 1 2 3 4").as_bytes()].concat();
    assert_eq!(obj::parse("x", &latin1, no_library).expect("loads").parts[0].mesh, expected.mesh);
}

#[test]
fn mistakes_name_their_line() {
    let cases = [
        ("v 0 0\nf 1 1 1", "test.obj:1: found the end of the line, expected three coordinates"),
        ("v 0 0 x", "test.obj:1: found `x`, expected three coordinates"),
        ("v 0,5 0 0", "test.obj:1: found `0,5`"),
        ("\nv 0 0 0 w", "test.obj:2: found `w`, expected a weight"),
        ("vn 0 0", "test.obj:1: found the end of the line, expected the three components of a normal"),
        ("vt u", "test.obj:1: found `u`, expected texture coordinates"),
        ("v 0 0 0\nf 1 1 1.5", "test.obj:2: found `1.5`, expected a corner of a face"),
        ("v 0 0 0\nf 1 1 1/2/3/4", "found `1/2/3/4`, expected a corner"),
        ("v 0 0 0\nf 1 1 /1", "found `/1`, expected a corner"),
        ("v 0 0 0\nf 1 1 99999999999999999999", "found `99999999999999999999`, expected a corner"),
        ("v 0 0 0\nf 1 1 0", "test.obj:2: a face names vertex 0, but the vertices end at 1"),
        ("v 0 0 0\nf 1 1 -2", "test.obj:2: a face names vertex -2"),
        ("v 0 0 0\nf 1 1 -9223372036854775808", "names vertex -9223372036854775808"),
        ("v 0 0 0\nf 1 1 2", "a face names vertex 2, but the vertices end at 1"),
        (
            "v 0 0 0\nv 1 nan 0\nv inf 1 1",
            "test.obj:2: vertices that are not finite: 2, the first is `1 nan 0`",
        ),
        ("v 1e999 0 0", "vertices that are not finite: 1"),
        ("v 1 2 3 0", "vertices that are not finite: 1"),
        ("v 0 0 0\n# only", "there are no faces to render (vertices: 1, points: 0, lines: 0, faces"),
    ];
    for (text, phrase) in cases {
        let message = refuse(text);
        assert!(message.contains(phrase), "`{text}` gives `{message}`");
    }
    assert!(refuse("").contains("the file is empty"));
}

#[test]
fn a_face_with_too_many_corners_is_refused_before_it_costs_anything() {
    let face = |corners: usize| format!("{SQUARE}f{}", " 1 2 3 4".repeat(corners / 4));
    assert_eq!(load(&face(400)).parts[0].mesh.triangles.len(), 398);
    let result = obj::parse("test.obj", face(16_388).as_bytes(), no_library);
    assert!(matches!(result, Err(ObjError::TooManyCorners { line: 5, corners: 16_388, limit: 16_384, .. })));
}

#[test]
fn a_quad_is_cut_along_the_diagonal_that_lies_inside() {
    // A dart: concave at its third corner.
    let dart = one_part("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 2 3 4 1\nf 3 4 1 2\nf 4 1 2 3\nf 1 2 3 4");
    assert_eq!(areas_along(&dart, DVec3::Z), [4.0; 8]);
}

#[test]
fn a_hole_joined_by_a_seam_stays_a_hole() {
    // An outer square of side 4 and an inner one of side 2, joined by an edge that is run through twice.
    let part = one_part(
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\nf 1 2 3 4 1 5 6 7 8 5",
    );
    let areas = areas_along(&part, DVec3::Z);
    assert_eq!(areas.len(), 8);
    assert!(areas.iter().all(|&area| area > 0.0), "{areas:?}");
    assert_eq!(areas.iter().sum::<f64>(), 2.0 * (16.0 - 4.0));
}

#[test]
fn corners_on_a_straight_edge_are_kept_and_leave_no_sliver() {
    // A square with three more corners on each side; a fan from any of them has triangles without area.
    let rim =
        [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (4, 1), (4, 2), (4, 3), (4, 4), (3, 4), (2, 4), (1, 4)];
    let rim = rim.into_iter().chain([(0, 4), (0, 3), (0, 2), (0, 1)]);
    let vertices: String = rim.map(|(x, z)| format!("v {x} 7 {z}\n")).collect();
    let corners: String = (1..=16).rev().map(|i| format!(" {i}")).collect();
    let part = one_part(&format!("{vertices}f{corners}"));
    let areas = areas_along(&part, DVec3::Y);
    assert_eq!((areas.len(), part.mesh.positions.len()), (14, 16));
    assert!(areas.iter().all(|&area| area > 0.0), "{areas:?}");
    assert_eq!(areas.iter().sum::<f64>(), 32.0);
}

#[test]
fn a_face_that_crosses_itself_is_cut_and_said() {
    for face in ["f 1 3 2 4", "f 1 2 1 2", "f 1 2 3 4 1 2 3 4"] {
        let file = load(&format!("{SQUARE}{face}"));
        let corners = face.split(' ').count() - 1;
        assert_eq!(file.parts[0].mesh.triangles.len(), corners - 2);
        assert!(
            only_warning(&file)
                .contains("faces that cross themselves or have no area, cut into triangles by a guess: 1")
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// A polygon star-shaped about the origin, in any plane, from any first corner: n − 2 triangles that all face the
    /// same way and add up to its area.
    #[test]
    fn star_shaped_faces_are_cut_without_overlap(
        radii in proptest::collection::vec(0.05_f64..1.0, 4..40),
        tilt in (-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0),
        shift in -1e4_f64..1e4,
    ) {
        let normal = DVec3::new(tilt.0, tilt.1, tilt.2);
        prop_assume!(normal.length() > 0.1);
        let normal = normal.normalize();
        let (right, up) = normal.any_orthonormal_pair();
        let count = radii.len();
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / count as f64;
            let (sin, cos) = angle.sin_cos();
            radii[i % count] * (cos * right + sin * up) + DVec3::splat(shift)
        };
        let vertices: String = (0..count).map(|i| {
            let p = corner(i);
            format!("v {} {} {}\n", p.x, p.y, p.z)
        }).collect();
        let corners: String = (1..=count).map(|i| format!(" {i}")).collect();
        let part = one_part(&format!("{vertices}f{corners}"));
        // Four neighbours or fewer can leave the origin outside; with all angles below half a turn it never is.
        let exact: f64 = (0..count).map(|i| {
            let sine = (std::f64::consts::TAU / count as f64).sin();
            radii[i] * radii[(i + 1) % count] * sine
        }).sum();
        let areas = areas_along(&part, normal);
        prop_assert_eq!(areas.len(), count - 2);
        // Coordinates near 1e4 are rounded to 2e-12, and a corner is at most 2 from another.
        prop_assert!((area_vector(&part).dot(normal) - exact).abs() < 1e-10 * count as f64);
        prop_assert!(areas.iter().all(|&area| area > -1e-11), "{:?}", areas);
    }
}
