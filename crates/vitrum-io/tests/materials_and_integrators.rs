//! Walks the table of materials and integrators in the format page: every material of the schema has a row, every
//! integrator a column, and each pair does what its cell says.

use std::path::Path;
use vitrum_io::load;
use vitrum_io::scene::schema;
use vitrum_tracer::{Settings, render};

/// The cells of the table, header first.
fn table() -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-format.md");
    let page = std::fs::read_to_string(path).expect("the page is part of the repository");
    let start = page.find("| material | `").expect("the page has the table");
    page[start..]
        .lines()
        .take_while(|line| line.starts_with('|'))
        .filter(|line| !line.starts_with("|---"))
        .map(|line| {
            line.trim_matches('|').split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect()
        })
        .collect()
}

/// The keys that a material needs beside its type.
fn required(material: &str) -> &'static str {
    match material {
        "reflective" => "kr = 0.5",
        "transparent" | "dielectric" | "thin" => "ior = 1.5",
        "conductor" => "n = 0.2, k = 3",
        "emissive" => "radiance = 1",
        _ => "color = 0.5",
    }
}

#[test]
fn every_material_renders_with_every_integrator_as_the_table_says() {
    let table = table();
    let materials: Vec<&str> = schema::MATERIAL.variants().iter().map(|variant| variant.name).collect();
    let rows: Vec<&str> = table[1..].iter().map(|row| row[0].as_str()).collect();
    assert_eq!(rows, materials, "one row for each material of the schema");
    let integrators: Vec<&str> = table[0][1..].iter().map(String::as_str).collect();
    let integrator =
        schema::RENDER.keys.iter().find(|key| key.name == "integrator").expect("the schema has it");
    let schema::Kind::Choice(known) = integrator.kind else { panic!("an integrator is chosen by name") };
    assert_eq!(integrators, known, "one column for each integrator of the schema");
    for row in &table[1..] {
        for (integrator, cell) in integrators.iter().zip(&row[1..]) {
            let ambient = "[[light]]\ntype = \"ambient\"\nradiance = 0.1\n";
            let text = |more: &str| {
                format!(
                    "[render]\nintegrator = \"{integrator}\"\n\
                 [camera]\ntype = \"pinhole\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n\
                 [background]\ntype = \"constant\"\ncolor = 1\n\
                 {}[[light]]\ntype = \"point\"\nposition = [3, 3, 5]\nintensity = 30\n\
                 [[object]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n\
                 material = {{ type = \"{}\", {}{more} }}\n",
                    if *integrator == "path" { "" } else { ambient },
                    row[0],
                    required(&row[0])
                )
            };
            let loaded = load::scene_text("table", &text(""), Path::new(""))
                .unwrap_or_else(|e| panic!("{}: {e}", row[0]));
            assert!(cell.starts_with("renders"), "the table says: {cell}");
            let refused = load::scene_text("table", &text(", roughness = 0.3"), Path::new(""));
            let is_rough = matches!(&*row[0], "dielectric" | "conductor");
            assert_eq!(
                cell.contains("refused when it is rough"),
                is_rough && refused.is_err(),
                "{}: {cell}",
                row[0]
            );
            let settings = Settings { size: [16, 16], spp: 2, ..loaded.settings };
            let rendering = render(&loaded.scene, &settings, &()).expect("valid settings");
            assert_eq!(rendering.stats.dropped, 0);
            assert!(rendering.film.image().iter().all(|p| p[0] > 0.0), "{}: nothing is black here", row[0]);
        }
    }
}
