//! Every scene in `scenes/invalid` is met with exactly the text that stands beside it, in `NAME.expected`.
//!
//! What reading finds nothing wrong with is loaded, for the files that it names.
//!
//! `VITRUM_BLESS=1` rewrites those files; read them before keeping them.

use std::fs;
use std::path::{Path, PathBuf};
use vitrum_io::load::{self, LoadError};

/// From the crate, where tests run.
const FOLDER: &str = "../../scenes/invalid";

fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(FOLDER).expect("scenes/invalid can be listed");
    let mut scenes: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry can be read").path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes.sort();
    scenes
}

#[test]
fn every_invalid_scene_gives_exactly_its_message() {
    let bless = vitrum_testkit::blessing();
    let mut wrong = Vec::new();
    let scenes = scenes();
    assert!(scenes.len() >= 40, "only {} scenes found", scenes.len());
    for path in scenes {
        let name = path.file_name().and_then(|name| name.to_str()).expect("names are UTF-8");
        let text = fs::read_to_string(&path).expect("the scene can be read");
        let (scene, mut problems) = vitrum_io::scene::parse(name, &text);
        assert_eq!(scene.is_none(), problems.has_errors(), "{name}: a scene exactly if there is no error");
        if problems.is_empty() {
            problems = match load::scene_text(name, &text, Path::new(FOLDER)) {
                Ok(loaded) => loaded.warnings,
                Err(LoadError::Invalid(problems)) => problems,
                Err(other) => panic!("{name}: {other}"),
            };
        }
        assert!(!problems.is_empty(), "{name}: nothing was found wrong");
        let shown = problems.to_string().replace(&format!("{FOLDER}/"), "");
        let expected_path = path.with_extension("expected");
        if bless {
            fs::write(&expected_path, &shown).expect("the expected text can be written");
        }
        let expected = fs::read_to_string(&expected_path).unwrap_or_default();
        if shown != expected {
            wrong.push(format!("==== {name}: expected\n{expected}==== found\n{shown}"));
        }
    }
    assert!(wrong.is_empty(), "{}\nVITRUM_BLESS=1 rewrites the expected texts", wrong.join("\n"));
}

#[test]
fn every_expected_text_has_its_scene() {
    for entry in fs::read_dir(FOLDER).expect("scenes/invalid can be listed") {
        let path = entry.expect("an entry can be read").path();
        if path.extension().is_some_and(|extension| extension == "expected") {
            assert!(path.with_extension("toml").exists(), "{} has no scene", path.display());
        }
    }
}
