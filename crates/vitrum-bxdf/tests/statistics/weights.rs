//! A sample says of itself what `eval` and `pdf` say of its direction.

use crate::stage::{COLOUR, EXPONENTS, direction, subjects};
use core::f64::consts::TAU;
use vitrum_bxdf::{Bxdf, Density, Sample, TransportMode};
use vitrum_testkit::Uniform;

/// Samples of a model from directions all over the sphere.
fn samples(model: &Bxdf<f64>, mut check: impl FnMut(glam::DVec3, &Sample<f64>)) {
    let mut uniform = Uniform::new(8);
    let mut returned = 0;
    for _ in 0..100_000 {
        let wo = direction(&mut uniform);
        if let Some(sample) = model.sample(wo, 0.5, uniform.pair(), TransportMode::Radiance) {
            check(wo, &sample);
            returned += 1;
        }
    }
    assert!(returned > 50_000, "only {returned} samples");
}

#[test]
fn the_weight_is_eval_over_pdf() {
    for subject in subjects() {
        samples(&subject.model, |wo, sample| {
            let pdf = subject.model.pdf(wo, sample.wi);
            assert_eq!(sample.pdf, Density::SolidAngle(pdf), "{}", subject.name);
            let expected = subject.model.eval(wo, sample.wi, TransportMode::Radiance) / pdf;
            let close = (sample.weight - expected).abs().cmple(expected * (4.0 * f64::EPSILON)).all();
            assert!(close, "{}: {} instead of {expected}", subject.name, sample.weight);
            assert_eq!(sample.eta, 1.0);
        });
    }
}

#[test]
fn directions_are_unit_vectors() {
    for subject in subjects() {
        samples(&subject.model, |_, sample| {
            let length = sample.wi.length();
            assert!((length - 1.0).abs() < 4.0 * f64::EPSILON, "{}: {length}", subject.name);
        });
    }
}

/// The closed form, without the lobe: 2π ks |cos θi| / (exponent + 1).
#[test]
fn the_weight_of_a_highlight_is_smooth() {
    for (subject, exponent) in subjects().iter().skip(1).zip(EXPONENTS) {
        samples(&subject.model, |_, sample| {
            let expected = COLOUR * (TAU * sample.wi.z.abs() / (exponent + 1.0));
            let close = (sample.weight - expected).abs().cmple(expected * (16.0 * f64::EPSILON)).all();
            assert!(close, "{}: {} instead of {expected}", subject.name, sample.weight);
        });
    }
}
