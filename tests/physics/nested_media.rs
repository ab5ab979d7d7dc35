//! Solids that reach into each other: the same thing modelled in several ways is one picture.

use std::fmt::Write;
use vitrum::io::load::{Loaded, scene_text};
use vitrum::tracer::{Integrator, NoSkip, Rendering, Settings, render};
use vitrum_testkit::Moments;

const SKY: &str = "[background]\ntype = \"gradient\"\nbottom = 0.2\ntop = [0.6, 0.8, 1]\n";
const WHITE: &str = "[background]\ntype = \"constant\"\ncolor = 1\n";

fn camera(position: &str, target: &str, fov: f64) -> String {
    format!("[camera]\ntype = \"pinhole\"\nposition = {position}\ntarget = {target}\nfov = {fov}\n")
}

fn load(text: &str) -> Loaded {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("tumbler.obj"), tumbler()).expect("the folder is writable");
    scene_text("a scene of this test", text, folder.path()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Renders, and sees to it that rays never lost count of what they are in.
fn rendered(loaded: &Loaded, settings: &Settings) -> Rendering {
    let rendering = render(&loaded.scene, settings, &()).expect("valid settings");
    let stats = &rendering.stats;
    let lost = [stats.dropped, stats.unmatched_exits, stats.overfull, stats.unending];
    assert_eq!(lost, [0; 4], "{stats:?}");
    rendering
}

fn sphere(name: &str, centre: &str, radius: f64, more: &str) -> String {
    format!(
        "[[object]]\nname = \"{name}\"\nshape = \"sphere\"\ncenter = {centre}\nradius = {radius}\n{more}\n"
    )
}

/// A bubble of air in a ball of water: as the inner wall of the ball, as a ball of air that is stronger than the water, and as an
/// interface whose index is relative to the water. `glass` is a material up to its index.
fn bubbles(glass: impl Fn(&str) -> String) -> [String; 3] {
    let water = "[[medium]]\nname = \"water\"\nior = 1.3333333333333333\n";
    let ball = sphere("ball", "[0, 0, 0]", 1.0, &format!("material = {{ {} }}", glass("1.3333333333333333")));
    let bubble = |material: String, more: &str| {
        sphere("bubble", "[0.2, 0.1, 0.3]", 0.4, &format!("material = {{ {material} }}\n{more}"))
    };
    [
        bubble(glass("1.3333333333333333"), "flip = true"),
        bubble(glass("1") + ", priority = 1", ""),
        bubble(glass("0.75") + ", outside = \"water\"", ""),
    ]
    .map(|bubble| format!("{water}{ball}{bubble}"))
}

/// Constant coefficients: only directions tell the three apart, and they are the same but for rounding.
#[test]
fn a_bubble_is_the_same_however_it_is_modelled() {
    let view = camera("[0, 0.5, 4]", "[0, 0, 0]", 32.0);
    let images =
        bubbles(|ior| format!("type = \"transparent\", ior = {ior}, kr = 0.1, kt = 0.9")).map(|bubble| {
            let loaded = load(&format!("{view}{SKY}{bubble}"));
            let settings = Settings { size: [64, 48], spp: 4, max_depth: Some(12), ..loaded.settings };
            rendered(&loaded, &Settings { integrator: Integrator::Whitted, ..settings }).film.image()
        });
    for other in &images[1..] {
        for (a, b) in images[0].iter().flatten().zip(other.iter().flatten()) {
            assert!((a - b).abs() <= 1e-6, "{a} {b}");
        }
    }
}

/// A tumbler of glass: a box of 2 x 2.4 x 2 m with a cavity of 1.6 x 2.2 x 1.6 m, open at the top.
fn tumbler() -> String {
    let mut obj = String::new();
    for (half, low) in [(1.0, 0.0), (0.8, 0.2)] {
        for y in [low, 2.4] {
            for (x, z) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
                let _ = writeln!(obj, "v {x} {y} {z}");
            }
        }
    }
    // Outer corners are 1 to 8, inner ones 9 to 16, from below to above.
    for side in 0..4 {
        let (a, b) = (1 + side, 1 + (side + 1) % 4);
        let _ = writeln!(obj, "f {b} {a} {} {}", a + 4, b + 4);
        let _ = writeln!(obj, "f {} {} {} {}", a + 8, b + 8, b + 12, a + 12);
        let _ = writeln!(obj, "f {} {} {} {}", a + 12, b + 12, b + 4, a + 4);
    }
    obj + "f 1 2 3 4\nf 12 11 10 9\n"
}

/// A rectangle square to an axis at `plane`, between the corners (a, b) of the two other axes in cyclic order, its normal along the
/// axis or against it, between two media.
fn cut(
    axis: usize,
    up: bool,
    plane: f64,
    [a0, a1]: [f64; 2],
    [b0, b1]: [f64; 2],
    inside: &str,
    outside: &str,
) -> String {
    let place = |along: f64, a: f64, b: f64| {
        let mut p = [0.0; 3];
        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (along, a, b);
        format!("{p:?}")
    };
    let (u, v) = (place(0.0, a1 - a0, 0.0), place(0.0, 0.0, b1 - b0));
    let (u, v) = if up { (u, v) } else { (v, u) };
    let corner = place(plane, a0, b0);
    format!(
        "[[object]]\nshape = \"rectangle\"\ncorner = {corner}\nedge_u = {u}\nedge_v = {v}\n\
         material = {{ type = \"dielectric\", inside = \"{inside}\", outside = \"{outside}\" }}\n"
    )
}

/// The walls of a box whose normals point to its outside, or into it, without those at its bottom and top.
fn walls([x, y, z]: [[f64; 2]; 3], outward: bool, inside: &str, outside: &str) -> String {
    [(0, y, z, x), (2, x, y, z)]
        .into_iter()
        .flat_map(|(axis, a, b, [low, high])| {
            [cut(axis, !outward, low, a, b, inside, outside), cut(axis, outward, high, a, b, inside, outside)]
        })
        .collect()
}

/// A level frame between two rectangles, its normal up.
fn frame(y: f64, [x, z]: [[f64; 2]; 2], [hx, hz]: [[f64; 2]; 2], inside: &str, outside: &str) -> String {
    [(z, [x[0], hx[0]]), (z, [hx[1], x[1]]), ([z[0], hz[0]], hx), ([hz[1], z[1]], hx)]
        .into_iter()
        .map(|(z, x)| cut(1, true, y, z, x, inside, outside))
        .collect()
}

/// A tumbler of water with a cube of ice that swims in it: the water reaching into the glass, which is stronger; each surface between
/// two media by itself; the water as large as the cavity, its walls those of the glass.
fn glasses_of_water() -> [String; 3] {
    const MEDIA: &str = "[[medium]]\nname = \"glass\"\nior = 1.5\n[[medium]]\nname = \"still water\"\nior = 1.333\n\
                         [[medium]]\nname = \"frozen water\"\nior = 1.31\n";
    let solid = |name: &str, min: [f64; 3], max: [f64; 3], inside: &str, priority: u32| {
        format!(
            "[[object]]\nname = \"{name}\"\nshape = \"box\"\nmin = {min:?}\nmax = {max:?}\n\
             material = {{ type = \"dielectric\", inside = \"{inside}\", priority = {priority} }}\n"
        )
    };
    let glass = "[[object]]\nname = \"glass\"\nshape = \"mesh\"\nfile = \"tumbler.obj\"\nnormals = \"flat\"\n\
                 material = { type = \"dielectric\", inside = \"glass\", priority = 2 }\n";
    let ice = solid("ice", [-0.2, 1.1, -0.25], [0.4, 1.7, 0.35], "frozen water", 1);
    let water =
        |half: f64, low: f64| solid("water", [-half, low, -half], [half, 1.5, half], "still water", 0);
    let (all, cavity) = ([-1.0, 1.0], [-0.8, 0.8]);
    let ([ix, iz], [under, over]) = ([[-0.2, 0.4], [-0.25, 0.35]], [[1.1, 1.5], [1.5, 1.7]]);
    let cuts = [
        walls([all, [0.0, 2.4], all], true, "glass", "air"),
        cut(1, false, 0.0, all, all, "glass", "air"),
        frame(2.4, [all, all], [cavity, cavity], "glass", "air"),
        walls([cavity, [0.2, 1.5], cavity], false, "glass", "still water"),
        cut(1, true, 0.2, cavity, cavity, "glass", "still water"),
        walls([cavity, [1.5, 2.4], cavity], false, "glass", "air"),
        frame(1.5, [cavity, cavity], [ix, iz], "still water", "air"),
        walls([ix, under, iz], true, "frozen water", "still water"),
        cut(1, false, 1.1, iz, ix, "frozen water", "still water"),
        walls([ix, over, iz], true, "frozen water", "air"),
        cut(1, true, 1.7, iz, ix, "frozen water", "air"),
    ];
    [
        format!("{MEDIA}{glass}{ice}{}", water(0.9, 0.1)),
        format!("{MEDIA}{}", cuts.concat()),
        format!("{MEDIA}{glass}{ice}{}", water(0.8, 0.2)),
    ]
}

/// The means of tiles of 8 x 8 pixels, over several seeds.
fn tiles(loaded: &Loaded, settings: &Settings, seeds: u64) -> Vec<Moments> {
    let [width, height] = settings.size.map(|side| side as usize);
    let mut all = vec![Moments::default(); width / 8 * (height / 8)];
    for seed in 0..seeds {
        let image = rendered(loaded, &Settings { seed, ..*settings }).film.image();
        for (tile, moments) in all.iter_mut().enumerate() {
            let (left, top) = (tile % (width / 8) * 8, tile / (width / 8) * 8);
            let pixels = (0..64).map(|i| image[(top + i / 8) * width + left + i % 8]);
            moments.push(pixels.flatten().map(f64::from).sum::<f64>() / 192.0);
        }
    }
    all
}

/// Eight seeds of 128 samples each tell the error of each tile. Of 18 tiles and 3 pairs none should be farther apart than 4.5 standard
/// errors of the difference (Student's t of 14 degrees of freedom: 5e-4 each); errors are at most 0.3 %.
#[test]
fn a_glass_of_water_is_the_same_however_it_is_modelled() {
    let view = camera("[1.5, 3.2, 5]", "[0, 1.1, 0]", 32.0);
    let all = glasses_of_water().map(|glass| {
        let loaded = load(&format!("[render]\nintegrator = \"path\"\n{view}{SKY}{glass}"));
        tiles(&loaded, &Settings { size: [48, 24], spp: 128, ..loaded.settings }, 8)
    });
    let mut largest: f64 = 0.0;
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        for (tile, (a, b)) in all[i].iter().zip(&all[j]).enumerate() {
            let error = a.standard_error().hypot(b.standard_error());
            assert!(error <= 0.003 * a.mean(), "tile {tile}: {error}");
            largest = largest.max((a.mean() - b.mean()).abs() / (error + 1e-9));
        }
    }
    assert!(largest < 4.5, "tiles are {largest} standard errors apart");
}

/// In white surroundings glass without absorption is not seen: the whole ray tree brings back all the light, but for what is not followed.
#[test]
fn nothing_is_lost_in_white_surroundings() {
    let bubbles = bubbles(|ior| {
        let key = if ior == "0.75" { "relative_ior" } else { "ior" };
        format!("type = \"dielectric\", {key} = {ior}")
    });
    let view = |scene: &str| {
        let close = scene.contains("bubble");
        if close {
            camera("[0, 0.5, 4]", "[0, 0, 0]", 32.0)
        } else {
            camera("[1.5, 3.2, 5]", "[0, 1.1, 0]", 32.0)
        }
    };
    for scene in bubbles.into_iter().chain(glasses_of_water()) {
        let loaded = load(&format!("{}{WHITE}{scene}", view(&scene)));
        let settings =
            Settings { size: [16, 12], spp: 1, max_depth: Some(400), cutoff: 2e-8, ..loaded.settings };
        let rendering = rendered(&loaded, &Settings { integrator: Integrator::Whitted, ..settings });
        for (at, pixel) in rendering.film.image().iter().enumerate() {
            assert!(pixel.iter().all(|c| (c - 1.0).abs() <= 1e-4), "pixel {at}: {pixel:?} in\n{scene}");
        }
    }
}

/// Which of several solids of one priority fills a place depends on their names, and on nothing else.
#[test]
fn the_order_in_the_file_does_not_matter() {
    let ball = |name: &str, centre: &str, ior: f64| {
        sphere(
            name,
            centre,
            0.7,
            &format!("material = {{ type = \"dielectric\", ior = {ior}, sigma_a = [0.5, {ior}, 1] }}"),
        )
    };
    let balls = [
        ball("b", "[-0.3, 0, 0]", 1.5),
        ball("a", "[0.3, 0, 0]", 1.33),
        ball("c", "[0, 0.4, 0.2]", 1.7),
        sphere("inner", "[0, 0.1, 0]", 0.2, "material = { type = \"dielectric\", ior = 1, priority = 3 }"),
    ];
    let view = camera("[0, 0.5, 4]", "[0, 0, 0]", 30.0);
    let picture = |order: [usize; 4], integrator| {
        let objects: String = order.into_iter().map(|i| balls[i].as_str()).collect();
        let loaded = load(&format!("{view}{SKY}{objects}"));
        let settings =
            Settings { size: [48, 36], spp: 8, max_depth: Some(10), integrator, ..loaded.settings };
        rendered(&loaded, &settings).film.image()
    };
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let first = picture([0, 1, 2, 3], integrator);
        for order in [[3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
            assert!(picture(order, integrator) == first, "{order:?}");
        }
        // Another name is another picture.
        let renamed = balls.each_ref().map(|ball| ball.replace("\"a\"", "\"z\"")).concat();
        let loaded = load(&format!("{view}{SKY}{renamed}"));
        let settings =
            Settings { size: [48, 36], spp: 8, max_depth: Some(10), integrator, ..loaded.settings };
        assert!(rendered(&loaded, &settings).film.image() != first);
    }
}

/// From within water all that is above lies in a cone about the vertical, whose half angle is the critical one, asin(1/n): nothing told
/// the renderer that the camera is in the water. Beyond the cone is the black bottom, seen in the surface from below.
#[test]
fn a_camera_under_water_sees_snells_window() {
    const SIZE: u32 = 200;
    const HALF_HEIGHT: f64 = 1.5;
    let water = "[[object]]\nname = \"water\"\nshape = \"box\"\nmin = [-50, -3, -50]\nmax = [50, 0, 50]\n\
                 material = { type = \"dielectric\", ior = 1.333 }\n\
                 [[object]]\nname = \"glass\"\nshape = \"box\"\nmin = [-60, -5, -60]\nmax = [60, -2.8, 60]\n\
                 material = { type = \"dielectric\", ior = 1.5 }\n\
                 [[object]]\nname = \"bottom\"\nshape = \"rectangle\"\ncorner = [-49, -2.5, 49]\nedge_u = [98, 0, 0]\nedge_v = [0, 0, -98]\n\
                 material = { type = \"matte\", color = 0 }\n";
    let fov = 2.0 * HALF_HEIGHT.atan().to_degrees();
    let view = format!(
        "[camera]\ntype = \"pinhole\"\nposition = [0, -1, 0]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\nfov = {fov}\n"
    );
    let loaded = load(&format!("{view}{WHITE}{water}"));
    let settings = Settings { size: [SIZE; 2], spp: 16, max_depth: Some(8), ..loaded.settings };
    let rendering = rendered(&loaded, &Settings { integrator: Integrator::Whitted, ..settings });
    let image = rendering.film.image();
    let row = &image[(SIZE * SIZE / 2) as usize..][..SIZE as usize];
    let bright: f64 = row.iter().filter(|p| p[0] > 0.2).count() as f64;
    let expected = (1.0_f64 / 1.333).asin().tan() / HALF_HEIGHT * f64::from(SIZE);
    assert!(
        (bright - expected).abs() <= 2.0,
        "{bright} pixels across, expected {expected}: within one at both ends"
    );
}

/// The picture of a scene by ray trees.
fn by_ray_trees(scene: &str, no_skip: NoSkip) -> Vec<[f32; 3]> {
    let loaded = load(scene);
    let settings = Settings { size: [48, 36], spp: 4, max_depth: Some(10), no_skip, ..loaded.settings };
    rendered(&loaded, &Settings { integrator: Integrator::Whitted, ..settings }).film.image()
}

/// Pictures whose rays are the same but for rounding.
fn assert_same(a: &[[f32; 3]], b: &[[f32; 3]], what: &str) {
    let apart = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(apart <= 2e-6, "{what}: {apart}");
    let shades = a.iter().flatten().map(|c| c.to_bits()).collect::<std::collections::BTreeSet<_>>().len();
    assert!(shades > 50, "{what}: a picture of {shades} shades shows nothing");
}

const LAMP: &str = "[[light]]\ntype = \"point\"\nposition = [1.5, 4, 2]\nintensity = 30\n";
const FLOOR: &str = "[[object]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n\
                     material = { type = \"matte\", color = [0.8, 0.6, 0.4] }\n";

fn cuboid(name: &str, min: &str, max: &str, material: &str) -> String {
    format!(
        "[[object]]\nname = \"{name}\"\nshape = \"box\"\nmin = {min}\nmax = {max}\nmaterial = {{ {material} }}\n"
    )
}

/// Opaque surfaces may lie in the walls of solids, before or behind them in the order of names.
#[test]
fn glass_stands_on_a_floor() {
    let forced = NoSkip { nested_media: true, ..NoSkip::default() };
    let view = camera("[1, 1.2, 4]", "[0, 0.4, 0]", 30.0);
    // Where the floor comes first, light from there leaves the glass once more than it entered it; without counting, it would enter twice.
    for (name, shadow) in [("a glass", "opaque"), ("a glass", "straight"), ("the glass", "opaque")] {
        let glass = cuboid(name, "[-0.7, 0, -0.7]", "[0.7, 1, 0.7]", "type = \"dielectric\", ior = 1.5");
        let render = format!("[render]\nintegrator = \"whitted\"\nshadow = \"{shadow}\"\n");
        let scene = format!("{render}{view}{SKY}{LAMP}{FLOOR}{glass}");
        let [without, with] = [NoSkip::default(), forced].map(|no_skip| by_ray_trees(&scene, no_skip));
        assert!(without == with, "{name}, {shadow}");
    }
}

/// The water of an aquarium ends at rectangles, each an interface between two media. A ball of glass in it knows nothing of them.
#[test]
fn a_solid_in_what_open_interfaces_enclose_is_in_that() {
    let water = "[[medium]]\nname = \"tank\"\nior = 1.33\nsigma_a = [0.4, 0.1, 0.05]\n";
    let (x, y, z) = ([-2.0, 2.0], [0.0, 1.6], [-1.0, 1.0]);
    let tank = [
        walls([x, y, z], true, "tank", "air"),
        cut(1, true, 1.6, z, x, "tank", "air"),
        cut(1, false, 0.0, z, x, "tank", "air"),
    ]
    .concat();
    let view = camera("[1, 1.2, 5]", "[0, 0.7, 0]", 34.0);
    let ball = |outside: &str| {
        sphere(
            "ball",
            "[0.3, 0.8, 0.1]",
            0.5,
            &format!("material = {{ type = \"dielectric\", ior = 1.5{outside} }}"),
        )
    };
    let picture = |outside: &str| {
        by_ray_trees(&format!("{view}{SKY}{LAMP}{FLOOR}{water}{tank}{}", ball(outside)), NoSkip::default())
    };
    assert_same(&picture(""), &picture(", outside = \"tank\""), "a ball in a tank");
}

/// A glass that is a ball with an inner wall turned inside out, and more water in it than there is room for.
#[test]
fn an_inner_wall_belongs_to_the_solid_around_it() {
    let media = "[[medium]]\nname = \"juice\"\nior = 1.35\nsigma_a = [0.1, 0.5, 1]\n";
    let view = camera("[0.5, 0.5, 4]", "[0, 0, 0]", 32.0);
    let glass = "material = { type = \"dielectric\", ior = 1.5, priority = 1 }";
    let outer = sphere("glass", "[0, 0, 0]", 1.0, glass);
    let inner = sphere("inner wall", "[0, 0, 0]", 0.8, &format!("{glass}\nflip = true"));
    let juice = sphere("juice", "[0, 0, 0]", 0.9, "material = { type = \"dielectric\", inside = \"juice\" }");
    let exact = sphere(
        "juice",
        "[0, 0, 0]",
        0.8,
        "material = { type = \"dielectric\", inside = \"juice\", priority = 2 }",
    );
    let bead =
        sphere("bead", "[0.2, 0.3, 0.1]", 0.2, "material = { type = \"dielectric\", ior = 1, priority = 7 }");
    let picture = |parts: [&str; 3]| {
        by_ray_trees(&format!("{view}{SKY}{media}{bead}{}", parts.concat()), NoSkip::default())
    };
    assert_same(&picture([&outer, &inner, &juice]), &picture([&outer, &exact, ""]), "a hollow ball of juice");
}

/// Two balls in the same place are one, and so are two halves that share a wall.
#[test]
fn what_is_there_twice_is_there_once() {
    let view = camera("[0.5, 0.5, 4]", "[0, 0, 0]", 32.0);
    let glass = "type = \"dielectric\", ior = 1.5";
    let ball = |name: &str| sphere(name, "[0, 0, 0]", 1.0, &format!("material = {{ {glass} }}"));
    let picture =
        |parts: &[String]| by_ray_trees(&format!("{view}{SKY}{LAMP}{}", parts.concat()), NoSkip::default());
    assert_same(&picture(&[ball("a")]), &picture(&[ball("a"), ball("b")]), "two balls");
    let whole = cuboid("whole", "[-1, -0.5, -0.5]", "[1, 0.5, 0.5]", glass);
    let left = cuboid("left", "[-1, -0.5, -0.5]", "[0.1, 0.5, 0.5]", glass);
    let right = cuboid("right", "[0.1, -0.5, -0.5]", "[1, 0.5, 0.5]", glass);
    assert_same(&picture(&[whole]), &picture(&[left, right]), "two halves of a box");
}

/// In one mesh, a cube of glass with a matte one in it: faces that are not of glass are no walls of a solid.
#[test]
fn what_is_opaque_in_a_mesh_of_glass_stays() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut obj = "mtllib weight.mtl\n".to_owned();
    for half in [1.0, 0.4] {
        for i in 0..8 {
            let side = |bit: i32| if i >> bit & 1 == 1 { half } else { -half };
            let _ = writeln!(obj, "v {} {} {}", side(0), side(1), side(2));
        }
    }
    for (base, material) in [(1, "glass"), (9, "paint")] {
        let _ = writeln!(obj, "usemtl {material}");
        for [a, b, c, d] in
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
        {
            let _ = writeln!(obj, "f {} {} {} {}", a + base, b + base, c + base, d + base);
        }
    }
    std::fs::write(folder.path().join("weight.obj"), obj).expect("the folder is writable");
    let mtl = "newmtl glass\nillum 7\nNi 1.5\nd 0.1\nTf 1 1 1\nnewmtl paint\nillum 1\nKd 0.9 0.3 0.1\n";
    std::fs::write(folder.path().join("weight.mtl"), mtl).expect("the folder is writable");
    let view = camera("[2, 1.5, 5]", "[0, 0, 0]", 34.0);
    let lit = "[[light]]\ntype = \"ambient\"\nradiance = 1\n";
    let text =
        format!("{view}{SKY}{lit}[[object]]\nshape = \"mesh\"\nfile = \"weight.obj\"\nnormals = \"flat\"\n");
    let loaded = scene_text("a paperweight", &text, folder.path()).unwrap_or_else(|error| panic!("{error}"));
    let picture = |nested_media: bool| {
        let no_skip = NoSkip { nested_media, ..NoSkip::default() };
        let settings = Settings { size: [48, 36], spp: 4, max_depth: Some(8), no_skip, ..loaded.settings };
        render(&loaded.scene, &Settings { integrator: Integrator::Whitted, ..settings }, &())
            .expect("valid settings")
    };
    let [without, with] = [false, true].map(picture);
    assert_same(&without.film.image(), &with.film.image(), "a paperweight");
    let reddish = without.film.image().iter().filter(|p| p[0] > 2.0 * p[2]).count();
    assert!(reddish > 100, "the paint is seen in {reddish} pixels");
}

/// A camera in water sees a white wall through so much of it, without a surface that says so: by the law of Bouguer, Lambert and Beer.
#[test]
fn the_camera_knows_that_it_is_in_a_solid() {
    for lens in ["\"pinhole\"", "\"thin-lens\"\nlens_radius = 1e-3"] {
        let view = format!("[camera]\ntype = {lens}\nposition = [0, 0, 0]\ntarget = [0, 0, -1]\nfov = 1\n");
        let water = cuboid(
            "water",
            "[-2, -2, -5]",
            "[2, 2, 1]",
            "type = \"dielectric\", ior = 1.33, sigma_a = [0.2, 0.4, 0]",
        );
        let wall = "[[object]]\nname = \"wall\"\nshape = \"rectangle\"\ncorner = [-1, -1, -3]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]\n\
                    material = { type = \"emissive\", radiance = 1 }\n";
        let loaded = load(&format!("{view}{water}{wall}"));
        for nested_media in [false, true] {
            let no_skip = NoSkip { nested_media, ..NoSkip::default() };
            let settings = Settings { size: [2, 2], spp: 1, no_skip, ..loaded.settings };
            for pixel in rendered(&loaded, &settings).film.image() {
                for (found, sigma) in pixel.into_iter().zip([0.2_f64, 0.4, 0.0]) {
                    let expected = (-3.0 * sigma).exp();
                    // Half a degree off the axis: 4e-5 longer.
                    assert!(
                        (f64::from(found) - expected).abs() < 1e-4,
                        "{lens}: {found}, expected {expected}"
                    );
                }
            }
        }
    }
    // What is said goes before what is found.
    let said = "[camera]\ntype = \"pinhole\"\nposition = [0, 0, 0]\ntarget = [0, 0, -1]\nfov = 1\nmedium = \"murky\"\n\
                [[medium]]\nname = \"murky\"\nior = 1\nsigma_a = 0.5\n";
    let wall = cuboid("wall", "[-1, -1, -4]", "[1, 1, -3]", "type = \"emissive\", radiance = 1");
    let loaded = load(&format!("{said}{wall}"));
    let image = rendered(&loaded, &Settings { size: [2, 2], spp: 1, ..loaded.settings }).film.image();
    assert!((f64::from(image[0][0]) - (-1.5_f64).exp()).abs() < 1e-4, "{image:?}");
}
