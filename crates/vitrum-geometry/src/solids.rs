//! What a ray inside a solid can meet: the solid itself, and what reaches into its bounds. Glass asks this all the time, and
//! is spared everything else that the scene holds.
//!
//! A ray that leaves a closed surface inward comes to that surface again. The way there lies within the bounds of the solid, so
//! objects whose bounds lie apart from these can't be met on it. Where the surface is not closed, the ray may come to nothing:
//! then everything is searched, so that no more than time depends on it.

use crate::departure::Query;
use crate::object::Object;
use crate::overlap::touching;
use vitrum_math::Bounds;

/// Longer lists are not kept: a tree finds its way among more objects sooner.
const MOST: usize = 4;

/// Bounds are widened by this share of their extent, and of their distance from the origin: more than the roundings of what is
/// traced, which is single precision in the frame of a mesh.
const WIDENED: (f64, f64) = (1e-6, 1e-14);

/// For each object what a ray inside it can meet, itself first, if it may have an inside and that is little.
#[derive(Clone, Debug)]
pub(crate) struct Solids(Vec<Option<Vec<u32>>>);

impl Solids {
    /// As if none of so many objects had an inside.
    pub(crate) fn none(objects: usize) -> Self {
        Self(vec![None; objects])
    }

    /// Of all objects and, by id, the bounds of those that have any.
    pub(crate) fn new(objects: &[Object], bounded: &[(u32, Bounds)]) -> Self {
        let mut within: Vec<Vec<u32>> = (0..objects.len() as u32).map(|id| vec![id]).collect();
        let mut meets = |id: u32, other: u32| {
            // One more than are kept says that there are too many.
            if within[id as usize].len() <= MOST {
                within[id as usize].push(other);
            }
        };
        let widened = |(id, b): &(u32, Bounds)| {
            let farthest = b.min.abs().max(b.max.abs()).max_element();
            (*id, b.padded(WIDENED.0 * b.extent().max_element() + WIDENED.1 * farthest))
        };
        let bounded: Vec<(u32, Bounds)> = bounded.iter().map(widened).collect();
        let boxes: Vec<Bounds> = bounded.iter().map(|(_, bounds)| *bounds).collect();
        touching(&boxes, |a, b| {
            meets(bounded[a].0, bounded[b].0);
            meets(bounded[b].0, bounded[a].0);
        });
        for (other, infinite) in (0u32..).zip(objects).filter(|(_, o)| o.bounds().is_none()) {
            for (id, _) in bounded.iter().filter(|(_, bounds)| infinite.may_cross(bounds)) {
                meets(*id, other);
            }
        }
        let is_worth = |object: &Object, list: &[u32]| {
            object.may_enclose() && list.len() <= MOST && list.len() < objects.len()
        };
        Self(
            objects
                .iter()
                .zip(within)
                .map(|(object, list)| is_worth(object, &list).then_some(list))
                .collect(),
        )
    }

    /// The solid that the ray starts inside of, when it does and is still there, and what reaches into its bounds.
    #[inline]
    pub(crate) fn around(&self, query: &Query) -> Option<(u32, &[u32])> {
        let departed = query.departed.as_ref()?;
        if !departed.behind || query.has_passed() {
            return None;
        }
        let (solid, others) = self.0[departed.object as usize].as_ref()?.split_first()?;
        Some((*solid, others))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Plane, Shape, Sphere};
    use vitrum_math::{DVec3, Transform};

    fn object(shape: Shape) -> Object {
        Object::new(shape, &Transform::IDENTITY, false).expect("valid")
    }

    fn sphere(x: f64, y: f64) -> Object {
        object(Shape::Sphere(Sphere::new(DVec3::new(x, y, 0.0), 1.0).expect("valid")))
    }

    fn solids(objects: &[Object]) -> Vec<Option<Vec<u32>>> {
        let bounded: Vec<_> =
            (0u32..).zip(objects).filter_map(|(id, o)| o.bounds().map(|b| (id, b))).collect();
        Solids::new(objects, &bounded).0
    }

    #[test]
    fn a_solid_is_searched_with_what_touches_it() {
        let floor = object(Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).expect("valid")));
        let objects = [sphere(0.0, 1.5), sphere(2.0, 1.5), sphere(4.5, 1.5), sphere(8.0, 1.0), floor];
        // The first two touch each other, the fourth stands on the floor, which has no inside.
        let expected = [Some(vec![0, 1]), Some(vec![1, 0]), Some(vec![2]), Some(vec![3, 4]), None];
        assert_eq!(solids(&objects), expected);
    }

    #[test]
    fn nothing_is_gained_where_everything_touches() {
        assert_eq!(solids(&[sphere(0.0, 0.0), sphere(1.0, 0.0)]), [None, None]);
        let crowd: Vec<Object> = (0..=MOST).map(|i| sphere(0.1 * i as f64, 0.0)).collect();
        let alone = sphere(9.0, 0.0);
        let found = solids(&[crowd, vec![alone]].concat());
        assert!(found[..=MOST].iter().all(Option::is_none), "too many to try one by one");
        assert_eq!(found[MOST + 1], Some(vec![MOST as u32 + 1]));
    }
}
