//! Refraction and reflectance against 256-bit arithmetic: how many digits are right, also next to the critical angle and
//! for indices that nearly match. The pair of indices and the cosine are taken as exact, each in the precision of the model.
//!
//! The thresholds are those of a survey of renderers' forms of these equations; the usual forms miss them by factors of
//! 10³ (in f64) to 10⁷ (in f32).

mod exact;

use exact::{critical_cosine, truth};
use glam::{DVec3, Vec3};
use vitrum_bxdf::{FresnelDielectric, Interface, Real, Refraction, TransportMode, Vector};
use vitrum_testkit::Uniform;

/// Index pairs, each taken in both directions: air against something, and glass in water.
const PAIRS: [(f64, f64); 6] =
    [(1.0, 1.0001), (1.0, 1.0003), (1.33, 1.5), (1.0, 1.5), (1.0, 2.42), (1.0, 4.0)];

/// The same in both directions.
fn directed_pairs() -> impl Iterator<Item = (f64, f64)> {
    PAIRS.into_iter().flat_map(|(a, b)| [(a, b), (b, a)])
}

/// The largest errors of one direction of travel.
#[derive(Debug, Default)]
struct Errors {
    cos_t_relative: f64,
    reflectance_relative: f64,
    reflectance_absolute: f64,
}

/// Number `steps` further along the positive numbers of this precision.
fn neighbour<R: Real>(x: R, steps: i64) -> R {
    if size_of::<R>() == 4 {
        let bits = i64::from((x.to_f64() as f32).to_bits()) + steps;
        R::from_f64(f64::from(f32::from_bits(u32::try_from(bits).expect("a positive number"))))
    } else {
        R::from_f64(f64::from_bits(
            x.to_f64().to_bits().checked_add_signed(steps).expect("a positive number"),
        ))
    }
}

/// Cosines from 0 to 1: evenly, towards zero, and towards the critical one from both sides, down to its neighbours.
fn cosines<R: Real>(n_i: R, n_t: R) -> Vec<R> {
    let mut cosines: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
    cosines.extend((1..60).map(|i| libm::exp2(-f64::from(i))));
    let mut exact: Vec<R> = Vec::new();
    if n_i > n_t {
        let critical = critical_cosine(n_i.to_f64(), n_t.to_f64()).to_f64();
        for i in 0..80 {
            let offset = 1e-7 * libm::exp2(-f64::from(i) / 3.0);
            cosines.extend([critical - offset, critical + offset]);
        }
        cosines.extend((0..60).flat_map(|i| {
            let offset = libm::exp2(-f64::from(i) / 2.0);
            [critical - offset, critical + offset]
        }));
        exact.extend((-4..=4).map(|steps| neighbour(R::from_f64(critical), steps)));
    }
    let inside = cosines.into_iter().filter(|c| (0.0..=1.0).contains(c));
    exact.into_iter().chain(inside.map(R::from_f64)).collect()
}

fn errors<R: Real>(n_i: f64, n_t: f64) -> Errors {
    let (n_i, n_t) = (R::from_f64(n_i), R::from_f64(n_t));
    let interface = Interface::new(n_i, n_t).expect("both are indices");
    let mut errors = Errors::default();
    for c in cosines(n_i, n_t) {
        let at = format!("{n_i:?} to {n_t:?} at {c:?}");
        let truth = truth(n_i.to_f64(), n_t.to_f64(), c.to_f64());
        let wo = R::Vec3::new((R::one() - c * c).sqrt(), R::zero(), c);
        let found = interface.reflectance(c).unpolarised().to_f64();
        assert!((0.0..=1.0).contains(&found), "{at}: reflects {found}");
        match (interface.refract(wo), truth.cos_t) {
            (Refraction::TotalInternalReflection, None) => assert_eq!(found, 1.0, "{at}"),
            (Refraction::Refracted { cos_t, .. }, Some(expected)) => {
                let error = expected.relative_error_of(cos_t.to_f64());
                errors.cos_t_relative = errors.cos_t_relative.max(error);
                let error = truth.reflectance.relative_error_of(found);
                errors.reflectance_relative = errors.reflectance_relative.max(error);
                let error = truth.reflectance.absolute_error_of(found);
                errors.reflectance_absolute = errors.reflectance_absolute.max(error);
            }
            (found, expected) => panic!("{at}: {found:?}, but total reflection is {}", expected.is_none()),
        }

        // The shares that a ray tree follows.
        let split = FresnelDielectric { interface }.split(wo, TransportMode::Importance);
        let share =
            |child: Option<vitrum_bxdf::Sample<R>>| child.map_or(R::zero(), |sample| sample.weight.x());
        let sum = share(split.reflected) + share(split.transmitted);
        assert!((sum - R::one()).abs() <= R::epsilon(), "{at}: shares sum to {sum:?}");
    }
    errors
}

#[test]
fn doubles_are_right_to_the_fourteenth_digit() {
    for (n_i, n_t) in directed_pairs() {
        let Errors { cos_t_relative, reflectance_relative, .. } = errors::<f64>(n_i, n_t);
        println!("f64, {n_i} to {n_t}: cos θt {cos_t_relative:.1e}, R {reflectance_relative:.1e}, relative");
        assert!(cos_t_relative <= 1e-14 && reflectance_relative <= 1e-13, "{n_i} to {n_t}");
    }
}

#[test]
fn singles_are_right_to_the_sixth_digit() {
    for (n_i, n_t) in directed_pairs() {
        let Errors { cos_t_relative, reflectance_absolute, .. } = errors::<f32>(n_i, n_t);
        println!(
            "f32, {n_i} to {n_t}: cos θt {cos_t_relative:.1e} relative, R {reflectance_absolute:.1e} absolute"
        );
        assert!(cos_t_relative <= 4e-7 && reflectance_absolute <= 5e-7, "{n_i} to {n_t}");
    }
}

/// Ratios from a thousandth to a thousand, random pairs too: the same thresholds.
#[test]
fn they_are_so_for_ratios_from_a_thousandth_to_a_thousand() {
    let mut uniform = Uniform::new(41);
    for _ in 0..16 {
        let ratio = libm::pow(10.0, 6.0 * uniform.number() - 3.0);
        let n_i = libm::pow(10.0, uniform.number() - 0.5);
        let double = errors::<f64>(n_i, n_i * ratio);
        let Errors { cos_t_relative, reflectance_relative, .. } = double;
        assert!(cos_t_relative <= 1e-14 && reflectance_relative <= 1e-13, "{ratio}: {double:?}");
        let single = errors::<f32>(n_i, n_i * ratio);
        let Errors { cos_t_relative, reflectance_absolute, .. } = single;
        assert!(cos_t_relative <= 4e-7 && reflectance_absolute <= 5e-7, "{ratio}: {single:?}");
    }
}

/// Right at the critical angle, for thousands of pairs: the cosine of refraction there is the root of what is left of a
/// double after the critical cosine is taken away, and that can be as small as the next hundred bits of it.
#[test]
fn the_neighbours_of_the_critical_angle_are_exact_for_any_pair() {
    let mut uniform = Uniform::new(43);
    let mut worst = 0.0_f64;
    for _ in 0..4000 {
        let n_i = 1.0 + 1.5 * uniform.number();
        let n_t = n_i * libm::pow(uniform.number(), 0.3);
        if n_t < 1e-3 * n_i {
            continue;
        }
        let interface = Interface::new(n_i, n_t).expect("both are indices");
        let critical = critical_cosine(n_i, n_t).to_f64();
        for steps in -1..=1 {
            let c = neighbour(critical, steps);
            let wo = DVec3::new((1.0 - c * c).max(0.0).sqrt(), 0.0, c);
            match (interface.refract(wo), truth(n_i, n_t, c).cos_t) {
                (Refraction::TotalInternalReflection, None) => {}
                (Refraction::Refracted { cos_t, .. }, Some(expected)) => {
                    worst = worst.max(expected.relative_error_of(cos_t));
                }
                (found, _) => panic!("{n_i} to {n_t} at {c}: {found:?}"),
            }
        }
    }
    println!("cos θt next to critical: {worst:.1e} relative");
    assert!(worst <= 1e-15, "{worst}");
}

/// Nearly matched pairs, down to one unit in the last place: reflectance and deflection go to zero without a step.
#[test]
fn nearly_matched_pairs_are_as_accurate() {
    for exponent in (5..=52).step_by(3) {
        let n = 1.0 + libm::exp2(-f64::from(exponent));
        for (n_i, n_t) in [(1.0, n), (n, 1.0)] {
            let double = errors::<f64>(n_i, n_t);
            assert!(double.cos_t_relative <= 1e-14 && double.reflectance_relative <= 1e-13, "{n_i} to {n_t}");
            if exponent <= 23 {
                let single = errors::<f32>(n_i, n_t);
                assert!(
                    single.cos_t_relative <= 4e-7 && single.reflectance_absolute <= 5e-7,
                    "{n_i} to {n_t}"
                );
            }
        }
    }
}

/// |n_i sin θi − n_t sin θt| in units in the last place of the first, and how far the refracted ray leaves the plane of
/// incidence.
#[test]
fn the_refracted_ray_obeys_snell_in_the_plane_of_incidence() {
    let mut uniform = Uniform::new(42);
    for (n_i, n_t) in directed_pairs() {
        let interface = Interface::new(n_i, n_t).expect("both are indices");
        for _ in 0..20_000 {
            let (z, phi) = (uniform.number(), core::f64::consts::TAU * uniform.number());
            let (sin_phi, cos_phi) = libm::sincos(phi);
            let sin = (1.0 - z * z).sqrt();
            let wo = DVec3::new(sin * cos_phi, sin * sin_phi, z);
            let Refraction::Refracted { wt, .. } = interface.refract(wo) else { continue };
            let incident = n_i * libm::hypot(wo.x, wo.y);
            let residual = incident - n_t * libm::hypot(wt.x, wt.y);
            let unit_in_the_last_place = incident.next_up() - incident;
            assert!(residual.abs() <= 4.0 * unit_in_the_last_place, "{n_i} to {n_t}, {wo}: {residual}");
            let out_of_plane = wo.x * wt.y - wo.y * wt.x;
            assert!(out_of_plane.abs() <= 1e-15, "{n_i} to {n_t}, {wo}: {out_of_plane}");
        }
    }
}

/// The same interface in single precision, through the vectors of glam.
#[test]
fn single_precision_vectors_refract_alike() {
    let interface = Interface::new(1.0_f32, 1.5).expect("both are indices");
    let Refraction::Refracted { wt, .. } = interface.refract(Vec3::new(0.6, 0.0, 0.8)) else {
        panic!("never total")
    };
    assert!((wt - Vec3::new(-0.4, 0.0, -(0.84_f32.sqrt()))).length() < 2.0 * f32::EPSILON);
}
