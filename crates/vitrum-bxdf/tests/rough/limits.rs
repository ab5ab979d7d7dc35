//! Where rough becomes smooth: at small roughness, and where indices match.

use crate::stage::{at_angle, even, glass, interface, metal, single};
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

/// The mean over evenly spread normals of what `value` makes of both children of each, reflected and transmitted.
fn mean(
    model: &RoughDielectric<f64>,
    wo: DVec3,
    normals: u32,
    value: impl Fn(Option<Sample<f64>>) -> f64,
) -> f64 {
    let side = f64::signum(wo.z);
    let of_normal = |u: [f64; 2]| {
        let m = model.roughness().sample(DVec3::new(wo.x, wo.y, wo.z.abs()), u);
        let cos = wo.dot(DVec3::new(m.x, m.y, side * m.z));
        let reflected = model.interface().reflectance(cos * side).unpolarised();
        let [reflection, transmission] =
            [0.0, 1.0 - f64::EPSILON].map(|uc| value(model.sample(wo, uc, u, MODE)));
        reflected * reflection + (1.0 - reflected) * transmission
    };
    even(normals).map(of_normal).sum::<f64>() / f64::from(normals)
}

/// The light that arrives from `wo` through rough glass.
fn seen(model: &RoughDielectric<f64>, wo: DVec3, normals: u32) -> f64 {
    mean(model, wo, normals, arrives)
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
            mean(&glass(1.0, 1.5, [alpha; 2]), wo, 1 << 17, |sample| {
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

/// In single precision the switch comes earlier, and no later than half vectors lose their digits.
#[test]
fn single_precision_switches_where_it_must() {
    let rough = |n: f32| {
        let interface = Interface::new(1.0_f32, n).expect("both are indices");
        RoughDielectric::new(interface, Ggx::isotropic(0.5).expect("a roughness"))
    };
    assert!(rough(1.0001).is_specular() && !rough(1.0003).is_specular());
    assert!(!glass(1.0, 1.000_000_1, [0.5; 2]).is_specular());
}
