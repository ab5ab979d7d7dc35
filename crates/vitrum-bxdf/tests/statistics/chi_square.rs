//! The directions that a model samples follow the density that it claims: Pearson's chi-square over the whole sphere,
//! with what it refuses as one more cell.

use crate::stage::{Subject, outgoing, subjects};
use glam::{DVec3, Vec3};
use vitrum_bxdf::{Bxdf, GlossySpecular, Lambertian, TransportMode};
use vitrum_testkit::{Uniform, chi_square_of_directions, sidak_level};

const SAMPLES: u64 = 200_000;

/// All tests of this file together blame a right model once in a thousand seeds.
const LEVEL: f64 = 1e-3;

/// Five models in two precisions, from eight directions.
const TESTS: u32 = 2 * 5 * 8;

/// Compares what `sample` draws with the density that the model has in double precision.
fn follows(
    subject: &Subject,
    precision: &str,
    sample: impl Fn(&mut Uniform, DVec3) -> Option<DVec3>,
    seed: u64,
) {
    for (seed, (place, wo)) in (seed..).zip(outgoing()) {
        let density = |wi| subject.model.pdf(wo, wi);
        let outcome =
            chi_square_of_directions(|uniform| sample(uniform, wo), density, subject.cells, SAMPLES, seed);
        assert!(
            outcome.passes(sidak_level(LEVEL, TESTS)),
            "{} {precision}, {place}: {outcome}",
            subject.name
        );
    }
}

#[test]
fn samplers_follow_their_densities() {
    for (subject, seed) in subjects().iter().zip((0..).step_by(100)) {
        let sample = |uniform: &mut Uniform, wo| {
            let u = uniform.pair();
            Some(subject.model.sample(wo, 0.5, u, TransportMode::Radiance)?.wi)
        };
        follows(subject, "in f64", sample, seed);
    }
}

#[test]
fn samplers_in_single_precision_follow_them_too() {
    for (subject, seed) in subjects().iter().zip((1000..).step_by(100)) {
        let single = match subject.model {
            Bxdf::Lambertian(b) => {
                Bxdf::<f32>::Lambertian(Lambertian { reflectance: b.reflectance.as_vec3() })
            }
            Bxdf::GlossySpecular(b) => {
                Bxdf::GlossySpecular(GlossySpecular::unnormalised(b.peak.as_vec3(), b.exponent as f32))
            }
            _ => unreachable!("no subject here"),
        };
        let sample = |uniform: &mut Uniform, wo: DVec3| {
            // Numbers that f32 holds and that stay below one.
            let u = uniform.pair().map(|u| (u * 16_777_216.0).floor() as f32 / 16_777_216.0);
            let wi: Vec3 = single.sample(wo.as_vec3(), 0.5, u, TransportMode::Radiance)?.wi;
            Some(wi.as_dvec3())
        };
        follows(subject, "in f32", sample, seed);
    }
}
