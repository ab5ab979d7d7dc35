//! Rays aimed where meshes leak: at vertices, at edges and along axes through vertices, from inside of closed meshes. Each
//! must meet a wall, and see it from behind.

use std::path::Path;
use std::sync::Arc;
use vitrum::geometry::mesh::{MeshData, TriangleMesh};
use vitrum::geometry::{Aggregate, Counters, Object, Query, Shape, Side, SurfaceInteraction};
use vitrum::io::obj;
use vitrum::math::{DVec3, Ray, Transform, unit};
use vitrum_testkit::Uniform;

/// Sizes of the meshes, and how far from the origin they stand, in metres.
const SCALES: [f64; 3] = [1e-4, 1.0, 1e4];
const OFFSETS: [f64; 2] = [0.0, 1e5];

/// Each mesh is looked at from so many points inside.
const POINTS: usize = 64;

/// A mesh in its place.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) scale: f64,
    pub(crate) offset: f64,
    /// Whether it is an instance, mirrored and stretched.
    pub(crate) is_instance: bool,
    aggregate: Aggregate,
    /// The corners of each triangle in the world.
    corners: Vec<[DVec3; 3]>,
    /// Points inside, not close to a wall.
    inside: Vec<DVec3>,
    /// Rays from points inside, along axes and exactly through vertices.
    through: Vec<Ray>,
}

/// Every closed mesh of the gallery at every scale and distance, as it is and as an instance.
pub(crate) fn cases(repository: &Path) -> Vec<Case> {
    let mut cases = Vec::new();
    for name in ["brilliant", "prism", "torus_knot", "wine_glass"] {
        let file = repository.join("scenes/gallery/meshes").join(name).with_extension("obj");
        let read = obj::read(&file).unwrap_or_else(|error| panic!("{error}"));
        let mesh = read.parts.into_iter().next().expect("a mesh").mesh;
        for scale in SCALES {
            for offset in OFFSETS {
                cases.extend([false, true].map(|is_instance| case(name, &mesh, scale, offset, is_instance)));
            }
        }
    }
    cases
}

fn case(name: &'static str, mesh: &MeshData, scale: f64, offset: f64, is_instance: bool) -> Case {
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p = *p * scale + DVec3::splat(offset));
    let centre = DVec3::splat(offset);
    let about = |transform: Transform| {
        let [there, back] = [-centre, centre].map(Transform::translate);
        there.then(&transform).and_then(|t| t.then(&back)).expect("invertible")
    };
    let transform = if is_instance {
        let stretched = Transform::scale(DVec3::new(-1.5, 0.7, 2.0)).expect("invertible");
        let turned = Transform::rotate(unit(DVec3::new(1.0, 2.0, 3.0)), 0.5);
        about(stretched.then(&turned).expect("invertible"))
    } else {
        Transform::IDENTITY
    };
    let corners: Vec<[DVec3; 3]> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(|corner| transform.world_point(mesh.positions[corner as usize])))
        .collect();
    let shape = Shape::Mesh(Arc::new(TriangleMesh::new(mesh).expect("a mesh that can be traced")));
    let object = Object::new(shape, &transform, false).expect("a valid object");
    let aggregate = Aggregate::new(vec![object]);
    let inside = points_inside(&aggregate);
    let through = through_vertices(&aggregate, &corners);
    Case { name, scale, offset, is_instance, aggregate, corners, inside, through }
}

/// Middles of chords.
fn points_inside(aggregate: &Aggregate) -> Vec<DVec3> {
    let mut uniform = Uniform::new(1);
    let (centre, size) = (aggregate.bounds().centre(), aggregate.bounds().extent().max_element());
    let mut points = Vec::new();
    while points.len() < POINTS {
        let start = centre + direction(&mut uniform) * size;
        let aim = centre + direction(&mut uniform) * (0.5 * size * uniform.number());
        points.extend(middle(aggregate, Ray::new(start, unit(aim - start)), &mut uniform));
    }
    points
}

fn through_vertices(aggregate: &Aggregate, corners: &[[DVec3; 3]]) -> Vec<Ray> {
    let mut uniform = Uniform::new(2);
    let size = aggregate.bounds().extent().max_element();
    let mut rays = Vec::new();
    for _ in 0..20 * POINTS {
        let [pick, axis] = uniform.pair();
        let [vertex, ..] = corners[(pick * corners.len() as f64) as usize % corners.len()];
        let axis = DVec3::AXES[(axis * 3.0) as usize % 3];
        if let Some(point) = middle(aggregate, Ray::new(vertex - axis * (2.0 * size), axis), &mut uniform) {
            rays.push(Ray::new(point, if (vertex - point).dot(axis) > 0.0 { axis } else { -axis }));
        }
    }
    rays
}

/// The middle of the first chord, if it is long enough and many rays say that it is inside.
fn middle(aggregate: &Aggregate, ray: Ray, uniform: &mut Uniform) -> Option<DVec3> {
    let size = aggregate.bounds().extent().max_element();
    let (surface, _) = look(aggregate, &Query::new(ray))?;
    let chord = surface.leave(ray.direction, Side::Transmitted);
    let (_, length) = look(aggregate, &chord)?;
    let middle = chord.ray.at(0.5 * length);
    let mut sees_a_back = || {
        let ray = Ray::new(middle, direction(uniform));
        look(aggregate, &Query::new(ray)).is_some_and(|(surface, _)| !surface.front)
    };
    (length > 2e-3 * size && (0..20).all(|_| sees_a_back())).then_some(middle)
}

/// The first wall, and how far it is.
fn look(aggregate: &Aggregate, query: &Query) -> Option<(SurfaceInteraction, f64)> {
    let hit = aggregate.closest(query, &mut Counters::default())?;
    Some((aggregate.interaction(query, &hit, &mut Counters::default()), hit.t))
}

impl Case {
    /// Aims so many rays, different ones for every seed; returns those that meet no wall, or see one from outside.
    pub(crate) fn leaks(&self, rays: u64, seed: u64) -> Vec<Ray> {
        let mut uniform = Uniform::new(seed);
        (0..rays).filter_map(|i| self.leak(i, &mut uniform)).collect()
    }

    fn leak(&self, i: u64, uniform: &mut Uniform) -> Option<Ray> {
        let [start, pick] = uniform.pair();
        let start = self.inside[(start * POINTS as f64) as usize % POINTS];
        let [a, b, _] = self.corners[(pick * self.corners.len() as f64) as usize % self.corners.len()];
        let ray = match i % 4 {
            0 => Ray::new(start, unit(a - start)),
            1 => Ray::new(start, unit((a + b) * 0.5 - start)),
            2 => Ray::new(start, unit(a + (b - a) * uniform.number() - start)),
            _ if self.through.is_empty() => Ray::new(start, DVec3::AXES[i as usize % 3]),
            _ => self.through[(uniform.number() * self.through.len() as f64) as usize % self.through.len()],
        };
        (!self.is_held(&ray)).then_some(ray)
    }

    /// Whether a ray from inside meets the back of a wall first. Through a vertex it meets several faces in one point, and the
    /// first of them may be a front by a rounding.
    fn is_held(&self, ray: &Ray) -> bool {
        let size = self.aggregate.bounds().extent().max_element();
        let mut query = Query::new(*ray);
        let mut first = None;
        while let Some(hit) = self.aggregate.closest(&query, &mut Counters::default()) {
            if hit.t > *first.get_or_insert(hit.t) + 1e-6 * size {
                return false;
            }
            if !self.aggregate.interaction(&query, &hit, &mut Counters::default()).front {
                return true;
            }
            query.pass(hit.t, hit.object, hit.face);
        }
        false
    }
}

fn direction(uniform: &mut Uniform) -> DVec3 {
    let [u, v] = uniform.pair();
    let z = 2.0 * u - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z)
}
