//! Models, directions and numbers.

use glam::DVec3;
use vitrum_bxdf::{
    ComplexIndex, Conductor, Ggx, Interface, Real, RoughDielectric, Sample, TransportMode, Vector,
};

pub(crate) fn interface(above: f64, below: f64) -> Interface<f64> {
    Interface::new(above, below).expect("both are indices")
}

pub(crate) fn ggx([alpha_x, alpha_y]: [f64; 2]) -> Ggx<f64> {
    Ggx::new(alpha_x, alpha_y).expect("both are roughnesses")
}

/// Compensated glass below air, or whatever else.
pub(crate) fn glass(above: f64, below: f64, alphas: [f64; 2]) -> RoughDielectric<f64> {
    RoughDielectric::new(interface(above, below), ggx(alphas))
}

/// The same without compensation.
pub(crate) fn single(above: f64, below: f64, alphas: [f64; 2]) -> RoughDielectric<f64> {
    RoughDielectric::single_scattering(interface(above, below), ggx(alphas))
}

/// Gold, roughly: n + ik at 650, 550 and 450 nm.
pub(crate) fn metal(alphas: [f64; 2]) -> Conductor<f64> {
    let (n, k) = (DVec3::new(0.16, 0.42, 1.43), DVec3::new(3.5, 2.4, 1.85));
    let index = ComplexIndex::new(n, k, 1.0).expect("it is a metal");
    Conductor { index, roughness: ggx(alphas) }
}

/// A direction at so many degrees from the normal, above or below, away from the axes.
pub(crate) fn at_angle(degrees: f64, above: bool) -> DVec3 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let (sin_phi, cos_phi) = libm::sincos(0.7);
    DVec3::new(sin * cos_phi, sin * sin_phi, if above { cos } else { -cos })
}

/// The first points of a sequence that fills the unit cube of `D` dimensions evenly (M. Roberts, The Unreasonable
/// Effectiveness of Quasirandom Sequences, 2018: multiples of powers of the root of x^(D+1) = x + 1).
pub(crate) fn even<const D: usize>(points: u32) -> impl Iterator<Item = [f64; D]> {
    let mut root = 1.5_f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (D as f64 + 1.0));
    }
    let mut power = 1.0;
    let steps: [f64; D] = core::array::from_fn(|_| {
        power /= root;
        power
    });
    (0..points).map(move |index| steps.map(|step| (0.5 + f64::from(index) * step).fract()))
}

/// A direction of this precision, of unit length in it.
pub(crate) fn direction_in<R: Real>(w: DVec3) -> R::Vec3 {
    R::Vec3::new(R::from_f64(w.x), R::from_f64(w.y), R::from_f64(w.z)).normalised()
}

/// The mean over evenly spread normals of what `value` makes of both children of each, reflected and transmitted: no random
/// choice between them, so that a few thousand normals are good for three digits and a half.
pub(crate) fn mean_over_normals<R: Real>(
    model: &RoughDielectric<R>,
    wo: R::Vec3,
    normals: u32,
    value: impl Fn(Option<Sample<R>>) -> f64,
) -> f64 {
    even(normals).map(|u| both_children(model, wo, u, &value)).sum::<f64>() / f64::from(normals)
}

/// The same for one normal.
pub(crate) fn both_children<R: Real>(
    model: &RoughDielectric<R>,
    wo: R::Vec3,
    u: [f64; 2],
    value: impl Fn(Option<Sample<R>>) -> f64,
) -> f64 {
    let below = wo.z() < R::zero();
    let u = u.map(R::from_f64);
    let m = model.roughness().sample(if below { wo.mirrored() } else { wo }, u);
    let cos = wo.dot(if below { m.mirrored() } else { m }).at_most(R::one());
    let reflected = model.interface().reflectance(if below { -cos } else { cos }).unpolarised().to_f64();
    let last = R::one() - R::epsilon() * R::from_f64(0.5);
    let [reflection, transmission] =
        [R::zero(), last].map(|uc| value(model.sample(wo, uc, u, TransportMode::Radiance)));
    reflected * reflection + (1.0 - reflected) * transmission
}
