//! 3: a bubble of air in water.

use crate::stage::{described, keep, loaded, picture, set_glass, surround_with_white, unanimous};
use vitrum::math::DVec3;

/// Light that would meet the bubble farther than 0.75 R from its centre is totally reflected. With kr = kt = 0 in white
/// surroundings only that light is left: 1 where a ray passes the centre at 0.75 R to R, 0 inside.
#[test]
fn the_silver_ring_begins_at_three_quarters_of_the_radius() {
    let mut desc = described("03_bubble");
    keep(&mut desc, &["bubble"]);
    set_glass(&mut desc, 0.0, 0.0);
    surround_with_white(&mut desc);
    let (centre, radius) = (DVec3::new(0.0, 1.35, 0.0), 1.0);

    let size = [240, 240];
    let camera = loaded(&desc).scene.camera;
    let is_dark = |x: f64, y: f64| {
        let ray = camera.ray(x, y, size, || unreachable!("no lens"));
        let offset = centre - ray.origin;
        let passes = (offset - ray.direction * offset.dot(ray.direction)).length();
        passes < 0.75 * radius
    };
    let (mut dark, mut bright) = (0, 0);
    for (i, pixel) in (0u32..).zip(picture(&desc, size, 2)) {
        let (x, y) = (i % size[0], i / size[0]);
        match unanimous(x, y, is_dark) {
            Some(true) => {
                assert_eq!(pixel, [0.0; 3], "({x}, {y})");
                dark += 1;
            }
            Some(false) => {
                assert_eq!(pixel, [1.0; 3], "({x}, {y})");
                bright += 1;
            }
            None => {}
        }
    }
    assert!(dark > 5000 && bright > 5000, "{dark}, {bright}");
}
