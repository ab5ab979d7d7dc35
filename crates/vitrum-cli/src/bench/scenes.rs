//! The scenes of a bench, and where their references are.

use crate::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// Where scenes are looked for when none is given.
const FOLDER: &str = "scenes/bench";

/// A scene that is measured.
#[derive(Clone, Debug)]
pub(crate) struct BenchScene {
    /// The name of its file, without extension.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    /// `references/NAME.exr` beside it.
    pub(crate) reference: PathBuf,
}

impl BenchScene {
    pub(crate) fn new(path: &Path) -> Self {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let reference = path.with_file_name("references").join(format!("{name}.exr"));
        Self { name, path: path.to_owned(), reference }
    }
}

/// The scenes that were asked for, or all of the folder, by name.
pub(super) fn list(asked: &[PathBuf]) -> Result<Vec<BenchScene>, Failure> {
    if !asked.is_empty() {
        if let Some(missing) = asked.iter().find(|path| !path.is_file()) {
            return Err(Failure::usage(format!(
                "{}: found no such file, expected a scene (.toml)",
                missing.display()
            )));
        }
        let scenes: Vec<BenchScene> = asked.iter().map(|path| BenchScene::new(path)).collect();
        for (place, scene) in scenes.iter().enumerate() {
            if let Some(other) = scenes[..place].iter().find(|other| other.name == scene.name) {
                return Err(Failure::usage(format!(
                    "{} and {}: found two scenes of one name, which results could not tell apart; rename one",
                    other.path.display(),
                    scene.path.display()
                )));
            }
        }
        return Ok(scenes);
    }
    let entries = fs::read_dir(FOLDER).map_err(|e| {
        Failure::usage(format!("{FOLDER}: cannot be read ({e}); run this in the repository, or name scenes"))
    })?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    Ok(paths.iter().map(|path| BenchScene::new(path)).collect())
}
