//! `vitrum`: renders glass from the command line.
//!
//! Exit codes: 0 done, 1 failed while running (a retry may help), 2 usage or scene error, 3 internal error, 130 or 143
//! stopped by ^C or a termination signal, with the picture kept.

mod args;
mod failure;
mod input;
mod inspect;
mod interrupt;
mod progress;
mod render;
mod summary;
mod terminal;

use args::{Arguments, Command};
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    // The message of the panic has been printed; what is left is the exit code.
    let outcome =
        std::panic::catch_unwind(|| run(&arguments.command)).unwrap_or_else(|_| Err(Failure::internal()));
    outcome.unwrap_or_else(|failure| {
        terminal::say(&failure.to_string());
        failure.code()
    })
}

fn run(command: &Command) -> Result<ExitCode, Failure> {
    match command {
        Command::Render(arguments) => render::run(arguments),
        Command::Inspect(arguments) => inspect::run(arguments),
    }
}
