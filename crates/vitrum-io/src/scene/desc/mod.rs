//! What a scene file says, as plain data: nothing is loaded, resolved or normalised yet.
//!
//! The parts mirror the tables of the file and keep their units: metres, degrees, linear Rec.709. Beside each part that
//! later steps may have to complain about stands its [`Span`] in the file, 0..0 if the scene was built in code. What
//! [`parse`](super::parse) returns has passed every check of the format: numbers lie in their ranges, names are unique
//! and known, vectors are not zero. A scene built in code is taken at its word.

mod light;
mod matter;
mod object;
mod picture;

pub use light::{Falloff, Light, LightKind};
pub use matter::{
    Absorption, Around, ColourOrTexture, Index, Material, Medium, MetalIndex, Model, Pattern, Phong, Texture,
};
pub use object::{MaterialChoice, Normals, Object, Shape, Step, Transform};
pub use picture::{Background, Branching, Camera, Filter, Integrator, Lens, Output, Render, Shadow, Tone};

use crate::diagnostic::Span;

/// A whole scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneDesc {
    /// How the picture is computed.
    pub render: Render,
    /// How it is written.
    pub output: Output,
    /// Where it is seen from.
    pub camera: Camera,
    /// The medium around everything: of [`media`](Self::media) or predefined.
    pub surroundings: Name,
    /// What a ray sees that meets nothing.
    pub background: Background,
    /// Media beside those that have [names](vitrum_materials::NamedMedium) anyway, or in their place.
    pub media: Vec<Medium>,
    /// Lights.
    pub lights: Vec<Light>,
    /// Textures, which materials name.
    pub textures: Vec<Texture>,
    /// Materials, which objects name.
    pub materials: Vec<Material>,
    /// Objects.
    pub objects: Vec<Object>,
}

impl SceneDesc {
    /// An empty scene in air before a black background, with the default settings of the format.
    pub fn new(camera: Camera) -> Self {
        Self {
            render: Render::default(),
            output: Output::default(),
            camera,
            surroundings: Name::new("air"),
            background: Background::default(),
            media: Vec::new(),
            lights: Vec::new(),
            textures: Vec::new(),
            materials: Vec::new(),
            objects: Vec::new(),
        }
    }
}

/// A name, where it is given or where it is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The name itself.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

impl Name {
    /// A name that stands in no file.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), span: Span::default() }
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.text.fmt(f)
    }
}
