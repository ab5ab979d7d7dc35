//! Published and independently computed tables, from the folder that `VITRUM_ASSETS` names.

/// The rows of a table, the first one with the names of its columns; `None` without the folder.
pub(crate) fn table(name: &str) -> Option<Vec<Vec<String>>> {
    let path = vitrum_testkit::assets()?.join("reference").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    Some(text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

/// A number of a row, by the name of its column; `None` where there is none.
pub(crate) fn column(names: &[String], row: &[String], name: &str) -> Option<f64> {
    let index = names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name}"));
    row[index].parse().ok()
}
