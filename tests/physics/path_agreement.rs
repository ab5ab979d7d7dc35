//! Every way of following light gives the same picture: each branching, light found by asking, by meeting and by both, numbers
//! that fill the square and numbers that don't. Seven scenes, compared by tiles of the picture.
//!
//! `VITRUM_TIMES=16 cargo test --release --test physics every_strategy -- --nocapture` takes sixteen times the samples, and prints how
//! large the standard errors of the tiles are.

use std::path::Path;
use vitrum::io::load::scene_text;
use vitrum::math::Sequence;
use vitrum::tracer::{Branching, Crop, LightSampling, Scene, Settings, render};
use vitrum_testkit::Moments;

const SCENES: [(&str, &str); 7] = [
    ("glass on a floor", include_str!("../scenes/glass_on_a_floor.toml")),
    ("rough glass and metal", include_str!("../scenes/rough.toml")),
    ("hollow ball", include_str!("../scenes/hollow_ball.toml")),
    ("pane before a lamp", include_str!("../scenes/pane.toml")),
    ("many lights", include_str!("../scenes/many_lights.toml")),
    ("lamps of flat faces", include_str!("../scenes/lamps.toml")),
    ("the lecture's materials", include_str!("../scenes/lecture_materials.toml")),
];

const TILES: usize = 4;
const SIZE: usize = 32;
const SEEDS: u64 = 12;

/// Seven scenes, six variants and sixteen tiles are 672 comparisons: in one of a hundred runs one of them would be farther off by
/// chance than this, in standard errors that come from twelve seeds each (Student's t with 22 degrees of freedom).
const FARTHEST: f64 = 5.5;

/// Means over the tiles of a picture, so many along a side, from several seeds.
fn tiles(scene: &Scene, settings: &Settings, count: usize) -> Vec<Moments> {
    let mut all = vec![Moments::default(); count * count];
    for seed in 0..SEEDS {
        let rendering = render(scene, &Settings { seed, ..*settings }, &()).expect("valid settings");
        assert_eq!(rendering.stats.dropped, 0);
        let image = rendering.film.image();
        let edge = SIZE / count;
        for (tile, moments) in all.iter_mut().enumerate() {
            let (x, y) = (tile % count * edge, tile / count * edge);
            let rows = (y..y + edge).flat_map(|row| &image[row * SIZE + x..][..edge]);
            moments.push(rows.flatten().map(|c| f64::from(*c)).sum::<f64>() / (3 * edge * edge) as f64);
        }
    }
    all
}

#[test]
fn every_strategy_gives_the_same_picture() {
    let times = vitrum_testkit::times();
    for (name, text) in SCENES {
        let loaded = scene_text(name, text, Path::new("")).unwrap_or_else(|e| panic!("{name}: {e}"));
        let spp = times * loaded.settings.spp;
        let base = Settings { size: [SIZE as u32; 2], spp, ..loaded.settings };
        let reference = tiles(&loaded.scene, &base, TILES);
        println!("{name}: {}", errors(&reference));
        let variants = [
            Settings { branching: Branching::One, ..base },
            Settings { branching: Branching::First, ..base },
            Settings { branching: Branching::Tree, ..base },
            Settings { light_sampling: LightSampling::Lights, ..base },
            Settings { light_sampling: LightSampling::Bsdf, spp: 4 * base.spp, ..base },
            Settings { sequence: Sequence::Independent, ..base },
        ];
        for settings in variants {
            let found = tiles(&loaded.scene, &settings, TILES);
            let Settings { branching, light_sampling, sequence, .. } = settings;
            println!("  {branching:?}, {light_sampling:?}, {sequence:?}: {}", errors(&found));
            assert_same_tiles(name, &settings, &reference, &found);
        }
    }
}

/// The standard errors of tiles that are not black.
fn errors(tiles: &[Moments]) -> String {
    let lit = tiles.iter().filter(|tile| tile.mean() > 0.0);
    let mut errors: Vec<f64> = lit.map(|tile| 100.0 * tile.standard_error() / tile.mean()).collect();
    errors.sort_by(f64::total_cmp);
    format!(
        "errors of tiles {:.3} % (median), {:.3} % (largest)",
        errors[errors.len() / 2],
        errors[errors.len() - 1]
    )
}

/// A pane, behind which trees are best, and a mesh whose rays are dear.
const A_KNOT_BEHIND_A_PANE: &str = r#"
[camera]
type = "pinhole"
position = [0, 1.6, 5]
target = [0, 0.8, 0]
fov = 36
[background]
type = "gradient"
bottom = 0.1
top = 1
[[object]]
shape = "rectangle"
corner = [-4, 0, 3]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = { type = "matte", color = 0.7 }
[[object]]
shape = "rectangle"
corner = [-1.6, 0.1, 1]
edge_u = [1.6, 0, 0]
edge_v = [0, 1.5, 0]
material = { type = "thin", ior = 1.5 }
[[object]]
shape = "mesh"
file = "scenes/gallery/meshes/torus_knot.obj"
transform = [{ translate = [0.3, 0, -0.4] }]
material = { type = "dielectric", ior = 1.5 }
"#;

/// How a part of a picture branches is found out for it as for the whole, by any number of threads.
#[test]
fn a_part_branches_like_the_whole() {
    for (name, text) in [SCENES[0], SCENES[3], ("knot behind a pane", A_KNOT_BEHIND_A_PANE)] {
        let loaded = scene_text(name, text, Path::new("")).unwrap_or_else(|e| panic!("{name}: {e}"));
        let base = Settings { size: [90, 70], spp: 16, branching: Branching::Auto, ..loaded.settings };
        let whole = render(&loaded.scene, &base, &()).expect("valid settings");
        let ways: std::collections::BTreeSet<String> =
            whole.branching.iter().map(|way| format!("{way:?}")).collect();
        assert!(ways.len() > 1 && !ways.contains("Auto"), "{name} mixes: {ways:?}");
        assert!(whole.stats.pilot_rays > 0);
        let image = whole.film.image();
        for (threads, crop) in [(1, [37, 21, 29, 18]), (2, [0, 0, 8, 8]), (2, [83, 60, 7, 10])] {
            let [x, y, width, height] = crop;
            let crop = Some(Crop { x, y, width, height });
            let part =
                render(&loaded.scene, &Settings { threads, crop, ..base }, &()).expect("valid settings");
            let part = part.film.image();
            for (row, line) in part.chunks_exact(width as usize).enumerate() {
                let start = (y as usize + row) * 90 + x as usize;
                assert_eq!(line, &image[start..][..line.len()], "row {row} of {crop:?} of {name}");
            }
        }
    }
}

/// A depth limit cuts the same paths, however light is found.
#[test]
fn a_depth_limit_means_the_same_to_every_way_of_finding_light() {
    for (name, text) in [SCENES[1], SCENES[3]] {
        let loaded = scene_text(name, text, Path::new("")).unwrap_or_else(|e| panic!("{name}: {e}"));
        for depth in 0..3 {
            let (size, max_depth) = ([SIZE as u32; 2], Some(depth));
            let base = Settings { size, max_depth, spp: 16, ..loaded.settings };
            // The whole picture: in single tiles some of this light is too rare to be met in so few samples.
            let reference = tiles(&loaded.scene, &base, 1);
            let lights = Settings { light_sampling: LightSampling::Lights, ..base };
            let bsdf = Settings { light_sampling: LightSampling::Bsdf, spp: 4 * base.spp, ..base };
            for settings in [lights, bsdf] {
                assert_same(name, &loaded.scene, &reference, &settings);
            }
        }
    }
}

/// A floor with a glass ball under 24 lights, points and balls that shine; only those that `shines` says, the others are dark.
fn under_many_lights(shines: impl Fn(usize) -> bool) -> String {
    let mut text = String::from(
        "[render]\nintegrator = \"path\"\nspp = 16\n\
         [camera]\ntype = \"pinhole\"\nposition = [0, 2, 6]\ntarget = [0, 0.5, 0]\nfov = 45\n\
         [[object]]\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n\
         material = { type = \"phong\", color = 0.6, kd = 0.7, ks = 0.3, exponent = 20 }\n\
         [[object]]\nshape = \"sphere\"\ncenter = [0, 0.5, 0]\nradius = 0.5\n\
         material = { type = \"dielectric\", ior = 1.5 }\n",
    );
    for light in 0..24 {
        // Somewhere about the ball, by the golden angle.
        let turn = 2.4 * light as f64;
        let (r, y) = (0.9 + 0.1 * light as f64, 0.3 + 0.08 * light as f64);
        let place = format!("[{}, {y}, {}]", r * libm::cos(turn), r * libm::sin(turn));
        let bright = if shines(light) { 1.0 + (light % 5) as f64 } else { 0.0 };
        if light % 2 == 0 {
            text += &format!(
                "[[object]]\nname = \"{light}\"\nshape = \"sphere\"\ncenter = {place}\nradius = 0.15\n\
                 material = {{ type = \"emissive\", radiance = {bright} }}\n"
            );
        } else if bright > 0.0 {
            text += &format!(
                "[[light]]\nname = \"{light}\"\ntype = \"point\"\nposition = {place}\nintensity = {}\n",
                0.05 * bright
            );
        }
    }
    text
}

/// Light adds up: a picture under many lights, which are found in a tree, is the sum of pictures under few of them at a time,
/// which are estimated one by one; and it is the same however light is found.
#[test]
fn many_lights_are_the_sum_of_few() {
    let load = |text: &str| scene_text("many lights", text, Path::new("")).expect("a valid scene");
    let all = load(&under_many_lights(|_| true));
    let base = Settings { size: [SIZE as u32; 2], ..all.settings };
    let together = tiles(&all.scene, &base, TILES);
    let parts = [0, 1, 2, 3].map(|part| {
        let some = load(&under_many_lights(|light| light / 6 == part));
        tiles(&some.scene, &base, TILES)
    });
    for (tile, together) in together.iter().enumerate() {
        let sum: f64 = parts.iter().map(|part| part[tile].mean()).sum();
        let squares = |m: &Moments| m.standard_error() * m.standard_error();
        let error = (squares(together) + parts.iter().map(|part| squares(&part[tile])).sum::<f64>()).sqrt();
        let z = (together.mean() - sum) / error;
        assert!(z.abs() < FARTHEST, "tile {tile}: {together:?} {sum}");
    }
    let lights = Settings { light_sampling: LightSampling::Lights, ..base };
    assert_same("many lights in a tree", &all.scene, &together, &lights);
}

fn assert_same(name: &str, scene: &Scene, reference: &[Moments], settings: &Settings) {
    let count = if reference.len() == 1 { 1 } else { TILES };
    assert_same_tiles(name, settings, reference, &tiles(scene, settings, count));
}

fn assert_same_tiles(name: &str, settings: &Settings, reference: &[Moments], found: &[Moments]) {
    for (tile, (a, b)) in reference.iter().zip(found).enumerate() {
        let (ea, eb) = (a.standard_error(), b.standard_error());
        let error = (ea * ea + eb * eb).sqrt();
        // Tiles of the background alone have no error but that of single precision.
        let z = (a.mean() - b.mean()) / (error + 1e-7 * a.mean()).max(f64::MIN_POSITIVE);
        assert!(z.abs() < FARTHEST, "{name}, {settings:?}, tile {tile}: {a:?} {b:?}");
    }
}
