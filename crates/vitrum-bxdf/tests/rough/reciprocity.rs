//! What light does one way and the other, and what a sample says of itself.

use crate::stage::{glass, metal, single};
use glam::DVec3;
use vitrum_bxdf::{Bxdf, Density, RoughDielectric, TransportMode};
use vitrum_testkit::Uniform;

const ALPHAS: [[f64; 2]; 5] = [[0.02, 0.02], [0.2, 0.2], [1.0, 1.0], [0.05, 0.6], [0.7, 0.3]];

/// A unit vector, uniform over the sphere.
fn direction(uniform: &mut Uniform) -> DVec3 {
    let z = 1.0 - 2.0 * uniform.number();
    let (sin, cos) = libm::sincos(core::f64::consts::TAU * uniform.number());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos, r * sin, z)
}

/// Pairs of directions between which the model scatters: uniform ones, and sampled ones, which find narrow lobes.
fn pairs(model: &Bxdf<f64>, mut check: impl FnMut(DVec3, DVec3)) {
    let mut uniform = Uniform::new(21);
    let mut nonzero = 0;
    for i in 0..20_000 {
        let wo = direction(&mut uniform);
        let wi = if i % 2 == 0 {
            direction(&mut uniform)
        } else {
            let (uc, u) = (uniform.number(), uniform.pair());
            let Some(sample) = model.sample(wo, uc, u, TransportMode::Radiance) else { continue };
            sample.wi
        };
        check(wo, wi);
        nonzero += u32::from(model.pdf(wo, wi) > 0.0);
    }
    assert!(nonzero > 5_000, "only {nonzero} pairs show anything");
}

/// f without the cosine.
fn f(model: &RoughDielectric<f64>, wo: DVec3, wi: DVec3, mode: TransportMode) -> f64 {
    model.eval(wo, wi, mode).x / wi.z.abs()
}

/// Equal to within what rounding does to half vectors, which are short for nearly opposite directions and steep in units of
/// the roughness, and to transmission next to the critical angle, where it vanishes.
fn assert_equal(a: f64, b: f64, wo: DVec3, wi: DVec3) {
    assert!((a - b).abs() <= 1e-5 * a.max(b), "{wo} and {wi}: {a} and {b}");
}

/// `f(wo, wi)/n_o² = f(wi, wo)/n_i²` for radiance, and for importance the other way round.
#[test]
fn single_scattering_is_reciprocal_with_the_squared_index() {
    for alphas in ALPHAS {
        let model = single(1.0, 1.5, alphas);
        let n = |w: DVec3| if w.z >= 0.0 { 1.0 } else { 1.5 };
        pairs(&Bxdf::RoughDielectric(model), |wo, wi| {
            let there = f(&model, wo, wi, TransportMode::Radiance) / (n(wo) * n(wo));
            let back = f(&model, wi, wo, TransportMode::Radiance) / (n(wi) * n(wi));
            assert_equal(there, back, wo, wi);
        });
    }
}

/// What importance does from `wo` to `wi` is what radiance does from `wi` to `wo`: with compensation too.
#[test]
fn importance_is_the_adjoint_of_radiance() {
    for alphas in ALPHAS {
        let model = glass(1.0, 1.5, alphas);
        assert!(model.is_compensated());
        pairs(&Bxdf::RoughDielectric(model), |wo, wi| {
            let importance = f(&model, wo, wi, TransportMode::Importance);
            let radiance = f(&model, wi, wo, TransportMode::Radiance);
            assert_equal(importance, radiance, wo, wi);
        });
    }
}

#[test]
fn metal_is_reciprocal() {
    for alphas in ALPHAS {
        let model = metal(alphas);
        pairs(&Bxdf::Conductor(model), |wo, wi| {
            if wo.z * wi.z > 0.0 {
                let there = model.eval(wo, wi) / wi.z.abs();
                let back = model.eval(wi, wo) / wo.z.abs();
                assert_equal(there.x, back.x, wo, wi);
                assert_equal(there.z, back.z, wo, wi);
            } else {
                assert_eq!(model.eval(wo, wi), DVec3::ZERO);
            }
        });
    }
}

/// Weight = f · |cos θi| / pdf, and the density in the sample is that of `pdf`.
#[test]
fn samples_say_of_themselves_what_eval_and_pdf_say() {
    for alphas in ALPHAS {
        let models = [
            Bxdf::RoughDielectric(glass(1.0, 1.5, alphas)),
            Bxdf::RoughDielectric(single(1.33, 1.1, alphas)),
            Bxdf::Conductor(metal(alphas)),
        ];
        for model in models {
            let mut uniform = Uniform::new(22);
            for i in 0..20_000 {
                let mode = if i % 2 == 0 { TransportMode::Radiance } else { TransportMode::Importance };
                let wo = direction(&mut uniform);
                let (uc, u) = (uniform.number(), uniform.pair());
                let Some(sample) = model.sample(wo, uc, u, mode) else { continue };
                let Density::SolidAngle(claimed) = sample.pdf else { panic!("it is rough") };
                assert_equal(claimed, model.pdf(wo, sample.wi), wo, sample.wi);
                let expected = model.eval(wo, sample.wi, mode) / model.pdf(wo, sample.wi);
                assert!(
                    (sample.weight - expected).abs().max_element() <= 1e-9 * expected.max_element(),
                    "{wo}"
                );
                assert_eq!(sample.lobe.is_transmission(), sample.wi.z * wo.z < 0.0);
                assert!((sample.wi.length() - 1.0).abs() < 1e-14);
            }
        }
    }
}
