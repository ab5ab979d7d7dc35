//! Counts how ray trees grow with the depth limit: `cargo run --release --example tree_growth`.
//!
//! Prints the Markdown table of `scenes/gallery/README.md`; a test of the package keeps that table up to date.

mod table;

use std::error::Error;
use std::io::{self, Write};
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery");
    write!(io::stdout(), "{}", table::markdown(&gallery)?)?;
    Ok(())
}
