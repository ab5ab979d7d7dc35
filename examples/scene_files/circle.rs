//! Points on the unit circle, exact in their symmetries: multiples of a quarter turn have exact zeros and
//! ones, and mirrored points are mirrored to the last bit. Sine and cosine are libm's, so that they are the
//! same everywhere.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use glam::{DVec2, DVec3};

/// The point at `step` of `steps` equal parts of a whole turn, as (cosine, sine).
pub(crate) fn point(step: usize, steps: usize) -> DVec2 {
    // The octant, and the angle to the nearest axis in units of π/4 / steps.
    let eighths = 8 * (step % steps);
    let (octant, past) = (eighths / steps, eighths % steps);
    let from_axis = if octant % 2 == 0 { past } else { steps - past };
    let (c, s) = if from_axis == steps {
        (FRAC_1_SQRT_2, FRAC_1_SQRT_2)
    } else {
        let angle = FRAC_PI_4 * from_axis as f64 / steps as f64;
        (libm::cos(angle), libm::sin(angle))
    };
    let (x, y) = match octant {
        0 => (c, s),
        1 => (s, c),
        2 => (-s, c),
        3 => (-c, s),
        4 => (-c, -s),
        5 => (-s, -c),
        6 => (s, -c),
        _ => (c, -s),
    };
    DVec2::new(x, y)
}

/// The point at a radius and a height above the xz plane; steps run anticlockwise seen from above.
pub(crate) fn around_y(step: usize, steps: usize, radius: f64, height: f64) -> DVec3 {
    let DVec2 { x, y } = point(step, steps);
    DVec3::new(radius * x, height, -radius * y)
}
