//! Whatever unit directions and legal parameters a model is given, in either precision: no panic, nothing that is not
//! finite, nothing negative, and directions of unit length on the right side.
//!
//! Directions are drawn where arithmetic breaks: exactly along the axes and in their planes, with components that are zero
//! of either sign, subnormal, or the smallest that is normal.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use vitrum_bxdf::{
    Bxdf, ComplexIndex, Conductor, Density, FresnelDielectric, Ggx, GlossySpecular, Interface, Lambertian,
    PerfectSpecular, PerfectTransmitter, Real, RoughDielectric, Sample, ThinDielectric, TransportMode,
    Vector,
};

/// A number in both precisions, each with its own extremes.
#[derive(Clone, Copy, Debug)]
struct Number {
    double: f64,
    single: f32,
}

fn number(x: f64) -> Number {
    Number { double: x, single: x as f32 }
}

/// What vanishes beside one.
fn tiny() -> impl Strategy<Value = Number> {
    let sizes = [
        number(0.0),
        Number { double: f64::from_bits(1), single: f32::from_bits(1) },
        Number { double: f64::MIN_POSITIVE / 3.0, single: f32::MIN_POSITIVE / 3.0 },
        Number { double: f64::MIN_POSITIVE, single: f32::MIN_POSITIVE },
        Number { double: 1e-160, single: 1e-22 },
        number(1e-30),
        Number { double: f64::EPSILON / 4.0, single: f32::EPSILON / 4.0 },
    ];
    (prop::sample::select(sizes.to_vec()), any::<bool>())
        .prop_map(|(n, negative)| if negative { Number { double: -n.double, single: -n.single } } else { n })
}

/// A unit vector in both precisions: exact to rounding in each.
fn direction() -> impl Strategy<Value = (DVec3, Vec3)> {
    let angle = prop_oneof![Just(0.0), Just(90.0), Just(180.0), Just(270.0), 0.0..360.0_f64];
    let special = (angle, tiny(), tiny(), 0..6_usize).prop_map(|(degrees, a, b, order)| {
        // The axes themselves, or a plane through two of them.
        let (sin, cos) = match degrees {
            0.0 => (b, number(1.0)),
            90.0 => (number(1.0), b),
            180.0 => (b, number(-1.0)),
            270.0 => (number(-1.0), b),
            _ => {
                let (sin, cos) = libm::sincos(degrees.to_radians());
                (number(sin), number(cos))
            }
        };
        let [x, y, z] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][order]
            .map(|i: usize| [cos, sin, a][i]);
        (DVec3::new(x.double, y.double, z.double), Vec3::new(x.single, y.single, z.single))
    });
    let general = [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]
        .prop_map(DVec3::from_array)
        .prop_filter("it has a direction", |v| v.length() > 1e-3)
        .prop_map(|v| (v.normalize(), v.normalize().as_vec3()));
    prop_oneof![3 => special, 1 => general]
}

/// A number in [0, 1), at its ends more often than not.
fn uniform() -> impl Strategy<Value = Number> {
    let last = Number { double: 1.0 - f64::EPSILON / 2.0, single: 1.0 - f32::EPSILON / 2.0 };
    let first = Number { double: f64::from_bits(1), single: f32::from_bits(1) };
    // Rounding 1 − 2⁻⁵³ to f32 would give one.
    let inside = (0..1_u32 << 24).prop_map(|i| number(f64::from(i) / 16_777_216.0));
    prop_oneof![Just(number(0.0)), Just(first), Just(last), inside]
}

/// A share between zero and one.
fn share() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), Just(1e-30), 0.0..=1.0_f64]
}

fn colour() -> impl Strategy<Value = DVec3> {
    [share(), share(), share()].prop_map(DVec3::from_array)
}

/// Parameters in f64, for a model of either precision.
#[derive(Clone, Copy, Debug)]
enum Parameters {
    Lambertian(DVec3),
    Glossy(DVec3, f64),
    Specular(DVec3),
    Transmitter { kr: DVec3, kt: DVec3, above: f64, below: f64 },
    Smooth { above: f64, below: f64 },
    Thin { above: f64, below: f64, transmittance: DVec3 },
    Rough { above: f64, below: f64, alphas: [f64; 2], compensated: bool },
    Metal { n: f64, k: f64, alphas: [f64; 2] },
}

fn parameters() -> impl Strategy<Value = Parameters> {
    // Up to 10⁶, the sharpest highlight that a scene may ask for. In f32 a mirror direction whose cosine rounds to 1 + 2⁻²³
    // overflows the power from about 10⁹ on.
    let exponent = prop_oneof![Just(1.0), Just(1e6), (0.0..6.0_f64).prop_map(|e| 10.0_f64.powf(e))];
    let index = || {
        prop_oneof![
            Just(1.0),
            Just(1.5),
            Just(1e-3),
            Just(1e3),
            Just(1.0 + 2.0 * f64::EPSILON),
            Just(1.0 + 1e-7),
            Just(1.0 + 1e-4),
            0.4..2.5_f64
        ]
    };
    let alpha = || {
        prop_oneof![
            Just(0.0),
            Just(0.9e-4),
            Just(1e-4),
            Just(1.0),
            (-4.0..0.0_f64).prop_map(|e| 10.0_f64.powf(e))
        ]
    };
    let alphas = move || [alpha(), alpha()];
    prop_oneof![
        1 => colour().prop_map(Parameters::Lambertian),
        1 => (colour(), exponent).prop_map(|(ks, exponent)| Parameters::Glossy(ks, exponent)),
        1 => colour().prop_map(Parameters::Specular),
        1 => (colour(), colour(), index(), index()).prop_map(|(kr, kt, above, below)| {
            Parameters::Transmitter { kr, kt: kt * (DVec3::ONE - kr), above, below }
        }),
        1 => (index(), index()).prop_map(|(above, below)| Parameters::Smooth { above, below }),
        1 => (index(), index(), colour())
            .prop_map(|(above, below, transmittance)| Parameters::Thin { above, below, transmittance }),
        3 => (index(), index(), alphas(), any::<bool>()).prop_map(|(above, below, alphas, compensated)| {
            Parameters::Rough { above, below, alphas, compensated }
        }),
        2 => (index(), prop_oneof![Just(0.0), Just(1e3), 0.0..10.0_f64], alphas())
            .prop_map(|(n, k, alphas)| Parameters::Metal { n, k, alphas }),
    ]
}

fn model<R: Real>(parameters: Parameters) -> Bxdf<R> {
    let colour = |c: DVec3| R::Vec3::new(R::from_f64(c.x), R::from_f64(c.y), R::from_f64(c.z));
    let interface = |above, below| Interface::new(R::from_f64(above), R::from_f64(below)).expect("in range");
    let ggx = |[x, y]: [f64; 2]| Ggx::new(R::from_f64(x), R::from_f64(y)).expect("in range");
    match parameters {
        Parameters::Lambertian(c) => Bxdf::Lambertian(Lambertian { reflectance: colour(c) }),
        Parameters::Glossy(c, exponent) => {
            Bxdf::GlossySpecular(GlossySpecular::unnormalised(colour(c), R::from_f64(exponent)))
        }
        Parameters::Specular(c) => Bxdf::PerfectSpecular(PerfectSpecular { kr: colour(c) }),
        Parameters::Transmitter { kr, kt, above, below } => Bxdf::PerfectTransmitter(PerfectTransmitter {
            kr: colour(kr),
            kt: colour(kt),
            interface: interface(above, below),
        }),
        Parameters::Smooth { above, below } => {
            Bxdf::FresnelDielectric(FresnelDielectric { interface: interface(above, below) })
        }
        Parameters::Thin { above, below, transmittance } => Bxdf::ThinDielectric(ThinDielectric {
            interface: interface(above, below),
            transmittance: colour(transmittance),
        }),
        Parameters::Rough { above, below, alphas, compensated } => {
            let new = if compensated { RoughDielectric::new } else { RoughDielectric::single_scattering };
            Bxdf::RoughDielectric(new(interface(above, below), ggx(alphas)))
        }
        Parameters::Metal { n, k, alphas } => {
            let index = ComplexIndex::new(colour(DVec3::splat(n)), colour(DVec3::splat(k)), R::one());
            Bxdf::Conductor(Conductor { index: index.expect("in range"), roughness: ggx(alphas) })
        }
    }
}

fn doubles<R: Real>(v: R::Vec3) -> DVec3 {
    DVec3::new(v.x().to_f64(), v.y().to_f64(), v.z().to_f64())
}

/// Asks everything that the contract offers.
fn ask<R: Real>(
    model: &Bxdf<R>,
    [wo, wi]: [R::Vec3; 2],
    uc: R,
    u: [R; 2],
    epsilon: f64,
) -> Result<(), TestCaseError> {
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        let value = doubles::<R>(model.eval(wo, wi, mode));
        prop_assert!(value.is_finite() && value.min_element() >= 0.0, "eval is {}", value);
        prop_assert!(!model.is_specular() || value == DVec3::ZERO);
    }
    let pdf = model.pdf(wo, wi).to_f64();
    prop_assert!(pdf.is_finite() && pdf >= 0.0, "pdf is {}", pdf);
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        let split = model.split(wo, mode);
        let chosen = model.sample(wo, uc, u, mode);
        for sample in [split.reflected, split.transmitted, chosen].into_iter().flatten() {
            check_sample::<R>(wo, &sample, epsilon)?;
            prop_assert_eq!(model.is_specular(), matches!(sample.pdf, Density::Discrete(_)));
            prop_assert_eq!(model.is_specular(), sample.lobe.is_specular());
        }
    }
    Ok(())
}

fn check_sample<R: Real>(wo: R::Vec3, sample: &Sample<R>, epsilon: f64) -> Result<(), TestCaseError> {
    let (wo, wi, weight) = (doubles::<R>(wo), doubles::<R>(sample.wi), doubles::<R>(sample.weight));
    prop_assert!(weight.is_finite() && weight.min_element() >= 0.0, "the weight is {}", weight);
    let (Density::Discrete(pdf) | Density::SolidAngle(pdf)) = sample.pdf;
    prop_assert!(pdf.to_f64() > 0.0 && pdf.is_finite(), "the density is {:?}", pdf);
    if matches!(sample.pdf, Density::Discrete(_)) {
        prop_assert!(pdf.to_f64() <= 1.0, "the probability is {:?}", pdf);
    }
    let eta = sample.eta.to_f64();
    prop_assert!(eta > 0.0 && eta.is_finite(), "eta is {}", eta);

    // |wi|² − 1 is that of wo over eta², by Snell's law, beside a few roundings: more where a normal was rounded first.
    let roundings = if sample.lobe.is_specular() { 8.0 } else { 32.0 };
    let slack = roundings * epsilon * (1.0 / (eta * eta)).max(1.0);
    prop_assert!(wi.is_finite() && (wi.length_squared() - 1.0).abs() <= slack, "wi is {}", wi);
    // Zero of either sign counts as above.
    let (wo_above, wi_above) = (wo.z >= 0.0, wi.z >= 0.0);
    let crosses = sample.lobe.is_transmission();
    prop_assert!(crosses != (wo_above == wi_above), "wo is {} and wi {}", wo, wi);
    prop_assert!(!crosses || wi.z != 0.0, "it crosses along the surface: {}", wi);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100_000) })]

    #[test]
    fn models_answer_with_numbers(
        parameters in parameters(),
        wo in direction(),
        wi in direction(),
        uc in uniform(),
        u in [uniform(), uniform()],
    ) {
        let double = u.map(|u| u.double);
        ask::<f64>(&model(parameters), [wo.0, wi.0], uc.double, double, f64::EPSILON)?;
        let single = u.map(|u| u.single);
        ask::<f32>(&model(parameters), [wo.1, wi.1], uc.single, single, f64::from(f32::EPSILON))?;
    }
}
