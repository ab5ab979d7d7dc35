//! How much of the light that falls on rough glass comes out again, with and without energy compensation:
//!
//! ```text
//! cargo run --example energy_compensation
//! ```
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use glam::DVec3;
use std::error::Error;
use vitrum_bxdf::{Ggx, Interface, RoughDielectric, TransportMode};

fn main() -> Result<(), Box<dyn Error>> {
    println!("roughness | from outside: 0, 60, 85 degrees | from inside: 0, 60, 85 degrees");
    for alpha in [0.05, 0.1, 0.2, 0.4, 0.7, 1.0] {
        let (interface, roughness) = (Interface::new(1.0, 1.5)?, Ggx::isotropic(alpha)?);
        let single = RoughDielectric::single_scattering(interface, roughness);
        let compensated = RoughDielectric::new(interface, roughness);
        for (name, model) in [("single", single), ("compensated", compensated)] {
            let at = |degrees: f64, below: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                albedo(&model, DVec3::new(sin, 0.0, cos * below))
            };
            let [outside, inside] = [1.0, -1.0].map(|side| [0.0, 60.0, 85.0].map(|angle| at(angle, side)));
            println!("{alpha:9} | {outside:.3?} | {inside:.3?} {name}");
        }
    }
    Ok(())
}

/// The mean weight of sampled directions, over a grid of the numbers that choose them.
fn albedo(model: &RoughDielectric<f64>, wo: DVec3) -> f64 {
    const N: u32 = 64;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(N);
    let mut sum = 0.0;
    for (i, j, k) in (0..N * N * N).map(|n| (n % N, n / N % N, n / (N * N))) {
        let sample = model.sample(wo, at(i), [at(j), at(k)], TransportMode::Radiance);
        // Radiance that crosses is scaled by 1/eta²: that is no loss.
        sum += sample.map_or(0.0, |sample| sample.weight.x * sample.eta * sample.eta);
    }
    sum / f64::from(N * N * N)
}
