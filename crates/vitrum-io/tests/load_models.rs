//! Every OBJ file of the assets goes the whole way, from the file to a picture: on a floor, small, as glass with its trees of rays and
//! as what the file says. What `expectations/obj.toml` says must load does, without a lost sample; what it says is refused stays so.
//! Needs the folder of assets: `VITRUM_ASSETS`.

use std::path::Path;
use std::time::{Duration, Instant};
use toml::de::DeTable;
use vitrum_io::load::{self, Loaded, ModelMaterial, ModelOptions};
use vitrum_testkit::{assets, files_with_extension};
use vitrum_tracer::{Settings, render};

/// Folder of the assets for each section of the table.
const FOLDERS: [(&str, &str); 3] = [("obj", "obj"), ("bad-mesh", "bad-mesh"), ("malformed", "malformed/obj")];

/// Loads and renders a model. What is wrong with the outcome, if anything.
fn show(path: &Path, material: ModelMaterial, refused: Option<&str>) -> Result<(), String> {
    let options = ModelOptions { material, ..ModelOptions::default() };
    let Loaded { scene, settings, meshes, .. } =
        match (load::model_file(path, &options, load::SceneOptions::default()), refused) {
            (Ok(loaded), None) => loaded,
            (Ok(_), Some(phrase)) => return Err(format!("loads, expected `{phrase}`")),
            (Err(error), Some(phrase)) if error.to_string().contains(phrase) => return Ok(()),
            (Err(error), _) => return Err(format!("is refused: {error}")),
        };
    if meshes.iter().any(|mesh| !mesh.closed && mesh.findings.is_empty()) {
        return Err("is not closed, and nothing says why".to_owned());
    }
    let settings = Settings { size: [24, 24], spp: 1, max_depth: Some(6), ..settings };
    let rendering = render(&scene, &settings, &()).map_err(|error| error.to_string())?;
    let (pixels, stats) = (rendering.film.image(), &rendering.stats);
    let is_seen = material != ModelMaterial::Glass || stats.transmitted_rays > 0;
    match stats.first_dropped {
        Some(first) => Err(format!("{} samples are lost, the first {first:?}", stats.dropped)),
        None if pixels.iter().flatten().any(|c| !c.is_finite() || *c < 0.0) => {
            Err("has bad pixels".to_owned())
        }
        None if !is_seen || stats.samples != 24 * 24 => Err("is not in the picture".to_owned()),
        None => Ok(()),
    }
}

#[expect(clippy::disallowed_methods, reason = "a test that is told how long its slowest files take")]
fn now() -> Instant {
    Instant::now()
}

#[test]
fn every_model_of_the_assets_is_shown_or_refused() {
    let Some(assets) = assets() else { return };
    let table =
        DeTable::parse(include_str!("expectations/obj.toml")).expect("the table is TOML").into_inner();
    let mut problems = Vec::new();
    let mut times: Vec<(Duration, String)> = Vec::new();
    for (section, folder) in FOLDERS {
        let rows = table[section].get_ref().as_table().expect("a section of the table");
        for path in files_with_extension(&assets.join(folder), "obj") {
            let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
            let Some(row) = rows.get(name.as_str()).and_then(|row| row.get_ref().as_table()) else {
                problems.push(format!("{section}/{name} is not in the table"));
                continue;
            };
            let refused = row.get("refused").and_then(|phrase| phrase.get_ref().as_str());
            let start = now();
            for material in [ModelMaterial::Glass, ModelMaterial::File] {
                let verdict = show(&path, material, refused);
                problems.extend(verdict.err().map(|e| format!("{section}/{name} ({material:?}) {e}")));
            }
            times.push((start.elapsed(), format!("{section}/{name}")));
        }
    }
    times.sort();
    for (time, name) in times.iter().rev().take(5) {
        eprintln!("{:6.2} s  {name}", time.as_secs_f64());
    }
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
    let listed: usize = FOLDERS.iter().filter_map(|(s, _)| Some(table[*s].get_ref().as_table()?.len())).sum();
    assert_eq!(times.len(), listed, "every file of the table is in the assets");
}
