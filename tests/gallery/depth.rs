//! 5: the depth ladder.

use crate::stage::{described, keep, picture, set_glass, surround_with_white, unanimous};
use vitrum::io::scene::Lens;
use vitrum::math::DVec3;

/// Straight through the middle of a ball in white surroundings, kr = 0.1 and kt = 0.9, at the depths 1 to 6. The factors
/// of the radiance in glass cancel in all that gets out.
///
/// Solid: 1 - kt kr^(D-1). Hollow, with o, c for a crossing of the outer and the inner surface: depth 1 the reflection
/// of the outside, 0.1; depth 3 what the cavity reflects, 0.9 x 0.1 x 0.9; depth 4 what crosses all four, 0.9^4. Depth
/// 5 and 6 sum the paths with one or two reflections more; they are counted by `walked` below.
#[test]
fn straight_through_the_middle_each_depth_adds_its_paths() {
    let solid: Vec<f64> = (0..6).map(|d| 1.0 - 0.9 * 0.1f64.powi(d)).collect();
    let hollow: Vec<f64> = (1..=6).map(|depth| walked(4, depth)).collect();
    assert_eq!(walked(2, 3), 0.1 + 0.81 + 0.081);
    for (depth, expected) in [(1, 0.1), (2, 0.1), (3, 0.181), (4, 0.8371)] {
        let found: f64 = hollow[depth - 1];
        assert!((found - expected).abs() < 1e-15, "{found}, by hand {expected}");
    }
    let hollow_parts = ["hollow, inside", "hollow, outside"];
    for (names, x, expected) in [(&["solid"][..], -1.15, solid), (&hollow_parts[..], 1.15, hollow)] {
        for (depth, expected) in (1..).zip(expected) {
            let mut desc = described("05_depth");
            keep(&mut desc, names);
            set_glass(&mut desc, 0.1, 0.9);
            surround_with_white(&mut desc);
            desc.render.max_depth = Some(depth);
            desc.render.cutoff = 0.0;
            desc.camera.position = DVec3::new(x, 1.02, 5.0);
            desc.camera.target = DVec3::new(x, 1.02, 0.0);
            desc.camera.lens = Lens::Orthographic { height: 0.05 };
            for pixel in picture(&desc, [8, 8], 2) {
                // Rounded to single precision.
                assert!((f64::from(pixel[0]) - expected).abs() < 2e-7, "{names:?}, depth {depth}: {pixel:?}");
            }
        }
    }
}

/// What leaves a row of parallel surfaces at either end within `depth` steps, of light 1 that comes to the first.
fn walked(surfaces: u32, depth: u32) -> f64 {
    through(surfaces, 0, true, 1.0, depth)
}

/// What gets out of a ray in one of the gaps, counted from 0, before the first surface, to that behind the last.
fn through(surfaces: u32, gap: u32, forward: bool, weight: f64, steps: u32) -> f64 {
    let end = if forward { surfaces } else { 0 };
    if gap == end {
        return weight;
    }
    if steps == 0 {
        return 0.0;
    }
    let beyond = if forward { gap + 1 } else { gap - 1 };
    through(surfaces, gap, !forward, 0.1 * weight, steps - 1)
        + through(surfaces, beyond, forward, 0.9 * weight, steps - 1)
}

/// At depth 3 the hollow ball shows its cavity at its true size: light that passes the centre at less than 0.8 R meets the
/// cavity within the critical angle, since sin = b / (1.5 x 0.8 R) there and 1/1.5 is critical, and leaves 0.1 + 0.9 x 0.1 x
/// 0.9; farther out it is totally reflected, and leaves 0.1 + 0.9 x 0.9.
#[test]
fn the_rim_of_the_hollow_ball_is_bright_from_depth_three_on() {
    let mut desc = described("05_depth");
    keep(&mut desc, &["hollow, inside", "hollow, outside"]);
    set_glass(&mut desc, 0.1, 0.9);
    surround_with_white(&mut desc);
    desc.render.max_depth = Some(3);
    desc.camera.position = DVec3::new(1.15, 1.02, 5.0);
    desc.camera.target = DVec3::new(1.15, 1.02, 0.0);
    let (size, height) = (120u32, 2.2);
    desc.camera.lens = Lens::Orthographic { height };
    let metres = |pixels: f64| (pixels / f64::from(size) - 0.5) * height;
    let zone = |x: f64, y: f64| match metres(x).hypot(metres(y)) {
        passes if passes < 0.8 => 0.181,
        passes if passes < 1.0 => 0.91,
        _ => 1.0,
    };
    for (i, pixel) in (0u32..).zip(picture(&desc, [size; 2], 2)) {
        let (x, y) = (i % size, i / size);
        if let Some(expected) = unanimous(x, y, zone) {
            // Rounded to single precision.
            assert!((f64::from(pixel[0]) - expected).abs() < 2e-7, "({x}, {y}): {pixel:?}, not {expected}");
        }
    }
}

/// A deeper limit adds branches and takes none away, and no branch brings negative light. The order of the sum changes, which
/// shows in the last bits only.
#[test]
fn no_pixel_gets_darker_with_depth() {
    let mut desc = described("05_depth");
    let mut shallower = vec![[0.0; 3]; 96 * 54];
    for depth in 0..=6 {
        desc.render.max_depth = Some(depth);
        let deeper = picture(&desc, [96, 54], 2);
        for (a, b) in shallower.iter().zip(&deeper) {
            assert!((0..3).all(|c| b[c] >= a[c] * (1.0 - 3e-7)), "{a:?} became {b:?} at depth {depth}");
        }
        shallower = deeper;
    }
}
