//! Same scene, settings and seed: same bytes. Whatever the number of threads, the size of tiles, the part of the picture
//! that is asked for, and the order in which the file lists what is in the scene; and the same as when this test was
//! written.

use std::fs;
use std::path::Path;
use vitrum::io::load::{Loaded, scene_text};
use vitrum::tracer::{Crop, Ended, Rendering, Settings, render};

/// Lights, textures and materials of all scenes. What can go without a name does.
const COMMON: &str = r#"
[background]
type = "gradient"
bottom = [0.30, 0.25, 0.20]
top = [0.55, 0.70, 0.95]

[[light]]
type = "ambient"
radiance = [0.11, 0.13, 0.17]

[[light]]
type = "ambient"
radiance = 0.0307

[[light]]
type = "point"
position = [-4, 7, 5]
intensity = [31, 29, 23]

[[light]]
name = "lamp"
type = "point"
position = [3, 5, 6]
intensity = 0.37
falloff = "none"

[[light]]
type = "directional"
direction = [0.3, -1, -0.4]
irradiance = [0.41, 0.53, 0.47]

[[texture]]
name = "tiles"
type = "checker"
even = [0.86, 0.84, 0.80]
odd = [0.12, 0.16, 0.22]
size = 0.5

[[material]]
name = "glass"
type = "transparent"
ior = 1.5
ks = 0.3

[[material]]
name = "floor"
type = "matte"
color = "tiles"

[[object]]
shape = "plane"
point = [0, -1, 0]
normal = [0, 1, 0]
material = "floor"
"#;

/// Spheres: hollow, mirrored, twice in the same place, one inside the other.
const SPHERES: &str = r#"
[camera]
type = "pinhole"
position = [0.3, 1.2, 5]
target = [0, 0, 0]
fov = 45

[[medium]]
name = "dense"
ior = 1.5

[[material]]
name = "air"
type = "transparent"
outside = "dense"
ior = 0.6666666666666666

[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "glass"

[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 0.8
material = "air"

[[object]]
shape = "sphere"
center = [1.6, -0.4, 0.5]
radius = 0.6
material = "glass"

[[object]]
shape = "sphere"
center = [1.6, -0.4, 0.5]
radius = 0.6
material = "glass"

[[object]]
name = "ball"
shape = "sphere"
center = [-1.5, -0.5, 0.4]
radius = 0.5
material = { type = "reflective", color = [0.5, 0.3, 0.1], ks = 0.4, kr = [0.5, 0.4, 0.2] }

[[object]]
shape = "sphere"
center = [-0.6, 0.2, -2]
radius = 0.7
material = { type = "phong", color = [0.7, 0.1, 0.1] }
"#;

/// Every other analytic shape, transformed and repeated; two disks share a plane, so that a tie decides what is seen.
const SHAPES: &str = r#"
[camera]
type = "thin-lens"
position = [0.3, 1.2, 5]
target = [0, 0, 0]
fov = 45
lens_radius = 0.05

[[object]]
name = "block"
shape = "box"
min = [-0.5, -0.5, -0.5]
max = [0.5, 0.5, 0.5]
transform = [{ rotate = { axis = [1, 2, 3], angle = 37 } }, { translate = [-1.2, 0, 0] }]
material = "glass"

[[object]]
shape = "instance"
of = "block"
transform = [{ scale = [0.5, 1.5, 0.5] }, { translate = [0.2, -0.2, 1] }]

[[object]]
shape = "cylinder"
bottom = [1.2, -1, 0]
top = [1.4, 0.8, -0.3]
radius = 0.4
material = "glass"

[[object]]
shape = "cylinder"
bottom = [0.6, -1, -1.5]
top = [0.6, 1.2, -1.5]
radius = 0.3
capped = false
material = { type = "phong", color = [0.1, 0.4, 0.2] }

[[object]]
shape = "disk"
center = [-0.6, 0.4, -2]
normal = [0, 0, 1]
radius = 0.8
material = { type = "matte", color = [0.8, 0.7, 0.1] }

[[object]]
shape = "disk"
center = [0.2, 0.8, -2]
normal = [0, 0, 1]
radius = 0.8
material = { type = "emissive", radiance = [0.2, 0.3, 0.9] }

[[object]]
shape = "rectangle"
corner = [-3, -1, -3]
edge_u = [6, 0, 0]
edge_v = [0, 3, 0]
material = { type = "reflective", color = 0.2, kr = 0.6 }
"#;

/// A knot of triangles and its mirror image, seen in parallel rays; shadows go straight through.
const MESH: &str = r#"
[camera]
type = "orthographic"
position = [0.3, 1.2, 5]
target = [0, 0, 0]
height = 4

[render]
shadow = "straight"

[[object]]
name = "ring"
shape = "mesh"
file = "ring.obj"
normals = "smooth"
material = "glass"
transform = [{ rotate = { axis = [1, 0, 0], angle = 60 } }]

[[object]]
shape = "instance"
of = "ring"
transform = [{ scale = [-0.6, 0.6, 0.6] }, { translate = [0.9, 0.3, 1] }]

[[object]]
shape = "mesh"
file = "ring.obj"
normals = "flat"
material = { type = "phong", color = [0.7, 0.1, 0.1] }
transform = [{ translate = [0, 0, -2] }]
"#;

/// The scenes, each with the hash of its picture: FNV-1a of 64 bits over the bits of its float32 values, red, green and blue
/// of each pixel, row by row from the top, least byte first.
///
/// A hash that changes means that everybody's pictures change. That needs a reason, and an entry under "Images" in
/// CHANGELOG.md; then put in what the test has found.
const SCENES: [(&str, &str, u64); 3] = [
    ("spheres", SPHERES, 0x19a2_21e1_3508_e712),
    ("shapes", SHAPES, 0xc9fe_73c8_9410_ef8f),
    ("mesh", MESH, 0xc317_a678_c6e4_78d5),
];

/// Nine samples are more than one block of the film's sums, and no power of two.
const SETTINGS: &str = "size = [40, 30]\nspp = 9\nmax_depth = 7\nseed = 5\n";

/// The text of a scene, complete.
fn complete(scene: &str) -> String {
    match scene.split_once("[render]\n") {
        Some((before, after)) => format!("{before}[render]\n{SETTINGS}{after}{COMMON}"),
        None => format!("[render]\n{SETTINGS}{scene}{COMMON}"),
    }
}

fn load(name: &str, text: &str) -> Loaded {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("repeatable").join(name);
    fs::create_dir_all(&folder).expect("the folder for temporary files is writable");
    // Tests run side by side: each writes the same bytes, and none finds half of them.
    let (ring, half) = (folder.join("ring.obj"), folder.join(format!("{:?}", std::thread::current().id())));
    fs::write(&half, ring_of_triangles()).expect("writable");
    fs::rename(&half, &ring).expect("writable");
    let loaded = scene_text(name, text, &folder).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
    loaded
}

/// A bumpy torus as an OBJ file: 48 x 24 squares, in halves.
fn ring_of_triangles() -> String {
    const AROUND: usize = 48;
    const ACROSS: usize = 24;
    let angle = |i: usize, n: usize| i as f64 * std::f64::consts::TAU / n as f64;
    let mut text = String::new();
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let (u, v) = (angle(i, AROUND), angle(j, ACROSS));
            let tube = 0.3 + 0.05 * libm::sin(5.0 * u);
            let radius = 0.9 + tube * libm::cos(v);
            let [x, y, z] = [radius * libm::cos(u), tube * libm::sin(v), -radius * libm::sin(u)];
            text += &format!("v {x:?} {y:?} {z:?}\n");
        }
    }
    let corner = |i: usize, j: usize| i % AROUND * ACROSS + j % ACROSS + 1;
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
        }
    }
    text
}

fn picture(loaded: &Loaded, settings: Settings) -> Rendering {
    let rendering = render(&loaded.scene, &settings, &()).expect("the settings make a picture");
    assert_eq!(rendering.stats.dropped, 0);
    assert_eq!(rendering.ended, Ended::Samples);
    rendering
}

/// The bits of a picture.
fn bits(rendering: &Rendering) -> Vec<[u32; 3]> {
    rendering.film.image().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

fn fnv1a(bits: &[[u32; 3]]) -> u64 {
    bits.iter()
        .flatten()
        .flat_map(|channel| channel.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn pictures_are_those_that_they_were() {
    let mut changed = Vec::new();
    for (name, scene, expected) in SCENES {
        let loaded = load(name, &complete(scene));
        let found = fnv1a(&bits(&picture(&loaded, loaded.settings)));
        if found != expected {
            changed.push(format!("{name}: found 0x{found:016x}, expected 0x{expected:016x}"));
        }
    }
    let why =
        "The bytes of pictures change: say why under \"Images\" in CHANGELOG.md, then put in the new hashes";
    assert!(changed.is_empty(), "\n{}\n{why}", changed.join("\n"));
}

/// Pictures, and what is counted on the way.
#[test]
fn threads_and_tiles_change_nothing() {
    for (name, scene, _) in SCENES {
        let loaded = load(name, &complete(scene));
        let of = |threads, tile| picture(&loaded, Settings { threads, tile, ..loaded.settings });
        let expected = of(1, 16);
        for threads in [1, 2, 7] {
            for tile in [1, 5, 16, 64] {
                let found = of(threads, tile);
                let case = format!("{name}, {threads} threads, tiles of {tile}");
                assert!(bits(&found) == bits(&expected), "{case}");
                assert_eq!(found.stats, expected.stats, "{case}");
                assert_eq!(found.film.given_up(), expected.film.given_up(), "{case}");
            }
        }
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let crops: [[u32; 4]; 8] = [
        [0, 0, 40, 30],
        [0, 0, 1, 1],
        [39, 29, 1, 1],
        [17, 11, 1, 1],
        [0, 13, 40, 1],
        [23, 0, 1, 30],
        [3, 5, 17, 19],
        [15, 15, 18, 15],
    ];
    for (name, scene, _) in SCENES {
        let loaded = load(name, &complete(scene));
        let whole = bits(&picture(&loaded, loaded.settings));
        for [x, y, width, height] in crops {
            let crop = Some(Crop { x, y, width, height });
            for (threads, tile) in [(1, 16), (2, 7)] {
                let part = bits(&picture(&loaded, Settings { crop, threads, tile, ..loaded.settings }));
                let rows = part.chunks(width as usize).zip(y..);
                assert_eq!(part.len(), (width * height) as usize);
                for (row, line) in rows {
                    let start = (line * 40 + x) as usize;
                    let expected = &whole[start..start + width as usize];
                    assert!(row == expected, "{name}, {crop:?}, line {line}");
                }
            }
        }
    }
}

/// The tables of a scene in another order. The first piece of the split is what stands before the first header.
fn shuffled(text: &str, seed: u64) -> String {
    let mut tables: Vec<&str> = text.split("\n\n").collect();
    // Fisher and Yates, with the random numbers of SplitMix64 (S. Vigna).
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    for last in (1..tables.len()).rev() {
        tables.swap(last, (random() % (last as u64 + 1)) as usize);
    }
    tables.join("\n\n")
}

#[test]
fn the_order_of_the_file_changes_nothing() {
    for (name, scene, _) in SCENES {
        let text = complete(scene);
        let loaded = load(name, &text);
        let expected = picture(&loaded, loaded.settings);
        let names = loaded.scene.names();
        let reversed =
            text.split("\n\n").collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>().join("\n\n");
        let orders = (1..=12).map(|seed| shuffled(&text, seed)).chain([reversed]);
        for (number, order) in orders.enumerate() {
            assert_ne!(order, text);
            let loaded = load(name, &order);
            assert_eq!(loaded.scene.names(), names, "{name}, order {number}");
            let found = picture(&loaded, loaded.settings);
            assert!(bits(&found) == bits(&expected), "{name}, order {number}:\n{order}");
            assert_eq!(found.stats, expected.stats, "{name}, order {number}");
        }
    }
}
