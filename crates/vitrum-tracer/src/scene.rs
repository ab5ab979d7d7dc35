//! A scene with everything resolved: what the tracer reads, and never changes.

use crate::background::Background;
use crate::camera::Camera;
use crate::feature::{Feature, Uses};
use crate::light::Light;
use crate::overlaps::Overlaps;
use vitrum_geometry::{Aggregate, Counters, Hit, Object, Query, Shape};
use vitrum_materials::{Material, Medium, Place, Scattering};
use vitrum_math::{DVec2, DVec3, Ray, Rgb, unit};

/// An object with its name and material, as it enters a [`Scene`].
#[derive(Clone, Debug)]
pub struct SceneObject {
    /// Unique in the scene; objects are sorted by it, so that their order in a file never matters.
    pub name: String,
    /// The shape in its place; made by [`Object::with_uvs`] where a material shows an image.
    pub object: Object,
    /// What it is made of: the materials that its faces number (see [`Object::material_of`]). A number beyond the last
    /// stands for the last.
    pub materials: Vec<Material>,
}

/// A scene that can't be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// Two objects of the same name.
    #[error("two objects are named `{0}`")]
    DuplicateName(String),
    /// An object without a material.
    #[error("the object `{0}` has no material")]
    NoMaterial(String),
    /// More objects than 32-bit ids count.
    #[error("{0} objects are too many")]
    TooMany(usize),
    /// More solids of glass than a ray keeps count of may share a point.
    #[error(
        "more than 8 solids of glass overlap in one place: `{}`; join some of them, or say what is outside of each (`outside`)",
        .0.join("`, `")
    )]
    Overlap(Vec<String>),
}

/// Where a ray hits; counts what textures ask of it.
struct HitPlace<'a> {
    aggregate: &'a Aggregate,
    hit: &'a Hit,
    point: DVec3,
    uses: &'a mut Uses,
}

impl Place for HitPlace<'_> {
    #[inline(always)]
    fn point(&mut self) -> DVec3 {
        self.uses.count(Feature::Textures);
        self.point
    }

    #[inline(always)]
    fn uv(&mut self) -> DVec2 {
        self.uses.count(Feature::Textures);
        self.uses.count(Feature::Images);
        if Feature::Images.is_built() { self.aggregate.uv(self.hit, self.point) } else { DVec2::ZERO }
    }
}

/// Everything that light meets, and the camera that looks at it.
#[derive(Clone, Debug)]
pub struct Scene {
    aggregate: Aggregate,
    names: Vec<String>,
    materials: Vec<Material>,
    /// For each object where its materials start.
    first_material: Vec<usize>,
    /// For each object what a ray costs that leaves its surface.
    ray_costs: Vec<f64>,
    /// Objects that were left out because nothing can see them.
    invisible: Vec<String>,
    /// The camera.
    pub camera: Camera,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// Radiance that arrives everywhere from everywhere.
    pub ambient: Rgb,
    /// Lights; sums over them are formed in this order.
    pub lights: Vec<Light>,
    /// What surrounds everything.
    pub medium: Medium,
    /// What the camera stands in; `None` for what is found there.
    pub camera_medium: Option<Medium>,
    overlaps: Overlaps,
}

impl Scene {
    /// A scene of `objects`, seen by `camera`, dark and empty otherwise. Objects are sorted by name; those that nothing can see
    /// are left out.
    ///
    /// # Errors
    /// [`SceneError`] for duplicate names, objects without a material, and too many solids in one place.
    pub fn new(mut objects: Vec<SceneObject>, camera: Camera) -> Result<Self, SceneError> {
        objects.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(pair) = objects.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return Err(SceneError::DuplicateName(pair[0].name.clone()));
        }
        if u32::try_from(objects.len()).is_err() {
            return Err(SceneError::TooMany(objects.len()));
        }
        if let Some(object) = objects.iter().find(|o| o.materials.is_empty()) {
            return Err(SceneError::NoMaterial(object.name.clone()));
        }
        let invisible = invisible(&objects)?;
        let (seen, invisible): (Vec<_>, Vec<_>) =
            objects.into_iter().partition(|o| invisible.binary_search(&o.name).is_err());
        let mut materials = Vec::new();
        let mut first_material = Vec::new();
        let mut names = Vec::new();
        let mut shapes = Vec::new();
        for object in seen {
            first_material.push(materials.len());
            materials.extend(object.materials);
            names.push(object.name);
            shapes.push(object.object);
        }
        let ray_costs = shapes.iter().map(ray_cost).collect();
        let mut scene = Self {
            ray_costs,
            aggregate: Aggregate::new(shapes),
            names,
            materials,
            first_material,
            invisible: invisible.into_iter().map(|o| o.name).collect(),
            camera,
            background: Background::Constant(Rgb::ZERO),
            ambient: Rgb::ZERO,
            lights: Vec::new(),
            medium: Medium::AIR,
            camera_medium: None,
            overlaps: Overlaps::default(),
        };
        scene.overlaps =
            Overlaps::new(&scene.aggregate, |id| scene.materials_of(id), &scene.names, |_| true)?;
        Ok(scene)
    }

    /// Pairs of solids of glass that may share a point, each as (lower, higher) by id, where rays count what they are in.
    pub fn overlapping_solids(&self) -> Vec<(u32, u32)> {
        if self.overlaps.depth == 0 {
            return vec![];
        }
        let others = |(id, solid): (u32, &Option<crate::overlaps::Solid>)| {
            let others = solid.as_ref().map_or(vec![], |solid| solid.solids.clone());
            others.into_iter().filter(move |other| *other > id).map(move |other| (id, other))
        };
        (0u32..).zip(&self.overlaps.solids).flat_map(others).collect()
    }

    /// Which solids reach into each other.
    pub(crate) fn overlaps(&self) -> &Overlaps {
        &self.overlaps
    }

    /// Shapes and what rays find of them.
    pub fn aggregate(&self) -> &Aggregate {
        &self.aggregate
    }

    /// The same scene with more to search: see [`Aggregate::searched_in_full`].
    pub(crate) fn searched_in_full(&self, in_tree: bool, in_solids: bool) -> Self {
        Self { aggregate: self.aggregate.searched_in_full(in_tree, in_solids), ..self.clone() }
    }

    /// Names of the objects, by id.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Names of the objects that were left out because nothing can see them.
    pub fn invisible(&self) -> &[String] {
        &self.invisible
    }

    /// What a ray costs that leaves the surface of an object, in rays that meet no large mesh.
    #[inline]
    pub(crate) fn ray_cost(&self, object: u32) -> f64 {
        self.ray_costs[object as usize]
    }

    /// All materials in use; objects may repeat them.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The material of a face of an object.
    #[inline]
    pub fn material(&self, object: u32, face: u32) -> &Material {
        let materials = self.materials_of(object);
        let number = self.aggregate.objects()[object as usize].material_of(face) as usize;
        &materials[number.min(materials.len() - 1)]
    }

    /// What the surface does to light at a hit, whose point is given.
    // Always, because what it returns is large and would be copied.
    #[inline(always)]
    pub fn scattering(&self, hit: &Hit, point: DVec3, uses: &mut Uses) -> Scattering {
        let mut place = HitPlace { aggregate: &self.aggregate, hit, point, uses };
        self.material(hit.object, hit.face).scattering(&mut place)
    }

    /// The places of the materials of an object among [all](Self::materials).
    pub(crate) fn materials_at(&self, object: u32) -> std::ops::Range<usize> {
        let first = self.first_material[object as usize];
        first..first + self.materials_of(object).len()
    }

    /// The place of the material of a face of an object among [all](Self::materials).
    #[inline]
    pub(crate) fn material_at(&self, object: u32, face: u32) -> usize {
        let first = self.first_material[object as usize];
        let number = self.aggregate.objects()[object as usize].material_of(face) as usize;
        first + number.min(self.materials_of(object).len() - 1)
    }

    /// The smooth glass that a point lies in: an object whose surface a ray from there meets from behind, where rays in all of
    /// several directions meet such a surface first. What a point light sends out there stays there: no ray that asks for it
    /// is refracted.
    pub fn glass_around(&self, point: DVec3) -> Option<u32> {
        // Off the axes, along which models have edges and seams.
        const DIRECTIONS: [DVec3; 6] = [
            DVec3::new(0.91, 0.17, -0.29),
            DVec3::new(-0.83, 0.31, 0.23),
            DVec3::new(0.13, 0.87, 0.37),
            DVec3::new(-0.19, -0.93, 0.11),
            DVec3::new(0.29, -0.23, 0.79),
            DVec3::new(-0.37, -0.13, -0.89),
        ];
        let left = |direction: &DVec3| {
            let query = Query::new(Ray::new(point, unit(*direction)));
            let mut counters = Counters::default();
            let hit = self.aggregate.closest(&query, &mut counters)?;
            let material = self.material(hit.object, hit.face);
            let behind = !self.aggregate.interaction(&query, &hit, &mut counters).front;
            (behind && material.is_dielectric() && !material.is_rough()).then_some(hit.object)
        };
        let objects: Option<Vec<u32>> = DIRECTIONS.iter().map(left).collect();
        objects?.first().copied()
    }

    /// The materials of an object, at least one.
    #[inline]
    pub fn materials_of(&self, object: u32) -> &[Material] {
        let object = object as usize;
        let end = self.first_material.get(object + 1).copied().unwrap_or(self.materials.len());
        &self.materials[self.first_material[object]..end]
    }
}

/// The names of the objects that nothing can see, sorted as the objects are: crossing their surfaces changes nothing, and what surrounds
/// them is what their materials say.
fn invisible(objects: &[SceneObject]) -> Result<Vec<String>, SceneError> {
    let is_candidate = |o: &SceneObject| o.materials.iter().all(Material::is_invisible);
    if !objects.iter().any(is_candidate) {
        return Ok(vec![]);
    }
    let names: Vec<String> = objects.iter().map(|o| o.name.clone()).collect();
    let aggregate = Aggregate::new(objects.iter().map(|o| o.object.clone()).collect());
    let materials_of = |id: u32| objects[id as usize].materials.as_slice();
    let overlaps =
        Overlaps::new(&aggregate, materials_of, &names, |id| !is_candidate(&objects[id as usize]))?;
    let takes_place = |id: usize| overlaps.solids[id].as_ref().is_some_and(|solid| !solid.knows);
    let unseen = (0..objects.len()).filter(|id| is_candidate(&objects[*id]) && !takes_place(*id));
    Ok(unseen.map(|id| names[id].clone()).collect())
}

/// A fit to the time of rays inside meshes of 300, 16 000 and 100 000 triangles: 1.0, 1.7 and 2.9 times as long as that of rays
/// that meet no large mesh.
fn ray_cost(object: &Object) -> f64 {
    match object.shape() {
        Shape::Mesh(mesh) => 1.0 + 0.2 * (mesh.triangle_count() as f64 / 256.0).log2().max(0.0),
        _ => 1.0,
    }
}
