//! Results: one line of JSON a run, and the same as a table.

use super::{BenchScene, Run, program, reference::Reference};
use crate::errors::{self, Errors};
use crate::failure::Failure;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;

/// One run, of this program or of another renderer. Seconds, and `Errors`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Record {
    /// The name of the scene's file.
    pub(crate) scene: String,
    /// What is measured.
    pub(crate) program: String,
    /// Of the program.
    pub(crate) version: String,
    /// Processors, and how many threads were used.
    pub(crate) machine: String,
    pub(crate) spp: u32,
    pub(crate) seed: u64,
    /// Reading the scene and building its trees.
    pub(crate) loading: f64,
    pub(crate) rendering: f64,
    /// What all threads together were busy while rendering, where that is known.
    #[serde(default)]
    pub(crate) processors: Option<f64>,
    /// Rays traced, where that is known.
    #[serde(default)]
    pub(crate) rays: Option<u64>,
    #[serde(flatten)]
    pub(crate) errors: Errors,
    /// relMSE of the reference itself, by which `rel_mse` is too large.
    pub(crate) reference_error: f64,
    /// The reference, relative to the file that this stands in.
    pub(crate) reference: PathBuf,
    /// The picture, relative to the file that this stands in, where it was kept.
    #[serde(default)]
    pub(crate) picture: Option<PathBuf>,
}

impl Record {
    /// What a user waits for: loading and rendering.
    pub(crate) fn seconds(&self) -> f64 {
        self.loading + self.rendering
    }

    /// relMSE without the part that is the reference's.
    pub(crate) fn error(&self) -> f64 {
        self.errors.rel_mse - self.reference_error
    }

    /// Whether the reference is good enough to tell this error.
    pub(crate) fn is_told(&self) -> bool {
        self.errors.rel_mse >= TELLING * self.reference_error
    }
}

/// A reference tells an error to a twentieth of it.
pub(crate) const TELLING: f64 = 20.0;

/// Reads a file of records.
pub(crate) fn read(path: &Path) -> Result<Vec<Record>, Failure> {
    lines(path, "result of a bench", "vitrum bench")
}

/// Reads a file with a JSON object on each line: what each is, and who writes them.
pub(crate) fn lines<T: DeserializeOwned>(path: &Path, what: &str, by: &str) -> Result<Vec<T>, Failure> {
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::usage(format!("{}: cannot be read ({e})", path.display())))?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let records = lines.map(|(number, line)| {
        serde_json::from_str(line).map_err(|e| {
            Failure::usage(format!(
                "{}:{}: found no {what} ({e}); expected a line that `{by}` wrote",
                path.display(),
                number + 1
            ))
        })
    });
    records.collect()
}

/// Where the copy of a reference lies in a folder of results.
fn kept_reference(scene: &BenchScene) -> PathBuf {
    Path::new("references").join(format!("{}.exr", scene.name))
}

/// A folder that results are written to.
pub(super) struct Results {
    folder: PathBuf,
    lines: File,
    records: Vec<Record>,
}

impl Results {
    /// In a folder that has none yet: measured results are not written over.
    pub(super) fn create(folder: &Path) -> Result<Self, Failure> {
        let failed =
            |e: std::io::Error| Failure::running(format!("{}: cannot be written to ({e})", folder.display()));
        fs::create_dir_all(folder.join("pictures")).map_err(failed)?;
        fs::create_dir_all(folder.join("references")).map_err(failed)?;
        let path = folder.join("results.jsonl");
        let lines = File::create_new(&path).map_err(|e| {
            Failure::usage(format!(
                "{}: cannot be created ({e}); choose a new folder with -o, results are not written over",
                path.display()
            ))
        })?;
        Ok(Self { folder: folder.to_owned(), lines, records: Vec::new() })
    }

    /// Puts the reference of a scene beside its pictures, so that the folder needs nothing else.
    pub(super) fn keep_reference(&self, scene: &BenchScene) -> Result<(), Failure> {
        let copy = self.folder.join(kept_reference(scene));
        fs::copy(&scene.reference, &copy)
            .map_err(|e| Failure::running(format!("{}: cannot be written ({e})", copy.display())))?;
        Ok(())
    }

    /// A picture that is not kept.
    pub(super) fn scratch(&self) -> PathBuf {
        self.folder.join("scratch.exr")
    }

    /// Renders, compares, and writes down: at once, so that a bench that is stopped has lost nothing.
    pub(super) fn run(
        &mut self,
        scene: &BenchScene,
        reference: &Reference,
        run: &Run<'_>,
    ) -> Result<&Record, Failure> {
        let name = format!("{}-{}-{}.exr", scene.name, run.program.number, run.spp);
        let kept = (run.seed == 1).then(|| Path::new("pictures").join(name));
        let path = kept.as_ref().map_or_else(|| self.scratch(), |kept| self.folder.join(kept));
        let report = program::render(scene, run, &path)?;
        let picture = reference.image_like(&path)?;
        let (errors, _) = errors::between(&picture, &reference.image, 0.0);
        let record = Record {
            scene: scene.name.clone(),
            program: run.program.name.clone(),
            version: report.version.clone(),
            machine: machine(run.threads),
            spp: run.spp,
            seed: run.seed,
            loading: report.loading,
            rendering: report.rendering,
            processors: Some(report.processors),
            rays: Some(report.rays()),
            errors,
            reference_error: reference.error,
            reference: kept_reference(scene),
            picture: kept,
        };
        let line = serde_json::to_string(&record).map_err(|e| Failure::running(e.to_string()))?;
        writeln!(self.lines, "{line}").map_err(|e| {
            Failure::running(format!("{}: cannot be written to ({e})", self.folder.display()))
        })?;
        self.records.push(record);
        Ok(&self.records[self.records.len() - 1])
    }

    /// The table, and what was measured.
    pub(super) fn finish(self) -> Result<Vec<Record>, Failure> {
        // There is none where nothing was measured.
        let _ = fs::remove_file(self.scratch());
        let path = self.folder.join("results.csv");
        write_table(&self.records, &path)
            .map_err(|e| Failure::running(format!("{}: cannot be written ({e})", path.display())))?;
        Ok(self.records)
    }
}

/// One column for each key.
fn write_table(records: &[Record], path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut table = csv::Writer::from_path(path)?;
    for (number, record) in records.iter().enumerate() {
        let serde_json::Value::Object(values) = serde_json::to_value(record)? else { continue };
        if number == 0 {
            table.write_record(values.keys())?;
        }
        table.write_record(values.values().map(|value| match value {
            serde_json::Value::String(text) => text.clone(),
            serde_json::Value::Null => String::new(),
            other => other.to_string(),
        }))?;
    }
    table.flush()?;
    Ok(())
}

/// Processors and threads, as far as the system tells.
fn machine(threads: u32) -> String {
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let model = model.map_or(std::env::consts::ARCH, |(_, model)| model);
    let all = thread::available_parallelism().map_or(1, usize::from);
    let used = if threads == 0 { all } else { threads as usize };
    format!("{model}, {used} of {all} threads")
}
