//! Refraction in both precisions, and the two children of a ray tree's node.
//!
//! Elements are directions. They are uniform over the hemisphere where a side is named, else over the sphere. From inside
//! the glass (n = 1.5) three in four are beyond the critical angle, whose cosine is 0.745: a branch that can't be predicted,
//! as in a picture.

use crate::directions::{INPUTS, direction};
use crate::measure::Harness;
use std::hint::black_box;
use vitrum::bxdf::{FresnelDielectric, Interface, PerfectTransmitter, Real, TransportMode, Vector};
use vitrum::math::DVec3;
use vitrum_testkit::Uniform;

pub(crate) fn bench(harness: &mut Harness) {
    refract(harness);
    split(harness);
}

/// Directions of the whole sphere.
fn everywhere() -> Vec<DVec3> {
    let mut uniform = Uniform::new(1);
    (0..INPUTS).map(|_| direction(&mut uniform)).collect()
}

/// Directions on one side of the surface.
fn on_side(above: bool) -> Vec<DVec3> {
    let towards = if above { 1.0 } else { -1.0 };
    everywhere().into_iter().map(|d| DVec3::new(d.x, d.y, towards * d.z.abs())).collect()
}

fn glass<R: Real>() -> PerfectTransmitter<R> {
    let interface = Interface::new(R::one(), R::from_f64(1.5)).expect("both indices are positive");
    let share = |s: f64| R::Vec3::splat(R::from_f64(s));
    PerfectTransmitter { kr: share(0.1), kt: share(0.9), interface }
}

fn refract(harness: &mut Harness) {
    fn sides<R: Real>(harness: &mut Harness, precision: &str) {
        let interface = glass::<R>().interface;
        for (side, above) in [("from outside", true), ("from inside", false)] {
            let directions: Vec<R::Vec3> = on_side(above)
                .into_iter()
                .map(|d| R::Vec3::new(R::from_f64(d.x), R::from_f64(d.y), R::from_f64(d.z)))
                .collect();
            harness.measure(&format!("refract/{precision} {side}"), INPUTS, || {
                for wo in &directions {
                    black_box(interface.refract(*wo));
                }
            });
        }
    }
    sides::<f64>(harness, "f64");
    sides::<f32>(harness, "f32");
}

/// The two children of a ray tree's node: with constant coefficients, and with Fresnel's.
fn split(harness: &mut Harness) {
    let directions = everywhere();
    let constant = glass::<f64>();
    harness.measure("split/constant coefficients", INPUTS, || {
        for wo in &directions {
            black_box(black_box(&constant).split(*wo, TransportMode::Radiance));
        }
    });
    let fresnel = FresnelDielectric { interface: constant.interface };
    harness.measure("split/Fresnel", INPUTS, || {
        for wo in &directions {
            black_box(black_box(&fresnel).split(*wo, TransportMode::Radiance));
        }
    });
}
