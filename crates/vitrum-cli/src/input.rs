//! The scene that a command is about: a file, a model, or the built-in one.

use crate::args::Model;
use crate::failure::Failure;
use std::path::Path;
use vitrum_io::load::{self, Loaded, SceneOptions};

/// The built-in scene.
const DEFAULT_SCENE: &str = include_str!("../../../scenes/default.toml");

/// Loads what the command line names; a model is framed for a picture of `size`, where that is given.
pub(crate) fn load(
    path: Option<&Path>,
    options: SceneOptions,
    model: &Model,
    size: Option<[u32; 2]>,
) -> Result<Loaded, Failure> {
    let extension = path.and_then(Path::extension).map(|e| e.to_string_lossy().to_ascii_lowercase());
    match (path, extension.as_deref()) {
        (Some(_), Some("obj")) if model.has_idle_index() => Err(Failure::usage(
            "--ior is the index of refraction of --material glass; leave it out with matte and file",
        )),
        (Some(path), Some("obj")) => Ok(load::model_file(path, &model.options(size), options)?),
        // Scenes may come through a pipe, whose name has no extension.
        (Some(path), Some(other)) if other != "toml" => Err(Failure::usage(format!(
            "{}: found the extension .{other}, expected .toml (a scene) or .obj (a model); export a model of another format \
             as OBJ",
            path.display()
        ))),
        _ if model.is_given() => Err(Failure::usage(
            "--material, --ior and --normals are for models (.obj); a scene says so itself",
        )),
        (None, _) => Ok(load::scene_text("built-in scene", DEFAULT_SCENE, Path::new(""))?),
        (Some(path), _) => Ok(load::scene_file(path, options)?),
    }
}
