//! What `explain` tells of a pixel, and what is seen in pixels beside light, next to closed forms.

use vitrum::io::load::{Loaded, scene_text};
use vitrum::math::{DVec3, Rgb};
use vitrum::tracer::{Ending, ExplainedRay, Seen, Settings, Way, explain, seen};

const VIEW: &str = "[camera]\ntype = \"orthographic\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nheight = 0.2\n\
                    [background]\ntype = \"constant\"\ncolor = 0.7\n";

fn load(objects: &str) -> Loaded {
    let text = format!("{VIEW}{objects}");
    scene_text("a scene of this test", &text, std::path::Path::new(""))
        .unwrap_or_else(|error| panic!("{error}"))
}

fn slab(name: &str, [low, high]: [f64; 2], material: &str) -> String {
    format!(
        "[[object]]\nname = \"{name}\"\nshape = \"box\"\nmin = [-1, -1, {low}]\nmax = [1, 1, {high}]\nmaterial = {{ {material} }}\n"
    )
}

fn tree(loaded: &Loaded) -> Vec<ExplainedRay> {
    explain(&loaded.scene, &Settings { size: [1, 1], ..loaded.settings }, [0.5, 0.5], 100)
}

/// The middle of a picture of one pixel.
fn middle(loaded: &Loaded) -> Seen {
    seen(&loaded.scene, &Settings { size: [1, 1], spp: 4, ..loaded.settings }).expect("there are threads")[0]
}

/// At a right angle, a slab of index 1.5 reflects ((1.5 - 1)/(1.5 + 1))² = 4 % at each side; within, radiance is larger by 1.5².
#[test]
fn the_tree_of_a_slab_is_fresnels() {
    let rays = tree(&load(&slab("slab", [0.0, 1.0], "type = \"dielectric\", ior = 1.5")));
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    let [camera, mirrored, within, ..] = &rays[..] else { panic!("{rays:?}") };
    let hit = camera.met.as_ref().expect("it meets the slab");
    assert!(near(hit.distance, 4.0) && hit.front && hit.normal == DVec3::Z && near(hit.cos_theta_i, 1.0));
    assert!(near(hit.eta.expect("it divides two media"), 1.5) && !hit.unmatched);
    let [reflected, transmitted] = hit.shares.expect("it is smooth");
    assert!(near(reflected.x, 0.04) && near(transmitted.x, 0.96));
    assert_eq!((camera.way, camera.ended, camera.solids.len()), (Way::Camera, Ending::Divides, 0));
    assert_eq!((mirrored.way, mirrored.ended), (Way::Reflected, Ending::Escapes(Rgb::splat(0.7))));
    assert!(near(mirrored.throughput.x, 0.04) && mirrored.parent == Some(0));
    assert_eq!((within.way, within.depth, &within.solids[..]), (Way::Transmitted, 1, &[0][..]));
    assert!(near(within.throughput.x, 0.96 / 2.25) && near(within.medium.index.value(), 1.5));
    let out = within.met.as_ref().expect("it meets the other side");
    assert!(!out.front && near(out.distance, 1.0) && near(out.eta.expect("it divides two media"), 1.0 / 1.5));
    // Through both sides, 0.96 of 0.96, and the radiance is what it was.
    let through = rays.iter().find(|ray| ray.depth == 2 && ray.way == Way::Transmitted).expect("it leaves");
    assert!(near(through.throughput.x, 0.96 * 0.96) && through.ended == Ending::Escapes(Rgb::splat(0.7)));
}

/// What is passed is told, and so is a surface that does not fit: glass beyond glass that expects air.
#[test]
fn what_is_passed_and_what_does_not_fit_is_told() {
    let glass = slab("glass", [0.0, 1.0], "type = \"dielectric\", ior = 1.5, priority = 1");
    let water = slab("water", [0.5, 2.0], "type = \"dielectric\", inside = \"water\"");
    let rays = tree(&load(&format!("{glass}{water}")));
    let straight: Vec<&ExplainedRay> = rays.iter().filter(|ray| ray.passed.len() == 1).collect();
    assert!(!straight.is_empty(), "rays in the glass pass the wall of the water");
    // Objects are numbered by name: glass, water.
    assert!(straight.iter().all(|ray| ray.passed[0].1 == 1 && ray.medium.index.value() == 1.5));
    let pane = |z: f64| {
        format!(
            "[[object]]\nname = \"pane at {z}\"\nshape = \"rectangle\"\ncorner = [-1, -1, {z}]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]\n\
             material = {{ type = \"dielectric\", ior = 1.5, outside = \"air\" }}\n"
        )
    };
    let rays = tree(&load(&format!("{}{}", pane(0.0), pane(-1.0))));
    let unmatched: Vec<u32> =
        rays.iter().filter(|r| r.met.as_ref().is_some_and(|m| m.unmatched)).map(|r| r.depth).collect();
    assert!(unmatched.contains(&1) && !unmatched.contains(&0), "{unmatched:?}");
}

/// Behind water in glass lies a red wall; in front of nothing the sky.
#[test]
fn what_is_seen_is_what_is_there() {
    let glass = slab("glass", [0.0, 1.0], "type = \"dielectric\", ior = 1.5");
    let bead = slab("water", [0.2, 0.8], "type = \"dielectric\", inside = \"water\", priority = 1");
    let wall = slab("wall", [-3.0, -2.0], "type = \"matte\", color = [0.8, 0.1, 0.1]");
    let all = middle(&load(&format!("{glass}{bead}{wall}")));
    assert_eq!((all.object, all.media, all.unmatched), (1, 2, 0.0));
    assert!((all.depth - 4.0).abs() < 1e-12, "{all:?}");
    assert_eq!((all.normal, all.albedo), (DVec3::Z, Rgb::ONE));
    assert_eq!(all.normal_behind, DVec3::Z);
    assert!((all.albedo_behind - Rgb::new(0.8, 0.1, 0.1)).abs().max_element() < 1e-12, "{all:?}");
    let sky = middle(&load(""));
    assert_eq!((sky.object, sky.material, sky.depth), (0, 0, f64::INFINITY));
    assert_eq!((sky.normal, sky.albedo, sky.albedo_behind), (DVec3::ZERO, Rgb::splat(0.7), Rgb::splat(0.7)));
}
