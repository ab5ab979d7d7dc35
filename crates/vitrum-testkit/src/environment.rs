//! The two environment variables that tests listen to.
//!
//! - `VITRUM_ASSETS`: the folder of real files (meshes, malformed files, reference tables) that are not part of the
//!   repository. Unset or `none`, the tests that need it say so and pass.
//! - `VITRUM_BLESS`: set to `1`, tests write the expected outputs instead of comparing with them.

use std::path::{Path, PathBuf};

/// The folder of test assets, or `None` after saying on stderr that the test is skipped.
///
/// ```
/// let Some(assets) = vitrum_testkit::assets() else { return };
/// assert!(assets.is_dir());
/// ```
///
/// # Panics
/// If the variable names something that is not a folder: a typing error must not skip tests.
pub fn assets() -> Option<PathBuf> {
    let found = assets_of(variable("VITRUM_ASSETS"));
    if found.is_none() {
        skipped();
    }
    found
}

/// The files of a folder whose names end in `.extension`, sorted.
///
/// # Panics
/// If the folder cannot be read: a test that finds no files must not pass.
pub fn files_with_extension(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let paths = entries.map(|entry| entry.expect("an entry of a readable folder").path());
    let mut files: Vec<_> =
        paths.filter(|path| path.extension().is_some_and(|end| end == extension)).collect();
    files.sort();
    files
}

/// Whether expected outputs are to be written (`VITRUM_BLESS=1`) instead of compared.
pub fn blessing() -> bool {
    variable("VITRUM_BLESS").as_deref() == Some("1")
}

/// How many times the usual work a test is to do (`VITRUM_TIMES`, 1 where it is not set), where it can do more.
///
/// # Panics
/// If it is no whole number above 0.
pub fn times() -> u32 {
    let times = variable("VITRUM_TIMES").map_or(Ok(1), |times| times.parse());
    times.ok().filter(|times| *times > 0).expect("VITRUM_TIMES is a whole number above 0")
}

fn assets_of(value: Option<String>) -> Option<PathBuf> {
    let folder = PathBuf::from(value.filter(|value| !value.is_empty() && value != "none")?);
    assert!(
        folder.is_dir(),
        "VITRUM_ASSETS is '{}', which is not a folder; expected a folder or 'none'",
        folder.display()
    );
    Some(folder)
}

#[expect(clippy::disallowed_methods, reason = "tests have no caller who could pass it as an argument")]
fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

#[expect(clippy::print_stderr, reason = "a skipped test passes, so that the person in front must be told")]
fn skipped() {
    eprintln!("skipped: VITRUM_ASSETS is not set");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_means_no_assets() {
        assert_eq!(assets_of(None), None);
        assert_eq!(assets_of(Some(String::new())), None);
        assert_eq!(assets_of(Some("none".into())), None);
        assert_eq!(assets_of(Some("/".into())), Some(PathBuf::from("/")));
    }

    #[test]
    #[should_panic(expected = "not a folder")]
    fn a_wrong_folder_is_not_skipped() {
        assets_of(Some("/no/such/folder".into()));
    }
}
