//! The real program, run as a user runs it: what it writes, what it says, and how it ends.

mod bad_input;
mod bad_output;
mod measuring;
mod models;
mod rounds;
#[cfg(unix)]
mod signals;
mod talk;
mod workplace;
