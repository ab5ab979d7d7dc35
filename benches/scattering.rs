//! The scattering models, each by itself, and what it costs not to know beforehand which one it is.
//!
//! Elements are calls. Directions are uniform over the sphere, so that half of the pairs lie on different sides.

use crate::directions::{INPUTS, direction};
use crate::measure::Harness;
use std::hint::black_box;
use vitrum::bxdf::{
    Bxdf, ComplexIndex, Conductor, FresnelDielectric, Ggx, GlossySpecular, Interface, Lambertian,
    PerfectSpecular, PerfectTransmitter, RoughDielectric, Sample, ThinDielectric, TransportMode,
};
use vitrum::math::DVec3;
use vitrum_testkit::Uniform;

const MODE: TransportMode = TransportMode::Radiance;

/// What a call is given beside the model.
#[derive(Clone, Copy)]
struct Input {
    wo: DVec3,
    wi: DVec3,
    uc: f64,
    u: [f64; 2],
}

pub(crate) fn bench(harness: &mut Harness) {
    let inputs = inputs();
    for (name, model) in models() {
        if !model.is_specular() {
            harness.measure(&format!("eval/{name}"), INPUTS, || {
                for i in &inputs {
                    black_box(black_box(&model).eval(i.wo, i.wi, MODE));
                }
            });
        }
        harness.measure(&format!("sample/{name}"), INPUTS, || {
            for i in &inputs {
                black_box(black_box(&model).sample(i.wo, i.uc, i.u, MODE));
            }
        });
    }
    splits(harness, &inputs);
    rough(harness, &inputs);
    dispatch(harness, &inputs);
}

/// The children that a ray tree follows; of solid glass they stand in `refraction.rs`.
fn splits(harness: &mut Harness, inputs: &[Input]) {
    let glass = Interface::new(1.0, 1.5).expect("both are indices");
    let tinted = ThinDielectric { interface: glass, transmittance: DVec3::new(0.9, 0.8, 0.7) };
    for (name, sheet) in [("clear sheet", ThinDielectric::clear(glass)), ("tinted sheet", tinted)] {
        harness.measure(&format!("split/{name}"), INPUTS, || {
            for i in inputs {
                black_box(black_box(&sheet).split(i.wo));
            }
        });
    }
}

/// What a rough surface costs beside `eval` and `sample`: making the model, and its density alone.
fn rough(harness: &mut Harness, inputs: &[Input]) {
    let glass = Interface::new(1.0, 1.5).expect("both are indices");
    let roughness = Ggx::new(0.3, 0.3).expect("both are roughnesses");
    harness.measure("new/rough glass", INPUTS, || {
        for _ in inputs {
            black_box(RoughDielectric::new(black_box(glass), black_box(roughness)));
        }
    });
    let model = RoughDielectric::new(glass, roughness);
    harness.measure("pdf/rough glass", INPUTS, || {
        for i in inputs {
            black_box(black_box(&model).pdf(i.wo, i.wi));
        }
    });
}

fn inputs() -> Vec<Input> {
    let mut uniform = Uniform::new(1);
    (0..INPUTS)
        .map(|_| {
            let [wo, wi] = [0; 2].map(|_| direction(&mut uniform));
            Input { wo, wi, uc: uniform.number(), u: uniform.pair() }
        })
        .collect()
}

fn models() -> Vec<(&'static str, Bxdf<f64>)> {
    let glass = Interface::new(1.0, 1.5).expect("both are indices");
    let rough = Ggx::new(0.3, 0.3).expect("both are roughnesses");
    let (n, k) = (DVec3::new(0.16, 0.42, 1.43), DVec3::new(3.5, 2.4, 1.85));
    let gold = ComplexIndex::new(n, k, 1.0).expect("it is a metal");
    let half = DVec3::splat(0.5);
    let constant = PerfectTransmitter { kr: DVec3::splat(0.1), kt: DVec3::splat(0.9), interface: glass };
    vec![
        ("diffuse", Bxdf::Lambertian(Lambertian { reflectance: half })),
        ("highlight", Bxdf::GlossySpecular(GlossySpecular::normalised(half, 2000.0))),
        ("mirror", Bxdf::PerfectSpecular(PerfectSpecular { kr: half })),
        ("constant coefficients", Bxdf::PerfectTransmitter(constant)),
        ("smooth glass", Bxdf::FresnelDielectric(FresnelDielectric { interface: glass })),
        ("thin sheet", Bxdf::ThinDielectric(ThinDielectric::clear(glass))),
        ("rough glass", Bxdf::RoughDielectric(RoughDielectric::new(glass, rough))),
        ("rough glass, single", Bxdf::RoughDielectric(RoughDielectric::single_scattering(glass, rough))),
        ("smooth metal", Bxdf::Conductor(Conductor { index: gold, roughness: Ggx::smooth() })),
        ("rough metal", Bxdf::Conductor(Conductor { index: gold, roughness: rough })),
    ]
}

/// The other way to be one of many models.
trait Scatter {
    fn sample(&self, input: &Input) -> Option<Sample<f64>>;
}

macro_rules! scatter {
    ($($model:ident, $i:ident => $($argument:expr),+;)+) => {
        $(impl Scatter for $model<f64> {
            fn sample(&self, $i: &Input) -> Option<Sample<f64>> {
                Self::sample(self, $($argument),+)
            }
        })+

        fn boxed(model: &Bxdf<f64>) -> Box<dyn Scatter> {
            match *model {
                $(Bxdf::$model(model) => Box::new(model),)+
                _ => unreachable!("these are all"),
            }
        }
    };
}

scatter! {
    Lambertian, i => i.wo, i.u;
    GlossySpecular, i => i.wo, i.u;
    PerfectSpecular, i => i.wo;
    PerfectTransmitter, i => i.wo, i.uc, MODE;
    FresnelDielectric, i => i.wo, i.uc, MODE;
    ThinDielectric, i => i.wo, i.uc;
    RoughDielectric, i => i.wo, i.uc, i.u, MODE;
    Conductor, i => i.wo, i.u;
}

/// `sample` of the same models as values of an enum, and behind pointers: all smooth glass, and each another than the one
/// before. (The highlight is left out: it takes ten times as long as the others.)
fn dispatch(harness: &mut Harness, inputs: &[Input]) {
    let models: Vec<Bxdf<f64>> =
        models().into_iter().filter(|(name, _)| *name != "highlight").map(|(_, model)| model).collect();
    let mut uniform = Uniform::new(2);
    let mixed: Vec<Bxdf<f64>> =
        inputs.iter().map(|_| models[(uniform.number() * models.len() as f64) as usize]).collect();
    let glass = models.iter().find(|model| matches!(model, Bxdf::FresnelDielectric(_))).expect("it is there");
    for (name, models) in [("all smooth glass", vec![*glass; inputs.len()]), ("mixed", mixed)] {
        harness.measure(&format!("dispatch/enum, {name}"), INPUTS, || {
            for (model, i) in models.iter().zip(inputs) {
                black_box(model.sample(i.wo, i.uc, i.u, MODE));
            }
        });
        let boxes: Vec<Box<dyn Scatter>> = models.iter().map(boxed).collect();
        harness.measure(&format!("dispatch/dyn, {name}"), INPUTS, || {
            for (model, i) in boxes.iter().zip(inputs) {
                black_box(model.sample(i));
            }
        });
    }
}
