//! 7: solids in one piece and in parts.

use crate::stage::{described, picture};

const SIZE: [u32; 2] = [120, 120];

/// The largest difference of a channel, per pixel.
fn differences(a: &str, b: &str) -> Vec<f32> {
    let pictures = [a, b].map(|name| picture(&described(name), SIZE, 4));
    let distance =
        |(a, b): (&[f32; 3], &[f32; 3])| (0..3).fold(0.0, |most: f32, c| most.max((a[c] - b[c]).abs()));
    pictures[0].iter().zip(&pictures[1]).map(distance).collect()
}

/// Parts compute the same crossings by other formulas, so points and directions differ by some 1e-15, and a sample by no
/// more than the rounding to single precision, 6e-8 of values up to 1: allowed is 1e-6. A sample within 1e-15 of an
/// edge of the pattern, or of an edge of the solid, can still see the other side of it; of 57 600 samples, whose trees
/// cross thousands of edges a pixel wide each, none is expected to: allowed are two pixels.
#[test]
fn right_parts_are_the_solid() {
    for solid in ["box", "cylinder"] {
        let differences = differences(&format!("07_{solid}_right"), &format!("07_{solid}_solid"));
        let different = differences.iter().filter(|d| **d > 1e-6).count();
        assert!(different <= 2, "{solid}: {different} pixels differ");
    }
}

#[test]
fn one_turned_part_is_seen() {
    for solid in ["box", "cylinder"] {
        let differences = differences(&format!("07_{solid}_wrong"), &format!("07_{solid}_right"));
        // The turned part covers more than 3 % of the picture, and is another thing there, not a shade.
        let different = differences.iter().filter(|d| **d > 0.1).count();
        assert!(different > differences.len() * 3 / 100, "{solid}: {different} pixels differ");
    }
}
