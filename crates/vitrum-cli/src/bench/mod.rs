//! `vitrum bench`: run time against error.
//!
//! Every run is a process of its own, `PROGRAM render SCENE --spp N --seed S`, whose picture is compared with the scene's
//! reference: so a run costs what a user pays, and any two programs can be measured in one go. Runs of two programs alternate
//! (A B A B), because the speed of a machine drifts.

mod against;
mod program;
mod record;
mod reference;
mod scenes;

pub(crate) use record::{Record, TELLING, lines, read};
use scenes::BenchScene;

use crate::args::Bench;
use crate::failure::Failure;
use crate::page;
use crate::terminal::{answer, say};
use program::Program;
use record::Results;
use std::path::Path;
use std::process::ExitCode;

/// The most samples that are doubled to.
const MOST_SAMPLES: u32 = 1 << 16;

/// The program and one run of it.
struct Run<'a> {
    program: &'a Program,
    spp: u32,
    seed: u64,
    threads: u32,
}

pub(crate) fn run(arguments: &Bench) -> Result<ExitCode, Failure> {
    let scenes = scenes::list(&arguments.scenes)?;
    if arguments.make_references {
        for scene in &scenes {
            reference::make(scene, &Program::this()?, arguments)?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let programs = Program::all(&arguments.against)?;
    // All problems before anything that takes long.
    let references = scenes.iter().map(reference::read).collect::<Result<Vec<_>, _>>()?;
    let included = arguments.include.iter().map(|path| read(path)).collect::<Result<Vec<_>, _>>()?;
    let mut results = Results::create(&arguments.output)?;
    for (scene, reference) in scenes.iter().zip(&references) {
        measure(scene, reference, &programs, arguments, &mut results)?;
    }
    let own = results.finish()?;
    let mut text = page::table(&own);
    if let [before, after] = &programs[..] {
        text += &against::table(&own, [&before.name, &after.name]);
    }
    // First: drawing needs more files.
    answer(&text)?;
    let mut all: Vec<(Record, &Path)> =
        own.into_iter().map(|record| (record, arguments.output.as_path())).collect();
    for (records, path) in included.into_iter().zip(&arguments.include) {
        page::add(&mut all, records, path);
    }
    page::write(&all, &[], &arguments.output.join("index.html"))?;
    Ok(ExitCode::SUCCESS)
}

/// All runs of a scene.
fn measure(
    scene: &BenchScene,
    reference: &reference::Reference,
    programs: &[Program],
    arguments: &Bench,
    results: &mut Results,
) -> Result<(), Failure> {
    results.keep_reference(scene)?;
    // Files come into memory, and processors awake.
    for program in programs {
        let run = Run { program, spp: 1, seed: 0, threads: arguments.threads };
        program::render(scene, &run, &results.scratch())?;
    }
    let doubled = (0..).map(|i| 1u32 << i).take_while(|spp| *spp <= MOST_SAMPLES);
    let ladder: Vec<u32> = if arguments.spp.is_empty() { doubled.collect() } else { arguments.spp.clone() };
    for spp in ladder {
        let (mut longest, mut least) = (0.0f64, f64::INFINITY);
        for seed in 1..=u64::from(arguments.seeds) {
            for program in programs {
                let run = Run { program, spp, seed, threads: arguments.threads };
                let record = results.run(scene, reference, &run)?;
                longest = longest.max(record.seconds());
                least = least.min(record.errors.rel_mse);
            }
        }
        say(&format!("{}: {spp} samples, {longest:.2} s, relMSE {least:.2e}\n", scene.name));
        let is_done = longest >= arguments.time.as_secs_f64() || least < TELLING * reference.error;
        if arguments.spp.is_empty() && is_done {
            break;
        }
    }
    Ok(())
}
