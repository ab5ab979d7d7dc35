//! Points of a surface, chosen for a point that looks at it: how light sources with an extent are asked for light.
//!
//! | surface | how | density |
//! |---|---|---|
//! | sphere, from outside | a direction of the cone that it fills | uniform in solid angle |
//! | rectangle | a direction of the spherical rectangle that it fills (C. Ureña, M. Fajardo and A. King, An Area-Preserving Parametrization for Spherical Rectangles, 2013) | uniform in solid angle; in area where it fills less than [`SMALL`] |
//! | everything else | a point, patch by patch in proportion to weight and area | uniform in area within a patch |
//!
//! Densities are per steradian, seen from the point that looks. What can't be sampled (an infinite plane, stretched spheres,
//! cylinders) has no sampler.

use crate::interaction::SurfaceInteraction;
use crate::object::Object;
use crate::shape::{Rectangle, Shape, Sphere};
use std::f64::consts::{PI, TAU};
use vitrum_math::{DVec3, Frame, Transform, concentric_disk};

/// Below this solid angle a spherical rectangle is lost among the roundings of the four angles that it is the excess of.
const SMALL: f64 = 1e-3;

/// A point of a surface, as another point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSample {
    /// The point.
    pub point: DVec3,
    /// Outward normal there, unit length.
    pub ng: DVec3,
    /// Unit vector from the point that looks.
    pub towards: DVec3,
    /// Distance from it, metres.
    pub distance: f64,
    /// Density per steradian.
    pub pdf: f64,
    /// The face of the object.
    pub face: u32,
}

/// Chooses points of one object.
#[derive(Clone, Debug)]
pub struct AreaSampler {
    kind: Kind,
    area: f64,
    weight: f64,
    centre: DVec3,
    /// No point is farther from the centre.
    radius: f64,
}

#[derive(Clone, Debug)]
enum Kind {
    Sphere { sphere: Sphere, flipped: bool },
    Rectangle(RightRectangle),
    Patches(Patches),
}

impl AreaSampler {
    /// For an object, whose faces count in proportion to `weight` and their area; `None` when it can't be sampled, or no face
    /// counts.
    pub fn new(object: &Object, weight: &dyn Fn(u32) -> f64) -> Option<Self> {
        let (transform, flipped) = (object.transform(), object.is_flipped());
        let kind = match object.shape() {
            Shape::Sphere(sphere) if transform.is_none() => Kind::Sphere { sphere: *sphere, flipped },
            Shape::Rectangle(rectangle) if transform.is_none() => {
                match RightRectangle::new(rectangle, flipped) {
                    Some(right) => Kind::Rectangle(right),
                    None => Kind::Patches(Patches::new(object, weight)?),
                }
            }
            _ => Kind::Patches(Patches::new(object, weight)?),
        };
        let bounds = object.bounds()?;
        let (area, weight) = match &kind {
            Kind::Sphere { sphere, .. } => {
                let area = 4.0 * PI * sphere.radius() * sphere.radius();
                (area, area * weight(0))
            }
            Kind::Rectangle(r) => (r.extent[0] * r.extent[1], r.extent[0] * r.extent[1] * weight(0)),
            Kind::Patches(patches) => (patches.all.iter().map(|p| p.patch.area()).sum(), patches.total),
        };
        let (centre, radius) = (bounds.centre(), bounds.extent().length() * 0.5);
        (weight > 0.0 && weight.is_finite()).then_some(Self { kind, area, weight, centre, radius })
    }

    /// Area, square metres.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The sum of area times weight.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// A ball around everything that may be chosen: centre and radius, metres.
    pub fn ball(&self) -> (DVec3, f64) {
        (self.centre, self.radius)
    }

    /// A point of the surface for a point of the unit square; `None` where it sees nothing of it.
    #[inline]
    pub fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<AreaSample> {
        match &self.kind {
            Kind::Sphere { sphere, flipped } => sample_sphere(sphere, *flipped, from, u),
            Kind::Rectangle(rectangle) => rectangle.sample(from, u),
            Kind::Patches(patches) => patches.sample(from, u),
        }
    }

    /// The density with which [`sample`](Self::sample) chooses, for `from`, the point `hit` of this object.
    #[inline]
    pub fn pdf(&self, from: DVec3, hit: &SurfaceInteraction) -> f64 {
        let per_area = match &self.kind {
            Kind::Sphere { sphere, .. } => match cone(sphere, from) {
                Some(cone) => return cone.density(),
                None => 1.0 / self.area,
            },
            Kind::Rectangle(rectangle) => match rectangle.seen_from(from).solid_angle() {
                Some(solid_angle) => return 1.0 / solid_angle,
                None => 1.0 / self.area,
            },
            Kind::Patches(patches) => patches.density(hit.face),
        };
        let offset = hit.point - from;
        per_solid_angle(per_area, offset, hit.ng)
    }
}

/// A density per area as one per steradian; infinite for a surface seen edge on.
#[inline]
fn per_solid_angle(per_area: f64, offset: DVec3, normal: DVec3) -> f64 {
    let squared = offset.dot(offset);
    per_area * squared * squared.sqrt() / offset.dot(normal).abs()
}

/// A sample of a point that was chosen by area; `None` where the density is not finite.
#[inline]
fn by_area(from: DVec3, point: DVec3, ng: DVec3, per_area: f64, face: u32) -> Option<AreaSample> {
    let offset = point - from;
    let distance = offset.length();
    let pdf = per_solid_angle(per_area, offset, ng);
    (pdf.is_finite() && pdf > 0.0).then(|| AreaSample {
        point,
        ng,
        towards: offset / distance,
        distance,
        pdf,
        face,
    })
}

/// What a sphere fills of the view of a point outside.
struct Cone {
    /// Towards its centre, not unit length.
    axis: DVec3,
    squared: f64,
    /// 1 − cos of half its opening, without a difference of equals.
    versine: f64,
}

#[inline]
fn cone(sphere: &Sphere, from: DVec3) -> Option<Cone> {
    let axis = sphere.centre() - from;
    let squared = axis.dot(axis);
    let sin_squared = sphere.radius() * sphere.radius() / squared;
    (sin_squared < 1.0).then(|| Cone {
        axis,
        squared,
        versine: sin_squared / (1.0 + (1.0 - sin_squared).sqrt()),
    })
}

impl Cone {
    #[inline]
    fn density(&self) -> f64 {
        1.0 / (TAU * self.versine)
    }
}

fn sample_sphere(sphere: &Sphere, flipped: bool, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
    let (centre, r) = (sphere.centre(), sphere.radius());
    let (sin, cos) = libm::sincos(TAU * v);
    let Some(cone) = cone(sphere, from) else {
        // From inside: anywhere, uniformly.
        let z = 1.0 - 2.0 * u;
        let across = (1.0 - z * z).max(0.0).sqrt();
        let outward = DVec3::new(across * cos, across * sin, z);
        let ng = if flipped { -outward } else { outward };
        return by_area(from, centre + outward * r, ng, 1.0 / (4.0 * PI * r * r), 0);
    };
    let versine = u * cone.versine;
    let cos_theta = 1.0 - versine;
    let sin_squared = versine * (2.0 - versine);
    let across = sin_squared.sqrt();
    let distance_to_centre = cone.squared.sqrt();
    let towards = Frame::around(cone.axis / distance_to_centre).to_world(DVec3::new(
        across * cos,
        across * sin,
        cos_theta,
    ));
    // The nearer crossing, without a difference of equals.
    let root = (r * r - cone.squared * sin_squared).max(0.0).sqrt();
    let distance = (cone.squared - r * r) / (distance_to_centre * cos_theta + root);
    let outward = (from + towards * distance - centre) / r;
    let outward = outward / outward.length();
    let ng = if flipped { -outward } else { outward };
    Some(AreaSample { point: centre + outward * r, ng, towards, distance, pdf: cone.density(), face: 0 })
}

/// A parallelogram with a right angle.
#[derive(Clone, Debug)]
struct RightRectangle {
    corner: DVec3,
    /// Along the edges, and square to both; unit length.
    axes: [DVec3; 3],
    extent: [f64; 2],
    ng: DVec3,
}

/// The same in the coordinates of its axes, around the point that looks.
struct SeenRectangle<'r> {
    rectangle: &'r RightRectangle,
    x: [f64; 2],
    y: [f64; 2],
    /// Not positive.
    z: f64,
    /// Whether the third axis is turned.
    turned: bool,
}

impl RightRectangle {
    fn new(rectangle: &Rectangle, flipped: bool) -> Option<Self> {
        let (corner, [u, v]) = rectangle.corner_and_edges();
        let extent = [u.length(), v.length()];
        let (x, y) = (u / extent[0], v / extent[1]);
        let normal = x.cross(y);
        let ng = if flipped { -normal } else { normal };
        (x.dot(y).abs() < 1e-12).then_some(Self { corner, axes: [x, y, normal], extent, ng })
    }

    #[inline]
    fn seen_from(&self, from: DVec3) -> SeenRectangle<'_> {
        let offset = self.corner - from;
        let [x, y, z] = self.axes.map(|axis| axis.dot(offset));
        SeenRectangle {
            rectangle: self,
            x: [x, x + self.extent[0]],
            y: [y, y + self.extent[1]],
            z: -z.abs(),
            turned: z > 0.0,
        }
    }

    #[inline]
    fn sample(&self, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
        let seen = self.seen_from(from);
        if let Some(sample) = seen.sample(from, [u, v]) {
            return Some(sample);
        }
        let [x, y, _] = self.axes;
        let point = self.corner + x * (self.extent[0] * u) + y * (self.extent[1] * v);
        by_area(from, point, self.ng, 1.0 / (self.extent[0] * self.extent[1]), 0)
    }
}

/// The four angles of a spherical rectangle, and what sampling needs beside them.
struct Angles {
    solid_angle: f64,
    /// z components of the normals of the planes through the lower and the upper edge.
    lower: f64,
    upper: f64,
    /// The sum of the two angles at the left.
    left: f64,
}

impl SeenRectangle<'_> {
    #[inline]
    fn angles(&self) -> Option<Angles> {
        if self.z == 0.0 {
            return None;
        }
        let along = |c: f64| c / (c * c + self.z * self.z).sqrt();
        let [lower, upper] = [-along(self.y[0]), along(self.y[1])];
        let [left, right] = [-along(self.x[0]), along(self.x[1])];
        let angle = |a: f64, b: f64| libm::acos((-(a * b)).clamp(-1.0, 1.0));
        let (g0, g1) = (angle(lower, right), angle(right, upper));
        let (g2, g3) = (angle(upper, left), angle(left, lower));
        let solid_angle = g0 + g1 + g2 + g3 - TAU;
        (solid_angle >= SMALL).then_some(Angles { solid_angle, lower, upper, left: g2 + g3 })
    }

    /// `None` where it is too small to be told.
    #[inline]
    fn solid_angle(&self) -> Option<f64> {
        self.angles().map(|angles| angles.solid_angle)
    }

    #[inline]
    fn sample(&self, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
        let angles = self.angles()?;
        let z = self.z;
        let turn = u * angles.solid_angle + (TAU - angles.left);
        let (sin, cos) = libm::sincos(turn);
        let f = (cos * angles.lower - angles.upper) / sin;
        let c = (1.0 / (f * f + angles.lower * angles.lower).sqrt()).copysign(f).clamp(-1.0, 1.0);
        let x = (-(c * z) / (1.0 - c * c).max(f64::MIN_POSITIVE).sqrt()).clamp(self.x[0], self.x[1]);
        let squared = x * x + z * z;
        let height = |y: f64| y / (squared + y * y).sqrt();
        let (h0, h1) = (height(self.y[0]), height(self.y[1]));
        let h = h0 + v * (h1 - h0);
        let y = (h * (squared / (1.0 - h * h).max(f64::MIN_POSITIVE)).sqrt()).clamp(self.y[0], self.y[1]);
        let [x_axis, y_axis, normal] = self.rectangle.axes;
        let z_axis = if self.turned { -normal } else { normal };
        let offset = x_axis * x + y_axis * y + z_axis * z;
        let distance = offset.length();
        Some(AreaSample {
            point: from + offset,
            ng: self.rectangle.ng,
            towards: offset / distance,
            distance,
            pdf: 1.0 / angles.solid_angle,
            face: 0,
        })
    }
}

/// A flat piece of a surface: a corner or centre, and two vectors.
#[derive(Clone, Copy, Debug)]
struct Patch {
    outline: Outline,
    from: DVec3,
    edges: [DVec3; 2],
}

#[derive(Clone, Copy, Debug)]
enum Outline {
    Parallelogram,
    Triangle,
    Ellipse,
}

impl Patch {
    fn area(&self) -> f64 {
        let [u, v] = self.edges;
        let parallelogram = u.cross(v).length();
        match self.outline {
            Outline::Parallelogram => parallelogram,
            Outline::Triangle => 0.5 * parallelogram,
            Outline::Ellipse => PI * parallelogram,
        }
    }

    #[inline]
    fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        let [a, b] = match self.outline {
            Outline::Parallelogram => [u, v],
            Outline::Triangle => {
                let root = u.sqrt();
                [root * (1.0 - v), root * v]
            }
            Outline::Ellipse => concentric_disk([u, v]).to_array(),
        };
        self.from + self.edges[0] * a + self.edges[1] * b
    }
}

#[derive(Clone, Debug)]
struct Patches {
    all: Vec<Weighted>,
    /// The sum of area times weight.
    total: f64,
    /// Where the faces of the object stand among the patches.
    of_face: Vec<Option<u32>>,
}

#[derive(Clone, Copy, Debug)]
struct Weighted {
    patch: Patch,
    ng: DVec3,
    face: u32,
    /// Area times weight of this and all before.
    up_to: f64,
    /// Density per area with which its points are chosen.
    density: f64,
}

impl Patches {
    fn new(object: &Object, weight: &dyn Fn(u32) -> f64) -> Option<Self> {
        let identity = Transform::IDENTITY;
        let to = object.transform().unwrap_or(&identity);
        let mut all: Vec<Weighted> = Vec::new();
        let mut total = 0.0;
        let outlines = outlines(object.shape())?;
        let mut of_face = vec![None; outlines.len()];
        for (face, (patch, outward)) in (0u32..).zip(outlines) {
            let patch = Patch {
                outline: patch.outline,
                from: to.world_point(patch.from),
                edges: patch.edges.map(|e| to.world_vector(e)),
            };
            let counts = patch.area() * weight(face);
            // What is too small to have an area is never hit either.
            if !(counts > 0.0 && counts.is_finite()) {
                continue;
            }
            let [u, v] = patch.edges;
            let normal = u.cross(v);
            let normal = normal / normal.length();
            // Mirroring turns the product of the edges.
            let outward = to.world_normal(outward);
            let ng = if (normal.dot(outward) < 0.0) == object.is_flipped() { normal } else { -normal };
            total += counts;
            of_face[face as usize] = Some(all.len() as u32);
            all.push(Weighted { patch, ng, face, up_to: total, density: weight(face) });
        }
        all.iter_mut().for_each(|weighted| weighted.density /= total);
        (total > 0.0 && total.is_finite()).then_some(Self { all, total, of_face })
    }

    #[inline]
    fn sample(&self, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
        let at = u * self.total;
        let index = self.all.partition_point(|weighted| weighted.up_to <= at).min(self.all.len() - 1);
        let before = if index == 0 { 0.0 } else { self.all[index - 1].up_to };
        let Weighted { patch, ng, face, up_to, density } = &self.all[index];
        let within = ((at - before) / (up_to - before)).clamp(0.0, 1.0 - f64::EPSILON);
        by_area(from, patch.point([within, v]), *ng, *density, *face)
    }

    #[inline]
    fn density(&self, face: u32) -> f64 {
        let patch = self.of_face.get(face as usize).copied().flatten();
        patch.map_or(0.0, |patch| self.all[patch as usize].density)
    }
}

/// The flat faces of a shape in their order, each with a vector outward; `None` where they are not all flat.
fn outlines(shape: &Shape) -> Option<Vec<(Patch, DVec3)>> {
    let patch = |outline, from, edges| Patch { outline, from, edges };
    Some(match shape {
        Shape::Rectangle(rectangle) => {
            let (corner, [u, v]) = rectangle.corner_and_edges();
            vec![(patch(Outline::Parallelogram, corner, [u, v]), u.cross(v))]
        }
        Shape::Disk(disk) => {
            let frame = Frame::around(disk.normal());
            let edges = [DVec3::X, DVec3::Y].map(|axis| frame.to_world(axis) * disk.radius());
            vec![(patch(Outline::Ellipse, disk.centre(), edges), disk.normal())]
        }
        Shape::Cuboid(cuboid) => {
            let (min, max) = cuboid.corners();
            let extent = max - min;
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            (0..6)
                .map(|face| {
                    let axis = face / 2;
                    let (u, v) = (axes[(axis + 1) % 3] * extent, axes[(axis + 2) % 3] * extent);
                    let (corner, outward) = if face % 2 == 1 {
                        (min + axes[axis] * extent, axes[axis])
                    } else {
                        (min, -axes[axis])
                    };
                    (patch(Outline::Parallelogram, corner, [u, v]), outward)
                })
                .collect()
        }
        Shape::Mesh(mesh) => (0..mesh.triangle_count() as u32)
            .map(|face| {
                let [a, b, c] = mesh.triangle(face);
                (patch(Outline::Triangle, a, [b - a, c - a]), (b - a).cross(c - a))
            })
            .collect(),
        Shape::Sphere(_) | Shape::Plane(_) | Shape::Cylinder(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aggregate::{Aggregate, Counters};
    use crate::departure::Query;
    use crate::mesh::{MeshData, TriangleMesh};
    use crate::shape::{Cuboid, Disk};
    use std::sync::Arc;
    use vitrum_math::{Ray, unit};
    use vitrum_testkit::Uniform;

    fn placed(shape: Shape, transform: &Transform) -> Object {
        Object::new(shape, transform, false).expect("valid object")
    }

    fn rectangle(corner: DVec3, u: DVec3, v: DVec3) -> Shape {
        Shape::Rectangle(Rectangle::new(corner, u, v).expect("valid rectangle"))
    }

    /// Every kind of surface that can be sampled, some of them stretched and mirrored.
    fn objects() -> Vec<Object> {
        let skew = Transform::scale(DVec3::new(-1.5, 0.7, 2.0)).expect("invertible");
        let skew = skew.then(&Transform::rotate(unit(DVec3::new(1.0, 2.0, 3.0)), 0.5)).expect("invertible");
        let sphere = Sphere::new(DVec3::new(0.3, 0.1, -0.2), 0.8).expect("valid sphere");
        let disk = Disk::new(DVec3::ZERO, DVec3::new(0.2, 1.0, 0.4), 0.9).expect("valid disk");
        let cuboid = Cuboid::new(DVec3::splat(-0.4), DVec3::new(0.5, 0.3, 0.6)).expect("valid box");
        let tetrahedron = MeshData {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
            ..MeshData::default()
        };
        let mesh = Shape::Mesh(Arc::new(TriangleMesh::new(tetrahedron).expect("valid mesh")));
        let plain = Transform::IDENTITY;
        vec![
            placed(Shape::Sphere(sphere), &plain),
            placed(rectangle(DVec3::new(-0.5, 0.0, -0.7), DVec3::X, DVec3::Z * 1.4), &plain),
            placed(rectangle(DVec3::ZERO, DVec3::X, DVec3::new(0.4, 0.9, 0.1)), &skew),
            placed(Shape::Disk(disk), &plain),
            placed(Shape::Disk(disk), &skew),
            placed(Shape::Cuboid(cuboid), &skew),
            placed(mesh.clone(), &plain),
            placed(mesh, &skew),
        ]
    }

    /// A ray towards a chosen point meets it there, or the object itself is in the way; the density that the point is given is
    /// the one that it is found to have; and densities are the right size: the mean of one over them, where the point is seen,
    /// is the solid angle that the object fills, by rays in all directions.
    #[test]
    fn samples_lie_on_the_surface_with_the_density_they_claim() {
        let mut uniform = Uniform::new(8);
        for (number, object) in objects().into_iter().enumerate() {
            let sampler = AreaSampler::new(&object, &|_| 1.0).expect("it can be sampled");
            let aggregate = Aggregate::new(vec![object]);
            let mut counters = Counters::default();
            for from in [DVec3::new(0.5, 6.0, 0.3), DVec3::new(-5.0, -3.0, 4.0), DVec3::new(30.0, 40.0, 20.0)]
            {
                let (mut seen, mut filled) = (0.0, 0.0);
                let samples = 40_000;
                for _ in 0..samples {
                    let Some(sample) = sampler.sample(from, uniform.pair()) else { continue };
                    let query = Query::new(Ray::new(from, sample.towards));
                    let Some(hit) = aggregate.closest(&query, &mut counters) else {
                        // At the very border.
                        continue;
                    };
                    let surface = aggregate.interaction(&query, &hit);
                    assert!(hit.t < sample.distance * (1.0 + 1e-6));
                    if hit.t > sample.distance * (1.0 - 1e-6) {
                        seen += 1.0 / sample.pdf;
                        if hit.face != sample.face {
                            // At an edge.
                            continue;
                        }
                        let found = sampler.pdf(from, &surface);
                        assert!((found / sample.pdf - 1.0).abs() < 1e-6, "{number}: {found} {}", sample.pdf);
                        assert!(surface.ng.dot(sample.ng) > 0.999, "{number}: the normal");
                    }
                }
                // Directions about the ball around it.
                let (centre, radius) = sampler.ball();
                let around = cone(&Sphere::new(centre, radius).expect("valid"), from).expect("outside");
                let frame = Frame::around(unit(centre - from));
                for _ in 0..samples {
                    let [u, v] = uniform.pair();
                    let (sin, cos) = libm::sincos(TAU * v);
                    let z = 1.0 - u * around.versine;
                    let across = (1.0 - z * z).sqrt();
                    let towards = frame.to_world(DVec3::new(across * cos, across * sin, z));
                    let query = Query::new(Ray::new(from, unit(towards)));
                    filled += f64::from(u8::from(aggregate.closest(&query, &mut counters).is_some()));
                }
                let solid_angle = seen / f64::from(samples);
                let expected = filled / f64::from(samples) / around.density();
                // Some six standard errors of both.
                assert!((solid_angle / expected - 1.0).abs() < 0.05, "{number}: {solid_angle} {expected}");
            }
        }
    }

    /// Of a rectangle in closed form: directions are uniform, so that the mean cosine over the solid angle is the configuration
    /// factor (J. Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3), times π.
    #[test]
    fn a_spherical_rectangle_is_sampled_uniformly() {
        for (a, b, h) in [(0.7, 0.4, 1.0), (3.0, 0.1, 0.2), (0.1, 0.1, 1.0)] {
            let lamp = rectangle(DVec3::new(0.0, h, 0.0), DVec3::X * a, DVec3::Z * b);
            let sampler = AreaSampler::new(&placed(lamp, &Transform::IDENTITY), &|_| 1.0).expect("flat");
            let (x, y) = (a / h, b / h);
            let (rx, ry) = (f64::hypot(1.0, x), f64::hypot(1.0, y));
            let factor = (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / TAU;
            let edge = 200;
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(edge);
            let mut sum = 0.0;
            for i in 0..edge {
                for j in 0..edge {
                    let sample = sampler.sample(DVec3::ZERO, [at(i), at(j)]).expect("in view");
                    sum += sample.towards.y / sample.pdf;
                }
            }
            let found = sum / f64::from(edge * edge) / PI;
            assert!((found / factor - 1.0).abs() < 2e-5, "{a} x {b} at {h}: {found} {factor}");
        }
    }

    #[test]
    fn what_cannot_be_sampled_says_so() {
        let stretched = Transform::scale(DVec3::new(1.0, 2.0, 1.0)).expect("invertible");
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).expect("valid"));
        assert!(AreaSampler::new(&placed(sphere.clone(), &stretched), &|_| 1.0).is_none());
        assert!(
            AreaSampler::new(&placed(sphere, &Transform::IDENTITY), &|_| 0.0).is_none(),
            "it does not count"
        );
    }
}
