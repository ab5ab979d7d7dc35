//! Rays per second next to Embree 4, in one process, interleaved.
//!
//! ```text
//! pip download --no-deps embreex==4.4.0.post1 && unzip embreex-*.whl -d embreex
//! VITRUM_ASSETS=... cargo bench --bench embree -- embreex/embreex.libs/libembree4-*.so.4 [THREADS [MESH]]
//! ```
//!
//! For each mesh six kinds of rays, 120 000 of each: `primary` (a camera's), `refracted` (from where these hit, into glass of
//! n = 1.5), `internal` (after two reflections inside), `diffuse` (from where primary rays hit, cosine-distributed
//! outward), `random` (from anywhere in the box to anywhere) and `shadow` (towards an area light; any hit). Ours are asked
//! of an [`Aggregate`], which brings each ray into the mesh's frame, settles hits in double precision and returns their
//! barycentrics: all of that is in the time. Embree is asked one ray at a time too, with incoherent flags (its default).

#![expect(clippy::print_stdout, reason = "a table is what this program is for")]

#[path = "../../../examples/scene_files/brilliant.rs"]
#[expect(dead_code, reason = "the names of files are not needed here")]
mod brilliant;
#[path = "../../bumpy.rs"]
mod bumpy;
#[path = "../../../examples/scene_files/circle.rs"]
mod circle;
mod library;
mod meshes;
#[path = "../../../examples/scene_files/wine_glass.rs"]
#[expect(dead_code, reason = "the names of files are not needed here")]
mod wine_glass;

use library::{FlushToZero, Options, RayHit, Scene};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use vitrum::bxdf::{Interface, Refraction};
use vitrum::geometry::mesh::{MeshData, TriangleMesh};
use vitrum::geometry::{Aggregate, Counters, Object, Query, Shape, Side, SurfaceInteraction};
use vitrum::math::{DVec3, Frame, Ray, Transform, unit};
use vitrum_testkit::Uniform;

const RAYS: usize = 120_000;

/// Each set is timed so often, alternately; the fastest counts.
const REPEATS: usize = 5;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let [library, rest @ ..] = &arguments[..] else {
        println!(
            "nothing compared: name the file of Embree's library (see the head of benches/peers/embree/main.rs)"
        );
        return;
    };
    let threads = rest.first().map_or(1, |threads| threads.parse().expect("a number of threads"));
    let asked_for = |named: &meshes::Named| rest.get(1).is_none_or(|name| named.name == name);
    let assets = vitrum_testkit::assets();
    for named in meshes::all(assets.as_deref()).into_iter().filter(asked_for) {
        compare(&named, &PathBuf::from(library), threads);
    }
}

#[expect(clippy::disallowed_methods, reason = "a bench has a clock")]
fn now() -> Instant {
    Instant::now()
}

/// The rays of one kind, for both.
struct Set {
    name: &'static str,
    /// Beyond this a shadow ray's blocker does not count; infinite for the others.
    limit: f64,
    ours: Vec<Query>,
    theirs: Vec<RayHit>,
}

fn compare(named: &meshes::Named, library: &Path, threads: usize) {
    let start = now();
    let mesh = Arc::new(TriangleMesh::new(named.mesh.clone()).expect("a mesh that can be traced"));
    let our_build = start.elapsed().as_secs_f64();
    let bytes = mesh.memory() as f64 / mesh.triangle_count() as f64;
    let object = Object::new(Shape::Mesh(Arc::clone(&mesh)), &Transform::IDENTITY, false).expect("valid");
    let aggregate = Aggregate::new(vec![object]);

    let (positions, triangles) = single(&named.mesh);
    let build = |robust| {
        let options = Options { robust, threads: 1 };
        Scene::build(library, &positions, &triangles, options).unwrap_or_else(|error| panic!("{error}"))
    };
    let ((fast, their_build), (robust, _)) = (build(false), build(true));
    println!(
        "\n### {}, {} triangles\n\nbuild {:.0} ms, Embree {:.0} ms, ratio {:.2}; {bytes:.0} bytes a triangle\n",
        named.name,
        mesh.triangle_count(),
        1e3 * our_build,
        1e3 * their_build,
        our_build / their_build
    );
    println!("| rays | Mrays/s | Embree | robust | ratio | to robust | differ |");
    println!("|---|---:|---:|---:|---:|---:|---:|");
    let (mut to_fast, mut to_robust) = (0.0, 0.0);
    let sets = sets(&aggregate);
    for set in &sets {
        let mut seconds = [f64::INFINITY; 3];
        for _ in 0..REPEATS {
            let times = [
                on_threads(threads, |part| ours(&aggregate, set, part)),
                on_threads(threads, |part| theirs(&fast, set, part)),
                on_threads(threads, |part| theirs(&robust, set, part)),
            ];
            seconds = std::array::from_fn(|i| seconds[i].min(times[i]));
        }
        let rates = seconds.map(|s| 1e-6 * set.ours.len() as f64 / s);
        let ratios = [rates[0] / rates[1], rates[0] / rates[2]];
        to_fast += ratios[0].ln() / sets.len() as f64;
        to_robust += ratios[1].ln() / sets.len() as f64;
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {} |",
            set.name,
            rates[0],
            rates[1],
            rates[2],
            ratios[0],
            ratios[1],
            differences(&aggregate, &robust, set)
        );
    }
    println!("| geometric mean | | | | **{:.2}** | **{:.2}** | |", to_fast.exp(), to_robust.exp());
}

/// The mesh in single precision, as Embree takes it.
fn single(mesh: &MeshData) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    (mesh.positions.iter().map(|p| p.as_vec3().to_array()).collect(), mesh.triangles.clone())
}

/// Seconds until every thread has worked through its part.
fn on_threads(threads: usize, work: impl Fn(std::ops::Range<usize>) + Sync) -> f64 {
    let start = now();
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let part = RAYS * thread / threads..RAYS * (thread + 1) / threads;
            let work = &work;
            if threads == 1 {
                work(part);
            } else {
                scope.spawn(move || work(part));
            }
        }
    });
    start.elapsed().as_secs_f64()
}

fn ours(aggregate: &Aggregate, set: &Set, part: std::ops::Range<usize>) {
    let mut counters = Counters::default();
    let queries = &set.ours[part.start.min(set.ours.len())..part.end.min(set.ours.len())];
    if set.limit < f64::INFINITY {
        for query in queries {
            black_box(aggregate.occluded(query, set.limit, &mut counters));
        }
    } else {
        for query in queries {
            // The whole hit is in memory by then, like Embree's; to copy it at once would stall, and no user does.
            black_box(aggregate.closest(query, &mut counters).map(|hit| hit.t));
        }
    }
}

fn theirs(scene: &Scene, set: &Set, part: std::ops::Range<usize>) {
    let _flush = FlushToZero::new();
    for ray in &set.theirs[part.start.min(set.theirs.len())..part.end.min(set.theirs.len())] {
        let mut ray = *ray;
        if set.limit < f64::INFINITY {
            scene.occluded(&mut ray);
        } else {
            scene.intersect(&mut ray);
        }
        black_box(&ray);
    }
}

/// How many rays of a set get another answer from Embree: hit or not, or a distance that differs by more than 1e-3.
fn differences(aggregate: &Aggregate, scene: &Scene, set: &Set) -> usize {
    let mut counters = Counters::default();
    let mut differs = |query: &Query, ray: &RayHit| {
        let mut ray = *ray;
        if set.limit < f64::INFINITY {
            scene.occluded(&mut ray);
            return aggregate.occluded(query, set.limit, &mut counters) != (ray.tfar < 0.0);
        }
        scene.intersect(&mut ray);
        match aggregate.closest(query, &mut counters) {
            None => ray.is_hit(),
            Some(hit) => !ray.is_hit() || (f64::from(ray.tfar) / hit.t - 1.0).abs() > 1e-3,
        }
    };
    set.ours
        .iter()
        .zip(&set.theirs)
        .map(|(query, ray)| differs(query, ray))
        .filter(|differs| *differs)
        .count()
}

fn sets(aggregate: &Aggregate) -> Vec<Set> {
    let bounds = aggregate.bounds();
    let (centre, size) = (bounds.centre(), bounds.extent().max_element());
    let mut uniform = Uniform::new(9);
    let mut counters = Counters::default();
    let mut surface_of = |query: &Query| {
        aggregate
            .closest(query, &mut counters)
            .map(|hit| aggregate.interaction(query, &hit, &mut Counters::default()))
    };

    // A square picture from in front and above, as many pixels as rays, in rows.
    let eye = centre + unit(DVec3::new(0.4, 0.5, 1.0)) * (1.6 * size);
    let view = Frame::around(unit(centre - eye));
    let edge = (RAYS as f64).sqrt() as usize;
    let primary: Vec<Query> = (0..RAYS)
        .map(|i| {
            let [x, y] = [i % edge, i / edge].map(|p| (p as f64 + 0.5) / edge as f64 - 0.5);
            Query::new(Ray::new(eye, unit(view.to_world(DVec3::new(x * 0.8, y * 0.8, 1.0)))))
        })
        .collect();
    let first: Vec<SurfaceInteraction> = primary.iter().filter_map(&mut surface_of).collect();

    let glass = Interface::new(1.0, 1.5).expect("both are indices");
    let refracted: Vec<Query> = first
        .iter()
        .filter_map(|surface| {
            let frame = Frame::around(surface.ng);
            match glass.refract(frame.to_local(surface.wo)) {
                Refraction::Refracted { wt, .. } => {
                    Some(surface.leave(unit(frame.to_world(wt)), Side::Transmitted))
                }
                Refraction::TotalInternalReflection => None,
            }
        })
        .collect();
    let mut internal = refracted.clone();
    for _ in 0..2 {
        internal = internal
            .iter()
            .filter_map(&mut surface_of)
            .map(|surface| {
                let along = surface.wo.dot(surface.ng);
                surface.leave(unit(surface.ng * (2.0 * along) - surface.wo), Side::Incident)
            })
            .collect();
    }
    let diffuse: Vec<Query> = first
        .iter()
        .map(|surface| {
            let [u, v] = uniform.pair();
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * v);
            let local = DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt().max(1e-6));
            let frame = Frame::around(if surface.front { surface.ng } else { -surface.ng });
            surface.leave(unit(frame.to_world(local)), Side::Incident)
        })
        .collect();
    let lamp = centre + DVec3::new(0.8, 2.0, 0.6) * size;
    let shadow: Vec<Query> = first
        .iter()
        .map(|surface| {
            let [u, v] = uniform.pair();
            let target = lamp + DVec3::new(u - 0.5, 0.0, v - 0.5) * (0.5 * size);
            let towards = unit(target - surface.point);
            surface.leave(towards, surface.side_of(towards))
        })
        .collect();
    let mut anywhere = || {
        let [x, y] = uniform.pair();
        bounds.min + bounds.extent() * DVec3::new(x, y, uniform.number())
    };
    let random: Vec<Query> = (0..RAYS)
        .map(|_| {
            let (from, to) = (anywhere(), anywhere());
            Query::new(Ray::new(from, unit(to - from)))
        })
        .collect();

    let set = |name, ours: Vec<Query>, limit: f64| {
        // As many of each, so that times compare: too few are repeated.
        let ours: Vec<Query> = ours.iter().copied().cycle().take(RAYS).collect();
        let theirs = ours.iter().map(|query| their_ray(query, size, limit)).collect();
        Set { name, limit, ours, theirs }
    };
    let infinite = f64::INFINITY;
    vec![
        set("primary", primary, infinite),
        set("refracted", refracted, infinite),
        set("internal", internal, infinite),
        set("diffuse", diffuse, infinite),
        set("random", random, infinite),
        set("shadow", shadow, 1e3 * size),
    ]
}

/// Rays that leave a surface start a little beyond it, as users of Embree have them do.
fn their_ray(query: &Query, size: f64, limit: f64) -> RayHit {
    let tnear = if query.departed.is_some() { 1e-5 * size as f32 } else { 0.0 };
    let [origin, direction] = [query.ray.origin, query.ray.direction].map(|v| v.as_vec3().to_array());
    RayHit::new(origin, direction, tnear, limit as f32)
}
