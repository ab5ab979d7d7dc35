//! A few spheres that every ray is tried against, four at a time.
//!
//! The sweep asks of each whether its [crossings](Sphere::crossings) exist and one of them lies ahead, by the same operations
//! in the same order, so that what it passes over is what would have come to nothing. Only the others are worked out.

use crate::aggregate::{Hit, Nearest};
use crate::departure::Query;
use crate::shape::{Crossing, Sphere};
use crate::wide::{Doubles, Isa, Processor, Task};
use vitrum_math::{DVec3, Ray};

const LANES: usize = 4;

/// The number of no object, where a block has room left.
const NONE: u32 = u32::MAX;

/// The number of no object either, where a ray leaves none: it must not be taken for room left.
const NOWHERE: u32 = u32::MAX - 1;

/// Spheres and the numbers of the objects that they are.
#[derive(Clone, Debug)]
pub(crate) struct Spheres {
    blocks: Vec<Block>,
    /// Chosen once more here: the sweep is a call of its own, so that scenes without spheres don't prepare for them.
    isa: Isa,
}

#[derive(Clone, Debug)]
#[repr(align(64))]
struct Block {
    /// By axis.
    centres: [[f64; LANES]; 3],
    /// Squares of the radii; NaN where there is no sphere, with which nothing compares.
    squares: [f64; LANES],
    objects: [u32; LANES],
    spheres: [Sphere; LANES],
}

impl Block {
    fn new(spheres: &[(u32, Sphere)]) -> Self {
        let mut block = Self {
            centres: [[0.0; LANES]; 3],
            squares: [f64::NAN; LANES],
            objects: [NONE; LANES],
            spheres: [spheres[0].1; LANES],
        };
        for (lane, (object, sphere)) in spheres.iter().enumerate() {
            for axis in 0..3 {
                block.centres[axis][lane] = sphere.centre()[axis];
            }
            block.squares[lane] = sphere.radius() * sphere.radius();
            block.objects[lane] = *object;
            block.spheres[lane] = *sphere;
        }
        block
    }

    /// A bit for each sphere that the ray crosses ahead of its origin, and for the one that it leaves.
    // No closures with lanes in them: they would be compiled for any processor.
    #[inline(always)]
    fn met<D: Doubles>(&self, ray: &Ray, left: u32) -> u32 {
        let (o, d) = (splat::<D>(ray.origin), splat::<D>(ray.direction));
        let [x, y, z] = &self.centres;
        let from_centre = [o[0].sub(D::new(*x)), o[1].sub(D::new(*y)), o[2].sub(D::new(*z))];
        let zero = D::splat(0.0);
        let towards = zero.sub(dot(from_centre, d));
        let to_foot = towards.div(D::splat(ray.direction.dot(ray.direction)));
        let foot = [
            from_centre[0].add(d[0].mul(to_foot)),
            from_centre[1].add(d[1].mul(to_foot)),
            from_centre[2].add(d[2].mul(to_foot)),
        ];
        let squares = D::new(self.squares);
        let crossed = dot(foot, foot).at_most(squares);
        let ahead = zero.at_most(towards) | dot(from_centre, from_centre).at_most(squares);
        let left = (0..LANES).fold(0, |mask, lane| mask | u32::from(self.objects[lane] == left) << lane);
        crossed & ahead | left
    }

    /// The next of those in `met`, and its first crossing that counts.
    #[inline(always)]
    fn first(&self, met: &mut u32, query: &Query) -> (u32, Crossing) {
        let lane = met.trailing_zeros() as usize % LANES;
        *met &= *met - 1;
        let object = self.objects[lane];
        let crossings = self.spheres[lane].crossings(&query.ray, query.face_left(object));
        (object, query.first(crossings, object))
    }
}

#[inline(always)]
fn splat<D: Doubles>(v: DVec3) -> [D; 3] {
    [D::splat(v.x), D::splat(v.y), D::splat(v.z)]
}

#[inline(always)]
fn dot<D: Doubles>(a: [D; 3], b: [D; 3]) -> D {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

impl Spheres {
    pub(crate) fn new(spheres: &[(u32, Sphere)]) -> Self {
        Self { blocks: spheres.chunks(LANES).map(Block::new).collect(), isa: Isa::best() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Offers the first crossing of each that counts.
    #[inline(never)]
    pub(crate) fn closest(&self, query: &Query, nearest: &mut Nearest) {
        self.isa.run(&mut Closest { spheres: self, query, nearest });
    }

    /// True when one is crossed nearer than `limit`.
    #[inline(never)]
    pub(crate) fn any(&self, query: &Query, limit: f64) -> bool {
        self.isa.run(&mut Any { spheres: self, query, limit })
    }
}

/// The object that a ray leaves.
#[inline(always)]
fn left(query: &Query) -> u32 {
    query.departed.map_or(NOWHERE, |departed| departed.object)
}

struct Closest<'a> {
    spheres: &'a Spheres,
    query: &'a Query,
    nearest: &'a mut Nearest,
}

impl Task for Closest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<P: Processor>(&mut self) {
        let left = left(self.query);
        for block in &self.spheres.blocks {
            let mut met = block.met::<P::Exact>(&self.query.ray, left);
            while met != 0 {
                let (object, Crossing { t, face }) = block.first(&mut met, self.query);
                if t <= self.nearest.limit() && t < f64::INFINITY {
                    self.nearest.offer(Hit { t, object, face, barycentrics: [0.0; 2] });
                }
            }
        }
    }
}

struct Any<'a> {
    spheres: &'a Spheres,
    query: &'a Query,
    limit: f64,
}

impl Task for Any<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<P: Processor>(&mut self) -> bool {
        let left = left(self.query);
        for block in &self.spheres.blocks {
            let mut met = block.met::<P::Exact>(&self.query.ray, left);
            while met != 0 {
                if block.first(&mut met, self.query).1.t < self.limit {
                    return true;
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::departure::Departure;
    use vitrum_math::unit;
    use vitrum_testkit::Uniform;

    /// The sweep finds what trying every sphere finds, with every kind of instructions: rays from outside, inside and far away,
    /// some of them tangent, some that leave a sphere to either side.
    #[test]
    fn the_sweep_finds_what_trying_every_sphere_finds() {
        let mut uniform = Uniform::new(4);
        let mut point =
            || DVec3::new(uniform.number(), uniform.number(), uniform.number()) * 2.0 - DVec3::ONE;
        let all: Vec<(u32, Sphere)> = (0..11)
            .map(|i| (2 * i + 1, Sphere::new(point(), 0.05 + 0.4 * point().x.abs()).expect("valid")))
            .collect();
        let (mut hits, mut departed) = (0, 0);
        for i in 0..20_000 {
            let (id, sphere) = all[i % all.len()];
            let (from, towards) = (point() * [0.5, 2.0, 1e3][i % 3], unit(point()));
            let mut query = match i % 4 {
                // Past the rim, within a few roundings.
                0 => {
                    let across = unit(towards.cross(point()));
                    let rim = sphere.centre() + across * (sphere.radius() * (1.0 + 1e-16 * point().x));
                    Query::new(Ray::new(rim - towards * point().y * 3.0, towards))
                }
                1 => {
                    let normal = unit(point());
                    let ray = Ray::new(sphere.centre() + normal * sphere.radius(), towards);
                    let behind = towards.dot(normal) < 0.0;
                    departed += 1;
                    Query::leaving(ray, Departure { object: id, face: 0, behind, error: 0.0 })
                }
                _ => Query::new(Ray::new(from, towards)),
            };
            for _ in 0..3 {
                let firsts = all.iter().map(|(id, sphere)| {
                    (*id, query.first(sphere.crossings(&query.ray, query.face_left(*id)), *id))
                });
                let expected = firsts.fold((u32::MAX, f64::INFINITY), |best, (id, crossing)| {
                    if crossing.t < best.1 { (id, crossing.t) } else { best }
                });
                for &isa in Isa::all() {
                    let swept = Spheres { isa, ..Spheres::new(&all) };
                    let mut nearest = Nearest::default();
                    swept.closest(&query, &mut nearest);
                    let found = nearest.found().map_or((u32::MAX, f64::INFINITY), |hit| (hit.object, hit.t));
                    assert_eq!(found, expected, "{isa:?}, ray {i}");
                    for limit in [0.1, 1.0, 1e4] {
                        assert_eq!(swept.any(&query, limit), expected.1 < limit, "{isa:?}, ray {i}");
                    }
                }
                if expected.1 == f64::INFINITY {
                    break;
                }
                hits += 1;
                query.pass(expected.1, expected.0, 0);
            }
        }
        assert!(hits > 8000 && departed > 4000, "{hits} hits, {departed} leave a sphere");
    }
}
