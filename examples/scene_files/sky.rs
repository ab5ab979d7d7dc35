//! The sky of the bench: a horizon that brightens, a ground, a sun and two soft boxes, so that no turn or mirror image of it is like
//! it. All edges are several texels wide, so that programs that place texels otherwise read nearly the same.

use std::f64::consts::PI;

use glam::DVec3;

pub(crate) const WIDTH: u32 = 256;
pub(crate) const HEIGHT: u32 = 128;

/// Azimuth and elevation of the middle, half width and half height, and the width of the edge, degrees; and the radiance.
type Patch = ([f64; 2], [f64; 2], f64, [f64; 3]);

const PATCHES: [Patch; 3] = [
    ([-60.0, 40.0], [18.0, 12.0], 8.0, [4.0, 3.6, 3.0]),
    ([55.0, 28.0], [8.0, 16.0], 8.0, [2.0, 2.8, 4.0]),
    ([150.0, 52.0], [3.0, 3.0], 5.0, [60.0, 54.0, 45.0]),
];

/// Radiance by rows from straight up; the middle of the picture is the direction -Z, and what is right of it lies towards +X.
pub(crate) fn pixels() -> Vec<[f32; 3]> {
    let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    places
        .map(|(x, y)| {
            let azimuth = ((f64::from(x) + 0.5) / f64::from(WIDTH) - 0.5) * 360.0;
            let elevation = 90.0 - (f64::from(y) + 0.5) / f64::from(HEIGHT) * 180.0;
            radiance(azimuth, elevation).to_array().map(|v| v as f32)
        })
        .collect()
}

fn radiance(azimuth: f64, elevation: f64) -> DVec3 {
    let up = libm::sin(elevation * PI / 180.0);
    let sky = DVec3::new(0.75, 0.78, 0.80).lerp(DVec3::new(0.20, 0.34, 0.62), up.max(0.0));
    let ground = DVec3::new(0.30, 0.26, 0.22);
    let base = ground.lerp(sky, smooth(up / 0.2 + 0.5));
    PATCHES.iter().fold(base, |light, ([across, above], [half_width, half_height], edge, colour)| {
        let distance = libm::remainder(azimuth - across, 360.0).abs();
        let inside = |distance: f64, half: f64| smooth((half + 0.5 * edge - distance) / edge);
        let share = inside(distance, *half_width) * inside((elevation - above).abs(), *half_height);
        light + share * DVec3::from_array(*colour)
    })
}

/// 0 below 0, 1 above 1, and an even way between.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
