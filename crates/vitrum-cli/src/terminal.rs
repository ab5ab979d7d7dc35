//! The way to the terminal. What is said there never ends the program: a picture is worth more than a message that nobody
//! can read. And it never commands the terminal: control characters that names bring along are replaced.

use crate::failure::Failure;
use std::io::{ErrorKind, Write};

/// Says something on stderr. A failure is passed over, for there is nobody left to tell.
pub(crate) fn say(text: &str) {
    let _ = std::io::stderr().write_all(readable(text).as_bytes());
}

/// Answers on stdout. A reader who has seen enough and closes the pipe is no failure.
///
/// # Errors
/// When the answer can't be written, as to a full disk.
pub(crate) fn answer(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    match stdout.write_all(readable(text).as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::running(format!("the answer cannot be written to the standard output ({error})")))
        }
        _ => Ok(()),
    }
}

/// The text with control characters replaced, apart from line ends.
fn readable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() && c != '\n' { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        assert_eq!(
            super::readable("two lines\nand \u{1b}[31mred, \u{9b}2J\r"),
            "two lines\nand \u{fffd}[31mred, \u{fffd}2J\u{fffd}"
        );
    }
}
