//! Instructions of the search for hits, counted by valgrind: the [`rays`] of a kind, up to 4096, in trees that one thread
//! built. The counts repeat to the unit, so each has a limit, and above it this bench fails. Valgrind knows AVX2, but not
//! AVX-512: searches are counted with the former, on processors that have it.
//!
//! ```text
//! cargo bench --bench ray_instructions        # needs what `benches/instructions.rs` needs
//! ```
//!
//! Not one program with that: what stands beside it changes what the compiler inlines.

#![expect(missing_docs, clippy::exit, reason = "what the macros of gungraun expand to")]

mod directions;
mod rays;

use gungraun::{
    Callgrind, EventKind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main,
};
use rays::Rays;
use std::hint::black_box;
use vitrum::geometry::{Aggregate, Counters, Query};

/// A scene with rays to ask about.
type Questions<R> = (Aggregate, Vec<R>);

fn questions<R>(name: &str, kind: fn(Rays) -> Vec<R>) -> &'static Questions<R> {
    let scene = rays::scene(name);
    let rays = kind(Rays::of(&scene));
    Box::leak(Box::new((scene, rays)))
}

/// Each line is a bench: its name, that of what prepares it, the most instructions it may take, the scene and the rays.
macro_rules! closest_at_most {
    ($($name:ident, $setup:ident: $limit:literal, $scene:literal, $kind:ident;)+) => {
        $(
            fn $setup() -> &'static Questions<Query> {
                questions($scene, |rays| rays.$kind)
            }

            #[library_benchmark(setup = self::$setup, config = limit($limit))]
            fn $name((scene, rays): &'static Questions<Query>) {
                for ray in rays {
                    black_box(scene.closest(ray, &mut Counters::default()));
                }
            }
        )+
        library_benchmark_group!(name = closest_at_most, benchmarks = [$($name),+]);
    };
}

closest_at_most! {
    gem_primary, rays_of_gem_primary: 3_455_000, "gem", primary;
    gem_inner, rays_of_gem_inner: 2_315_000, "gem", inner;
    gem_random, rays_of_gem_random: 3_969_000, "gem", random;
    wine_glass_primary, rays_of_wine_glass_primary: 2_479_000, "wine glass", primary;
    wine_glass_inner, rays_of_wine_glass_inner: 1_377_000, "wine glass", inner;
    wine_glass_random, rays_of_wine_glass_random: 3_483_000, "wine glass", random;
    spheres_primary, rays_of_spheres_primary: 954_000, "4 spheres", primary;
    shapes_inner, rays_of_shapes_inner: 913_000, "12 shapes", inner;
    glasses_inner, rays_of_glasses_inner: 3_509_000, "25 glasses", inner;
    tree_of_spheres_random, rays_of_tree_of_spheres_random: 3_426_000, "1000 spheres", random;
}

fn shadows_of_gem() -> &'static Questions<(Query, f64)> {
    questions("gem", |rays| rays.shadow)
}

fn shadows_of_wine_glass() -> &'static Questions<(Query, f64)> {
    questions("wine glass", |rays| rays.shadow)
}

#[library_benchmark(setup = self::shadows_of_gem, config = limit(677_000))]
fn gem_shadow(questions: &'static Questions<(Query, f64)>) {
    occluded(questions);
}

#[library_benchmark(setup = self::shadows_of_wine_glass, config = limit(786_000))]
fn wine_glass_shadow(questions: &'static Questions<(Query, f64)>) {
    occluded(questions);
}

fn occluded((scene, rays): &Questions<(Query, f64)>) {
    for (ray, distance) in rays {
        black_box(scene.occluded(ray, *distance, &mut Counters::default()));
    }
}

library_benchmark_group!(name = occluded_at_most, benchmarks = [gem_shadow, wine_glass_shadow]);

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = [closest_at_most, occluded_at_most]
);

fn limit(instructions: u64) -> LibraryBenchmarkConfig {
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::default().hard_limits([(EventKind::Ir, instructions)]));
    config
}
