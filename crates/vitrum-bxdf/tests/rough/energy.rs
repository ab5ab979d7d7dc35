//! White furnace: what comes out when the same light comes from everywhere.
//!
//! Albedos are means over evenly spread samples, whose error falls about as one over their number. A mean that is not close
//! to what is expected is taken again over thirty-two times as many.
#![expect(clippy::print_stdout, reason = "the case furthest from one, for people who ask to see it")]

use crate::stage::{at_angle, even, glass, metal, single};
use glam::DVec3;
use vitrum_bxdf::{ComplexIndex, Conductor, RoughDielectric, TransportMode};
use vitrum_testkit::{SphereGrid, integrate_sphere};

const ALPHAS: [f64; 10] = [1e-3, 0.01, 0.03, 0.07, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0];

/// Degrees from the normal, with the critical angles of 2.42 and 1.5.
const ANGLES: [f64; 13] = [0.0, 12.0, 24.4, 30.0, 41.8, 50.0, 60.0, 70.0, 77.0, 84.0, 88.5, 89.7, 89.99];

/// Where compensation is promised in full.
const RATIOS: [f64; 8] = [1.1, 1.128, 1.2, 1.33, 1.5, 1.7, 2.0, 2.42];

/// Where it is not: indices that nearly match.
const NEARLY_MATCHED: [f64; 4] = [1.0003, 1.01, 1.03, 1.06];

/// What a sample carries, less the radiance factor: 1/eta² where it crosses.
fn carried(model: &RoughDielectric<f64>, wo: DVec3, [uc, u, v]: [f64; 3]) -> f64 {
    let sample = model.sample(wo, uc, [u, v], TransportMode::Radiance);
    sample.map_or(0.0, |sample| sample.weight.x * sample.eta * sample.eta)
}

/// The mean over evenly spread points, to about `enough`.
fn mean<const D: usize>(points: u32, enough: f64, value: impl Fn([f64; D]) -> f64) -> f64 {
    let over = |points: u32| even(points).map(&value).sum::<f64>() / f64::from(points);
    let first = over(points);
    if (first - 1.0).abs() <= enough { first } else { over(32 * points) }
}

/// The share of light from everywhere that leaves towards `wo`.
fn albedo(model: &RoughDielectric<f64>, wo: DVec3) -> f64 {
    mean(1 << 13, 4e-3, |point| carried(model, wo, point))
}

/// 2 ∫ albedo(μ) μ dμ on one side.
fn mean_albedo(model: &RoughDielectric<f64>, side: f64) -> f64 {
    mean(1 << 14, 7e-4, |[uc, u, v, w]| {
        carried(model, DVec3::new((1.0 - w).sqrt(), 0.0, side * w.sqrt()), [uc, u, v])
    })
}

/// The case that is furthest from one.
struct Worst {
    albedo: f64,
    name: String,
}

impl Worst {
    fn new() -> Self {
        Self { albedo: 1.0, name: "none".to_owned() }
    }

    fn see(&mut self, albedo: f64, name: impl FnOnce() -> String) {
        if (albedo - 1.0).abs() > (self.albedo - 1.0).abs() {
            *self = Self { albedo, name: name() };
        }
    }

    fn within(&self, tolerance: f64) {
        println!("furthest from one, of at most {tolerance}: {} for {}", self.albedo, self.name);
        assert!((self.albedo - 1.0).abs() <= tolerance, "{} for {}", self.albedo, self.name);
    }
}

#[test]
fn compensated_glass_keeps_all_light_at_every_angle() {
    let mut worst = Worst::new();
    for ratio in RATIOS {
        for alpha in ALPHAS {
            let model = glass(1.0, ratio, [alpha; 2]);
            for (degrees, above) in ANGLES.into_iter().flat_map(|angle| [(angle, true), (angle, false)]) {
                worst.see(albedo(&model, at_angle(degrees, above)), || {
                    format!("ratio {ratio}, roughness {alpha}, {degrees} degrees, above: {above}")
                });
            }
        }
    }
    worst.within(5e-3);
}

#[test]
fn compensated_glass_keeps_all_light_on_average() {
    let mut worst = Worst::new();
    for ratio in RATIOS {
        for alpha in ALPHAS {
            let model = glass(1.0, ratio, [alpha; 2]);
            for side in [1.0, -1.0] {
                worst.see(mean_albedo(&model, side), || {
                    format!("ratio {ratio}, roughness {alpha}, side {side}")
                });
            }
        }
    }
    worst.within(1e-3);
}

/// Indices that nearly match: from the denser side, near the surface, single scattering is all but gone, and the factor is
/// limited. There a loss remains; on average it is small, and nowhere is there a gain.
#[test]
fn nearly_matched_glass_keeps_almost_all() {
    let (mut average, mut gain) = (Worst::new(), Worst::new());
    for ratio in NEARLY_MATCHED {
        for alpha in [0.03, 0.3, 0.7, 1.0] {
            let model = glass(1.0, ratio, [alpha; 2]);
            for side in [1.0, -1.0] {
                average.see(mean_albedo(&model, side), || {
                    format!("ratio {ratio}, roughness {alpha}, side {side}")
                });
                for degrees in ANGLES {
                    let albedo = albedo(&model, at_angle(degrees, side > 0.0)).max(1.0);
                    gain.see(albedo, || {
                        format!("ratio {ratio}, roughness {alpha}, {degrees} degrees, side {side}")
                    });
                }
            }
        }
    }
    average.within(2e-3);
    gain.within(1.5e-2);
}

/// Below one, not only on average: no sample carries more than it had.
#[test]
fn without_compensation_nothing_is_gained() {
    for ratio in RATIOS.into_iter().chain(NEARLY_MATCHED).chain([4.0, 100.0]) {
        for alphas in [[1e-3, 1e-3], [0.1, 0.1], [0.5, 0.5], [1.0, 1.0], [0.05, 0.9]] {
            let model = single(1.0, ratio, alphas);
            for (degrees, above) in ANGLES.into_iter().flat_map(|angle| [(angle, true), (angle, false)]) {
                for point in even(500) {
                    let carried = carried(&model, at_angle(degrees, above), point);
                    assert!(carried <= 1.0 + 1e-12, "{ratio}, {alphas:?}, {degrees}, {above}: {carried}");
                }
            }
        }
    }
}

/// The mean weight of samples is the integral of `eval`, at a tolerance that the quadrature over the sphere allows.
#[test]
fn the_mean_weight_is_the_integral_of_eval() {
    let wide = SphereGrid { theta: 60, phi: 120 };
    for (n, alphas) in [(1.5, [0.3, 0.3]), (1.5, [1.0, 1.0]), (2.42, [0.2, 0.7])] {
        for model in [glass(1.0, n, alphas), single(1.0, n, alphas)] {
            for (degrees, above) in [(0.0, true), (50.0, true), (80.0, true), (0.0, false), (60.0, false)] {
                let wo = at_angle(degrees, above);
                let eta = if above { n } else { 1.0 / n };
                let value = |wi: DVec3| {
                    let scale = if (wi.z > 0.0) == above { 1.0 } else { eta * eta };
                    model.eval(wo, wi, TransportMode::Radiance).x * scale
                };
                let integral = integrate_sphere(value, wide);
                let points = 1 << 18;
                let sampled =
                    even(points).map(|point| carried(&model, wo, point)).sum::<f64>() / f64::from(points);
                assert!(
                    (integral - sampled).abs() < 1e-3,
                    "{n}, {alphas:?}, {degrees}, {above}: {integral} and {sampled}"
                );
            }
        }
    }
}

/// Beyond the table's ratio nothing is made up for, and the constructor says so.
#[test]
fn the_table_ends_at_two_and_a_half() {
    for (above, below, compensated) in
        [(1.0, 2.5, true), (2.5, 1.0, true), (1.0, 2.6, false), (2.6, 1.0, false), (1.33, 3.0, true)]
    {
        assert_eq!(glass(above, below, [0.5; 2]).is_compensated(), compensated, "{above} over {below}");
    }
    assert!(!single(1.0, 1.5, [0.5; 2]).is_compensated());
}

/// Roughness that differs by direction is compensated as its mean: not exact, not far off, and nothing is gained.
#[test]
fn anisotropic_glass_keeps_most_of_its_light() {
    for (alphas, most_lost) in
        [([0.2, 0.3], 2e-3), ([0.1, 0.4], 0.025), ([1.0, 0.3], 0.035), ([0.05, 0.8], 0.08)]
    {
        let model = glass(1.0, 1.5, alphas);
        for side in [1.0, -1.0] {
            let mean = mean(1 << 14, 2e-3, |[uc, u, v, w, azimuth]| {
                let (sin, cos) = libm::sincos(core::f64::consts::TAU * azimuth);
                let r = (1.0 - w).sqrt();
                carried(&model, DVec3::new(r * cos, r * sin, side * w.sqrt()), [uc, u, v])
            });
            println!("roughness {alphas:?}, side {side}: {mean}");
            assert!(
                (1.0 - most_lost..=1.0 + 1e-3).contains(&mean),
                "roughness {alphas:?}, side {side}: {mean}"
            );
        }
    }
}

/// A metal of reflectance one loses what is reflected more than once, and gains nothing.
#[test]
fn metal_loses_what_its_manual_says() {
    let (n, k) = (DVec3::splat(1e-3), DVec3::splat(1e3));
    let index = ComplexIndex::new(n, k, 1.0).expect("it is a perfect metal, nearly");
    let mut most_lost = 0.0_f64;
    for alphas in [[0.01, 0.01], [0.3, 0.3], [1.0, 1.0], [0.1, 0.6]] {
        let model = Conductor { index, ..metal(alphas) };
        for degrees in ANGLES {
            let sum: f64 = even(4096)
                .filter_map(|u| model.sample(at_angle(degrees, true), u))
                .map(|sample| sample.weight.x)
                .sum();
            let albedo = sum / 4096.0;
            assert!(albedo <= 1.0, "{alphas:?}, {degrees} degrees: {albedo}");
            most_lost = most_lost.max(1.0 - albedo);
        }
    }
    println!("most lost: {most_lost}");
    assert!((0.6..0.7).contains(&most_lost), "{most_lost}");
}
