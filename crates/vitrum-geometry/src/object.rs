//! A shape in its place.

use crate::aggregate::{Counters, Hit, Nearest};
use crate::departure::Query;
use crate::interaction::SurfaceInteraction;
use crate::mesh::{MeshPoint, TriangleMesh};
use crate::shape::{Crossing, Plane, Rectangle, Shape, ShapeError, Sphere, SurfacePoint};
use std::sync::Arc;
use vitrum_math::{Bounds, DVec2, DVec3, Ray, Transform, unit};

/// A shape with its transform and orientation.
#[derive(Clone, Debug)]
pub struct Object {
    shape: Shape,
    /// `None` where the shape itself stands in world space.
    transform: Option<Transform>,
    flipped: bool,
    /// What was described, where the shape took up its transform and texture coordinates are asked for.
    described: Option<Box<(Shape, Transform)>>,
}

impl Object {
    /// A shape placed by `transform`; `flip` turns its outside inward, for surfaces that are parts of compound objects.
    /// Shapes that can take up the transform do, so that rays need none.
    ///
    /// # Errors
    /// [`ShapeError`] when the transformed shape is degenerate in double precision.
    pub fn new(shape: Shape, transform: &Transform, flip: bool) -> Result<Self, ShapeError> {
        let t = transform;
        let (shape, transform) = match &shape {
            _ if *t == Transform::IDENTITY => (shape, None),
            Shape::Sphere(s) if t.similarity().is_some() => {
                let scale = t.similarity().expect("just seen");
                (Shape::Sphere(Sphere::new(t.world_point(s.centre()), s.radius() * scale)?), None)
            }
            Shape::Plane(p) => {
                (Shape::Plane(Plane::new(t.world_point(p.point()), t.world_normal(p.normal()))?), None)
            }
            Shape::Rectangle(r) => {
                let (corner, [u, v]) = r.corner_and_edges();
                let (u_world, v_world) = (t.world_vector(u), t.world_vector(v));
                // Mirroring turns the product of the edges; exchanging them keeps the outside outside.
                let mirrored = u_world.cross(v_world).dot(t.world_normal(u.cross(v))) < 0.0;
                let (a, b) = if mirrored { (v_world, u_world) } else { (u_world, v_world) };
                (Shape::Rectangle(Rectangle::new(t.world_point(corner), a, b)?), None)
            }
            _ => (shape, Some(*t)),
        };
        Ok(Self { shape, transform, flipped: flip, described: None })
    }

    /// The same for an object whose material shows an image: it remembers what texture coordinates depend on.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_uvs(shape: Shape, transform: &Transform, flip: bool) -> Result<Self, ShapeError> {
        let described = (shape.clone(), *transform);
        let object = Self::new(shape, transform, flip)?;
        let took_it_up = object.transform.is_none() && *transform != Transform::IDENTITY;
        Ok(Self { described: took_it_up.then(|| Box::new(described)), ..object })
    }

    /// The shape.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What puts the shape in its place; `None` where the shape itself stands in world space.
    pub(crate) fn transform(&self) -> Option<&Transform> {
        self.transform.as_ref()
    }

    /// The sphere, when the object is one that needs no transform.
    pub(crate) fn as_sphere(&self) -> Option<&Sphere> {
        match (&self.shape, &self.transform) {
            (Shape::Sphere(sphere), None) => Some(sphere),
            _ => None,
        }
    }

    /// The mesh, when the object is one that needs no transform.
    pub(crate) fn as_mesh(&self) -> Option<&Arc<TriangleMesh>> {
        match (&self.shape, &self.transform) {
            (Shape::Mesh(mesh), None) => Some(mesh),
            _ => None,
        }
    }

    /// True for a shape with an inside that is convex, whatever its transform.
    pub fn is_convex_solid(&self) -> bool {
        match &self.shape {
            Shape::Sphere(_) | Shape::Cuboid(_) => true,
            Shape::Cylinder(cylinder) => cylinder.is_capped(),
            Shape::Plane(_) | Shape::Disk(_) | Shape::Rectangle(_) | Shape::Mesh(_) => false,
        }
    }

    /// True for a shape that may enclose a space: every mesh is taken for one.
    pub(crate) fn may_enclose(&self) -> bool {
        self.is_convex_solid() || matches!(self.shape, Shape::Mesh(_))
    }

    /// True when its outside is turned inward.
    pub fn is_flipped(&self) -> bool {
        self.flipped
    }

    /// False when an infinite object certainly stays outside of the bounds.
    pub fn may_cross(&self, bounds: &Bounds) -> bool {
        match &self.shape {
            Shape::Plane(plane) => {
                let sides = bounds.corners().map(|corner| plane.normal().dot(corner - plane.point()));
                !(sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0))
            }
            _ => true,
        }
    }

    /// The number of the material of a face; 0 unless the shape is a mesh with several.
    #[inline]
    pub fn material_of(&self, face: u32) -> u32 {
        match &self.shape {
            Shape::Mesh(mesh) => mesh.material(face),
            _ => 0,
        }
    }

    /// The box around it in the world; `None` when it is infinite.
    pub fn bounds(&self) -> Option<Bounds> {
        let own = self.shape.bounds()?;
        Some(self.transform.as_ref().map_or(own, |t| t.world_bounds(&own)))
    }

    /// The first crossing of an analytic shape that counts; at infinity when there is none.
    #[inline]
    fn first(&self, ray: &Ray, query: &Query, id: u32) -> Crossing {
        let leaving = query.face_left(id);
        let crossings = match &self.shape {
            Shape::Sphere(s) => s.crossings(ray, leaving),
            Shape::Plane(s) => s.crossings(ray, leaving),
            Shape::Disk(s) => s.crossings(ray, leaving),
            Shape::Rectangle(s) => s.crossings(ray, leaving),
            Shape::Cuboid(s) => s.crossings(ray, leaving),
            Shape::Cylinder(s) => s.crossings(ray, leaving),
            Shape::Mesh(_) => unreachable!("meshes search their own tree"),
        };
        query.first(crossings, id)
    }

    /// Offers the first hit that counts.
    #[inline]
    pub(crate) fn closest(&self, query: &Query, id: u32, nearest: &mut Nearest, counters: &mut Counters) {
        match &self.transform {
            None => self.closest_along(&query.ray, query, id, nearest, counters),
            Some(t) => self.closest_along(&t.object_ray(&query.ray), query, id, nearest, counters),
        }
    }

    /// The same with the ray in the frame of the shape.
    #[inline]
    fn closest_along(
        &self,
        ray: &Ray,
        query: &Query,
        id: u32,
        nearest: &mut Nearest,
        counters: &mut Counters,
    ) {
        if let Shape::Mesh(mesh) = &self.shape {
            mesh.closest(ray, query, id, nearest, counters);
        } else {
            let Crossing { t, face } = self.first(ray, query, id);
            if t <= nearest.limit() && t < f64::INFINITY {
                nearest.offer(Hit { t, object: id, face, barycentrics: [0.0; 2] });
            }
        }
    }

    /// True when something of it is hit nearer than `limit`.
    #[inline]
    pub(crate) fn any(&self, query: &Query, id: u32, limit: f64, counters: &mut Counters) -> bool {
        match &self.transform {
            None => self.any_along(&query.ray, query, id, limit, counters),
            Some(t) => self.any_along(&t.object_ray(&query.ray), query, id, limit, counters),
        }
    }

    /// The same with the ray in the frame of the shape.
    #[inline]
    fn any_along(&self, ray: &Ray, query: &Query, id: u32, limit: f64, counters: &mut Counters) -> bool {
        match &self.shape {
            Shape::Mesh(mesh) => mesh.any(ray, query, id, limit, counters),
            _ => self.first(ray, query, id).t < limit,
        }
    }

    /// The point of a hit.
    #[inline]
    pub(crate) fn interaction(
        &self,
        query: &Query,
        hit: &Hit,
        counters: &mut Counters,
    ) -> SurfaceInteraction {
        let mut shading = None;
        let mut error = 0.0;
        let moved;
        let ray = match &self.transform {
            None => &query.ray,
            Some(t) => {
                moved = t.object_ray(&query.ray);
                &moved
            }
        };
        let SurfacePoint { mut point, normal: mut ng } = match &self.shape {
            Shape::Sphere(s) => s.surface_point(ray, hit.t),
            Shape::Plane(s) => s.surface_point(ray, hit.t),
            Shape::Disk(s) => s.surface_point(ray, hit.t),
            Shape::Rectangle(s) => s.surface_point(ray, hit.t),
            Shape::Cuboid(s) => s.surface_point(ray, hit.t, hit.face),
            Shape::Cylinder(s) => s.surface_point(ray, hit.t, hit.face),
            Shape::Mesh(mesh) => {
                let p = mesh.point(hit.face, hit.barycentrics);
                error = self.origin_error(mesh, &p);
                if mesh.is_smooth() {
                    Counters::count(&mut counters.interpolated_normals);
                    shading = Some(p.ns);
                }
                SurfacePoint { point: p.point, normal: p.ng }
            }
        };
        if let Some(t) = &self.transform {
            point = t.world_point(point);
            ng = unit(t.world_normal(ng));
            shading = shading.map(|n| t.world_normal(n));
        }
        // An interpolated normal that vanishes or points through the surface says nothing.
        let ns = shading.filter(|n| n.dot(ng) > 0.0).map_or(ng, unit);
        let (ng, ns) = if self.flipped { (-ng, -ns) } else { (ng, ns) };
        let wo = -query.ray.direction;
        let front = wo.dot(ng) >= 0.0;
        let flipped = self.flipped;
        SurfaceInteraction { point, wo, ng, ns, front, object: hit.object, face: hit.face, flipped, error }
    }

    /// The texture coordinates of a hit at `point` in the world (see the module `uv`). `barycentrics` are those of the hit on a mesh;
    /// without them, the point says where it is.
    pub(crate) fn uv(&self, face: u32, barycentrics: Option<[f64; 2]>, point: DVec3) -> DVec2 {
        let (shape, transform) = match &self.described {
            Some(described) => (&described.0, Some(&described.1)),
            None => (&self.shape, self.transform.as_ref()),
        };
        let own = || transform.map_or(point, |t| t.object_point(point));
        match shape {
            Shape::Sphere(s) => s.uv(own()),
            Shape::Plane(s) => s.uv(own()),
            Shape::Disk(s) => s.uv(own()),
            Shape::Rectangle(s) => s.uv(own()),
            Shape::Cuboid(s) => s.uv(own(), face),
            Shape::Cylinder(s) => s.uv(own(), face),
            Shape::Mesh(mesh) => {
                mesh.uv(face, barycentrics.unwrap_or_else(|| mesh.barycentrics(face, own())))
            }
        }
    }

    /// Bound on the error, in units of the mesh's unit frame, of the origin of a ray that starts at a point of the mesh:
    /// the point goes to world space and back.
    fn origin_error(&self, mesh: &TriangleMesh, p: &MeshPoint) -> f64 {
        let own = match &self.transform {
            None => p.error,
            Some(t) => t.object_error(t.world_point(p.point), t.world_error(p.point, p.error)),
        };
        mesh.frame_error(p.point, own)
    }
}
