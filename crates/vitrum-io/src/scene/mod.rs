//! Scene files: TOML text in, a [`SceneDesc`] out, or every problem of the text at once.
//!
//! ```text
//! text -> syntax (toml crate, with byte spans) -> reading by the schema -> names -> SceneDesc
//! ```
//!
//! [`schema`] declares the format; `docs/scene-format.md` is its page, which a test holds to the schema. Reading never
//! stops at the first problem: each table is read to its end, each problem told once, at its place. Files that a scene
//! names are not opened here.

mod desc;
mod read;
pub mod schema;

pub use desc::*;

use crate::diagnostic::Diagnostics;

/// Largest scene file, bytes. Geometry belongs into meshes.
pub const MAX_BYTES: usize = 16 << 20;

/// Most entries of one list of a scene file.
pub const MAX_ENTRIES: usize = 1_000_000;

/// Most pixels of a picture.
pub const MAX_PIXELS: u64 = 1 << 28;

/// Reads the scene `text`, called `name` in messages.
///
/// The scene is `None` if and only if there are errors; warnings may come with it. References by name are known to be
/// good, files are not looked at.
pub fn parse(name: &str, text: &str) -> (Option<SceneDesc>, Diagnostics) {
    read::parse(name, text)
}
