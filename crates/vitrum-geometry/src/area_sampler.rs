//! Points of a surface, chosen for a point that looks at it: how light sources with an extent are asked for light.
//!
//! | surface | how | density |
//! |---|---|---|
//! | sphere, from outside | a direction of the cone that it fills | uniform in solid angle |
//! | rectangle | a direction of the spherical rectangle that it fills (C. Ureña, M. Fajardo and A. King, An Area-Preserving Parametrization for Spherical Rectangles, 2013); below [`SMALL`], as a patch | uniform in solid angle |
//! | everything else | a point of one of its flat patches | see `patches.rs` |
//!
//! Densities are per steradian, seen from the point that looks. What can't be sampled (an infinite plane, stretched spheres,
//! cylinders) has no sampler.

use crate::interaction::SurfaceInteraction;
use crate::object::Object;
use crate::patches::{Outline, Patch, Patches};
use crate::shape::{Rectangle, Shape, Sphere};
use std::f64::consts::{PI, TAU};
use vitrum_math::{Bounds, DVec3, Frame};

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

/// Directions about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalCone {
    /// Unit vector in the middle.
    pub axis: DVec3,
    /// Cosine of the largest angle to it; -1 where there are all.
    pub cos: f64,
}

impl NormalCone {
    /// All directions.
    const ALL: Self = Self { axis: DVec3::Z, cos: -1.0 };

    /// About the mean of some normals, each with what it counts.
    pub(crate) fn around(normals: impl Iterator<Item = (DVec3, f64)> + Clone) -> Self {
        let mean: DVec3 = normals.clone().map(|(normal, counts)| normal * counts).sum();
        let all: f64 = normals.clone().map(|(_, counts)| counts).sum();
        // Closed surfaces have no mean but what rounding leaves.
        if mean.length() <= 1e-6 * all {
            return Self::ALL;
        }
        let axis = mean / mean.length();
        Self { axis, cos: normals.map(|(normal, _)| normal.dot(axis)).fold(1.0, f64::min) }
    }

    /// The mean cosine that normals spread over the cone have towards its axis, where they face it.
    fn mean_cosine(&self) -> f64 {
        if self.cos >= 0.0 { 0.5 * (1.0 + self.cos) } else { 0.5 / (1.0 - self.cos) }
    }
}

/// Chooses points of one object.
#[derive(Clone, Debug)]
pub struct AreaSampler {
    kind: Kind,
    area: f64,
    weight: f64,
    bounds: Bounds,
    /// No point is farther from the centre.
    radius: f64,
    normals: NormalCone,
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
            Kind::Patches(patches) => (patches.area(), patches.weight()),
        };
        let (radius, normals) = match &kind {
            Kind::Sphere { sphere, .. } => (sphere.radius(), NormalCone::ALL),
            Kind::Rectangle(r) => (bounds.extent().length() * 0.5, NormalCone { axis: r.ng, cos: 1.0 }),
            Kind::Patches(patches) => (bounds.extent().length() * 0.5, patches.normals()),
        };
        (weight > 0.0 && weight.is_finite()).then_some(Self { kind, area, weight, bounds, radius, normals })
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
        (self.bounds.centre(), self.radius)
    }

    /// A box around it.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The outward normals of what may be chosen.
    pub fn normals(&self) -> NormalCone {
        self.normals
    }

    /// Weight times area as it looks from far away: along the axis of the normals, roughly, and of a sphere from everywhere.
    pub fn intensity(&self) -> f64 {
        self.weight * self.normals.mean_cosine()
    }

    /// A point of the surface for a point of the unit square; `None` where it sees nothing of it.
    // Always: there are several callers, and the compiler would not inline it into any.
    #[inline(always)]
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
        match &self.kind {
            Kind::Sphere { sphere, .. } => match cone(sphere, from) {
                Some(cone) => cone.density(),
                None => per_solid_angle(1.0 / self.area, hit.point - from, hit.ng),
            },
            Kind::Rectangle(rectangle) => match rectangle.seen_from(from).solid_angle() {
                Some(solid_angle) => 1.0 / solid_angle,
                None => rectangle.patch().seen_from(from).density_at(from, hit),
            },
            Kind::Patches(patches) => patches.pdf(from, hit),
        }
    }
}

/// A density per area as one per steradian; infinite for a surface seen edge on.
#[inline]
pub(crate) fn per_solid_angle(per_area: f64, offset: DVec3, normal: DVec3) -> f64 {
    let squared = offset.dot(offset);
    per_area * squared * squared.sqrt() / offset.dot(normal).abs()
}

/// A sample of a point that was chosen by area; `None` where the density is not finite.
#[inline]
pub(crate) fn by_area(from: DVec3, point: DVec3, ng: DVec3, per_area: f64, face: u32) -> Option<AreaSample> {
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
        self.patch().seen_from(from).sample(from, [u, v])
    }

    /// The same as a patch.
    #[inline]
    fn patch(&self) -> Patch {
        let [x, y, _] = self.axes;
        let edges = [x * self.extent[0], y * self.extent[1]];
        Patch::new(Outline::Parallelogram, self.corner, edges, self.ng, 0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aggregate::{Aggregate, Counters};
    use crate::departure::Query;
    use crate::mesh::{MeshData, TriangleMesh};
    use crate::shape::{Cuboid, Disk};
    use std::sync::Arc;
    use vitrum_math::{Ray, Transform, unit};
    use vitrum_testkit::{SphereGrid, Uniform, chi_square_of_directions, sidak_level};

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
                    let surface = aggregate.interaction(&query, &hit, &mut Counters::default());
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

    /// The radiance of one that a receiver gets from polygons, over π (J. Lambert, Photometria, 1760): for each edge half the angle
    /// that it spans, times the cosine between the receiver's normal and the plane of edge and point.
    fn lambert(from: DVec3, normal: DVec3, polygons: &[Vec<DVec3>]) -> f64 {
        let edge = |a: DVec3, b: DVec3| {
            let (a, b) = (unit(a - from), unit(b - from));
            let across = a.cross(b);
            0.5 * libm::atan2(across.length(), a.dot(b)) * unit(across).dot(normal)
        };
        let around = |corners: &Vec<DVec3>| {
            let count = corners.len();
            (0..count).map(|i| edge(corners[i], corners[(i + 1) % count])).sum::<f64>().abs()
        };
        polygons.iter().map(around).sum::<f64>() / PI
    }

    /// What faces the point, of a box and of a stretched rectangle, gives the configuration factor of its polygons. Strata of
    /// the square that lie across two patches leave an error of about one over their number.
    #[test]
    fn patches_give_the_configuration_factor_of_their_outlines() {
        let (min, max) = (DVec3::new(-0.5, 1.0, -0.3), DVec3::new(0.7, 1.4, 0.9));
        let cuboid = placed(Shape::Cuboid(Cuboid::new(min, max).expect("valid")), &Transform::IDENTITY);
        let from = DVec3::new(-2.0, 0.2, 0.1);
        let normal = unit(DVec3::new(1.0, 0.6, 0.0));
        let corner = |x: bool, y: bool, z: bool| {
            let of = |high: bool, axis: usize| if high { max[axis] } else { min[axis] };
            DVec3::new(of(x, 0), of(y, 1), of(z, 2))
        };
        let [f, t] = [false, true];
        let left = vec![corner(f, f, f), corner(f, f, t), corner(f, t, t), corner(f, t, f)];
        let below = vec![corner(f, f, f), corner(t, f, f), corner(t, f, t), corner(f, f, t)];
        let (base, u, v) = (DVec3::new(0.3, 2.0, -0.5), DVec3::new(1.0, 0.4, 0.0), DVec3::new(0.5, 0.0, 1.5));
        let slanted = placed(rectangle(base, u, v), &Transform::IDENTITY);
        let outline = vec![base, base + u, base + u + v, base + v];
        for (object, polygons) in [(cuboid, vec![left, below]), (slanted, vec![outline])] {
            let sampler = AreaSampler::new(&object, &|_| 1.0).expect("it can be sampled");
            let expected = lambert(from, normal, &polygons);
            let edge = 1000;
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(edge);
            let mut sum = 0.0;
            for i in 0..edge {
                for j in 0..edge {
                    let sample = sampler.sample(from, [at(i), at(j) * at(j)]).expect("in view");
                    sum += sample.towards.dot(normal) / sample.pdf * 2.0 * at(j);
                }
            }
            let found = sum / f64::from(edge * edge) / PI;
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }

    /// Directions of samples follow the density of what they hit: of boxes and meshes, whose patches are chosen by what they fill
    /// of the view, uniform over all of it.
    #[test]
    fn directions_follow_their_density() {
        let all = objects();
        let tests = [(2, 1.7), (5, 2.2), (7, 2.6)];
        let level = sidak_level(1e-3, tests.len() as u32);
        for (number, distance) in tests {
            let object = all[number].clone();
            let sampler = AreaSampler::new(&object, &|_| 1.0).expect("it can be sampled");
            let (centre, _) = sampler.ball();
            let aggregate = Aggregate::new(vec![object]);
            let mut away = unit(DVec3::new(1.0, 2.0, -0.8));
            if sampler.sample(centre + away * distance, [0.5, 0.5]).is_none_or(|s| s.towards.dot(s.ng) >= 0.0)
            {
                away = -away;
            }
            let from = centre + away * distance;
            let density = |direction: DVec3| {
                let query = Query::new(Ray::new(from, direction));
                let hit = aggregate.closest(&query, &mut Counters::default());
                hit.map_or(0.0, |hit| {
                    sampler.pdf(from, &aggregate.interaction(&query, &hit, &mut Counters::default()))
                })
            };
            // The silhouette is where samples may miss by their rounding.
            let sample = |uniform: &mut Uniform| sampler.sample(from, uniform.pair()).map(|s| s.towards);
            let outcome =
                chi_square_of_directions(sample, density, SphereGrid { theta: 20, phi: 40 }, 200_000, 3);
            assert!(outcome.passes(level), "{number}: {outcome}");
            assert!((outcome.integral - 1.0).abs() < 1e-3, "{number}: {outcome}");
        }
    }

    /// On the plane, far away, next to needles and above what fills half the view: a sample has numbers, faces the point, and lies
    /// on the patch; and the mean of one over the density is the solid angle, where that is known.
    #[test]
    fn extremes_have_numbers() {
        let triangle = |a: DVec3, b: DVec3, c: DVec3| {
            let data =
                MeshData { positions: vec![a, b, c], triangles: vec![[0, 1, 2]], ..MeshData::default() };
            placed(Shape::Mesh(Arc::new(TriangleMesh::new(data).expect("valid mesh"))), &Transform::IDENTITY)
        };
        let (o, x, z) = (DVec3::ZERO, DVec3::X, DVec3::Z);
        let far = DVec3::new(0.0, 1e6, 0.0);
        let cases = [
            // From above, which is outside: the corners go round against the clock.
            (triangle(o, z, x), far, Some(0.5e-12)),
            (triangle(o, z * 1e-5, x), DVec3::new(0.5, 1.0, 0.0), None),
            (triangle(-x * 1e6, z * 1e6, x * 1e6), DVec3::new(0.0, 1e-3, 3e5), Some(TAU)),
            (triangle(o, z, x), DVec3::new(-1.0, 1e-5, 0.3), None),
            (triangle(o, z, x), DVec3::new(-1.0, 1e-12, 0.3), None),
            (triangle(o, z, x), DVec3::new(-1.0, 0.0, 0.3), Some(0.0)),
            (triangle(o, z, x), DVec3::new(0.2, 0.0, 0.2), Some(0.0)),
            (triangle(o, z, x), DVec3::ZERO, Some(0.0)),
            (triangle(o, z, x), DVec3::new(0.2, 1e-13, 0.2), None),
        ];
        let mut uniform = Uniform::new(2);
        for (number, (object, from, solid_angle)) in cases.into_iter().enumerate() {
            let sampler = AreaSampler::new(&object, &|_| 1.0).expect("it can be sampled");
            let bounds = object.bounds().expect("it is finite");
            let count = 10_000;
            let mut sum = 0.0;
            for _ in 0..count {
                let Some(sample) = sampler.sample(from, uniform.pair()) else { continue };
                assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{number}: {sample:?}");
                assert!((sample.towards.length() - 1.0).abs() < 1e-12, "{number}: {sample:?}");
                assert!(sample.towards.dot(sample.ng) < 0.0, "{number}: {sample:?}");
                let reach = 1e-9 * bounds.extent().length();
                let low = sample.point.cmpge(bounds.min - DVec3::splat(reach)).all();
                assert!(
                    low && sample.point.cmple(bounds.max + DVec3::splat(reach)).all(),
                    "{number}: {sample:?}"
                );
                sum += 1.0 / sample.pdf;
            }
            if let Some(expected) = solid_angle {
                let found = sum / f64::from(count);
                assert!((found - expected).abs() <= 1e-5 * expected, "{number}: {found} {expected}");
            }
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
