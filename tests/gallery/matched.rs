//! 1: index 1.

use crate::stage::{described, loaded, picture, remove, set_glass};
use vitrum::io::scene::LightKind;

const SIZE: [u32; 2] = [120, 120];

#[test]
fn the_invisible_ball_changes_no_bit() {
    let with = described("01_invisible");
    let mut without = with.clone();
    remove(&mut without, "ball");
    assert_eq!(loaded(&with).scene.invisible(), ["ball"]);
    let expected = picture(&without, SIZE, 8);
    assert_eq!(picture(&with, SIZE, 8), expected);
    // The scene beside it is the same one.
    let mut matched = described("01_matched");
    remove(&mut matched, "ball");
    assert_eq!(picture(&matched, SIZE, 8), expected);
}

/// Each of two surfaces lets kt through and bends nothing: 0.81 of what stands behind, in every pixel inside the disc.
///
/// A direction is brought into the frame of the surface and back at each crossing, an error of some 1e-15: a sample within
/// that of an edge could change sides. Of 57 600 samples none is expected to, so no pixel is left out. The samples are
/// rounded to single precision, 6e-8 of themselves, before and after.
#[test]
fn the_matched_ball_dims_what_is_behind_it_to_kt_squared() {
    let mut with = described("01_matched");
    set_glass(&mut with, 0.0, 0.9);
    for light in &mut with.lights {
        if let LightKind::Directional { shadows, .. } = &mut light.kind {
            *shadows = false;
        }
    }
    let mut without = with.clone();
    remove(&mut without, "ball");
    let mut dimmed = 0;
    for (seen, behind) in picture(&with, SIZE, 4).iter().zip(picture(&without, SIZE, 4)) {
        let share = seen[1] / behind[1];
        // Pixels on the outline hold both.
        assert!((0.81 - 3e-7..=1.0).contains(&share), "{share}");
        if share < 0.81 + 3e-7 {
            dimmed += 1;
            for (seen, behind) in seen.iter().zip(behind) {
                assert!((seen / behind - 0.81).abs() < 3e-7, "{seen} of {behind}");
            }
        }
    }
    // The disc: a sphere of radius 1 at distance d = |(0, 0.5, 7)| is seen under asin(1/d), in 120 rows of 27 degrees.
    let distance = 0.5f64.hypot(7.0);
    let radius = 60.0 * (1.0 / (distance * distance - 1.0).sqrt()) / (13.5f64.to_radians()).tan();
    let disc = std::f64::consts::PI * radius * radius;
    // Off the axis by 4 degrees it is an ellipse, longer by less than 1 %; the outline crosses some 8 r pixels.
    let outline = 8.0 * radius;
    assert!((f64::from(dimmed) - disc).abs() < 0.01 * disc + outline, "{dimmed} pixels, expected {disc}");
}
