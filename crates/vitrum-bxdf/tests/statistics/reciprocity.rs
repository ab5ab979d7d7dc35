//! Helmholtz reciprocity: f = eval / |cos θi| stays the same when light goes the other way.

use crate::stage::{direction, glass, subjects};
use glam::DVec3;
use vitrum_bxdf::TransportMode;
use vitrum_testkit::Uniform;

#[test]
fn light_may_go_either_way() {
    for subject in subjects() {
        let mut uniform = Uniform::new(5);
        let mut nonzero = 0;
        for _ in 0..100_000 {
            let (wo, wi) = (direction(&mut uniform), direction(&mut uniform));
            let there = subject.model.eval(wo, wi, TransportMode::Radiance) / wi.z.abs();
            let back = subject.model.eval(wi, wo, TransportMode::Radiance) / wo.z.abs();
            // One product and one quotient, each rounded; far from the lobe both underflow.
            let tolerance = there * (4.0 * f64::EPSILON) + DVec3::splat(f64::MIN_POSITIVE);
            let close = (there - back).abs().cmple(tolerance).all();
            assert!(close, "{}, {wo} {wi}: {there:?} and {back:?}", subject.name);
            nonzero += u32::from(there.x > 0.0);
        }
        assert!(nonzero > 1000, "{}: only {nonzero} pairs show anything", subject.name);
    }
}

/// Nothing is reflected to the other side, or along the surface.
#[test]
fn sides_do_not_mix() {
    let mut uniform = Uniform::new(6);
    for subject in subjects() {
        for _ in 0..10_000 {
            let wo = direction(&mut uniform);
            let wi = direction(&mut uniform);
            let across = if wo.z * wi.z > 0.0 { -wi } else { wi };
            assert_eq!(subject.model.eval(wo, across, TransportMode::Radiance), DVec3::ZERO);
            assert_eq!(subject.model.pdf(wo, across), 0.0);
            assert_eq!(subject.model.eval(wo, DVec3::X, TransportMode::Radiance), DVec3::ZERO);
            let u = uniform.pair();
            if let Some(sample) = subject.model.sample(wo, 0.5, u, TransportMode::Radiance) {
                assert!(sample.wi.z * wo.z > 0.0);
            }
        }
    }
}

/// A specular crossing is reciprocal up to the squared ratio of the indices, and its ray returns the way it came.
#[test]
fn a_crossing_is_reciprocal_with_the_squared_index() {
    let glass = glass(DVec3::splat(0.1), DVec3::splat(0.9), 1.33, 1.7);
    let mut uniform = Uniform::new(7);
    for _ in 0..10_000 {
        let wo = direction(&mut uniform);
        let Some(there) = glass.split(wo, TransportMode::Radiance).transmitted else { continue };
        let back = glass.split(there.wi, TransportMode::Radiance).transmitted;
        let Some(back) = back else {
            // Only where the refracted ray runs along the surface may rounding close the way back.
            assert!(there.wi.z.abs() < 1e-7, "{wo}");
            continue;
        };
        // Refraction is ill-conditioned along the surface: the error grows as one over the cosines.
        let tolerance = 8.0 * f64::EPSILON / (wo.z.abs() * there.wi.z.abs()).min(1.0);
        assert!((back.wi - wo).length() < tolerance, "{wo} comes back as {}", back.wi);
        assert!((there.weight.x * there.eta * there.eta - 0.9).abs() < 4.0 * f64::EPSILON);
        assert!((there.eta * back.eta - 1.0).abs() < 2.0 * f64::EPSILON);
    }
}
