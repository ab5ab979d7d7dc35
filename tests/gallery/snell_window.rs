//! 4: the world above the water, seen from below.

use crate::stage::{described, keep, picture, set_glass, surround_with_white, unanimous};

/// The window's edge is where rays meet the surface at asin(3/4), for a camera that looks straight up: a circle of
/// tan(asin(3/4)) / tan(55°) half heights. Inside, radiance is (4/3)² of that above; outside all is reflected.
#[test]
fn the_window_is_as_wide_as_the_critical_angle() {
    let mut desc = described("04_snell_window");
    keep(&mut desc, &["surface"]);
    set_glass(&mut desc, 0.0, 1.0);
    surround_with_white(&mut desc);
    let size = 200u32;
    let half = f64::from(size) / 2.0;
    let radius = half * (0.75f64 / (1.0f64 - 0.75 * 0.75).sqrt()) / 55f64.to_radians().tan();
    // The number in the comment of the scene, for 300 pixels of half height.
    assert_eq!((radius / half * 300.0).round(), 238.0);

    let is_window = |x: f64, y: f64| (x - half).hypot(y - half) < radius;
    let mut window = 0;
    for (i, pixel) in (0u32..).zip(picture(&desc, [size; 2], 2)) {
        let (x, y) = (i % size, i / size);
        let expected = match unanimous(x, y, is_window) {
            // 16/9, computed in double precision and rounded once.
            Some(true) => 16.0 / 9.0,
            Some(false) => 1.0,
            None => continue,
        };
        window += u32::from(expected > 1.0);
        assert!((f64::from(pixel[0]) - expected).abs() < 3e-7, "({x}, {y}): {pixel:?}, not {expected}");
    }
    assert!(f64::from(window) > 0.95 * std::f64::consts::PI * radius * radius);
}
