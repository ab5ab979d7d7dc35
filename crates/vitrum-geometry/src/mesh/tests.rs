//! The tree against trying every triangle, and rays aimed where meshes leak.

use super::{Build, MeshData, TriangleMesh, smooth_normals};
use crate::aggregate::{Aggregate, Counters, Hit, Nearest};
use crate::departure::Query;
use crate::interaction::Side;
use crate::object::Object;
use crate::shape::{Plane, Shape, Sphere};
use crate::wide::Isa;
use std::sync::Arc;
use vitrum_math::{DVec3, Ray, Transform, unit};

/// A small generator for test input (splitmix64).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (x ^ x >> 31) as f64 / 18_446_744_073_709_551_616.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - DVec3::ONE
    }
}

/// A closed ball with bumps: a latitude-longitude grid with one vertex at each pole.
fn bumpy_ball(rings: u32, segments: u32) -> MeshData {
    let mut positions = vec![DVec3::Y, -DVec3::Y];
    for ring in 1..rings {
        for segment in 0..segments {
            let (theta, phi) = (
                f64::from(ring) / f64::from(rings) * std::f64::consts::PI,
                f64::from(segment) / f64::from(segments) * std::f64::consts::TAU,
            );
            let bump = 1.0 + 0.1 * (5.0 * theta).sin() * (4.0 * phi).cos();
            positions.push(DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()) * bump);
        }
    }
    let at = |ring: u32, segment: u32| 2 + (ring - 1) * segments + segment % segments;
    let mut triangles = Vec::new();
    for s in 0..segments {
        triangles.push([0, at(1, s + 1), at(1, s)]);
        triangles.push([1, at(rings - 1, s), at(rings - 1, s + 1)]);
        for ring in 1..rings - 1 {
            let (a, b, c, d) = (at(ring, s), at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    MeshData { positions, triangles, ..MeshData::default() }
}

fn soup(random: &mut Random, triangles: u32, size: f64) -> MeshData {
    let mut positions = Vec::new();
    for _ in 0..triangles {
        let centre = random.vector();
        positions.extend((0..3).map(|_| centre + random.vector() * size));
    }
    let triangles = (0..triangles).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    MeshData { positions, triangles, ..MeshData::default() }
}

fn closest(mesh: &TriangleMesh, ray: &Ray) -> Option<Hit> {
    let mut nearest = Nearest::default();
    mesh.closest(ray, &Query::new(*ray), 0, &mut nearest, &mut Counters::default());
    nearest.found()
}

/// The tree finds exactly what trying every triangle finds: distance, face and weights, to the last bit, with
/// every kind of instructions that this processor has.
#[test]
fn the_tree_finds_what_trying_every_triangle_finds() {
    let mut random = Random(1);
    let mut meshes = vec![
        bumpy_ball(12, 16),
        soup(&mut random, 300, 0.3),
        soup(&mut random, 300, 1e-3),
        soup(&mut random, 1, 0.5),
        // Needles: two corners nearly coincide.
        {
            let mut m = soup(&mut random, 200, 0.8);
            for i in 0..200 {
                m.positions[3 * i + 1] = m.positions[3 * i] + random.vector() * 1e-6;
            }
            m
        },
        // Four levels of scale in one mesh, and more triangles than fit into a few leaves.
        {
            let mut m = MeshData::default();
            for (extent, size) in [(1.0, 0.3), (0.1, 1e-2), (1e-2, 1e-4), (1e-3, 1e-6)] {
                let part = soup(&mut random, 400, size);
                let base = m.positions.len() as u32;
                m.positions.extend(part.positions.iter().map(|p| *p * extent));
                m.triangles.extend(part.triangles.iter().map(|t| t.map(|corner| corner + base)));
            }
            m
        },
        // All corners in three points, one triangle apart from the rest.
        MeshData {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(1e-9)],
            triangles: [[0, 1, 2]; 40].into_iter().chain([[0, 3, 2]]).collect(),
            ..MeshData::default()
        },
        // A stack of equal triangles, and the same once more turned around.
        MeshData {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: [[0, 1, 2]; 20].into_iter().chain([[0, 2, 1]; 20]).collect(),
            ..MeshData::default()
        },
        // Flat: no extent along z.
        {
            let mut m = soup(&mut random, 200, 0.3);
            m.positions.iter_mut().for_each(|p| p.z = 0.25);
            m
        },
    ];
    for (scale, offset) in [(1e-30, 0.0), (1e30, 0.0), (1.0, 1e5)] {
        let mut moved = bumpy_ball(10, 12);
        moved.positions.iter_mut().for_each(|p| *p = *p * scale + DVec3::splat(offset));
        meshes.push(moved);
    }
    for (number, data) in meshes.iter().enumerate() {
        let mesh = TriangleMesh::new(data.clone()).expect("valid mesh");
        let builds = [Build::Fast, Build::Medium, Build::Best];
        let walked: Vec<_> = builds
            .iter()
            .flat_map(|build| Isa::all().iter().map(move |isa| (build, isa)))
            .map(|how| {
                let mesh = TriangleMesh::with_build(data.clone(), *how.0).expect("valid mesh");
                (how, mesh.with_instructions(*how.1))
            })
            .collect();
        let (centre, size) = (mesh.bounds().centre(), mesh.bounds().extent().max_element());
        let mut hits = 0;
        for i in 0..3000 {
            let origin = centre + random.vector() * size * if i % 2 == 0 { 3.0 } else { 0.6 };
            // Every third ray goes at a vertex, every fifth along an axis.
            let target = match i % 15 {
                0 | 3 | 6 | 9 | 12 => data.positions[(random.unit() * data.positions.len() as f64) as usize],
                5 | 10 => origin + DVec3::AXES[i % 3] * if i % 2 == 0 { 1.0 } else { -1.0 } * size,
                _ => centre + random.vector() * size * 0.6,
            };
            let ray = Ray::new(origin, (target - origin).normalize());
            let mut oracle = Nearest::default();
            mesh.closest_of_all(&ray, &Query::new(ray), &mut oracle);
            let found = oracle.found();
            for (how, mesh) in &walked {
                assert_eq!(closest(mesh, &ray), found, "{how:?}: mesh {number}, {ray:?}");
                let limits = [f64::INFINITY, found.map_or(1.0, |hit| hit.t)];
                for limit in limits {
                    let any = mesh.any(&ray, &Query::new(ray), 0, limit, &mut Counters::default());
                    let expected = found.is_some_and(|hit| hit.t < limit);
                    assert_eq!(any, expected, "{how:?}, to {limit}: mesh {number}, {ray:?}");
                }
            }
            hits += u32::from(found.is_some());
        }
        assert!(hits > 20, "mesh {number}: {hits} hits");
    }
}

/// Big trees are built in parts, by as many threads as there are: always the same tree.
#[test]
fn threads_have_no_say_in_the_tree() {
    let data = bumpy_ball(32, 40);
    let alone = TriangleMesh::new(data.clone()).expect("valid mesh");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let together = pool.install(|| TriangleMesh::new(data)).expect("valid mesh");
    let faces = |mesh: &TriangleMesh| mesh.tree.blocks().iter().map(|block| block.faces).collect::<Vec<_>>();
    assert_eq!(faces(&alone), faces(&together));
    assert_eq!(format!("{:?}", alone.tree), format!("{:?}", together.tree));
}

/// Inside solids as everywhere, what is hit first is what is nearest of what each object has to say. A row of balls of which
/// some overlap, with a bubble each, one of which breaks through its wall, an open one, spheres in bubbles, a floor that cuts
/// one ball and passes a hair below another; rays in any direction, and rays aimed at vertices.
#[test]
fn inside_solids_nothing_is_missed() {
    let wall = bumpy_ball(12, 16);
    let bubbly = |offset: f64| {
        let mut ball = wall.clone();
        ball.positions.extend(wall.positions.iter().map(|p| *p * 0.7 + DVec3::X * offset));
        let base = wall.positions.len() as u32;
        ball.triangles.extend(wall.triangles.iter().map(|&[a, b, c]| [a, c, b].map(|corner| corner + base)));
        ball
    };
    let mut open = wall.clone();
    open.triangles.truncate(200);
    let lowest = wall.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min) * 1.1;
    let floor = Plane::new(DVec3::Y * (lowest - 1e-9), DVec3::Y).expect("valid plane");
    let mut objects =
        vec![Object::new(Shape::Plane(floor), &Transform::IDENTITY, false).expect("valid object")];
    let mut targets = Vec::new();
    for (i, x) in [0.0, 1.5, 4.0, 6.5, 8.0, 11.0].into_iter().enumerate() {
        let data =
            [bubbly(0.0), bubbly(0.0), bubbly(0.6), bubbly(0.0), wall.clone(), open.clone()][i].clone();
        let place = DVec3::new(x, if i == 3 { -1.0 } else { 0.0 }, 0.0);
        let scale = Transform::scale(DVec3::new(1.0, 1.1, -0.9)).expect("invertible");
        let to = scale.then(&Transform::translate(place)).expect("invertible");
        targets.extend(data.positions.iter().map(|p| to.world_point(*p)));
        let mesh = Shape::Mesh(Arc::new(TriangleMesh::new(data).expect("valid mesh")));
        objects.push(Object::new(mesh, &to, false).expect("valid object"));
        if i % 2 == 0 {
            let sphere = Shape::Sphere(Sphere::new(place, 0.3).expect("valid sphere"));
            objects.push(Object::new(sphere, &Transform::IDENTITY, false).expect("valid object"));
        }
    }
    let aggregate = Aggregate::new(objects.clone());
    let (mut random, mut counters) = (Random(6), Counters::default());
    let mut inside = 0;
    for i in 0..20_000 {
        let from = DVec3::new(random.unit() * 11.0, 0.0, 0.0) + random.vector() * 3.0;
        let target = |at: DVec3, random: &mut Random| {
            let aimed = targets[(random.unit() * targets.len() as f64) as usize] - at;
            unit(if i % 2 == 0 { random.vector() } else { aimed })
        };
        let mut query = Query::new(Ray::new(from, target(from, &mut random)));
        for _ in 0..12 {
            let hit = aggregate.closest(&query, &mut counters);
            let mut expected = Nearest::default();
            for (id, object) in (0u32..).zip(&objects) {
                object.closest(&query, id, &mut expected, &mut counters);
            }
            assert_eq!(hit, expected.found(), "ray {i}");
            let Some(hit) = hit else { break };
            let surface = aggregate.interaction(&query, &hit, &mut Counters::default());
            let wi = target(surface.point, &mut random);
            inside += u32::from(wi.dot(surface.ng) < 0.0);
            query = surface.leave(wi, surface.side_of(wi));
        }
    }
    assert!(inside > 10_000, "{inside} rays inside something");
}

/// No ray from inside a closed mesh gets out unseen, wherever it is aimed; seen from outside it enters as often as it
/// leaves.
#[test]
fn closed_meshes_do_not_leak() {
    let mut random = Random(2);
    for (scale, offset) in [(1.0, 0.0), (1e-4, 0.0), (1e4, 0.0), (1.0, 1e5)] {
        let mut data = bumpy_ball(24, 32);
        data.positions.iter_mut().for_each(|p| *p = *p * scale + DVec3::splat(offset));
        let mesh = Shape::Mesh(Arc::new(TriangleMesh::new(data.clone()).expect("valid mesh")));
        let skew = Transform::scale(DVec3::new(-1.5, 0.7, 2.0)).expect("invertible");
        let skew = skew.then(&Transform::rotate(unit(DVec3::new(1.0, 2.0, 3.0)), 0.5)).expect("invertible");
        for transform in [Transform::IDENTITY, skew] {
            let object = Object::new(mesh.clone(), &transform, false).expect("valid object");
            let aggregate = Aggregate::new(vec![object]);
            for i in 0..40_000 {
                let inside = transform.world_point(random.vector() * 0.1 * scale + DVec3::splat(offset));
                let pick = |random: &mut Random, n: usize| (random.unit() * n as f64) as usize;
                let triangle = data.triangles[pick(&mut random, data.triangles.len())];
                let corners = triangle.map(|v| data.positions[v as usize]);
                let target = transform.world_point(match i % 3 {
                    0 => corners[0],
                    1 => (corners[0] + corners[1]) * 0.5,
                    _ => corners[0] + (corners[1] - corners[0]) * random.unit(),
                });
                let direction = if i % 7 == 0 { DVec3::AXES[i % 3] } else { (target - inside).normalize() };
                let from_inside = Query::new(Ray::new(inside, direction));
                let mut counters = Counters::default();
                let hit = aggregate
                    .closest(&from_inside, &mut counters)
                    .expect("a ray from inside gets out unseen");
                let surface = aggregate.interaction(&from_inside, &hit, &mut Counters::default());
                assert!(!surface.front, "from inside the back is seen");
                // On from there, straight through: outside nothing may come that contradicts being outside.
                let mut query = surface.leave(direction, Side::Transmitted);
                let mut inside_now = false;
                for _ in 0..20 {
                    let Some(hit) = aggregate.closest(&query, &mut counters) else { break };
                    let surface = aggregate.interaction(&query, &hit, &mut Counters::default());
                    assert_eq!(surface.front, !inside_now, "entering and leaving alternate");
                    inside_now = !inside_now;
                    query = surface.leave(direction, Side::Transmitted);
                }
                assert!(!inside_now, "ends outside");
            }
        }
    }
}

/// Rays that leave a surface, reflected or transmitted, never meet it again at once: scale and place do not matter.
#[test]
fn departing_rays_see_no_surface_at_their_start() {
    let mut random = Random(3);
    for (scale, offset) in [(1e-3, 0.0), (1.0, 0.0), (1e5, 0.0), (1.0, 1e6), (1e-3, 1e3)] {
        let mut data = smooth_normals(bumpy_ball(24, 32));
        // Without bumps: convex, so a reflected ray can't come back at all.
        data.positions.iter_mut().for_each(|p| *p = unit(*p) * scale + DVec3::splat(offset));
        let mesh = Shape::Mesh(Arc::new(TriangleMesh::new(data.clone()).expect("valid mesh")));
        let aggregate = Aggregate::new(vec![Object::new(mesh, &Transform::IDENTITY, false).expect("valid")]);
        let centre = DVec3::splat(offset);
        for i in 0..20_000 {
            let vertex = data.positions[(random.unit() * data.positions.len() as f64) as usize];
            let target = if i % 2 == 0 { vertex } else { centre + random.vector() * 0.5 * scale };
            let start = centre + unit(random.vector()) * 3.0 * scale;
            let query = Query::new(Ray::new(start, (target - start).normalize()));
            let mut counters = Counters::default();
            let Some(hit) = aggregate.closest(&query, &mut counters) else { continue };
            let surface = aggregate.interaction(&query, &hit, &mut Counters::default());
            // A ray that only touches the outline, at a vertex, enters and leaves in one point: whether a face is left to be
            // met is then a matter of the last bit, and either answer is right.
            if surface.wo.dot(unit(surface.point - centre)) < 0.15 {
                continue;
            }
            assert!(surface.front);
            let mirrored = surface.wo * -1.0 + surface.ng * (2.0 * surface.wo.dot(surface.ng));
            let reflected = surface.leave(mirrored, Side::Incident);
            assert_eq!(aggregate.closest(&reflected, &mut counters), None, "scale {scale}, offset {offset}");
            let inward = surface.leave(query.ray.direction, Side::Transmitted);
            let next = aggregate.closest(&inward, &mut counters).expect("leaves again");
            assert!(!aggregate.interaction(&inward, &next, &mut Counters::default()).front);
        }
    }
}
