//! Files in and out: scenes, meshes and images, and what is wrong with them.
//!
//! The only crate that touches files. The path of the data:
//!
//! ```text
//! scene.toml --scene::parse--> SceneDesc --load--> tracer::Scene --render--> Film --image::write--> .exr, .png
//! model.obj  --obj::read-----> MeshData  --load--^                   Film <--checkpoint--> .checkpoint
//! ```
//!
//! Whatever a file says is checked here, once, and every problem is told with its place ([`diagnostic`]).

mod atomic;
pub mod checkpoint;
pub mod diagnostic;
pub mod image;
pub mod load;
pub mod obj;
pub mod scene;

use image::WriteError;
use std::io::Write;
use std::path::Path;

/// Writes a text: whole, or not at all.
///
/// # Errors
/// When it cannot be written. The file that was there before, if any, is then unchanged.
pub fn write_text(path: &Path, text: &str) -> Result<(), WriteError> {
    atomic::replace(path, |file| file.write_all(text.as_bytes()))
}

/// Whether a text can be written under this name, as far as can be known beforehand.
///
/// # Errors
/// When it cannot.
pub fn check_text_writable(path: &Path) -> Result<(), WriteError> {
    atomic::check(path)
}
