//! The programs that are measured.

use super::{BenchScene, Run};
use crate::failure::Failure;
use crate::report::Report;
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A program that renders as this one does.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    /// What it is called in results.
    pub(crate) name: String,
    /// Its place among those that are measured, from 1: the names of its pictures have it.
    pub(crate) number: usize,
    pub(crate) path: PathBuf,
}

impl Program {
    /// The program that runs.
    pub(crate) fn this() -> Result<Self, Failure> {
        let path = env::current_exe()
            .map_err(|e| Failure::running(format!("the program does not find its own file ({e})")))?;
        Ok(Self { name: "vitrum".to_owned(), number: 1, path })
    }

    /// Two that were asked for, named by their paths, or else this one.
    pub(crate) fn all(asked: &[PathBuf]) -> Result<Vec<Self>, Failure> {
        if asked.is_empty() {
            return Ok(vec![Self::this()?]);
        }
        let named = asked.iter().enumerate().map(|(place, path)| {
            let found = path.canonicalize().map_err(|e| {
                Failure::usage(format!("--against: {}: found no program ({e})", path.display()))
            })?;
            Ok(Self { name: path.display().to_string(), number: place + 1, path: found })
        });
        let programs = named.collect::<Result<Vec<_>, Failure>>()?;
        match &programs[..] {
            // The same program twice tells how far two equal ones are apart.
            [a, b] if a.name == b.name => Ok(vec![
                Self { name: format!("{} (first)", a.name), ..a.clone() },
                Self { name: format!("{} (second)", b.name), ..b.clone() },
            ]),
            _ => Ok(programs),
        }
    }
}

/// Renders to a file; its report lies beside it while it is read.
pub(super) fn render(scene: &BenchScene, run: &Run<'_>, picture: &Path) -> Result<Report, Failure> {
    let report = picture.with_extension("json");
    let mut command = Command::new(&run.program.path);
    command.arg("render").arg(&scene.path).arg("-o").arg(picture).arg("--report").arg(&report).arg("--quiet");
    for (option, value) in
        [("--spp", u64::from(run.spp)), ("--seed", run.seed), ("--threads", u64::from(run.threads))]
    {
        command.arg(option).arg(value.to_string());
    }
    let program = run.program.path.display();
    let output =
        command.output().map_err(|e| Failure::running(format!("{program}: cannot be started ({e})")))?;
    if !output.status.success() {
        return Err(Failure::running(format!(
            "{program}: could not render {} ({})\n{}",
            scene.path.display(),
            output.status,
            String::from_utf8_lossy(&output.stderr).trim_end()
        )));
    }
    let found = Report::read(&report)?;
    // What is left of it would be taken for a result.
    let _ = std::fs::remove_file(&report);
    Ok(found)
}
