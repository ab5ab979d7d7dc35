//! The hot loop, layer by layer, measured with criterion. How to run and compare: `benches/README.md`.

mod directions;
mod intersect;
mod measure;
mod pixel;
mod query;
mod rays;
mod refraction;
mod sampler;
mod scattering;

use criterion::{criterion_group, criterion_main};

criterion_group! {
    name = hot_loop;
    config = measure::short();
    targets = refraction::bench, scattering::bench, intersect::bench, query::bench, sampler::bench, pixel::bench
}
criterion_main!(hot_loop);
