//! What ends the program early, and the exit code that says so.

use std::process::ExitCode;
use vitrum_io::checkpoint::CheckpointError;
use vitrum_io::image::{ImageError, WriteError};
use vitrum_io::load::LoadError;
use vitrum_tracer::RenderError;

/// Failed while running; a retry may help.
const RUNNING: u8 = 1;
/// The user asked for something that can't be.
const USAGE: u8 = 2;
/// The program is wrong.
const INTERNAL: u8 = 3;

/// Why the program ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    error: anyhow::Error,
    code: u8,
    /// Diagnostics bring their own severity and line ends.
    is_diagnostics: bool,
}

impl Failure {
    fn new(error: anyhow::Error, code: u8) -> Self {
        Self { error, code, is_diagnostics: false }
    }

    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::new(anyhow::Error::msg(message.into()), USAGE)
    }

    pub(crate) fn running(message: impl Into<String>) -> Self {
        Self::new(anyhow::Error::msg(message.into()), RUNNING)
    }

    /// After a panic, which has said on stderr where it came from.
    pub(crate) fn internal() -> Self {
        let message = "internal error: this is a fault of vitrum, not yours. Please report it with the command, the scene \
                       and the lines above";
        Self::new(anyhow::Error::msg(message), INTERNAL)
    }

    pub(crate) fn code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}

impl std::fmt::Display for Failure {
    /// What to say on the terminal, with line ends. Messages are whole: what the system said stands in them already.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_diagnostics { write!(f, "{}", self.error) } else { writeln!(f, "error: {}", self.error) }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        let is_diagnostics = matches!(error, LoadError::Invalid(_));
        Self { is_diagnostics, ..Self::new(error.into(), USAGE) }
    }
}

impl From<CheckpointError> for Failure {
    fn from(error: CheckpointError) -> Self {
        Self::new(error.into(), USAGE)
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::new(error.into(), RUNNING)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let code = if matches!(error, RenderError::Threads(_)) { RUNNING } else { USAGE };
        Self::new(error.into(), code)
    }
}

impl From<ImageError> for Failure {
    /// A name that no picture can have is a mistake in the command; with a folder or disk that refuses, the same command may
    /// succeed later.
    fn from(error: ImageError) -> Self {
        let code = match error {
            ImageError::UnknownExtension { .. } | ImageError::Write(WriteError::NotReplaceable { .. }) => {
                USAGE
            }
            _ => RUNNING,
        };
        Self::new(error.into(), code)
    }
}
