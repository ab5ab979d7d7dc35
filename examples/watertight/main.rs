//! Counts the rays that slip through the edges of closed meshes, of as many as asked for:
//!
//! ```text
//! cargo run --release --example watertight -- 1e8
//! ```
//!
//! The same with a million rays is a test (`tests/watertight.rs`). Exits with 1 if there is a leak.

#![expect(clippy::print_stdout, reason = "a table is what this program is for")]

mod rays;

use rayon::prelude::*;
use std::path::Path;
use std::process::ExitCode;

/// So many rays are aimed at a time: enough threads have something to do.
const BATCH: u64 = 100_000;

fn main() -> ExitCode {
    let asked = std::env::args().nth(1).map_or(Ok(1e6), |rays| rays.parse::<f64>());
    let Ok(asked) = asked else {
        println!("how many rays? A number is expected, such as 1e8");
        return ExitCode::from(2);
    };
    let cases = rays::cases(Path::new(env!("CARGO_MANIFEST_DIR")));
    let batches = (asked / cases.len() as f64 / BATCH as f64).ceil() as u64;
    println!("| mesh | scale | offset | instance | rays | leaks |");
    println!("|---|---:|---:|---|---:|---:|");
    let mut leaks = 0;
    for case in &cases {
        let leaked: Vec<_> =
            (0..batches).into_par_iter().flat_map_iter(|seed| case.leaks(BATCH, seed)).collect();
        println!(
            "| {} | {:.0e} | {:.0e} | {} | {} | {} |",
            case.name,
            case.scale,
            case.offset,
            if case.is_instance { "yes" } else { "no" },
            batches * BATCH,
            leaked.len(),
        );
        for ray in leaked.iter().take(3) {
            println!("leaked: {ray:?}");
        }
        leaks += leaked.len();
    }
    println!("\n{leaks} leaks");
    ExitCode::from(u8::from(leaks > 0))
}
