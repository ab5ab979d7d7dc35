//! Scattering: refraction in both precisions, the models, and what it costs not to know the model beforehand.
//!
//! Elements are directions. They are uniform over the hemisphere where a side is named, else over the sphere. From inside
//! the glass (n = 1.5) three in four are beyond the critical angle, whose cosine is 0.745: a branch that can't be predicted,
//! as in a picture.

use crate::directions::{INPUTS, direction};
use crate::measure::measure;
use criterion::Criterion;
use std::hint::black_box;
use vitrum::bxdf::{
    Bxdf, GlossySpecular, Interface, Lambertian, PerfectSpecular, PerfectTransmitter, Real, TransportMode,
    Vector,
};
use vitrum::math::DVec3;
use vitrum_testkit::Uniform;

pub(crate) fn bench(criterion: &mut Criterion) {
    refract(criterion);
    split(criterion);
    density(criterion);
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

fn refract(criterion: &mut Criterion) {
    fn sides<R: Real>(criterion: &mut Criterion, precision: &str) {
        let interface = glass::<R>().interface;
        for (side, above) in [("from outside", true), ("from inside", false)] {
            let directions: Vec<R::Vec3> = on_side(above)
                .into_iter()
                .map(|d| R::Vec3::new(R::from_f64(d.x), R::from_f64(d.y), R::from_f64(d.z)))
                .collect();
            measure(criterion, &format!("refract/{precision} {side}"), INPUTS, || {
                for wo in &directions {
                    black_box(interface.refract(*wo));
                }
            });
        }
    }
    sides::<f64>(criterion, "f64");
    sides::<f32>(criterion, "f32");
}

/// The two children of a ray tree's node: from the model itself, from the enum when all are glass, and when each is
/// another model than the one before.
fn split(criterion: &mut Criterion) {
    let directions = everywhere();
    let model = glass::<f64>();
    measure(criterion, "split/glass", INPUTS, || {
        for wo in &directions {
            black_box(black_box(&model).split(*wo, TransportMode::Radiance));
        }
    });
    let all_glass = vec![Bxdf::PerfectTransmitter(model); INPUTS];
    let mut uniform = Uniform::new(2);
    let mixed: Vec<Bxdf<f64>> = (0..INPUTS).map(|_| any_model(uniform.number())).collect();
    for (name, models) in [("split/enum, all glass", &all_glass), ("split/enum, four models", &mixed)] {
        measure(criterion, name, INPUTS, || {
            for (model, wo) in models.iter().zip(&directions) {
                black_box(model.split(*wo, TransportMode::Radiance));
            }
        });
    }
}

/// One of the four models, by a number in [0, 1).
fn any_model(chosen: f64) -> Bxdf<f64> {
    match (4.0 * chosen) as u32 {
        0 => Bxdf::Lambertian(Lambertian { reflectance: DVec3::splat(0.5) }),
        1 => Bxdf::GlossySpecular(GlossySpecular::unnormalised(DVec3::splat(0.2), 2000.0)),
        2 => Bxdf::PerfectSpecular(PerfectSpecular { kr: DVec3::splat(0.5) }),
        _ => Bxdf::PerfectTransmitter(glass()),
    }
}

/// What a light asks for, and a random choice of direction.
fn density(criterion: &mut Criterion) {
    let (outgoing, incoming) = (on_side(true), {
        let mut uniform = Uniform::new(3);
        (0..INPUTS).map(|_| direction(&mut uniform)).collect::<Vec<_>>()
    });
    let mut uniform = Uniform::new(4);
    let points: Vec<[f64; 2]> = (0..INPUTS).map(|_| uniform.pair()).collect();
    for (name, model) in [("diffuse", any_model(0.0)), ("highlight", any_model(0.25))] {
        measure(criterion, &format!("eval/{name}"), INPUTS, || {
            for (wo, wi) in outgoing.iter().zip(&incoming) {
                black_box(black_box(&model).eval(*wo, *wi, TransportMode::Radiance));
            }
        });
        measure(criterion, &format!("sample/{name}"), INPUTS, || {
            for (wo, u) in outgoing.iter().zip(&points) {
                black_box(black_box(&model).sample(*wo, 0.5, *u, TransportMode::Radiance));
            }
        });
    }
}
