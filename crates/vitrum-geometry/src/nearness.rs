//! How near the surfaces of two objects come to each other, seen from points all over the first: whether they are flush, or face each
//! other across a gap that was hardly meant.

use crate::aggregate::{Aggregate, Counters};
use crate::departure::Query;
use vitrum_math::{DVec3, Ray};

/// Rays that look for points of a surface, along each axis and across it.
const ACROSS: u32 = 32;

/// So many crossings of one of these rays are looked at.
const MOST_CROSSINGS: u32 = 64;

/// What points of one surface have next to them of another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Nearness {
    /// Points that were looked at.
    pub points: u32,
    /// Those where the other surface is the same but for rounding.
    pub flush: u32,
    /// Those that face the outside of the other object across a gap.
    pub gaps: u32,
    /// The narrowest of these gaps, metres, and where it is.
    pub narrowest: Option<(f64, DVec3)>,
}

impl Aggregate {
    /// How near the surface of `other` comes to that of `object` outside of both, as far as `reach` metres. Both are bounded.
    pub fn nearness(&self, object: u32, other: u32, reach: f64) -> Nearness {
        let [a, b] = [object, other].map(|id| &self.objects()[id as usize]);
        let rounding = a.surface_error() + b.surface_error();
        let mut found = Nearness::default();
        let Some(bounds) = a.bounds() else { return found };
        let mut counters = Counters::default();
        let extent = bounds.extent();
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut direction = DVec3::ZERO;
            direction[axis] = 1.0;
            for i in 0..ACROSS * ACROSS {
                // Not at the middles of cells: edges of models lie there.
                let at = |step: u32, offset: f64| (f64::from(step) + offset) / f64::from(ACROSS);
                let mut origin = bounds.min - direction * extent[axis];
                origin[u] += extent[u] * at(i % ACROSS, 0.382);
                origin[v] += extent[v] * at(i / ACROSS, 0.618);
                let mut query = Query::new(Ray::new(origin, direction));
                for _ in 0..MOST_CROSSINGS {
                    let Some(hit) = self.closest_of(object, &query, f64::INFINITY, &mut counters) else {
                        break;
                    };
                    let surface = a.interaction(&query, &hit, &mut counters);
                    query.pass(hit.t, hit.object, hit.face);
                    self.look_from(
                        surface.point,
                        surface.ng,
                        other,
                        rounding,
                        reach,
                        &mut found,
                        &mut counters,
                    );
                }
            }
        }
        found
    }

    /// Looks from a point of a surface along its normal.
    #[expect(clippy::too_many_arguments, reason = "the inside of one loop, taken out")]
    fn look_from(
        &self,
        point: DVec3,
        normal: DVec3,
        other: u32,
        rounding: f64,
        reach: f64,
        found: &mut Nearness,
        counters: &mut Counters,
    ) {
        found.points += 1;
        let outward = Query::new(Ray::new(point - normal * (2.0 * rounding), normal));
        let Some(hit) = self.closest_of(other, &outward, reach + 2.0 * rounding, counters) else { return };
        let distance = hit.t - 2.0 * rounding;
        if distance <= rounding {
            found.flush += 1;
        } else if self.objects()[other as usize].interaction(&outward, &hit, counters).front {
            found.gaps += 1;
            if found.narrowest.is_none_or(|(least, _)| distance < least) {
                found.narrowest = Some((distance, point));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::Object;
    use crate::shape::{Cuboid, Shape, Sphere};
    use vitrum_math::Transform;

    fn cube(low: f64, high: f64) -> Object {
        let shape = Cuboid::new(DVec3::new(low, 0.0, 0.0), DVec3::new(high, 1.0, 1.0)).expect("valid");
        object(Shape::Cuboid(shape))
    }

    fn object(shape: Shape) -> Object {
        Object::new(shape, &Transform::IDENTITY, false).expect("valid")
    }

    /// Two of six sides of a cube are crossed by the rays along each axis, so that a sixth of the points is on each side.
    #[test]
    fn sides_of_boxes_are_flush_or_apart() {
        let near = |a: Object, b: Object| Aggregate::new(vec![a, b]).nearness(0, 1, 0.01);
        let points = 6 * ACROSS * ACROSS;
        let flush = near(cube(0.0, 1.0), cube(1.0, 2.0));
        assert_eq!((flush.points, flush.flush, flush.gaps), (points, points / 6, 0));
        let gap = near(cube(0.0, 1.0), cube(1.001, 2.0));
        assert_eq!((gap.flush, gap.gaps), (0, points / 6));
        let (width, at) = gap.narrowest.expect("there is a gap");
        assert!((width - 0.001).abs() < 1e-12 && at.x == 1.0, "{width} at {at}");
        for (a, b) in [(cube(0.0, 1.0), cube(0.999, 2.0)), (cube(0.0, 1.0), cube(1.02, 2.0))] {
            let far = near(a, b);
            assert_eq!((far.gaps, far.narrowest), (0, None), "they overlap, or are too far apart");
        }
    }

    #[test]
    fn spheres_in_spheres_have_gaps_only_outside_of_both() {
        let sphere = |radius: f64| object(Shape::Sphere(Sphere::new(DVec3::ZERO, radius).expect("valid")));
        let all = Aggregate::new(vec![sphere(1.0), sphere(1.001)]);
        let found = all.nearness(0, 1, 0.01);
        assert!(found.points > 4000, "{found:?}");
        assert_eq!((found.flush, found.gaps), (0, 0), "one lies in the other");
        let same = Aggregate::new(vec![sphere(1.0), sphere(1.0)]).nearness(0, 1, 0.01);
        assert_eq!(same.flush, same.points);
    }
}
