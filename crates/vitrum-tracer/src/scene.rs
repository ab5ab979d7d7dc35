//! A scene with everything resolved: what the tracer reads, and never changes.

use crate::background::Background;
use crate::camera::Camera;
use crate::light::Light;
use vitrum_geometry::{Aggregate, Object};
use vitrum_materials::{IndexOfRefraction, Material};
use vitrum_math::Rgb;

/// An object with its name and material, as it enters a [`Scene`].
#[derive(Clone, Debug)]
pub struct SceneObject {
    /// Unique in the scene; objects are sorted by it, so that their order in a file never matters.
    pub name: String,
    /// The shape in its place.
    pub object: Object,
    /// What it is made of, for each face group; see `material_of_face`.
    pub materials: Vec<Material>,
    /// For each triangle of a mesh the position in `materials`; empty when there is one material.
    pub material_of_face: Vec<u32>,
}

/// A scene that can't be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// Two objects of the same name.
    #[error("two objects are named `{0}`")]
    DuplicateName(String),
    /// An object without a material, or whose faces name one that it does not have.
    #[error("the object `{0}` names a material that it does not have")]
    Material(String),
    /// More objects than 32-bit ids count.
    #[error("{0} objects are too many")]
    TooMany(usize),
}

/// Everything that light meets, and the camera that looks at it.
#[derive(Clone, Debug)]
pub struct Scene {
    aggregate: Aggregate,
    names: Vec<String>,
    materials: Vec<Material>,
    /// For each object where its materials start, and its faces' materials if they differ.
    assignments: Vec<Assignment>,
    /// Objects that were left out because nothing can see them.
    invisible: Vec<String>,
    /// The camera.
    pub camera: Camera,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// Radiance that arrives everywhere from everywhere.
    pub ambient: Rgb,
    /// Lights, in the order of their names.
    pub lights: Vec<Light>,
    /// What surrounds everything.
    pub medium: IndexOfRefraction,
}

#[derive(Clone, Debug)]
struct Assignment {
    first: u32,
    of_face: Vec<u32>,
}

impl Scene {
    /// A scene of `objects`, seen by `camera`, dark and empty otherwise. Objects are sorted by name; those that nothing can see
    /// are left out. Lights that are dark are left out as well.
    ///
    /// # Errors
    /// [`SceneError`] for duplicate names and materials that don't exist.
    pub fn new(mut objects: Vec<SceneObject>, camera: Camera) -> Result<Self, SceneError> {
        objects.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(pair) = objects.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return Err(SceneError::DuplicateName(pair[0].name.clone()));
        }
        if u32::try_from(objects.len()).is_err() {
            return Err(SceneError::TooMany(objects.len()));
        }
        let is_assigned = |o: &SceneObject| {
            !o.materials.is_empty() && o.material_of_face.iter().all(|&m| (m as usize) < o.materials.len())
        };
        if let Some(object) = objects.iter().find(|o| !is_assigned(o)) {
            return Err(SceneError::Material(object.name.clone()));
        }
        let (invisible, seen): (Vec<_>, Vec<_>) =
            objects.into_iter().partition(|o| o.materials.iter().all(Material::is_invisible));
        let mut materials = Vec::new();
        let mut assignments = Vec::new();
        let mut names = Vec::new();
        let mut shapes = Vec::new();
        for object in seen {
            assignments.push(Assignment { first: materials.len() as u32, of_face: object.material_of_face });
            materials.extend(object.materials);
            names.push(object.name);
            shapes.push(object.object);
        }
        Ok(Self {
            aggregate: Aggregate::new(shapes),
            names,
            materials,
            assignments,
            invisible: invisible.into_iter().map(|o| o.name).collect(),
            camera,
            background: Background::Constant(Rgb::ZERO),
            ambient: Rgb::ZERO,
            lights: Vec::new(),
            medium: IndexOfRefraction::AIR,
        })
    }

    /// Shapes and what rays find of them.
    pub fn aggregate(&self) -> &Aggregate {
        &self.aggregate
    }

    /// Names of the objects, by id.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Names of the objects that were left out because nothing can see them.
    pub fn invisible(&self) -> &[String] {
        &self.invisible
    }

    /// All materials in use; objects may repeat them.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The material of a face of an object.
    #[inline]
    pub fn material(&self, object: u32, face: u32) -> &Material {
        let assignment = &self.assignments[object as usize];
        let of_face = assignment.of_face.get(face as usize).copied().unwrap_or(0);
        &self.materials[(assignment.first + of_face) as usize]
    }

    /// The materials of an object.
    pub fn materials_of(&self, object: u32) -> &[Material] {
        let start = self.assignments[object as usize].first as usize;
        let end = self.assignments.get(object as usize + 1).map_or(self.materials.len(), |next| next.first as usize);
        &self.materials[start..end]
    }
}
