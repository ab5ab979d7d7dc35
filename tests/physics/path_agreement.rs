//! Every way of following light gives the same picture: each branching, light found by asking, by meeting and by both, numbers
//! that fill the square and numbers that don't. Six scenes, compared by tiles of the picture.

use std::path::Path;
use vitrum::io::load::scene_text;
use vitrum::math::Sequence;
use vitrum::tracer::{Branching, LightSampling, Scene, Settings, render};
use vitrum_testkit::Moments;

const SCENES: [(&str, &str); 6] = [
    ("glass on a floor", include_str!("../scenes/glass_on_a_floor.toml")),
    ("rough glass and metal", include_str!("../scenes/rough.toml")),
    ("hollow ball", include_str!("../scenes/hollow_ball.toml")),
    ("pane before a lamp", include_str!("../scenes/pane.toml")),
    ("many lights", include_str!("../scenes/many_lights.toml")),
    ("the lecture's materials", include_str!("../scenes/lecture_materials.toml")),
];

const TILES: usize = 4;
const SIZE: usize = 32;
const SEEDS: u64 = 12;

/// Six scenes, five variants and sixteen tiles are 480 comparisons: in one of a hundred runs one of them would be farther off by
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
    for (name, text) in SCENES {
        let loaded = scene_text(name, text, Path::new("")).unwrap_or_else(|e| panic!("{name}: {e}"));
        let base = Settings { size: [SIZE as u32; 2], ..loaded.settings };
        let reference = tiles(&loaded.scene, &base, TILES);
        let variants = [
            Settings { branching: Branching::One, ..base },
            Settings { branching: Branching::First, ..base },
            Settings { light_sampling: LightSampling::Lights, ..base },
            Settings { light_sampling: LightSampling::Bsdf, spp: 4 * base.spp, ..base },
            Settings { sequence: Sequence::Independent, ..base },
        ];
        for settings in variants {
            assert_same(name, &loaded.scene, &reference, &settings);
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

fn assert_same(name: &str, scene: &Scene, reference: &[Moments], settings: &Settings) {
    let count = if reference.len() == 1 { 1 } else { TILES };
    for (tile, (a, b)) in reference.iter().zip(tiles(scene, settings, count)).enumerate() {
        let (ea, eb) = (a.standard_error(), b.standard_error());
        let error = (ea * ea + eb * eb).sqrt();
        // Tiles of the background alone have no error but that of single precision.
        let z = (a.mean() - b.mean()) / (error + 1e-7 * a.mean()).max(f64::MIN_POSITIVE);
        assert!(z.abs() < FARTHEST, "{name}, {settings:?}, tile {tile}: {a:?} {b:?}");
    }
}
