//! All scenes render, and the page names each of them.

use crate::stage::{described, gallery, names, picture};
use std::fs;
use vitrum::io::load;

#[test]
fn every_scene_loads_without_a_warning_and_renders_without_a_bad_sample() {
    for name in names() {
        let loaded =
            load::scene_file(&gallery().join(&name).with_extension("toml"), load::SceneOptions::default());
        let loaded = loaded.unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(loaded.warnings.to_string(), "", "{name}");
        let pixels = picture(&described(&name), [48, 48], 1);
        assert!(pixels.iter().any(|pixel| pixel.iter().any(|c| *c > 0.05)), "{name} is black");
    }
}

#[test]
fn every_scene_says_what_is_seen_and_why_and_stands_on_the_page() {
    let page = fs::read_to_string(gallery().join("README.md")).unwrap();
    for name in names() {
        assert!(page.contains(&format!("{name}.toml")), "{name}.toml is missing in the gallery's README");
        let text = fs::read_to_string(gallery().join(&name).with_extension("toml")).unwrap();
        for part in ["# What is seen: ", "# Why it is right: "] {
            assert!(text.contains(part), "{name}.toml does not say `{part}`");
        }
    }
}

/// What a browser has to fetch before it shows the first page of the project.
#[test]
fn the_pictures_of_the_pages_are_small() {
    for (name, limit) in [("contact_sheet.png", 600_000), ("hero.png", 300_000)] {
        let bytes = fs::read(gallery().join(name)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{name} is not a PNG file");
        assert!(bytes.len() < limit, "{name} has {} bytes, more than {limit}", bytes.len());
    }
}
