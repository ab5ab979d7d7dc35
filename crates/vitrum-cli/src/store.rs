//! The checkpoint beside a picture.

use crate::failure::Failure;
use crate::render::decisive;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use vitrum_io::checkpoint::{self, Checkpoint};
use vitrum_io::load::Loaded;
use vitrum_tracer::{Film, Settings};

/// Rounds that end sooner after the last one that was kept are not kept.
const INTERVAL: Duration = Duration::from_secs(10);

/// Where the film of a picture is kept, and what it is made with.
pub(crate) struct Store {
    path: PathBuf,
    /// What decides the picture: settings, and the content of the scene.
    about: Vec<(String, String)>,
    /// When it was last written, and what went wrong.
    last: Mutex<(Instant, Option<String>)>,
}

impl Store {
    /// For a picture.
    pub(crate) fn new(output: &Path, loaded: &Loaded, settings: &Settings) -> Result<Self, Failure> {
        let mut name = output.file_name().unwrap_or_default().to_owned();
        name.push(".checkpoint");
        let mut pairs = decisive(settings);
        let rounds = if settings.until.is_some() { "until an error" } else { "of all pixels" };
        pairs.push(("rounds".to_owned(), rounds.to_owned()));
        // Now, and not when it is kept: files may change meanwhile.
        let fingerprint = loaded.origin.fingerprint();
        let fingerprint =
            fingerprint.map_err(|e| Failure::running(format!("a file of the scene is gone: {e}")))?;
        pairs.push(("scene".to_owned(), format!("{fingerprint:016x}")));
        Ok(Self {
            path: output.with_file_name(name),
            about: pairs,
            last: Mutex::new((crate::render::now(), None)),
        })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    pub(crate) fn write(&self, film: &Film) -> Result<(), Failure> {
        Ok(checkpoint::write(&self.path, &self.about, film)?)
    }

    /// Keeps the film of a round, now and then. A failure is told at the end.
    pub(crate) fn keep(&self, film: &Film) {
        let Ok(mut last) = self.last.lock() else { return };
        if last.0.elapsed() >= INTERVAL {
            last.1 = self.write(film).err().map(|failure| failure.to_string());
            last.0 = crate::render::now();
        }
    }

    /// What keeping failed with, the last time.
    pub(crate) fn trouble(&self) -> Option<String> {
        self.last.lock().ok()?.1.take()
    }

    /// The film to go on with.
    pub(crate) fn read(&self) -> Result<Film, Failure> {
        let Checkpoint { about, film } = checkpoint::read(&self.path)?;
        let ours = &self.about;
        let differing = ours.iter().find(|pair| !about.contains(pair));
        let other = |key: &str| about.iter().find(|(k, _)| k == key).map_or("none", |(_, value)| value);
        match differing {
            None if about.len() == ours.len() => Ok(film),
            None => {
                Err(Failure::usage(format!("{}: the checkpoint is of other settings", self.path.display())))
            }
            Some((key, _)) if key == "scene" => Err(Failure::usage(format!(
                "{}: the checkpoint is of another scene, or the scene or one of its files has changed; render anew without \
                 --resume",
                self.path.display()
            ))),
            Some((key, value)) => Err(Failure::usage(format!(
                "{}: the checkpoint was made with {key} {}, found {value}; use the settings that it was made with, or render \
                 anew without --resume",
                self.path.display(),
                other(key)
            ))),
        }
    }

    /// The picture is done.
    pub(crate) fn remove(&self) -> Result<(), Failure> {
        fs::remove_file(&self.path)
            .map_err(|e| Failure::running(format!("{}: cannot be removed ({e})", self.path.display())))
    }
}
