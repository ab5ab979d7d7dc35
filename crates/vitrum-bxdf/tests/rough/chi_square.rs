//! The directions that a model samples follow the density that it claims: Pearson's chi-square, with what it refuses as one
//! more cell, on both sides, in both modes of transport, from along the normal to along the surface.
//!
//! Wide lobes are counted in cells of the sphere of directions. For narrow ones (roughness below 0.05, indices that nearly
//! match, or a direction along the surface) cells of directions tell nothing, so they are counted in the space of slopes: a
//! direction is replaced by the microscopic normal that leads to it, stretched by the roughness, and that by the direction
//! that it mirrors the stretched `wo` to. There visible normals are spread evenly over a cap of the sphere, which is laid
//! out on the upper hemisphere for reflection and on the lower one for transmission, its rim around the poles, where what
//! falls on the wrong side of the surface is. The Jacobians of these steps are
//! written down here anew (Walter and others 2007, equations 14 and 17; Dupuy and Benyoub 2023).
#![expect(clippy::print_stdout, reason = "the p-values, for people who ask to see them")]

use crate::stage::{at_angle, ggx, glass, interface, metal};
use glam::{DVec3, Vec3};
use vitrum_bxdf::{
    Bxdf, ComplexIndex, Conductor, Ggx, Interface, Refraction, RoughDielectric, TransportMode,
};
use vitrum_testkit::{ChiSquare, SphereGrid, Uniform, chi_square_of_directions, sidak_level};

/// All tests of this file together blame a right model once in a thousand seeds.
const LEVEL: f64 = 1e-3;

/// The number of tests in this file.
const TESTS: u32 = 296;

const SAMPLES: u64 = 100_000;

/// Degrees from the normal where lobes are wide, and all of them.
const STEEP: [f64; 3] = [0.0, 40.0, 80.0];
const ALL: [f64; 4] = [0.0, 40.0, 80.0, 89.99];

const MODES: [TransportMode; 2] = [TransportMode::Radiance, TransportMode::Importance];

fn judge(name: &str, outcome: &ChiSquare) {
    println!("{name}: {outcome}");
    // With what is refused the density integrates to one: to five sigma, and what quadrature misses at the rims.
    let refused = outcome.refused as f64 / outcome.samples as f64;
    let sigma = (refused * (1.0 - refused) / outcome.samples as f64).sqrt();
    assert!((outcome.integral + refused - 1.0).abs() <= 5.0 * sigma + 3e-4, "{name}: {outcome}");
    assert!(outcome.passes(sidak_level(LEVEL, TESTS)), "{name}: {outcome}");
}

/// Runs a test from these angles, on both sides, in both modes, each with its own seed.
fn everywhere(angles: &[f64], first_seed: u64, mut test: impl FnMut(String, DVec3, TransportMode, u64)) {
    let places = angles.iter().flat_map(|&angle| [(angle, true), (angle, false)]);
    let cases = places.flat_map(|place| MODES.map(|mode| (place, mode)));
    for (seed, ((angle, above), mode)) in (first_seed..).zip(cases) {
        let side = if above { "above" } else { "below" };
        test(format!("{angle} degrees {side}, {mode:?}"), at_angle(angle, above), mode, seed);
    }
}

/// In cells of directions.
fn by_direction(name: &str, model: &Bxdf<f64>, cells: SphereGrid, seed: u64) {
    everywhere(&STEEP, seed, |place, wo, mode, seed| {
        let sample = |uniform: &mut Uniform| {
            let (uc, u) = (uniform.number(), uniform.pair());
            Some(model.sample(wo, uc, u, mode)?.wi)
        };
        let outcome = chi_square_of_directions(sample, |wi| model.pdf(wo, wi), cells, SAMPLES, seed);
        judge(&format!("{name}, {place}"), &outcome);
    });
}

/// In cells of stretched normals. `interface` is none for a metal.
fn by_slope(
    name: &str,
    model: &Bxdf<f64>,
    alphas: [f64; 2],
    interface: Option<Interface<f64>>,
    angles: &[f64],
    seed: u64,
) {
    let stretch = DVec3::new(alphas[0], alphas[1], 1.0);
    everywhere(angles, seed, |place, wo, mode, seed| {
        // As if seen from above.
        let turned = |w: DVec3| if wo.z < 0.0 { DVec3::new(w.x, w.y, -w.z) } else { w };
        let out = turned(wo);
        let stretched_out = (out * stretch).normalize();
        let cap = 1.0 + stretched_out.z;
        let eta = interface.map_or(1.0, |i| if wo.z >= 0.0 { i.eta() } else { 1.0 / i.eta() });
        // A direction with this z and the azimuth of `like`.
        let with_height = |z: f64, like: DVec3| {
            let radius = (1.0 - z * z).max(0.0).sqrt();
            let across = DVec3::new(like.x, like.y, 0.0).normalize_or(DVec3::X);
            across * radius + DVec3::Z * z
        };
        let to_cell = |wi: DVec3| {
            let wi = turned(wi);
            let half = if wi.z > 0.0 { out + wi } else { out + wi * eta };
            let m = if half.z > 0.0 { half } else { -half };
            let m = (m / stretch).normalize();
            let mirrored = m * (2.0 * m.dot(stretched_out)) - stretched_out;
            let height = (1.0 - mirrored.z) / cap;
            let upper = with_height(height.clamp(1e-15, 1.0), mirrored);
            if wi.z > 0.0 { upper } else { DVec3::new(upper.x, upper.y, -upper.z) }
        };
        let density = |cell: DVec3| {
            let mirrored = with_height(1.0 - cell.z.abs() * cap, cell);
            let m = (mirrored + stretched_out).normalize();
            let from_mirrored = cap / (4.0 * m.dot(stretched_out));
            let stretched = m * stretch;
            let m = stretched.normalize();
            let from_stretched = stretch.x * stretch.y / stretched.length().powi(3);
            let cos = out.dot(m);
            let (wi, from_normal) = if cell.z > 0.0 {
                (m * (2.0 * cos) - out, 4.0 * cos)
            } else {
                let sin_squared = (1.0 - cos * cos) / (eta * eta);
                if sin_squared >= 1.0 {
                    return 0.0;
                }
                let cos_t = (1.0 - sin_squared).sqrt();
                let wi = m * (cos / eta - cos_t) - out / eta;
                (wi, (out + wi * eta).length_squared() / (eta * eta * cos_t))
            };
            if (wi.z > 0.0) != (cell.z > 0.0) || cos <= 0.0 {
                return 0.0;
            }
            model.pdf(wo, turned(wi).normalize()) * from_normal * from_stretched * from_mirrored
        };
        let sample = |uniform: &mut Uniform| {
            let (uc, u) = (uniform.number(), uniform.pair());
            Some(to_cell(model.sample(wo, uc, u, mode)?.wi))
        };
        let outcome = chi_square_of_directions(sample, density, SphereGrid::default(), SAMPLES, seed);
        judge(&format!("{name} by slope, {place}"), &outcome);
    });
}

/// A lobe of roughness 0.05 is six degrees wide.
fn cells(alphas: [f64; 2]) -> SphereGrid {
    if alphas[0].min(alphas[1]) < 0.1 { SphereGrid { theta: 90, phi: 180 } } else { SphereGrid::default() }
}

/// Rough glass under air, by direction and, along the surface, by slope.
fn glass_both_ways(n: f64, alphas: [f64; 2], seed: u64) {
    let (name, model) = (format!("index {n}, {alphas:?}"), Bxdf::RoughDielectric(glass(1.0, n, alphas)));
    by_direction(&name, &model, cells(alphas), seed);
    by_slope(&name, &model, alphas, Some(interface(1.0, n)), &[89.99], seed + 50);
}

#[test]
fn isotropic_glass() {
    for (alpha, seed) in [0.05, 0.2, 0.6, 1.0].into_iter().zip((100..).step_by(100)) {
        glass_both_ways(1.5, [alpha; 2], seed);
    }
}

#[test]
fn anisotropic_glass() {
    for (alphas, seed) in [[0.1, 0.5], [0.9, 0.3]].into_iter().zip((1000..).step_by(100)) {
        glass_both_ways(2.42, alphas, seed);
    }
}

#[test]
fn nearly_smooth_glass() {
    for (alphas, seed) in [[1e-3, 1e-3], [0.01, 0.01], [1e-3, 0.04]].into_iter().zip((2000..).step_by(100)) {
        let model = Bxdf::RoughDielectric(glass(1.0, 1.5, alphas));
        by_slope(&format!("glass {alphas:?}"), &model, alphas, Some(interface(1.0, 1.5)), &ALL, seed);
    }
}

/// Indices that nearly match deflect by next to nothing, whatever the roughness.
#[test]
fn nearly_matched_glass() {
    let cases = [(1.0003, [0.3, 0.3]), (1.01, [0.8, 0.2])];
    for ((n, alphas), seed) in cases.into_iter().zip((3000..).step_by(100)) {
        let model = Bxdf::RoughDielectric(glass(1.0, n, alphas));
        by_slope(&format!("index {n} {alphas:?}"), &model, alphas, Some(interface(1.0, n)), &ALL, seed);
    }
}

/// Both ways of counting agree where both can be used.
#[test]
fn wide_lobes_by_slope_too() {
    let model = Bxdf::RoughDielectric(glass(1.0, 1.5, [0.3, 0.7]));
    by_slope("glass [0.3, 0.7]", &model, [0.3, 0.7], Some(interface(1.0, 1.5)), &ALL, 4000);
}

#[test]
fn metal_of_any_roughness() {
    for (alphas, seed) in [[0.15, 0.15], [1.0, 1.0], [0.2, 0.6]].into_iter().zip((5000..).step_by(100)) {
        let (name, model) = (format!("metal {alphas:?}"), Bxdf::Conductor(metal(alphas)));
        by_direction(&name, &model, cells(alphas), seed);
        by_slope(&name, &model, alphas, None, &[89.99], seed + 50);
    }
    for (alphas, seed) in [[1e-3, 1e-3], [0.002, 0.03]].into_iter().zip((5500..).step_by(100)) {
        by_slope(&format!("metal {alphas:?}"), &Bxdf::Conductor(metal(alphas)), alphas, None, &ALL, seed);
    }
}

/// Single precision follows the density of double precision.
#[test]
fn single_precision() {
    let alphas = [0.2, 0.4];
    let single_ggx = Ggx::new(0.2_f32, 0.4).expect("both are roughnesses");
    let interface = Interface::new(1.0_f32, 1.5).expect("both are indices");
    let index = ComplexIndex::new(Vec3::splat(0.5), Vec3::splat(3.0), 1.0).expect("it is a metal");
    let glasses = (
        Bxdf::RoughDielectric(RoughDielectric::new(interface, single_ggx)),
        Bxdf::RoughDielectric(glass(1.0, 1.5, alphas)),
    );
    let metals = (
        Bxdf::Conductor(Conductor { index, roughness: single_ggx }),
        Bxdf::Conductor(Conductor { roughness: ggx(alphas), ..metal(alphas) }),
    );
    for ((name, (single, double)), first) in
        [("glass", glasses), ("metal", metals)].into_iter().zip([6000, 6100])
    {
        everywhere(&STEEP, first, |place, wo, mode, seed| {
            let sample = |uniform: &mut Uniform| {
                // Numbers that f32 holds and that stay below one.
                let [uc, u, v] =
                    [0; 3].map(|_| (uniform.number() * 16_777_216.0).floor() as f32 / 16_777_216.0);
                Some(single.sample(wo.as_vec3(), uc, [u, v], mode)?.wi.as_dvec3())
            };
            let density = |wi| double.pdf(wo, wi);
            let outcome = chi_square_of_directions(sample, density, SphereGrid::default(), SAMPLES, seed);
            judge(&format!("{name} in f32, {place}"), &outcome);
        });
    }
}

/// The test's own refraction is the crate's.
#[test]
fn the_slope_space_refracts_as_the_interface_does() {
    let Refraction::Refracted { wt, .. } = interface(1.0, 1.5).refract(DVec3::new(0.6, 0.0, 0.8)) else {
        panic!("never total")
    };
    let (cos, eta): (f64, f64) = (0.8, 1.5);
    let cos_t = (1.0 - (1.0 - cos * cos) / (eta * eta)).sqrt();
    let expected = DVec3::Z * (cos / eta - cos_t) - DVec3::new(0.6, 0.0, 0.8) / eta;
    assert!((wt - expected).length() < 4.0 * f64::EPSILON);
}
