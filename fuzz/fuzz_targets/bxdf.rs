//! Any parameters that the constructors take and any directions of unit length: every answer is a number, none is negative.
#![no_main]

use libfuzzer_sys::fuzz_target;
use vitrum_bxdf::glam::DVec3;
use vitrum_bxdf::{
    Bxdf, ComplexIndex, Conductor, FresnelDielectric, Ggx, Interface, RoughDielectric, ThinDielectric, TransportMode,
};

type Input = (u8, [f64; 4], [f64; 3], [f64; 3], [u32; 3]);

fuzz_target!(|input: Input| {
    let (kind, [a, b, x, y], wo, wi, u) = input;
    let Some(model) = model(kind, [a, b], [x, y]) else { return };
    // Twice, because the length of a tiny vector has few digits.
    let [wo, wi] = [wo, wi].map(|w| DVec3::from_array(w).try_normalize().map(DVec3::normalize));
    let (Some(wo), Some(wi)) = (wo, wi) else { return };
    let [uc, u, v] = u.map(|u| f64::from(u) / 4_294_967_296.0);
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        let value = model.eval(wo, wi, mode);
        assert!(value.is_finite() && value.min_element() >= 0.0, "{value}");
        let pdf = model.pdf(wo, wi);
        assert!(pdf.is_finite() && pdf >= 0.0, "{pdf}");
        let split = model.split(wo, mode);
        for sample in [split.reflected, split.transmitted, model.sample(wo, uc, [u, v], mode)].into_iter().flatten() {
            assert!(sample.weight.is_finite() && sample.weight.min_element() >= 0.0, "{sample:?}");
            // Snell's law carries the rounding of wo's length on, divided by eta².
            let slack = 32.0 * f64::EPSILON / sample.eta.min(1.0).powi(2);
            assert!((sample.wi.length() - 1.0).abs() <= slack, "{sample:?}");
        }
    }
});

fn model(kind: u8, [a, b]: [f64; 2], [x, y]: [f64; 2]) -> Option<Bxdf<f64>> {
    if kind % 5 == 4 {
        let index = ComplexIndex::new(DVec3::splat(a), DVec3::splat(b), 1.0).ok()?;
        return Some(Bxdf::Conductor(Conductor { index, roughness: Ggx::new(x, y).ok()? }));
    }
    let interface = Interface::new(a, b).ok()?;
    Some(match kind % 5 {
        0 => Bxdf::FresnelDielectric(FresnelDielectric { interface }),
        1 if (0.0..=1.0).contains(&x) => {
            Bxdf::ThinDielectric(ThinDielectric { interface, transmittance: DVec3::new(x, 1.0 - x, 1.0) })
        }
        2 => Bxdf::RoughDielectric(RoughDielectric::new(interface, Ggx::new(x, y).ok()?)),
        3 => Bxdf::RoughDielectric(RoughDielectric::single_scattering(interface, Ggx::new(x, y).ok()?)),
        _ => return None,
    })
}
