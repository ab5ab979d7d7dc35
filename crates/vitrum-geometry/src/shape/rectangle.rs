//! A parallelogram; with perpendicular edges, a rectangle.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `corner` | metres | finite |
//! | `edge_u`, `edge_v` | from the corner to its neighbours, metres | not zero, not parallel |
//!
//! The normal is `edge_u × edge_v`. Points are rebuilt from their two coordinates, so that they lie in the plane.

use super::{Crossings, Leaving, ShapeError, SurfacePoint, direction, finite, plane_distance};
use vitrum_math::{Bounds, DVec2, DVec3, Ray};

/// A parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    corner: DVec3,
    edges: [DVec3; 2],
    /// The vectors whose products with a point's offset from the corner are its coordinates along the edges.
    dual: [DVec3; 2],
    normal: DVec3,
}

impl Rectangle {
    /// The parallelogram with one corner and the edges that start there.
    ///
    /// # Errors
    /// [`ShapeError`] for parameters that are not finite, or edges that are zero or parallel.
    pub fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Result<Self, ShapeError> {
        direction(edge_u, "edge_u")?;
        direction(edge_v, "edge_v")?;
        let cross = edge_u.cross(edge_v);
        let normal = direction(cross, "normal").map_err(|_| ShapeError::ParallelEdges)?;
        let area_squared = cross.dot(cross);
        let dual = [edge_v.cross(cross) / area_squared, cross.cross(edge_u) / area_squared];
        if dual.iter().all(|d| d.is_finite()) {
            Ok(Self { corner: finite(corner, "corner")?, edges: [edge_u, edge_v], dual, normal })
        } else {
            Err(ShapeError::ParallelEdges)
        }
    }

    /// The corner and the two edges that start there, in metres.
    pub const fn corner_and_edges(&self) -> (DVec3, [DVec3; 2]) {
        (self.corner, self.edges)
    }

    pub(crate) fn bounds(&self) -> Bounds {
        let [u, v] = self.edges;
        Bounds::around([self.corner, self.corner + u, self.corner + v, self.corner + u + v])
    }

    #[inline]
    fn coordinates(&self, ray: &Ray, t: f64) -> DVec2 {
        let offset = (ray.origin - self.corner) + ray.direction * t;
        DVec2::new(self.dual[0].dot(offset), self.dual[1].dot(offset))
    }

    /// Where the line of `ray` crosses the parallelogram.
    #[inline]
    pub fn crossings(&self, ray: &Ray, leaving: Option<Leaving>) -> Crossings {
        match plane_distance(ray, self.corner, self.normal) {
            Some(t) if leaving.is_none() => {
                let c = self.coordinates(ray, t);
                let inside = (0.0..=1.0).contains(&c.x) && (0.0..=1.0).contains(&c.y);
                if inside { Crossings::one(t, 0) } else { Crossings::NONE }
            }
            _ => Crossings::NONE,
        }
    }

    /// The point at distance `t`.
    #[inline]
    pub fn surface_point(&self, ray: &Ray, t: f64) -> SurfacePoint {
        let c = self.coordinates(ray, t).clamp(DVec2::ZERO, DVec2::ONE);
        SurfacePoint { point: self.corner + self.edges[0] * c.x + self.edges[1] * c.y, normal: self.normal }
    }

    /// The coordinates of a point along the edges.
    pub(crate) fn uv(&self, point: DVec3) -> DVec2 {
        let offset = point - self.corner;
        DVec2::new(self.dual[0].dot(offset), self.dual[1].dot(offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skewed_edges_bound_it() {
        let r =
            Rectangle::new(DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)).expect("valid");
        let at = |x: f64, y: f64| r.crossings(&Ray::new(DVec3::new(x, y, 1.0), -DVec3::Z), None);
        assert_eq!(at(1.5, 0.5), Crossings::one(1.0, 0));
        assert_eq!(at(0.4, 0.5), Crossings::NONE, "left of the slanted edge");
        assert_eq!(at(2.6, 0.5), Crossings::NONE, "right of the slanted edge");
        assert_eq!(r.surface_point(&Ray::new(DVec3::new(1.5, 0.5, 1.0), -DVec3::Z), 1.0).normal, DVec3::Z);
    }

    #[test]
    fn parallel_edges_are_refused() {
        let parallel = Rectangle::new(DVec3::ZERO, DVec3::X, DVec3::X * -3.0);
        assert_eq!(parallel, Err(ShapeError::ParallelEdges));
    }
}
