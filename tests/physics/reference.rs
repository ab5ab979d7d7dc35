//! Published and independently computed tables, from the folder that `VITRUM_ASSETS` names.

use std::path::PathBuf;

/// The rows of a table, the first one with the names of its columns; `None` (said on stderr) without the folder.
pub(crate) fn table(name: &str) -> Option<Vec<Vec<String>>> {
    let Some(folder) = std::env::var_os("VITRUM_ASSETS").filter(|v| v != "none").map(PathBuf::from) else {
        eprintln!("skipped: VITRUM_ASSETS is not set");
        return None;
    };
    let path = folder.join("reference").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    Some(text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

/// A number of a row, by the name of its column; `None` where there is none.
pub(crate) fn column(names: &[String], row: &[String], name: &str) -> Option<f64> {
    let index = names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name}"));
    row[index].parse().ok()
}
