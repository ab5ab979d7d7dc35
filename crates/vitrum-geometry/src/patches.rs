//! Flat pieces of a surface, and points of them: faces of meshes and boxes, stretched rectangles, disks.
//!
//! A patch is chosen first, then a point of it. Up to [`FEW`] patches are chosen in proportion to their weight times the solid
//! angle that they fill, and none that turns its back: then the density is the patch's weight over the sum of these products, which
//! for equal weights is uniform over all that faces the point. More are chosen in proportion to weight and area.
//!
//! Within a triangle points are uniform in solid angle (`spherical_triangle.rs`), and in a parallelogram too, which is two of them.
//! In what is seen edge on, in an ellipse, and in what is so far away that it makes no difference ([`NEAR`]), they are uniform in
//! area.

use crate::area_sampler::{AreaSample, NormalCone, by_area, per_solid_angle};
use crate::interaction::SurfaceInteraction;
use crate::object::Object;
use crate::shape::Shape;
use crate::spherical_triangle::SphericalTriangle;
use std::f64::consts::PI;
use vitrum_math::{DVec3, Frame, Transform, concentric_disk};

/// More patches than this are not looked at one by one.
const FEW: usize = 16;

/// Where the squares of its edges are less of the square of the distance, a patch is sampled by area. The density then varies by
/// about the root of this over it, and the time that solid angles take is saved.
const NEAR: f64 = 0.01;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outline {
    Parallelogram,
    Triangle,
    Ellipse,
}

/// A flat piece of a shape: a corner or centre, and two vectors.
#[derive(Clone, Copy, Debug)]
struct Flat {
    outline: Outline,
    from: DVec3,
    edges: [DVec3; 2],
}

/// A flat piece in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    outline: Outline,
    from: DVec3,
    edges: [DVec3; 2],
    /// The product of the edges.
    normal: DVec3,
    ng: DVec3,
    face: u32,
}

impl Patch {
    #[inline]
    pub(crate) fn new(outline: Outline, from: DVec3, edges: [DVec3; 2], ng: DVec3, face: u32) -> Self {
        Self { outline, from, edges, normal: edges[0].cross(edges[1]), ng, face }
    }

    fn area(&self) -> f64 {
        let parallelogram = self.normal.length();
        match self.outline {
            Outline::Parallelogram => parallelogram,
            Outline::Triangle => 0.5 * parallelogram,
            Outline::Ellipse => PI * parallelogram,
        }
    }

    #[inline]
    fn faces(&self, from: DVec3) -> bool {
        (self.from - from).dot(self.ng) < 0.0
    }

    /// The solid angle that it fills, roughly where it is not needed exactly.
    #[inline]
    fn apparent_size(&self, from: DVec3) -> f64 {
        self.seen_from(from).solid_angle().unwrap_or_else(|| {
            let [u, v] = self.edges;
            let middle = match self.outline {
                Outline::Parallelogram => (u + v) * 0.5,
                Outline::Triangle => (u + v) / 3.0,
                Outline::Ellipse => DVec3::ZERO,
            };
            let offset = self.from + middle - from;
            let squared = offset.dot(offset);
            self.area() * offset.dot(self.ng).abs() / (squared * squared.sqrt())
        })
    }

    /// What a point sees of it.
    #[inline]
    pub(crate) fn seen_from(&self, from: DVec3) -> SeenPatch<'_> {
        let corner = self.from - from;
        let [u, v] = self.edges;
        let near = u.dot(u) + v.dot(v) > NEAR * corner.dot(corner);
        let half = |corner, edges| {
            if near { SphericalTriangle::new(corner, edges, self.normal) } else { None }
        };
        let halves = match self.outline {
            Outline::Triangle => half(corner, [u, v]).map(|all| (all, None)),
            Outline::Parallelogram => half(corner, [u, v])
                .zip(half(corner + u + v, [-u, -v]))
                .map(|(first, second)| (first, Some(second))),
            Outline::Ellipse => None,
        };
        SeenPatch { patch: self, halves }
    }
}

/// A patch around a point that looks.
pub(crate) struct SeenPatch<'p> {
    patch: &'p Patch,
    /// The triangles that it consists of, where it is sampled by solid angle.
    halves: Option<(SphericalTriangle, Option<SphericalTriangle>)>,
}

impl SeenPatch<'_> {
    /// Steradians, where they are known.
    #[inline]
    fn solid_angle(&self) -> Option<f64> {
        let (first, second) = self.halves.as_ref()?;
        Some(first.solid_angle() + second.as_ref().map_or(0.0, SphericalTriangle::solid_angle))
    }

    /// A point of it, and its density per steradian.
    #[inline]
    pub(crate) fn sample(&self, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
        let Patch { outline, from: corner, edges, ng, face, .. } = *self.patch;
        let point = |[s, t]: [f64; 2]| corner + edges[0] * s + edges[1] * t;
        let Some((first, second)) = &self.halves else {
            let shares = match outline {
                Outline::Parallelogram => [u, v],
                Outline::Triangle => {
                    let root = u.sqrt();
                    [root * (1.0 - v), root * v]
                }
                Outline::Ellipse => concentric_disk([u, v]).to_array(),
            };
            return by_area(from, point(shares), ng, 1.0 / self.patch.area(), face);
        };
        let (solid_angle, shares) = match second {
            None => (first.solid_angle(), first.sample([u, v])),
            Some(second) => {
                let total = first.solid_angle() + second.solid_angle();
                let share = first.solid_angle() / total;
                let within = |u: f64| u.clamp(0.0, 1.0 - f64::EPSILON);
                let shares = if u < share {
                    first.sample([within(u / share), v])
                } else {
                    let [s, t] = second.sample([within((u - share) / (1.0 - share)), v]);
                    [1.0 - s, 1.0 - t]
                };
                (total, shares)
            }
        };
        let point = point(shares);
        let offset = point - from;
        let distance = offset.length();
        Some(AreaSample { point, ng, towards: offset / distance, distance, pdf: 1.0 / solid_angle, face })
    }

    /// The density per steradian of a hit on it.
    #[inline]
    pub(crate) fn density_at(&self, from: DVec3, hit: &SurfaceInteraction) -> f64 {
        match self.solid_angle() {
            Some(solid_angle) => 1.0 / solid_angle,
            None => per_solid_angle(1.0 / self.patch.area(), hit.point - from, hit.ng),
        }
    }
}

/// Several patches, each with its weight.
#[derive(Clone, Debug)]
pub(crate) struct Patches {
    all: Vec<Weighted>,
    /// Where the faces of the object stand among the patches.
    of_face: Vec<Option<u32>>,
}

#[derive(Clone, Copy, Debug)]
struct Weighted {
    patch: Patch,
    weight: f64,
    /// Area times weight of this and all before.
    up_to: f64,
}

/// A patch that a point asks for.
struct Chosen<'p> {
    patch: &'p Patch,
    probability: f64,
    /// What is left of the number that chose it.
    within: f64,
}

impl Patches {
    pub(crate) fn new(object: &Object, weight: &dyn Fn(u32) -> f64) -> Option<Self> {
        let identity = Transform::IDENTITY;
        let to = object.transform().unwrap_or(&identity);
        let mut all: Vec<Weighted> = Vec::new();
        let mut total = 0.0;
        let outlines = outlines(object.shape())?;
        let mut of_face = vec![None; outlines.len()];
        for (face, (flat, outward)) in (0u32..).zip(outlines) {
            let edges = flat.edges.map(|e| to.world_vector(e));
            let normal = edges[0].cross(edges[1]);
            let normal = normal / normal.length();
            // Mirroring turns the product of the edges.
            let outward = to.world_normal(outward);
            let ng = if (normal.dot(outward) < 0.0) == object.is_flipped() { normal } else { -normal };
            let patch = Patch::new(flat.outline, to.world_point(flat.from), edges, ng, face);
            let weight = weight(face);
            let counts = patch.area() * weight;
            // What is too small to have an area is never hit either.
            if !(counts > 0.0 && counts.is_finite()) {
                continue;
            }
            total += counts;
            of_face[face as usize] = Some(all.len() as u32);
            all.push(Weighted { patch, weight, up_to: total });
        }
        (total > 0.0 && total.is_finite()).then_some(Self { all, of_face })
    }

    /// Square metres.
    pub(crate) fn area(&self) -> f64 {
        self.all.iter().map(|weighted| weighted.patch.area()).sum()
    }

    /// The sum of area times weight.
    pub(crate) fn weight(&self) -> f64 {
        self.all.last().map_or(0.0, |last| last.up_to)
    }

    /// The cone of their normals.
    pub(crate) fn normals(&self) -> NormalCone {
        NormalCone::around(self.all.iter().map(|w| (w.patch.ng, w.weight * w.patch.area())))
    }

    #[inline]
    pub(crate) fn sample(&self, from: DVec3, [u, v]: [f64; 2]) -> Option<AreaSample> {
        let Chosen { patch, probability, within } = self.choose(from, u)?;
        let sample = patch.seen_from(from).sample(from, [within, v])?;
        Some(AreaSample { pdf: sample.pdf * probability, ..sample })
    }

    /// The density per steradian of a hit on one of them.
    #[inline]
    pub(crate) fn pdf(&self, from: DVec3, hit: &SurfaceInteraction) -> f64 {
        let Some(index) = self.of_face.get(hit.face as usize).copied().flatten() else { return 0.0 };
        let index = index as usize;
        let probability = match self.all.len() {
            1 => 1.0,
            2..=FEW => {
                let mut sums = [0.0; FEW];
                let sums = self.look(from, &mut sums);
                share(|i| sums[i], index) / sums[sums.len() - 1]
            }
            _ => share(|i| self.all[i].up_to, index) / self.weight(),
        };
        // Not where nothing faces the point: that has no number.
        if probability > 0.0 {
            probability * self.all[index].patch.seen_from(from).density_at(from, hit)
        } else {
            0.0
        }
    }

    #[inline]
    fn choose(&self, from: DVec3, u: f64) -> Option<Chosen<'_>> {
        match self.all.len() {
            1 => Some(Chosen { patch: &self.all[0].patch, probability: 1.0, within: u }),
            2..=FEW => {
                let mut sums = [0.0; FEW];
                let sums = self.look(from, &mut sums);
                let at = u * sums[sums.len() - 1];
                self.chosen(sums.partition_point(|sum| *sum <= at), |i| sums[i], at)
            }
            _ => {
                let at = u * self.weight();
                let index = self.all.partition_point(|weighted| weighted.up_to <= at);
                self.chosen(index, |i| self.all[i].up_to, at)
            }
        }
    }

    /// The patch at an index, whose share of the sums `at` lies in.
    #[inline]
    fn chosen(&self, index: usize, up_to: impl Fn(usize) -> f64, at: f64) -> Option<Chosen<'_>> {
        let last = self.all.len() - 1;
        let index = index.min(last);
        let share = share(&up_to, index);
        let within = ((at - (up_to(index) - share)) / share).clamp(0.0, 1.0 - f64::EPSILON);
        (share > 0.0).then(|| Chosen {
            patch: &self.all[index].patch,
            probability: share / up_to(last),
            within,
        })
    }

    /// The sums of weight times solid angle of each patch and all before, for those that face a point.
    #[inline]
    fn look<'s>(&self, from: DVec3, sums: &'s mut [f64; FEW]) -> &'s [f64] {
        let mut sum = 0.0;
        for (weighted, up_to) in self.all.iter().zip(sums.iter_mut()) {
            if weighted.patch.faces(from) {
                sum += weighted.weight * weighted.patch.apparent_size(from);
            }
            *up_to = sum;
        }
        &sums[..self.all.len()]
    }
}

/// What the part at `index` adds to the sums.
#[inline]
fn share(up_to: impl Fn(usize) -> f64, index: usize) -> f64 {
    up_to(index) - if index == 0 { 0.0 } else { up_to(index - 1) }
}

/// The flat faces of a shape in their order, each with a vector outward; `None` where they are not all flat.
fn outlines(shape: &Shape) -> Option<Vec<(Flat, DVec3)>> {
    let patch = |outline, from, edges| Flat { outline, from, edges };
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
