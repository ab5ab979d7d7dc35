//! The hot loop, layer by layer: times by criterion, or counts of instructions. How to run and compare: `benches/README.md`.

mod bumpy;
mod directions;
mod intersect;
mod measure;
mod pixel;
mod query;
mod rays;
mod refraction;
mod sampler;
mod scattering;

fn main() {
    let mut harness = measure::Harness::of_the_command_line();
    refraction::bench(&mut harness);
    scattering::bench(&mut harness);
    intersect::bench(&mut harness);
    query::bench(&mut harness);
    sampler::bench(&mut harness);
    pixel::bench(&mut harness);
    harness.finish();
}
