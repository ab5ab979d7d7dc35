//! Maps from the unit square, each keeping the measure and neighbourhoods.

use crate::DVec2;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A point of the unit disk for a point of the unit square, uniformly distributed (density 1/π; Shirley and Chiu, A Low
/// Distortion Map Between Disk and Square, 1997).
pub fn concentric_disk([u, v]: [f64; 2]) -> DVec2 {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, angle) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, FRAC_PI_2 - FRAC_PI_4 * (a / b)) };
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(radius * cos, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_fills_the_disk_evenly() {
        let n = 256;
        let mut inside = 0;
        for i in 0..n * n {
            let u = [((i % n) as f64 + 0.5) / n as f64, ((i / n) as f64 + 0.5) / n as f64];
            let p = concentric_disk(u);
            assert!(p.length_squared() <= 1.0 + 1e-15);
            inside += i32::from(p.length_squared() <= 0.25);
        }
        // A quarter of the disk's area; the tolerance is the row of cells that the circle crosses.
        assert!((f64::from(inside) / f64::from(n * n) - 0.25).abs() < 4.0 / f64::from(n));
    }
}
