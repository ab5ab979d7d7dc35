//! ^C and termination: asked to stop once, the program ends the work in hand and keeps the picture; asked again, by the
//! same signal or the other, it ends at once.
//!
//! A limit on the size of files raises a signal too, whose default is to end the program in mid-writing. Here it is
//! caught, so that the write fails like any other and the half-written file is cleared away.

use crate::failure::Failure;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Whether, and by which signal, the program was asked to stop.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt {
    signal: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Starts listening.
    pub(crate) fn listen() -> Result<Self, Failure> {
        let signal = Arc::new(AtomicUsize::new(0));
        let again = Arc::new(AtomicBool::new(false));
        let register = || {
            for number in [SIGINT, SIGTERM] {
                // The order counts: a second signal finds the flag that the first one raised.
                flag::register_conditional_shutdown(number, 128 + number, Arc::clone(&again))?;
                flag::register(number, Arc::clone(&again))?;
                flag::register_usize(number, Arc::clone(&signal), number.cast_unsigned() as usize)?;
            }
            #[cfg(unix)]
            flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
            Ok(())
        };
        register().map_err(|e: std::io::Error| Failure::running(format!("cannot listen for ^C ({e})")))?;
        Ok(Self { signal })
    }

    /// True once the program was asked to stop.
    pub(crate) fn is_asked(&self) -> bool {
        self.signal.load(Ordering::Relaxed) != 0
    }

    /// The exit code of a program that was stopped: 130 by ^C, 143 by a termination signal.
    pub(crate) fn code(&self) -> ExitCode {
        let signal = u8::try_from(self.signal.load(Ordering::Relaxed)).unwrap_or(2);
        ExitCode::from(128 + signal)
    }
}
