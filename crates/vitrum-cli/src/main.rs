//! `vitrum`: renders glass from the command line.
//!
//! Exit codes: 0 done, 1 failed while running (a retry may help), 2 usage or scene error, 3 internal error, 130 or 143
//! stopped by ^C or a termination signal, with the picture kept.

mod args;
mod bench;
mod compare;
#[cfg(test)]
mod docs;
mod errors;
mod explain;
mod failure;
mod input;
mod inspect;
mod interrupt;
mod page;
mod progress;
mod render;
mod report;
mod store;
mod summary;
mod terminal;

use args::{Arguments, Command};
use failure::Failure;
use std::panic::UnwindSafe;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    ending(|| run(&arguments.command))
}

/// The exit code of what the program does, with the reason on stderr where it fails.
fn ending(work: impl FnOnce() -> Result<ExitCode, Failure> + UnwindSafe) -> ExitCode {
    // The message of a panic has been printed; what is left is the exit code.
    let outcome = std::panic::catch_unwind(work).unwrap_or_else(|_| Err(Failure::internal()));
    outcome.unwrap_or_else(|failure| {
        terminal::say(&failure.to_string());
        failure.code()
    })
}

fn run(command: &Command) -> Result<ExitCode, Failure> {
    match command {
        Command::Render(arguments) => render::run(arguments),
        Command::Inspect(arguments) => inspect::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Page(arguments) => page::run(arguments),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_ending_has_its_code() {
        let code = |work: fn() -> Result<ExitCode, Failure>| format!("{:?}", ending(work));
        let expected = |number: u8| format!("{:?}", ExitCode::from(number));
        assert_eq!(code(|| Ok(ExitCode::SUCCESS)), expected(0));
        assert_eq!(code(|| Err(Failure::running("the disk is full"))), expected(1));
        assert_eq!(code(|| Err(Failure::usage("no such scene"))), expected(2));
        assert_eq!(code(|| panic!("a fault of the program")), expected(3));
    }
}
