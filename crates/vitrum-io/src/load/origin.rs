//! What a scene was made of, for telling later whether it is still the same.

use super::naming::fnv1a;
use std::fs;
use std::io;
use std::path::PathBuf;

/// The description of a scene and its files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// Hashes of what was described, and of the materials of model files.
    pub(super) hashes: Vec<u64>,
    /// Geometry and pictures.
    pub(super) files: Vec<PathBuf>,
}

impl Origin {
    /// A number that changes with anything that the scene was made of. Reads all its files.
    ///
    /// # Errors
    /// When a file can't be read any more.
    pub fn fingerprint(&self) -> io::Result<u64> {
        let mut hashes = self.hashes.clone();
        for file in &self.files {
            let read =
                fs::read(file).map_err(|e| io::Error::new(e.kind(), format!("{}: {e}", file.display())))?;
            hashes.push(fnv1a(&read));
        }
        let bytes: Vec<u8> = hashes.iter().flat_map(|hash| hash.to_le_bytes()).collect();
        Ok(fnv1a(&bytes))
    }
}
