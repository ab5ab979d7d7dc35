//! How much of the light that falls on a surface comes back.

use crate::stage::{ANGLES, COLOUR, EXPONENTS, at_angle, glass, glossy, lambertian, outgoing, subjects};
use core::f64::consts::TAU;
use glam::DVec3;
use vitrum_bxdf::{Bxdf, PerfectSpecular, Sample, Split, TransportMode};
use vitrum_testkit::{Moments, SphereGrid, Uniform, integrate_sphere, sidak_level, z_test};

/// The share of light from everywhere, red channel.
fn albedo(model: &Bxdf<f64>, wo: DVec3) -> f64 {
    integrate_sphere(|wi| model.eval(wo, wi, TransportMode::Radiance).x, SphereGrid::default())
}

#[test]
fn a_lambertian_surface_returns_its_reflectance_in_every_direction() {
    for (place, wo) in outgoing() {
        let found = albedo(&lambertian(), wo);
        assert!((found - COLOUR.x).abs() < 1e-6, "{place}: {found}");
    }
}

/// At most 2π ks/(exponent + 1), as its page says; and 2π ks/(exponent + 2) along the normal, where the highlight's
/// cosine is the surface's.
#[test]
fn a_highlight_returns_at_most_what_its_page_says() {
    for (subject, exponent) in subjects().iter().skip(1).zip(EXPONENTS) {
        let bound = TAU * COLOUR.x / (exponent + 1.0);
        for (place, wo) in outgoing() {
            let found = albedo(&subject.model, wo);
            assert!(found <= bound, "{}, {place}: {found} of at most {bound}", subject.name);
        }
        let expected = TAU * COLOUR.x / (exponent + 2.0);
        let found = albedo(&subject.model, at_angle(0.0, true));
        assert!((found - expected).abs() < 1e-6, "{}: {found} instead of {expected}", subject.name);
    }
}

/// White furnace: the mean weight of the sampled directions, refusals counting as zero, is the integral of eval.
#[test]
fn the_mean_weight_is_the_albedo() {
    let level = sidak_level(1e-3, 5 * 8);
    for (subject, first_seed) in subjects().iter().zip((2000..).step_by(100)) {
        for (seed, (place, wo)) in (first_seed..).zip(outgoing()) {
            let mut uniform = Uniform::new(seed);
            let weight = |u| {
                let sample = subject.model.sample(wo, 0.5, u, TransportMode::Radiance);
                sample.map_or(0.0, |s| s.weight.x)
            };
            let moments: Moments = (0..400_000).map(|_| weight(uniform.pair())).collect();
            let outcome = z_test(&moments, albedo(&subject.model, wo));
            // Lambert's weight does not vary: what is left is rounding, and the quadrature's error.
            let equal = (outcome.mean - outcome.expected).abs() < 1e-6;
            assert!(equal || outcome.passes(level), "{}, {place}: {outcome}", subject.name);
            assert!(outcome.sigma <= 0.003 * outcome.expected, "{}, {place}: {outcome}", subject.name);
        }
    }
}

/// Specular models: in flux (importance is not scaled by the media's indices) the children carry kr + kt, all of it in
/// total reflection, and one child chosen at random carries as much in the mean.
#[test]
fn specular_children_carry_their_shares() {
    let (kr, kt) = (DVec3::new(0.1, 0.2, 0.0), DVec3::new(0.9, 0.3, 0.05));
    let glass = glass(kr, kt, 1.0, 1.5);
    let mirror = Bxdf::PerfectSpecular(PerfectSpecular::<f64> { kr });
    let mode = TransportMode::Importance;
    for (place, wo) in outgoing() {
        let Split { reflected, transmitted } = glass.split(wo, mode);
        let carried: DVec3 = [reflected, transmitted].into_iter().flatten().map(|s| s.weight).sum();
        let total = transmitted.is_none();
        assert_eq!(carried, if total { DVec3::ONE } else { kr + kt }, "{place}");
        assert_eq!(total, wo.z < 0.0 && wo.z > -(1.0 - 1.0 / 2.25f64).sqrt(), "{place}");
        assert_eq!(mirror.split(wo, mode).reflected.map(|s| s.weight), Some(kr), "{place}");

        let n = 1000;
        let chosen = |i: i32| glass.sample(wo, (f64::from(i) + 0.5) / f64::from(n), [0.5; 2], mode);
        let weights = (0..n).filter_map(chosen).map(|s: Sample<f64>| s.weight);
        let mean = weights.sum::<DVec3>() / f64::from(n);
        // The border between the two children lies inside one of the thousand steps.
        assert!((mean - carried).abs().max_element() < 2.0 / f64::from(n), "{place}: {mean} of {carried}");
    }
}

/// The factor of the media's indices: radiance that goes in and comes out again is what it was.
#[test]
fn radiance_factors_of_entering_and_leaving_cancel() {
    let glass = glass(DVec3::ZERO, DVec3::ONE, 1.0, 1.5);
    for degrees in ANGLES {
        let entering = glass.split(at_angle(degrees, true), TransportMode::Radiance).transmitted;
        let entering = entering.expect("no total reflection from outside");
        // Back the way it came: from the inside, along the refracted ray.
        let leaving = glass.split(entering.wi, TransportMode::Radiance).transmitted;
        let leaving = leaving.expect("the way back is open");
        let round_trip = entering.weight.x * leaving.weight.x;
        assert!((round_trip - 1.0).abs() < 4.0 * f64::EPSILON, "{degrees} degrees: {round_trip}");
    }
}

/// The bound of the highlight is tight enough to say that ks = (exponent + 1)/2π is the most a passive surface can have.
#[test]
fn the_largest_passive_highlight_returns_at_most_everything() {
    for exponent in EXPONENTS {
        let Bxdf::GlossySpecular(mut model) = glossy(exponent) else { unreachable!("it is a highlight") };
        model.peak = DVec3::splat((exponent + 1.0) / TAU);
        for (place, wo) in outgoing() {
            let found = albedo(&Bxdf::GlossySpecular(model), wo);
            assert!(found <= 1.0, "exponent {exponent}, {place}: {found}");
        }
    }
}
