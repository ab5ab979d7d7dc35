//! A path tracer of a glass sphere before a sky, complete, on nothing but this crate:
//!
//! ```text
//! cargo run --release --example glass_sphere > sphere.ppm
//! ```
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use glam::DVec3;
use vitrum_bxdf::{Bxdf, FresnelDielectric, IndexError, Interface, TransportMode};

const SIZE: u32 = 256;
const SAMPLES: u32 = 32;

fn main() -> Result<(), IndexError> {
    let glass = Bxdf::FresnelDielectric(FresnelDielectric { interface: Interface::new(1.0_f64, 1.5)? });
    let mut random = Random(1);
    println!("P3 {SIZE} {SIZE} 255");
    for (y, x) in (0..SIZE * SIZE).map(|pixel| (pixel / SIZE, pixel % SIZE)) {
        let mut sum = DVec3::ZERO;
        for _ in 0..SAMPLES {
            let [u, v] = [x, y].map(|p| (f64::from(p) + random.next()) / f64::from(SIZE) - 0.5);
            sum +=
                radiance(&glass, DVec3::new(0.0, 0.0, 4.0), DVec3::new(u, -v, -1.4).normalize(), &mut random);
        }
        let [r, g, b] =
            (sum / f64::from(SAMPLES)).to_array().map(|c| 255.0 * c.clamp(0.0, 1.0).powf(1.0 / 2.2));
        println!("{r:.0} {g:.0} {b:.0}");
    }
    Ok(())
}

/// The light that arrives along a path that begins here and goes that way.
fn radiance(glass: &Bxdf<f64>, mut origin: DVec3, mut direction: DVec3, random: &mut Random) -> DVec3 {
    let mut throughput = DVec3::ONE;
    for _ in 0..64 {
        let Some(distance) = unit_sphere(origin, direction) else { return throughput * sky(direction) };
        origin = (origin + direction * distance).normalize();

        // The model knows a local frame, z = outward normal: into it, ask, and out again.
        let (x, y) = origin.any_orthonormal_pair();
        let wo = DVec3::new(-direction.dot(x), -direction.dot(y), -direction.dot(origin));
        let u = [random.next(), random.next()];
        let Some(sample) = glass.sample(wo, random.next(), u, TransportMode::Radiance) else { break };
        direction = (x * sample.wi.x + y * sample.wi.y + origin * sample.wi.z).normalize();
        throughput *= sample.weight;
    }
    DVec3::ZERO
}

/// The distance to the unit sphere; what is nearer than rounding is the point that the ray leaves.
fn unit_sphere(origin: DVec3, direction: DVec3) -> Option<f64> {
    let (b, c) = (origin.dot(direction), origin.length_squared() - 1.0);
    let root = (b * b - c).sqrt();
    [-b - root, -b + root].into_iter().find(|&distance| distance > 1e-9)
}

/// A checkered ground to the horizon, and a blue sky above it.
fn sky(d: DVec3) -> DVec3 {
    let ground = ((d.x / d.y * 2.0).floor() + (d.z / d.y * 2.0).floor()).rem_euclid(2.0);
    if d.y < 0.0 {
        DVec3::splat(0.2 + 0.6 * ground)
    } else {
        DVec3::new(0.9, 0.9, 0.9).lerp(DVec3::new(0.2, 0.4, 0.8), d.y)
    }
}

/// Numbers in [0, 1): a linear congruential generator (D. Knuth's MMIX constants).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
