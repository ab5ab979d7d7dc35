//! `vitrum`: renders glass from the command line.
//!
//! Exit codes: 0 done, 1 failed while running (a retry may help), 2 usage or scene error, 3 internal error, 130 or 143
//! stopped by ^C or a termination signal, with the picture kept.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "this is the program that talks to the terminal"
)]

mod args;
mod failure;
mod input;
mod inspect;
mod interrupt;
mod progress;
mod render;
mod summary;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.command {
        Command::Render(render) => render::run(render),
        Command::Inspect(inspect) => inspect::run(inspect),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => {
            let text = failure.to_string();
            // Diagnostics bring their own severity and line ends.
            if text.starts_with("error") {
                eprint!("{text}");
            } else {
                eprintln!("error: {}", text.trim_end());
            }
            failure.code()
        }
    }
}
