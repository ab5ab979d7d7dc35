//! What ends the program early, and the exit code that says so.

use std::process::ExitCode;
use vitrum_io::image::ImageError;
use vitrum_io::load::LoadError;
use vitrum_tracer::RenderError;

/// Failed while running; a retry may help.
const RUNNING: u8 = 1;
/// The user asked for something that can't be.
const USAGE: u8 = 2;

/// Why the program ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    error: anyhow::Error,
    code: u8,
}

impl Failure {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self { error: anyhow::Error::msg(message.into()), code: USAGE }
    }

    pub(crate) fn running(error: impl Into<anyhow::Error>) -> Self {
        Self { error: error.into(), code: RUNNING }
    }

    pub(crate) fn code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:#}", self.error)
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Self { error: error.into(), code: USAGE }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = if matches!(error, RenderError::Threads(_)) { RUNNING } else { USAGE };
        Self { error: error.into(), code }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        let code = if matches!(error, ImageError::UnknownExtension { .. }) { USAGE } else { RUNNING };
        Self { error: error.into(), code }
    }
}
