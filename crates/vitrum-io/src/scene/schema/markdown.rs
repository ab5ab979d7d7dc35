//! The schema as Markdown, for the format page.

use super::{Default, Key, Kind, Table, one_of};

/// What the page shows of one table: its keys, and those of each variant.
pub fn markdown(table: &Table) -> String {
    let mut page = String::new();
    if let Some(choice) = &table.choice {
        let names: Vec<&str> = choice.variants.iter().map(|variant| variant.name).collect();
        page += &format!("`{}` is required: {}.\n", choice.key, code(&one_of(&names)));
    }
    if !table.keys.is_empty() {
        page += &format!("\n{}", keys(table.keys));
    }
    for variant in table.variants() {
        let choice = table.choice.as_ref().map_or("", |choice| choice.key);
        page +=
            &format!("\n`{choice} = \"{}\"`: {}\n\n{}", variant.name, variant.meaning, keys(variant.keys));
    }
    page.trim_start().to_string()
}

fn keys(keys: &[Key]) -> String {
    let mut rows = vec![
        ["Key", "Value", "Unit", "Default", "Range", "Meaning"].map(String::from),
        ["---"; 6].map(String::from),
    ];
    rows.extend(keys.iter().map(row));
    rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect()
}

fn row(key: &Key) -> [String; 6] {
    let default = match key.default {
        Default::Required => "**required**".into(),
        Default::Toml(text) => format!("`{text}`"),
        Default::Words(words) => words.into(),
    };
    let range = key.range.words().unwrap_or_default();
    let cells =
        [format!("`{}`", key.name), value(key.kind), key.unit.into(), default, range, key.meaning.into()];
    cells.map(|cell: String| cell.replace('|', "\\|"))
}

/// Quoted strings of a sentence set as code.
fn code(sentence: &str) -> String {
    let parts = sentence.split('"').enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { format!("`\"{part}\"`") } else { part.to_string() }).collect()
}

fn value(kind: Kind) -> String {
    match kind {
        Kind::Choice(options) => code(&one_of(options)),
        Kind::Boolean => "`true` or `false`".into(),
        Kind::Name => "string".into(),
        Kind::Text => "string".into(),
        Kind::File => "file path".into(),
        Kind::Reference(realm) => format!("name of a `[[{}]]`", realm.noun()),
        Kind::Number => "number".into(),
        Kind::Integer => "integer".into(),
        Kind::Size => "`[width, height]`".into(),
        Kind::Pair => "`[u, v]`".into(),
        Kind::Repeats => "number or `[u, v]`, none 0".into(),
        Kind::Point => "`[x, y, z]`".into(),
        Kind::Vector => "`[x, y, z]`, not all 0".into(),
        Kind::Scale => "number or `[x, y, z]`, none 0".into(),
        Kind::Colour => "colour".into(),
        Kind::ColourOrTexture => "colour, or name of a `[[texture]]`".into(),
        Kind::Material => "name of a `[[material]]`, or a material in place".into(),
        Kind::Table(table) => format!("table, [below](#{})", table.id),
        Kind::Tables(table) => format!("list of tables, [below](#{})", table.id),
    }
}
