//! Image files: each read once, however often it is shown.

use crate::image::{ImageError, read_texture};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vitrum_materials::{Encoding, Image};

/// Why an image can't be shown.
#[derive(Clone, Debug)]
pub(super) struct Refusal {
    /// What is the matter.
    pub(super) message: String,
    /// True when there is no such file.
    pub(super) is_missing: bool,
}

/// All images of a scene.
#[derive(Default)]
pub(super) struct Images {
    read: BTreeMap<(PathBuf, Option<Encoding>), Result<Arc<Image>, Refusal>>,
}

impl Images {
    /// The files that are shown.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.read.iter().filter(|(_, read)| read.is_ok()).map(|((path, _), _)| path)
    }

    /// The image in a file, called `name` as it is written. `warn` takes what the file gives reason to say, once.
    pub(super) fn image(
        &mut self,
        path: &Path,
        name: &str,
        encoding: Option<Encoding>,
        warn: impl FnOnce(String),
    ) -> Result<Arc<Image>, Refusal> {
        let read = self.read.entry((path.to_owned(), encoding)).or_insert_with(|| {
            let refusal = |error: ImageError| Refusal {
                is_missing: matches!(error, ImageError::NotFound { .. }),
                message: error.to_string(),
            };
            let texels = read_texture(path, name, encoding).map_err(refusal)?;
            if texels.is_transparent {
                warn(format!("{}: the image has transparent parts, which show their colour", path.display()));
            }
            Ok(Arc::new(texels.image))
        });
        read.clone()
    }
}
