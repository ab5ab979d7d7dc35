//! Where rough becomes smooth: at small roughness, and where indices match.

use crate::stage::{at_angle, direction_in, even, glass, interface, mean_over_normals, metal, single};
use glam::DVec3;
use vitrum_bxdf::{Bxdf, Density, FresnelDielectric, Ggx, Interface, RoughDielectric, Sample, TransportMode};

const MODE: TransportMode = TransportMode::Radiance;

/// What a scene shows behind the surface: smooth, and different everywhere.
fn sky(w: DVec3) -> f64 {
    1.0 + 0.9 * libm::sin(6.0 * w.x + 3.0 * w.y + 2.0 * w.z)
}

fn arrives(sample: Option<Sample<f64>>) -> f64 {
    sample.map_or(0.0, |sample| sample.weight.x * sky(sample.wi))
}

/// The light that arrives from `wo` through rough glass.
fn seen(model: &RoughDielectric<f64>, wo: DVec3, normals: u32) -> f64 {
    mean_over_normals(model, wo, normals, arrives)
}

/// The same of a smooth model.
fn seen_by_splitting(model: &Bxdf<f64>, wo: DVec3) -> f64 {
    let split = model.split(wo, MODE);
    arrives(split.reflected) + arrives(split.transmitted)
}

/// The mean square distance between rough and smooth children, which bounds the difference under any smooth sky, falls with
/// the square of the roughness times its logarithm: the second moment of GGX's slopes grows with the logarithm of where
/// one stops to count.
#[test]
fn small_roughness_tends_to_smooth_glass() {
    let smooth = FresnelDielectric { interface: interface(1.0, 1.5) };
    for wo in [at_angle(5.0, true), at_angle(40.0, true), at_angle(70.0, true), at_angle(15.0, false)] {
        let split = smooth.split(wo, MODE);
        let [reflected, transmitted] =
            [split.reflected, split.transmitted].map(|child| child.expect("both").wi);
        let spreads = [0.02, 0.01, 0.005].map(|alpha| {
            mean_over_normals(&glass(1.0, 1.5, [alpha; 2]), wo, 1 << 17, |sample| {
                sample.map_or(0.0, |sample| {
                    let limit = if sample.lobe.is_transmission() { transmitted } else { reflected };
                    (sample.wi - limit).length_squared()
                })
            })
        });
        let orders: Vec<f64> = spreads.windows(2).map(|pair| libm::log2(pair[0] / pair[1])).collect();
        println!("{wo:.2}: mean squares {spreads:?}, orders {orders:.2?}");
        assert!(orders.into_iter().all(|order| (1.6..2.0).contains(&order)), "{wo}: {spreads:?}");
    }
}

/// On both sides of the switch the picture is the same, up to its α² = 1e-8 and what evenly spread normals of a
/// distribution with long tails miss.
#[test]
fn the_switch_to_smooth_is_continuous() {
    let alphas = [1.000_001e-4, 0.999_999e-4];
    for wo in [at_angle(10.0, true), at_angle(70.0, true), at_angle(30.0, false), at_angle(80.0, false)] {
        for model in [glass, single] {
            let [rough, smooth] = alphas.map(|alpha| model(1.0, 1.5, [alpha; 2]));
            assert!(!rough.is_specular() && smooth.is_specular());
            let smooth = seen_by_splitting(&Bxdf::RoughDielectric(smooth), wo);
            let rough = seen(&rough, wo, 1 << 16);
            assert!((rough - smooth).abs() < 1e-5, "{wo}: {rough} and {smooth}");
        }
        let [rough, smooth] = alphas.map(|alpha| metal([alpha; 2]));
        assert!(!rough.is_specular() && smooth.is_specular());
        let sum: f64 = even(1 << 16).map(|u| arrives(rough.sample(wo, u))).sum();
        let (rough, smooth) = (sum / 65_536.0, seen_by_splitting(&Bxdf::Conductor(smooth), wo));
        assert!((rough - smooth).abs() < 1e-5, "{wo}: {rough} and {smooth}");
    }
}

/// Indices that come closer and closer: what is seen tends to what would be seen without the surface, and the switch to
/// discrete densities is not seen.
#[test]
fn matching_indices_make_rough_glass_vanish() {
    let wo = at_angle(40.0, true);
    let nothing = sky(-wo);
    for exponent in 2..52 {
        let n = 1.0 + libm::exp2(-f64::from(exponent));
        let model = glass(1.0, n, [0.4; 2]);
        let seen = if model.is_specular() {
            seen_by_splitting(&Bxdf::RoughDielectric(model), wo)
        } else {
            seen(&model, wo, 1 << 12)
        };
        // The deflection and the reflected share are of the order of n − 1 (the sky's slope is 6); compensation is good to 1e-3.
        assert!((seen - nothing).abs() < 12.0 * (n - 1.0) + 1e-3, "{n}: {seen} instead of {nothing}");
    }
    let matched = glass(1.33, 1.33, [0.4; 2]);
    assert!(matched.is_specular());
    let split = matched.split(wo, MODE);
    assert_eq!(split.reflected, None);
    assert_eq!(
        split.transmitted.map(|s| (s.wi, s.weight, s.pdf)),
        Some((-wo, DVec3::ONE, Density::Discrete(1.0)))
    );
}

/// The switch depends on the pair of indices, not on its order, and comes earlier in single precision.
#[test]
fn the_switch_comes_where_half_vectors_lose_their_digits() {
    let rough = |above: f32, below: f32, alpha: f32| {
        let interface = Interface::new(above, below).expect("both are indices");
        RoughDielectric::new(interface, Ggx::isotropic(alpha).expect("a roughness"))
    };
    assert!(rough(1.0, 1.5, 1.1e-4).roughness().alpha_x() > 0.0 && !rough(1.0, 1.5, 1.1e-4).is_specular());
    for (alpha, specular) in [(0.04, true), (0.06, false)] {
        assert_eq!(rough(1.0, 1.0003, alpha).is_specular(), specular, "{alpha}");
        assert_eq!(rough(1.0003, 1.0, alpha).is_specular(), specular, "{alpha}");
    }
    assert!(!glass(1.0, 1.0 + 1e-13, [0.5; 2]).is_specular());
    assert!(glass(1.0, 1.0 + 1e-14, [0.5; 2]).is_specular());
}

/// Single precision sees what double precision sees, on both sides of its switch.
#[test]
fn single_precision_sees_the_same() {
    for (n, alpha) in [(1.5, 0.3), (1.5, 0.02), (1.0003, 0.06), (1.0003, 0.04), (2.42, 0.7)] {
        let double = glass(1.0, n, [alpha; 2]);
        let interface = Interface::new(1.0_f32, n as f32).expect("both are indices");
        let single = RoughDielectric::new(interface, Ggx::isotropic(alpha as f32).expect("a roughness"));
        for wo in [at_angle(10.0, true), at_angle(75.0, true), at_angle(25.0, false), at_angle(80.0, false)] {
            let narrow = direction_in::<f32>(wo);
            let wide = |sample: Option<Sample<f32>>| {
                sample.map_or(0.0, |s| f64::from(s.weight.x) * sky(s.wi.as_dvec3()))
            };
            let found = if single.is_specular() {
                let split = single.split(narrow, MODE);
                wide(split.reflected) + wide(split.transmitted)
            } else {
                mean_over_normals(&single, narrow, 1 << 14, wide)
            };
            let expected = seen(&double, narrow.as_dvec3().normalize(), 1 << 14);
            assert!((found - expected).abs() < 2e-3, "{n}, {alpha}, {wo}: {found} and {expected}");
        }
    }
}

/// What the page says of densities in single precision: that of a sample is the one of `pdf`, down to roughness 0.02, and
/// both agree with double precision.
#[test]
fn single_precision_knows_its_densities() {
    for alpha in [0.02_f32, 0.1, 0.5] {
        let interface = Interface::new(1.0_f32, 1.5).expect("both are indices");
        let single = RoughDielectric::new(interface, Ggx::isotropic(alpha).expect("a roughness"));
        let double = glass(1.0, 1.5, [f64::from(alpha); 2]);
        for degrees in [0.0, 30.0, 60.0, 85.0, 89.5] {
            for above in [true, false] {
                let wo = direction_in::<f32>(at_angle(degrees, above));
                for [uc, u, v] in even(2000) {
                    let sample = single.sample(wo, uc as f32, [u as f32, v as f32], MODE);
                    let Some(sample) = sample else { continue };
                    let Density::SolidAngle(claimed) = sample.pdf else { panic!("it is rough") };
                    let [wo, wi] = [wo, sample.wi].map(|w| w.as_dvec3().normalize());
                    let expected = double.pdf(wo, wi);
                    for found in [claimed, single.pdf(wo.as_vec3(), sample.wi)] {
                        let error = (f64::from(found) / expected - 1.0).abs();
                        assert!(error < 0.01, "{alpha}, {degrees}, {above}: {found} and {expected}");
                    }
                }
            }
        }
    }
}
