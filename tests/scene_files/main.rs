//! The meshes of the scenes are what they claim to be, and the files in the repository are what the program
//! writes.

#[path = "../../examples/scene_files/balls.rs"]
mod balls;
#[path = "../../examples/scene_files/brilliant.rs"]
mod brilliant;
#[path = "../../examples/scene_files/circle.rs"]
mod circle;
#[path = "../../examples/scene_files/knot.rs"]
mod knot;
#[path = "../../examples/scene_files/obj.rs"]
mod obj;
#[path = "../../examples/scene_files/sky.rs"]
mod sky;
#[path = "../../examples/scene_files/tumbler.rs"]
mod tumbler;
#[path = "../../examples/scene_files/wine_glass.rs"]
mod wine_glass;

use std::{collections::BTreeSet, f64::consts::PI, fs, path::Path};

use glam::DVec3;
use vitrum::io::image::{self, Display, ImageView};
use vitrum_geometry::mesh::{MeshData, Triangle, health, mend};

fn models() -> [(&'static str, &'static str, MeshData); 3] {
    [
        (knot::NAME, knot::ABOUT, knot::mesh()),
        (wine_glass::NAME, wine_glass::ABOUT, wine_glass::mesh(wine_glass::SEGMENTS)),
        (brilliant::NAME, brilliant::ABOUT, brilliant::mesh(brilliant::GIRDLE_SIDES)),
    ]
}

/// Those of the bench.
fn bench_models() -> [(&'static str, &'static str, MeshData); 7] {
    [
        (knot::FINE, knot::ABOUT_FINE, knot::fine_mesh()),
        (tumbler::OUTSIDE.0, tumbler::OUTSIDE.1, tumbler::outside()),
        (tumbler::BELOW.0, tumbler::BELOW.1, tumbler::below()),
        (tumbler::SURFACE.0, tumbler::SURFACE.1, tumbler::surface()),
        (tumbler::WHOLE.0, tumbler::WHOLE.1, tumbler::whole()),
        (tumbler::WATER.0, tumbler::WATER.1, tumbler::water()),
        (tumbler::ICE.0, tumbler::ICE.1, tumbler::ice()),
    ]
}

fn points(mesh: &MeshData, triangle: Triangle) -> [DVec3; 3] {
    triangle.map(|index| mesh.positions[index as usize])
}

fn bounds(mesh: &MeshData) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    mesh.positions.iter().fold(none, |(low, high), point| (low.min(*point), high.max(*point)))
}

/// Vertices - edges + faces of a closed surface: 2 for a ball, 0 for a ring.
fn euler_characteristic(mesh: &MeshData) -> i64 {
    let distinct: BTreeSet<_> =
        mesh.positions.iter().map(|point| point.to_array().map(f64::to_bits)).collect();
    assert_eq!(distinct.len(), mesh.positions.len(), "vertices are shared");
    let faces = i64::try_from(mesh.triangles.len()).expect("few faces");
    let vertices = i64::try_from(distinct.len()).expect("few vertices");
    vertices - 3 * faces / 2 + faces
}

#[test]
fn files_are_what_the_program_writes() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let of_gallery = models().map(|model| ("gallery/meshes", model, 1_200_000));
    let of_bench = bench_models().map(|model| ("bench/meshes", model, 4_000_000));
    for (folder, (name, about, mesh), most) in of_gallery.into_iter().chain(of_bench) {
        let file = fs::read(scenes.join(folder).join(name).with_extension("obj")).unwrap();
        assert!(file.len() < most, "{name}: {} bytes", file.len());
        let same = obj::text(name, about, &mesh).into_bytes() == file;
        assert!(same, "{name}.obj is not up to date: run `cargo run --example scene_files`");
    }
    let scene = fs::read_to_string(scenes.join("bench/11_thousand_balls.toml")).unwrap();
    assert!(
        scene == balls::text(),
        "the scene of balls is not up to date: run `cargo run --example scene_files`"
    );
    let place = tempfile::tempdir().unwrap();
    let (path, pixels) = (place.path().join("sky.exr"), sky::pixels());
    let view = ImageView { width: sky::WIDTH, height: sky::HEIGHT, pixels: &pixels };
    image::write(&path, view, &[], &[], Display::default()).unwrap();
    let same = fs::read(path).unwrap() == fs::read(scenes.join("bench/sky.exr")).unwrap();
    assert!(same, "the sky is not up to date: run `cargo run --example scene_files`");
}

/// Glass, water and air touch along one circle, where each pair of surfaces has the same points.
#[test]
fn the_tumbler_is_closed_by_its_water() {
    let parts = [tumbler::outside(), tumbler::below(), tumbler::surface()];
    let at_water = |mesh: &MeshData| -> BTreeSet<[u64; 3]> {
        let (_, high) = bounds(&tumbler::surface());
        let level =
            mesh.positions.iter().filter(|p| p.y == high.y && p.x.hypot(p.z) > 0.4 && p.x.hypot(p.z) < 0.5);
        level.map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    let circles = parts.each_ref().map(at_water);
    assert_eq!(circles[0].len(), 96);
    assert!(circles[0] == circles[1] && circles[1] == circles[2]);
    // What the glass has around it: its outside with the inside of its cup, turned away from it.
    let mut whole = parts[0].clone();
    let base = whole.positions.len() as u32;
    whole.positions.extend(&parts[1].positions);
    whole.triangles.extend(parts[1].triangles.iter().map(|t| t.map(|corner| corner + base)));
    // Wall, floor, half a ring on top, and what the rounded edges take off outside and fill inside (Pappus); a circle of 96 pieces
    // has 0.9993 of its area, and arcs of 15 degrees a little less than theirs.
    let disk = |radius: f64| PI * radius * radius;
    let fillet = (1.0 - PI / 4.0) * 0.01 * 2.0 * PI;
    let wall = (disk(0.55) - disk(0.47)) * 1.29 + disk(0.47) * 0.12 + 0.5 * disk(0.04) * 2.0 * PI * 0.51;
    let expected = 0.9993 * (wall - fillet * (0.55 - 0.022) + fillet * (0.47 - 0.022));
    let volume = signed_volume(&whole);
    assert!((volume / expected - 1.0).abs() < 3e-3, "{volume}, expected {expected}");
    let solid = health(&tumbler::whole());
    assert!(solid.is_closed() && (solid.volume().unwrap() / volume - 1.0).abs() < 1e-12, "{solid}");
    // The water fills a cylinder, all but its rounded edge, and as much of the glass as it reaches into.
    let body = health(&tumbler::water());
    let fillet = (1.0 - PI / 4.0) * 0.13 * 0.13 * 2.0 * PI * (0.5 - 0.029);
    let expected = 0.9993 * (disk(0.5) * (0.85 - 0.1) - fillet);
    assert!(
        body.is_closed() && (body.volume().unwrap() / expected - 1.0).abs() < 3e-3,
        "{body}, expected {expected}"
    );
    let ice = health(&tumbler::ice());
    assert!(ice.is_closed() && (ice.volume().unwrap() / 0.027 - 1.0).abs() < 1e-9, "{ice}");
}

fn signed_volume(mesh: &MeshData) -> f64 {
    mesh.triangles.iter().map(|t| points(mesh, *t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// So many triangles, closed, and of the volume of the gallery's knot but for the finer rounding.
#[test]
fn the_fine_knot_is_the_knot() {
    let [fine, coarse] = [knot::fine_mesh(), knot::mesh()].map(|mesh| (mesh.triangles.len(), health(&mesh)));
    assert_eq!(fine.0, 100_000);
    assert!(fine.1.is_closed() && fine.1.findings.is_empty(), "{}", fine.1);
    let ratio = fine.1.volume().unwrap() / coarse.1.volume().unwrap();
    // A 24-gon has 0.9886 of its circle, a 50-gon 0.9974.
    assert!((ratio - 0.9974 / 0.9886).abs() < 2e-3, "{ratio}");
}

/// The spheres of a scene: centres and radii.
fn spheres(text: &str) -> Vec<(DVec3, f64)> {
    let numbers = |line: &str| -> Vec<f64> {
        let (_, value) = line.split_once(" = ").expect("a key has a value");
        value.trim_matches(['[', ']']).split(", ").map(|v| v.parse().expect("a number")).collect()
    };
    let objects = text.split("[[object]]").filter(|object| object.contains("shape = \"sphere\""));
    let value = |object: &str, key: &str| {
        numbers(object.lines().find(|l| l.starts_with(key)).expect("the key is there"))
    };
    objects.map(|o| (DVec3::from_slice(&value(o, "center")), value(o, "radius")[0])).collect()
}

/// No two spheres of a scene of the bench cross: they stand apart, or one lies in the other.
#[test]
fn no_glass_overlaps() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bench");
    let mut count = 0;
    for path in vitrum_testkit::files_with_extension(&folder, "toml") {
        let spheres = spheres(&fs::read_to_string(&path).unwrap());
        count += spheres.len();
        for (i, (a, r)) in spheres.iter().enumerate() {
            for (b, s) in &spheres[..i] {
                let distance = a.distance(*b);
                assert!(distance > r + s || distance < (r - s).abs(), "{}: {a} and {b}", path.display());
            }
        }
    }
    assert!(count > 1000, "{count}");
}

/// None of the balls touches another, or the floor.
#[test]
fn the_balls_stand_apart() {
    let balls = spheres(&balls::text());
    assert_eq!(balls.len(), 1000);
    for (i, (a, r)) in balls.iter().enumerate() {
        assert!(a.y - r > 0.01, "{a}");
        assert!(balls[..i].iter().all(|(b, s)| a.distance(*b) > r + s), "{a} touches another");
    }
}

#[test]
fn meshes_are_solids() {
    for ((name, _, mesh), euler) in models().into_iter().zip([0, 2, 2]) {
        let report = health(&mesh);
        assert_eq!(report.findings, [], "{name}: {report}");
        assert!(report.is_closed() && report.components.len() == 1, "{name}: {report}");
        assert!(report.volume().unwrap() > 0.0, "{name}: {report}");
        assert_eq!(euler_characteristic(&mesh), euler, "{name}");
        assert_eq!(mend(mesh.clone()), (mesh, vec![]), "{name} needs no mending");
    }
}

#[test]
fn normals_agree_with_faces() {
    // A face differs from the normals at its corners by about half of what the surface turns between them:
    // 7.5° around the knot (24 sides), 15° over the lip of the wine glass (6 pieces), nothing on a facet. The
    // limits, 18° and 26°, leave room for the other direction.
    for ((name, _, mesh), least) in models().into_iter().zip([0.95, 0.9, 1.0 - 1e-12]) {
        for (triangle, normals) in mesh.triangles.iter().zip(&mesh.normal_triangles) {
            let [a, b, c] = points(&mesh, *triangle);
            let of_face = (b - a).cross(c - a).normalize();
            for index in normals {
                let normal = mesh.normals[*index as usize];
                assert!((normal.length() - 1.0).abs() < 1e-15, "{name}: unit normals");
                assert!(of_face.dot(normal) > least, "{name}: {of_face} and {normal} at {a}");
            }
        }
    }
}

#[test]
fn the_knot_is_a_free_tube() {
    let mesh = knot::mesh();
    let (low, high) = bounds(&mesh);
    assert!(low.min_element() > -1.0 - 1e-12 && high.max_element() < 1.0 + 1e-12, "{low} to {high}");
    let middle = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
    assert!(middle.length() < 1e-12, "centred: {middle}");

    let rings: Vec<DVec3> =
        mesh.positions.chunks(24).map(|ring| ring.iter().sum::<DVec3>() / ring.len() as f64).collect();
    let radius = (mesh.positions[0] - rings[0]).length();
    assert_eq!(rings.len(), 256);
    let mut length = 0.0;
    for (i, a) in rings.iter().enumerate() {
        length += a.distance(rings[(i + 1) % rings.len()]);
        for (j, b) in rings.iter().enumerate() {
            // Neither near along the tube nor near around the start: then not near at all.
            let apart = i.abs_diff(j).min(rings.len() - i.abs_diff(j));
            assert!(apart < 30 || a.distance(*b) > 2.5 * radius, "rings {i} and {j}: {}", a.distance(*b));
        }
    }
    // Pappus: length times the area of the 24-gon. A chord is short by (piece/radius of curvature)²/24 of
    // itself, about 1e-3 where the curve is tightest.
    let volume = length * 12.0 * radius * radius * (PI / 12.0).sin();
    let found = health(&mesh).volume().unwrap();
    assert!((found / volume - 1.0).abs() < 3e-3, "{found}, expected {volume}");
    assert!(mesh.uvs.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0));
}

#[test]
fn the_wine_glass_stands_and_holds() {
    let mesh = wine_glass::mesh(wine_glass::SEGMENTS);
    assert!(mesh.triangles.len() <= 10_000, "{}", mesh.triangles.len());
    let (low, high) = bounds(&mesh);
    assert_eq!((low.y, high.y), (0.0, 0.2));
    assert!((high.x - 0.041).abs() < 1e-12, "widest at the bowl: {high}");

    // Walls in the plane z = 0, x > 0: the outline's crossings of a height, from the axis outward.
    let outline: Vec<DVec3> = mesh.positions.iter().copied().filter(|p| p.z == 0.0 && p.x >= 0.0).collect();
    let crossings = |y: f64| {
        let mut radii: Vec<f64> = outline
            .windows(2)
            .filter(|pair| (pair[0].y > y) != (pair[1].y > y))
            .map(|pair| pair[0].x + (y - pair[0].y) / (pair[1].y - pair[0].y) * (pair[1].x - pair[0].x))
            .collect();
        radii.sort_by(f64::total_cmp);
        radii
    };
    for y in [0.01, 0.05, 0.08] {
        assert_eq!(crossings(y).len(), 1, "solid at {y}");
    }
    for y in [0.095, 0.11, 0.13, 0.15, 0.17, 0.19, 0.198] {
        let [inside, outside] = crossings(y)[..] else { panic!("two sides of the wall at {y}") };
        let wall = outside - inside;
        assert!((0.0010..0.0150).contains(&wall) && inside > 0.01, "wall of {wall} at {y}");
        assert!(y < 0.12 || wall < 0.0020, "wall of {wall} at {y}");
    }
}

#[test]
fn the_brilliant_has_its_facets() {
    let mesh = brilliant::mesh(brilliant::GIRDLE_SIDES);
    let mut heights: Vec<_> = mesh.normals.iter().map(|normal| normal.y).collect();
    heights.sort_by(f64::total_cmp);
    assert_eq!(heights.iter().filter(|y| **y > 1e-9).count(), 33, "crown");
    assert_eq!(heights.iter().filter(|y| **y < -1e-9).count(), 24, "pavilion");
    assert_eq!(heights.iter().filter(|y| y.abs() < 1e-12).count(), 64, "girdle");

    // Facets are flat, and the stone is convex: no vertex stands before the plane of any facet.
    for (triangle, normals) in mesh.triangles.iter().zip(&mesh.normal_triangles) {
        let normal = mesh.normals[normals[0] as usize];
        let on_plane = mesh.positions[triangle[0] as usize];
        for vertex in &mesh.positions {
            assert!(normal.dot(*vertex - on_plane) < 1e-12, "{vertex} before the facet at {on_plane}");
        }
    }
    for facet in 0..u32::try_from(mesh.normals.len()).unwrap() {
        let normal = mesh.normals[facet as usize];
        let faces = || mesh.triangles.iter().zip(&mesh.normal_triangles).filter(|(_, of)| of[0] == facet);
        let corners: Vec<_> = faces().flat_map(|(triangle, _)| points(&mesh, *triangle)).collect();
        let offsets: Vec<_> = corners.iter().map(|corner| normal.dot(*corner - corners[0])).collect();
        assert!(offsets.iter().all(|offset| offset.abs() < 1e-12), "facet {facet} is planar: {offsets:?}");
    }
}

#[test]
fn the_brilliant_has_its_proportions() {
    let mesh = brilliant::mesh(brilliant::GIRDLE_SIDES);
    let steep = |degrees: f64| {
        let angle = |normal: &&DVec3| (normal.y.abs().acos().to_degrees() - degrees).abs() < 1e-9;
        mesh.normals.iter().filter(angle).count()
    };
    assert_eq!(steep(34.5), 8, "bezels");
    assert_eq!(steep(40.75), 8, "pavilion mains");
    let (low, high) = bounds(&mesh);
    assert!((low + high).length() < 1e-12 && (high.x - 0.5).abs() < 1e-12, "{low} to {high}");
    let plan = |vertex: &DVec3| (vertex.x * vertex.x + vertex.z * vertex.z).sqrt();
    let at_table = mesh.positions.iter().filter(|vertex| vertex.y == high.y);
    assert!(
        at_table.clone().count() == 8 && at_table.clone().all(|vertex| (plan(vertex) - 0.285).abs() < 1e-15)
    );
    let mut rim: Vec<_> = mesh.positions.iter().filter(|vertex| plan(vertex) > 0.49).collect();
    rim.sort_by(|a, b| a.y.total_cmp(&b.y));
    assert!(rim.len() == 128 && rim.iter().all(|vertex| (plan(vertex) - 0.5).abs() < 1e-15));
    let (below, above) = rim.split_at(64);
    let thickest = above[63].y - below[0].y;
    assert!((thickest - 0.025).abs() < 1e-12, "girdle {thickest}");
    let thinnest = above[0].y - below[63].y;
    assert!((0.005..0.015).contains(&thinnest), "scallops leave {thinnest}");
    // Jewellers weigh a set round stone as 0.0061 carat for each mm³ of diameter² x depth; a carat of diamond
    // (3.52 g/cm³) is 56.8 mm³. The rule is good to a few percent.
    let rule = 0.0061 * 56.8 * (high.y - low.y);
    let volume = health(&mesh).volume().unwrap();
    assert!((volume / rule - 1.0).abs() < 0.05, "{volume}, by the rule {rule}");
}

#[test]
fn the_circle_is_symmetric_to_the_last_bit() {
    for steps in [3, 16, 24, 64, 256] {
        for step in 0..steps {
            let point = circle::point(step, steps);
            let angle = 2.0 * PI * step as f64 / steps as f64;
            assert!(point.distance(glam::DVec2::new(angle.cos(), angle.sin())) < 1e-14, "{step} of {steps}");
            let mirrored = circle::point(steps - step, steps);
            assert_eq!((point.x, -point.y), (mirrored.x, mirrored.y), "{step} of {steps}");
            if steps % 4 == 0 {
                let turned = circle::point(step + steps / 4, steps);
                assert_eq!((-point.y, point.x), (turned.x, turned.y), "{step} of {steps}");
            }
        }
    }
}
