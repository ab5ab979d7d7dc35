//! Every model with any legal parameters, asked about any directions, in both precisions: every answer is a number, and none
//! is negative.
//!
//! The bytes are mapped onto what is legal, with its ends, so that few of them are wasted.
#![no_main]

use libfuzzer_sys::fuzz_target;
use vitrum_bxdf::glam::DVec3;
use vitrum_bxdf::{
    Bxdf, ComplexIndex, Conductor, FresnelDielectric, Ggx, GlossySpecular, Interface, Lambertian, PerfectSpecular,
    PerfectTransmitter, Real, RoughDielectric, ThinDielectric, TransportMode, Vector,
};

/// Which model, its parameters, two directions, three random numbers.
type Input = (u8, [u16; 4], [[i16; 3]; 2], [u8; 2], [u32; 3]);

fuzz_target!(|input: Input| {
    ask::<f64>(&input);
    ask::<f32>(&input);
});

fn ask<R: Real>((kind, parameters, directions, tiny, numbers): &Input) {
    let model: Bxdf<R> = model(*kind, *parameters);
    let [Some(wo), Some(wi)] = [0, 1].map(|i| direction::<R>(directions[i], tiny[i])) else { return };
    let [uc, u, v] = numbers.map(|n| R::from_f64(f64::from(n >> 8) / 16_777_216.0));
    let is_share = |x: R| x >= R::zero() && x.is_finite();
    let is_colour = |c: R::Vec3| is_share(c.x()) && is_share(c.y()) && is_share(c.z());
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        assert!(is_colour(model.eval(wo, wi, mode)) && is_share(model.pdf(wo, wi)));
        let split = model.split(wo, mode);
        let chosen = model.sample(wo, uc, [u, v], mode);
        for sample in [split.reflected, split.transmitted, chosen].into_iter().flatten() {
            assert!(is_colour(sample.weight), "{sample:?}");
            assert!((sample.wi.dot(sample.wi).to_f64() - 1.0).abs() < 1e-3, "{sample:?}");
        }
    }
}

/// A direction, with one component made tiny where `tiny` says so.
fn direction<R: Real>(w: [i16; 3], tiny: u8) -> Option<R::Vec3> {
    let mut w = w.map(f64::from);
    if tiny < 64 {
        w[usize::from(tiny % 3)] = [0.0, -0.0, 1e-30, -1e-30, 1e-12, -1e-7][usize::from(tiny / 3 % 6)];
    }
    let w = DVec3::from_array(w).try_normalize()?;
    let w = R::Vec3::new(R::from_f64(w.x), R::from_f64(w.y), R::from_f64(w.z));
    Some(w / w.dot(w).sqrt())
}

fn model<R: Real>(kind: u8, [a, b, x, y]: [u16; 4]) -> Bxdf<R> {
    let share = |n: u16| f64::from(n) / 65_535.0;
    let number = R::from_f64;
    let colour = |a: f64, b: f64, c: f64| R::Vec3::new(number(a), number(b), number(c));
    // Ratios from 1e-6 to 1e6, half of them near one.
    let index = |n: u16| if n % 2 == 0 { 10_f64.powf(6.0 * share(n) - 3.0) } else { 1.0 + 1e-3 * share(n).powi(4) };
    let interface = Interface::new(number(index(a)), number(index(b))).expect("a legal pair");
    let alpha = |n: u16| share(n).powi(3);
    let roughness = Ggx::new(number(alpha(x)), number(alpha(y))).expect("legal roughness");
    match kind % 9 {
        0 => Lambertian { reflectance: colour(share(a), share(b), share(x)) }.into(),
        1 => GlossySpecular::unnormalised(colour(share(a), share(b), 1.0), number(10_f64.powf(6.0 * share(x)))).into(),
        2 => PerfectSpecular { kr: colour(share(a), share(b), share(x)) }.into(),
        3 => {
            let kr = share(x);
            let kt = (1.0 - kr) * share(y);
            PerfectTransmitter { kr: colour(kr, 0.0, kr), kt: colour(kt, kt, 0.0), interface }.into()
        }
        4 => FresnelDielectric { interface }.into(),
        5 => ThinDielectric { interface, transmittance: colour(share(x), share(y), 1.0) }.into(),
        6 => RoughDielectric::new(interface, roughness).into(),
        7 => RoughDielectric::single_scattering(interface, roughness).into(),
        _ => {
            let n = 10_f64.powf(6.0 * share(a) - 3.0).clamp(1e-3, 1e3);
            let k = (1e3 * share(b).powi(4)).min(1e3);
            let index = ComplexIndex::new(colour(n, n, 1.0), colour(k, 0.0, k), R::one()).expect("a legal metal");
            Bxdf::from(Conductor { index, roughness })
        }
    }
}
