//! What a ray hits first, and whether anything is in the way: the two questions of the ray tree, asked of whole scenes.
//! Elements are [rays](crate::rays).

use crate::bumpy::bumpy;
use crate::measure::Harness;
use crate::rays::{Rays, gallery, scene, trace};
use std::hint::black_box;
use vitrum::geometry::Counters;

pub(crate) fn bench(harness: &mut Harness) {
    query(harness);
    build(harness);
}

/// Among them meshes of 302, 9984, 12 288, 100 000 and a million triangles.
const SCENES: [&str; 9] = [
    "4 spheres",
    "12 shapes",
    "1000 spheres",
    "gem",
    "wine glass",
    "knot",
    "25 glasses",
    "100 000 triangles",
    LARGEST,
];
const LARGEST: &str = "1 000 000 triangles";

fn query(harness: &mut Harness) {
    for name in SCENES {
        if harness.is_count() && name == LARGEST {
            continue;
        }
        let scene = scene(name);
        let Rays { primary, inner, random, shadow } = Rays::of(&scene);
        for (kind, rays) in [("primary", &primary), ("inner", &inner), ("random", &random)] {
            harness.measure(&format!("query/{name}, {kind}"), rays.len(), || {
                for ray in rays {
                    black_box(scene.closest(ray, &mut Counters::default()));
                }
            });
        }
        harness.measure(&format!("query/{name}, shadow"), shadow.len(), || {
            for (ray, distance) in &shadow {
                black_box(scene.occluded(ray, *distance, &mut Counters::default()));
            }
        });
    }
}

/// Elements are triangles: from arrays to a mesh that rays can be traced against.
fn build(harness: &mut Harness) {
    let mut meshes = vec![("knot", gallery("torus_knot.obj"))];
    if !harness.is_count() {
        meshes.push((LARGEST, bumpy(501, 1000)));
    }
    for (name, mesh) in meshes {
        harness.measure(&format!("build/{name}"), mesh.triangles.len(), || {
            black_box(trace(&mesh));
        });
    }
}
