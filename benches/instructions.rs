//! Instructions of the scattering models, counted by valgrind: 4096 calls each, in double precision, over directions of the
//! whole sphere. The counts repeat to the unit, so each has a limit, and above it this bench fails.
//!
//! ```text
//! cargo install gungraun-runner --version 0.20.0      # and valgrind, a package of every system
//! cargo bench --bench instructions
//! ```
//!
//! A limit is a little more than what was counted when it was written. A change that needs more raises it and says why;
//! one that needs less lowers it.

#![expect(missing_docs, clippy::exit, reason = "what the macros of gungraun expand to")]

mod directions;

use directions::{INPUTS, direction};
use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use std::hint::black_box;
use vitrum::bxdf::{
    Bxdf, ComplexIndex, Conductor, FresnelDielectric, Ggx, GlossySpecular, Interface, Lambertian,
    PerfectSpecular, PerfectTransmitter, RoughDielectric, ThinDielectric, TransportMode,
};
use vitrum::math::DVec3;
use vitrum_testkit::Uniform;

const MODE: TransportMode = TransportMode::Radiance;

/// What a call is given: a model, two directions and three random numbers.
struct Input<M> {
    model: M,
    wo: DVec3,
    wi: DVec3,
    uc: f64,
    u: [f64; 2],
}

/// The inputs of a model: not counted.
fn inputs<M: Copy>(model: M) -> &'static [Input<M>] {
    let mut uniform = Uniform::new(1);
    let inputs = (0..INPUTS).map(|_| {
        let [wo, wi] = [0; 2].map(|_| direction(&mut uniform));
        Input { model, wo, wi, uc: uniform.number(), u: uniform.pair() }
    });
    inputs.collect::<Vec<_>>().leak()
}

fn glass() -> Interface<f64> {
    Interface::new(1.0, 1.5).expect("both are indices")
}

fn rough() -> Ggx<f64> {
    Ggx::new(0.3, 0.3).expect("both are roughnesses")
}

fn gold() -> ComplexIndex<f64> {
    let (n, k) = (DVec3::new(0.16, 0.42, 1.43), DVec3::new(3.5, 2.4, 1.85));
    ComplexIndex::new(n, k, 1.0).expect("it is a metal")
}

fn lambertian() -> &'static [Input<Lambertian<f64>>] {
    inputs(Lambertian { reflectance: DVec3::splat(0.5) })
}

fn highlight() -> &'static [Input<GlossySpecular<f64>>] {
    inputs(GlossySpecular::normalised(DVec3::splat(0.5), 200.0))
}

fn mirror() -> &'static [Input<PerfectSpecular<f64>>] {
    inputs(PerfectSpecular { kr: DVec3::splat(0.5) })
}

fn perfect_transmitter() -> &'static [Input<PerfectTransmitter<f64>>] {
    inputs(PerfectTransmitter { kr: DVec3::splat(0.1), kt: DVec3::splat(0.9), interface: glass() })
}

fn fresnel_dielectric() -> &'static [Input<FresnelDielectric<f64>>] {
    inputs(FresnelDielectric { interface: glass() })
}

fn clear_sheet() -> &'static [Input<ThinDielectric<f64>>] {
    inputs(ThinDielectric::clear(glass()))
}

fn tinted_sheet() -> &'static [Input<ThinDielectric<f64>>] {
    inputs(ThinDielectric { interface: glass(), transmittance: DVec3::new(0.9, 0.8, 0.7) })
}

fn rough_dielectric() -> &'static [Input<RoughDielectric<f64>>] {
    inputs(RoughDielectric::new(glass(), rough()))
}

fn single_scattering() -> &'static [Input<RoughDielectric<f64>>] {
    inputs(RoughDielectric::single_scattering(glass(), rough()))
}

fn smooth_metal() -> &'static [Input<Conductor<f64>>] {
    inputs(Conductor { index: gold(), roughness: Ggx::smooth() })
}

fn rough_metal() -> &'static [Input<Conductor<f64>>] {
    inputs(Conductor { index: gold(), roughness: rough() })
}

fn all_models() -> &'static [Input<Bxdf<f64>>] {
    let models = [
        Bxdf::Lambertian(lambertian()[0].model),
        Bxdf::PerfectSpecular(mirror()[0].model),
        Bxdf::FresnelDielectric(fresnel_dielectric()[0].model),
        Bxdf::ThinDielectric(clear_sheet()[0].model),
        Bxdf::RoughDielectric(rough_dielectric()[0].model),
        Bxdf::Conductor(rough_metal()[0].model),
    ];
    let each = inputs(()).iter().zip(models.into_iter().cycle());
    each.map(|(i, model)| Input { model, wo: i.wo, wi: i.wi, uc: i.uc, u: i.u }).collect::<Vec<_>>().leak()
}

/// Each line is a bench: its name, the most instructions it may take, its inputs, and the call.
macro_rules! at_most {
    ($($name:ident: $limit:literal, $inputs:ident: $model:ty, |$i:ident| $call:expr;)+) => {
        $(
            #[library_benchmark(setup = self::$inputs, config = limit($limit))]
            fn $name(inputs: &'static [Input<$model>]) {
                for $i in inputs {
                    black_box($call);
                }
            }
        )+
        library_benchmark_group!(name = at_most, benchmarks = [$($name),+]);
    };
}

at_most! {
    lambertian_eval: 75_000, lambertian: Lambertian<f64>, |i| i.model.eval(i.wo, i.wi);
    lambertian_sample: 700_000, lambertian: Lambertian<f64>, |i| i.model.sample(i.wo, i.u);
    highlight_eval: 495_000, highlight: GlossySpecular<f64>, |i| i.model.eval(i.wo, i.wi);
    highlight_sample: 4_271_000, highlight: GlossySpecular<f64>, |i| i.model.sample(i.wo, i.u);
    mirror_sample: 104_000, mirror: PerfectSpecular<f64>, |i| i.model.sample(i.wo);
    perfect_transmitter_split: 256_000, perfect_transmitter: PerfectTransmitter<f64>, |i| i.model.split(i.wo, MODE);
    perfect_transmitter_sample: 523_000, perfect_transmitter: PerfectTransmitter<f64>, |i| i.model.sample(i.wo, i.uc, MODE);
    fresnel_dielectric_split: 336_000, fresnel_dielectric: FresnelDielectric<f64>, |i| i.model.split(i.wo, MODE);
    fresnel_dielectric_sample: 509_000, fresnel_dielectric: FresnelDielectric<f64>, |i| i.model.sample(i.wo, i.uc, MODE);
    clear_sheet_split: 596_000, clear_sheet: ThinDielectric<f64>, |i| i.model.split(i.wo);
    clear_sheet_sample: 712_000, clear_sheet: ThinDielectric<f64>, |i| i.model.sample(i.wo, i.uc);
    tinted_sheet_split: 3_988_000, tinted_sheet: ThinDielectric<f64>, |i| i.model.split(i.wo);
    single_scattering_eval: 789_000, single_scattering: RoughDielectric<f64>, |i| i.model.eval(i.wo, i.wi, MODE);
    single_scattering_pdf: 589_000, single_scattering: RoughDielectric<f64>, |i| i.model.pdf(i.wo, i.wi);
    single_scattering_sample: 1_708_000, single_scattering: RoughDielectric<f64>, |i| i.model.sample(i.wo, i.uc, i.u, MODE);
    rough_dielectric_new: 828_000, rough_dielectric: RoughDielectric<f64>, |i| RoughDielectric::new(*i.model.interface(), *i.model.roughness());
    rough_dielectric_eval: 1_175_000, rough_dielectric: RoughDielectric<f64>, |i| i.model.eval(i.wo, i.wi, MODE);
    rough_dielectric_sample: 2_301_000, rough_dielectric: RoughDielectric<f64>, |i| i.model.sample(i.wo, i.uc, i.u, MODE);
    smooth_metal_sample: 960_000, smooth_metal: Conductor<f64>, |i| i.model.sample(i.wo, i.u);
    rough_metal_eval: 661_000, rough_metal: Conductor<f64>, |i| i.model.eval(i.wo, i.wi);
    rough_metal_sample: 1_937_000, rough_metal: Conductor<f64>, |i| i.model.sample(i.wo, i.u);
    all_models_eval: 401_000, all_models: Bxdf<f64>, |i| i.model.eval(i.wo, i.wi, MODE);
    all_models_sample: 1_128_000, all_models: Bxdf<f64>, |i| i.model.sample(i.wo, i.uc, i.u, MODE);
}

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = at_most
);

fn limit(instructions: u64) -> LibraryBenchmarkConfig {
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::default().hard_limits([(EventKind::Ir, instructions)]));
    config
}
