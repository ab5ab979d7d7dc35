//! What a ray hits first, and whether anything is in the way: the two questions of the ray tree, asked of whole scenes.
//! Elements are [rays](crate::rays).

use crate::measure::measure;
use crate::rays::{Rays, gallery, scene, trace};
use criterion::Criterion;
use std::hint::black_box;
use vitrum::geometry::Counters;

pub(crate) fn bench(criterion: &mut Criterion) {
    query(criterion);
    build(criterion);
}

fn query(criterion: &mut Criterion) {
    for name in ["4 spheres", "12 shapes", "1000 spheres", "gem", "wine glass", "knot", "25 glasses"] {
        let scene = scene(name);
        let Rays { primary, inner, random, shadow } = Rays::of(&scene);
        for (kind, rays) in [("primary", &primary), ("inner", &inner), ("random", &random)] {
            measure(criterion, &format!("query/{name}, {kind}"), rays.len(), || {
                for ray in rays {
                    black_box(scene.closest(ray, &mut Counters::default()));
                }
            });
        }
        measure(criterion, &format!("query/{name}, shadow"), shadow.len(), || {
            for (ray, distance) in &shadow {
                black_box(scene.occluded(ray, *distance, &mut Counters::default()));
            }
        });
    }
}

/// Elements are triangles: from arrays to a mesh that rays can be traced against.
fn build(criterion: &mut Criterion) {
    let mesh = gallery("torus_knot.obj");
    measure(criterion, "build/knot", mesh.triangles.len(), || {
        black_box(trace(&mesh));
    });
}
