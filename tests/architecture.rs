//! The architecture page and the code agree.
//!
//! ARCHITECTURE.md lists, in a fenced block marked `layers`, every arrow between our crates: `user -> used` or
//! `user -> used, used`, one user per line. Here the manifests are held against that list, the sources of the layers
//! below `vitrum-io` against what they must not touch, and the page's file names against the tree.
//!
//! An arrow is a dependency of the built crate, target-specific and build dependencies included. What only tests need
//! (`dev-dependencies`) is free.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// Crates that know no files, no environment, no clock and no terminal.
const BELOW_IO: [&str; 6] =
    ["vitrum-math", "vitrum-geometry", "vitrum-bxdf", "vitrum-materials", "vitrum-tracer", "vitrum-measure"];

/// What gives such knowledge away in a source file. (A `Duration` is no clock.)
const FORBIDDEN: [&str; 13] = [
    "std::fs",
    "fs::",
    "std::env",
    "env::",
    "Instant",
    "SystemTime",
    "std::net",
    "std::process",
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
    "dbg!",
];

/// The top-level folders whose paths the page must not get wrong.
const FOLDERS: [&str; 7] = ["benches/", "crates/", "docs/", "examples/", "fuzz/", "scenes/", "tests/"];

/// One dependency between our crates: who uses, whom.
type Arrow = (String, String);

#[test]
fn the_manifests_have_the_arrows_of_the_page() {
    let listed = listed_arrows(&page());
    let present: BTreeSet<Arrow> = packages().iter().flat_map(Package::arrows).collect();
    let problems: Vec<String> = (present.difference(&listed))
        .map(|(user, used)| {
            format!("{user} depends on {used}, which the layers of ARCHITECTURE.md do not list")
        })
        .chain((listed.difference(&present)).map(|(user, used)| {
            format!(
                "the layers of ARCHITECTURE.md list {user} -> {used}, but {user} does not depend on {used}"
            )
        }))
        .collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn only_the_program_uses_anyhow() {
    for package in packages() {
        let uses = package.dependencies.iter().any(|name| name == "anyhow");
        assert!(
            !uses || package.name == "vitrum-cli",
            "{} depends on anyhow: libraries have their own error enum (thiserror)",
            package.name
        );
    }
}

#[test]
fn the_lower_layers_touch_nothing_outside() {
    let mut problems = Vec::new();
    for name in BELOW_IO {
        let sources = rust_files(&root().join("crates").join(name).join("src"));
        assert!(!sources.is_empty(), "{name} has no sources");
        for file in sources {
            for (line, word) in forbidden_words(&read(&file)) {
                let file = file.strip_prefix(root()).expect("it was found below the root").display();
                problems.push(format!("{file}:{line}: `{word}` in a layer that knows nothing outside"));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn the_paths_of_the_page_exist() {
    for path in paths_in(&page()) {
        assert!(root().join(&path).exists(), "ARCHITECTURE.md names `{path}`, which is not there");
    }
}

#[test]
fn the_checks_see_what_they_look_for() {
    let page = "Text `crates/a/b.rs` and `tests/c.rs:7`, not `a -> b`.\n```layers\na -> b, c\n`crates/in/a/block`\nb -> c\n```\n";
    let arrow = |user: &str, used: &str| (user.to_owned(), used.to_owned());
    let block = page.replace("`crates/in/a/block`\n", "");
    assert_eq!(listed_arrows(&block), [arrow("a", "b"), arrow("a", "c"), arrow("b", "c")].into());
    assert_eq!(paths_in(page), ["crates/a/b.rs", "tests/c.rs"]);

    let manifest = "[package]\nname = 'x'\n[dependencies]\nvitrum-math.workspace = true\nglam = '1'\n\
        [target.'cfg(unix)'.dependencies]\nalias = { package = 'vitrum-bxdf', version = '1' }\n\
        [build-dependencies]\nvitrum-io = '1'\n[dev-dependencies]\nanyhow = '1'\nvitrum-testkit = '1'\n";
    let package = Package::parse(manifest, "x");
    let arrows: Vec<Arrow> = package.arrows().collect();
    assert_eq!(arrows, [arrow("x", "vitrum-bxdf"), arrow("x", "vitrum-io"), arrow("x", "vitrum-math")]);
    assert!(package.dependencies.contains("anyhow"));

    let source = "// std::fs in a comment\nuse std::{fs, io};\nlet a = fs::read(p);\nlet e = env!(\"X\"); Instantiate;\n\
        eprintln!(\"x\");\n#[cfg(test)]\nmod tests {\n    println!();\n}\n";
    assert_eq!(forbidden_words(source), [(3, "fs::"), (5, "eprintln!")]);
}

/// What a manifest says that matters here.
struct Package {
    name: String,
    /// The packages that the built crate depends on, whoever wrote them.
    built_with: BTreeSet<String>,
    /// These and the development dependencies.
    dependencies: BTreeSet<String>,
}

impl Package {
    fn parse(manifest: &str, place: &str) -> Self {
        let manifest = DeTable::parse(manifest).unwrap_or_else(|error| panic!("{place}: {error}"));
        let manifest = manifest.get_ref();
        let name = table(manifest, "package").and_then(|package| text(package, "name"));
        let name = name.unwrap_or_else(|| panic!("{place} names no package")).to_owned();

        // Dependencies stand at the top level and under every `target.CFG`.
        let targets = table(manifest, "target").into_iter().flat_map(|targets| targets.values());
        let places = targets.filter_map(|target| target.get_ref().as_table()).chain([manifest]);
        let (mut built_with, mut dependencies) = (BTreeSet::new(), BTreeSet::new());
        for place in places {
            for kind in ["dependencies", "build-dependencies", "dev-dependencies"] {
                for (key, value) in table(place, kind).into_iter().flat_map(|table| table.iter()) {
                    let renamed = value.get_ref().as_table().and_then(|table| text(table, "package"));
                    let used = renamed.unwrap_or(key.get_ref()).to_owned();
                    if kind != "dev-dependencies" {
                        built_with.insert(used.clone());
                    }
                    dependencies.insert(used);
                }
            }
        }
        Self { name, built_with, dependencies }
    }

    fn arrows(&self) -> impl Iterator<Item = Arrow> {
        let ours = self.built_with.iter().filter(|used| used.starts_with("vitrum"));
        ours.map(|used| (self.name.clone(), used.clone()))
    }
}

/// The root package and every member of the workspace.
fn packages() -> Vec<Package> {
    let manifest = read(&root().join("Cargo.toml"));
    let manifest = DeTable::parse(&manifest).expect("cargo has read it already");
    let members = table(manifest.get_ref(), "workspace")
        .and_then(|workspace| workspace.get("members"))
        .and_then(|members| members.get_ref().as_array())
        .expect("the workspace has members");
    let folders = members.iter().map(|member| match member.get_ref() {
        DeValue::String(folder) => root().join(folder.as_ref()),
        other => panic!("a member is a {}, expected a string", other.type_str()),
    });
    let folders = folders.chain([root().to_owned()]);
    folders
        .map(|folder| {
            let file = folder.join("Cargo.toml");
            Package::parse(&read(&file), &file.display().to_string())
        })
        .collect()
}

fn table<'a, 'i>(parent: &'a DeTable<'i>, key: &str) -> Option<&'a DeTable<'i>> {
    parent.get(key)?.get_ref().as_table()
}

fn text<'a>(parent: &'a DeTable<'_>, key: &str) -> Option<&'a str> {
    parent.get(key)?.get_ref().as_str()
}

/// The arrows of the block that opens with ```` ```layers ````.
fn listed_arrows(page: &str) -> BTreeSet<Arrow> {
    let block = page.lines().skip_while(|line| line.trim() != "```layers").skip(1);
    let mut arrows = BTreeSet::new();
    for line in block.take_while(|line| line.trim() != "```").filter(|line| !line.trim().is_empty()) {
        let (user, used) = line.split_once("->").unwrap_or_else(|| {
            panic!("the layers of ARCHITECTURE.md hold `{line}`, expected `user -> used`")
        });
        arrows.extend(used.split(',').map(|used| (user.trim().to_owned(), used.trim().to_owned())));
    }
    assert!(!arrows.is_empty(), "ARCHITECTURE.md has no block marked `layers`, or an empty one");
    arrows
}

/// The paths in backticks, outside fenced blocks, that begin with one of our folders; without a line number.
fn paths_in(page: &str) -> Vec<String> {
    let mut fenced = false;
    let mut paths = Vec::new();
    for line in page.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            let quoted = line.split('`').skip(1).step_by(2);
            let ours = quoted.filter(|text| FOLDERS.iter().any(|folder| text.starts_with(folder)));
            paths.extend(ours.map(|text| text.split(':').next().unwrap_or(text).to_owned()));
        }
    }
    paths
}

/// The forbidden words of a source file and their lines (from 1), before its tests and outside line comments.
fn forbidden_words(source: &str) -> Vec<(usize, &'static str)> {
    let code = source.lines().take_while(|line| line.trim() != "#[cfg(test)]").enumerate();
    code.filter(|(_, line)| !line.trim_start().starts_with("//"))
        .flat_map(|(index, line)| {
            let mut found = FORBIDDEN.into_iter().filter(move |word| contains_word(line, word));
            found.next().map(|word| (index + 1, word))
        })
        .collect()
}

/// Whether `word` stands in `line` with nothing of a name before it, nor after it.
fn contains_word(line: &str, word: &str) -> bool {
    let of_a_name = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(start, _)| {
        let before = line[..start].chars().next_back().is_some_and(of_a_name);
        let after = word.ends_with(of_a_name) && line[start + word.len()..].starts_with(of_a_name);
        !before && !after
    })
}

/// Every Rust file below a folder, in order, except those that hold only tests (`tests.rs`, `tests/`).
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("it was listed").path()).collect();
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        if path.file_stem().is_some_and(|stem| stem == "tests") {
            continue;
        }
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> String {
    read(&root().join("ARCHITECTURE.md"))
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}
