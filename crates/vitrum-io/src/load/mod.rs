//! From a description to a scene that can be rendered: names become values, files become meshes.
//!
//! ```text
//! scene.toml --parse--> SceneDesc --lower--> Loaded { Scene, Settings, Display, .. }
//! model.obj  --frame--> SceneDesc --lower--> ...
//! ```
//!
//! Lowering goes on after a problem, so that all of them are told at once.

mod environment;
mod images;
mod lower;
mod matter;
mod meshes;
mod model;
mod naming;
mod origin;

pub use meshes::MeshReport;
use meshes::Meshes;
pub use model::{ModelMaterial, ModelOptions};
pub(crate) use naming::fnv1a;
pub use origin::Origin;

use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::image::Display;
use crate::obj::{self, ObjError};
use crate::scene::{self, SceneDesc};
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use vitrum_materials::Medium;
use vitrum_tracer::{Scene, Settings};

/// A scene ready to render, and what was noticed on the way.
#[derive(Debug)]
pub struct Loaded {
    /// What to render.
    pub scene: Scene,
    /// How to render it.
    pub settings: Settings,
    /// How a PNG is made of the result.
    pub display: Display,
    /// What the meshes are like.
    pub meshes: Vec<MeshReport>,
    /// The media that the scene declares or uses, by name.
    pub media: Vec<(String, Medium)>,
    /// What it was made of.
    pub origin: Origin,
    /// Warnings.
    pub warnings: Diagnostics,
}

/// How a scene file is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneOptions {
    /// Texels of environments that are no radiance are replaced, and told in a warning, where they are an error otherwise: what
    /// is not a number or negative by 0, what is infinite by the largest finite value of the picture.
    pub repair: bool,
    /// Meshes are looked through for faces that cross others and vertices that none uses, too.
    pub examine: bool,
}

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The scene file can't be read, or the model can't be shown.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is the matter, and what to do.
        reason: String,
    },
    /// The model can't be read.
    #[error(transparent)]
    Model(#[from] ObjError),
    /// The scene has errors; all of them.
    #[error("{0}")]
    Invalid(Diagnostics),
}

/// Loads a scene file.
///
/// # Errors
/// [`LoadError`] when the file can't be read or has errors.
pub fn scene_file(path: &Path, options: SceneOptions) -> Result<Loaded, LoadError> {
    let text = read_text(path).map_err(|reason| LoadError::Unreadable { path: path.to_owned(), reason })?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    described(&path.display().to_string(), &text, folder, options)
}

/// The text of a scene file; else what is the matter, and what to do.
fn read_text(path: &Path) -> Result<String, String> {
    let refused = |e: io::Error| match e.kind() {
        io::ErrorKind::NotFound => "there is no such scene file; check the path".to_owned(),
        io::ErrorKind::PermissionDenied => format!("cannot be read ({e}); check its permissions"),
        _ => format!("cannot be read ({e})"),
    };
    if fs::metadata(path).map_err(refused)?.is_dir() {
        return Err("is a folder, expected a scene file (.toml) or a model (.obj)".to_owned());
    }
    // Some files, such as pipes, don't say their size, or have no end: one byte too many is enough.
    let mut bytes = Vec::new();
    let mut file = fs::File::open(path).map_err(refused)?.take(scene::MAX_BYTES as u64 + 1);
    file.read_to_end(&mut bytes).map_err(refused)?;
    if bytes.len() > scene::MAX_BYTES {
        let limit = scene::MAX_BYTES;
        return Err(format!(
            "a scene file may have {limit} bytes, this one has more; put geometry into OBJ files"
        ));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..valid]);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
        let byte = error.as_bytes()[valid];
        format!("line {line}, column {column}: found the byte 0x{byte:02x}, expected text in UTF-8; save the file as UTF-8")
    })
}

/// Loads the text of a scene, called `name` in messages. Its files are looked for in `folder`.
///
/// # Errors
/// [`LoadError::Invalid`] with all problems.
pub fn scene_text(name: &str, text: &str, folder: &Path) -> Result<Loaded, LoadError> {
    described(name, text, folder, SceneOptions::default())
}

fn described(name: &str, text: &str, folder: &Path, options: SceneOptions) -> Result<Loaded, LoadError> {
    let (desc, diagnostics) = scene::parse(name, text);
    let source = Source::new(name, text);
    match desc {
        Some(desc) => {
            lower::lower(&desc, &source, folder, Meshes::new(options.examine), diagnostics, options)
        }
        None => Err(LoadError::Invalid(diagnostics)),
    }
}

/// Loads a model file into a scene made for it: in the middle of the picture, on a floor, under a light.
///
/// # Errors
/// [`LoadError`] when the model can't be read or has nothing to show.
pub fn model_file(path: &Path, options: &ModelOptions, how: SceneOptions) -> Result<Loaded, LoadError> {
    let file = obj::read(path)?;
    let desc = model::frame(path, &file, options)
        .map_err(|reason| LoadError::Unreadable { path: path.to_owned(), reason })?;
    let name = path.display().to_string();
    let files = Meshes::new(how.examine).holding(path, file);
    lower::lower(&desc, &Source::new(&name, ""), Path::new(""), files, Diagnostics::default(), how)
}

/// Loads a scene that was described in code. Its files are looked for in `folder`.
///
/// # Errors
/// [`LoadError::Invalid`] with all problems.
pub fn description(desc: &SceneDesc, folder: &Path) -> Result<Loaded, LoadError> {
    let (source, options) = (Source::new("scene", ""), SceneOptions::default());
    lower::lower(desc, &source, folder, Meshes::new(options.examine), Diagnostics::default(), options)
}

/// A problem at a place of the source.
fn error(source: &Source<'_>, span: crate::diagnostic::Span, message: String, label: &str) -> Diagnostic {
    Diagnostic::error(source.name(), message).at(source, span, label)
}
