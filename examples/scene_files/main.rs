//! Writes what the scenes of the repository read, and one of them: `cargo run --example scene_files -- [FOLDER]`.
//!
//! FOLDER is `scenes` if it is not given, and has to hold `gallery/meshes` and `bench/meshes`. The files are the same bytes on every
//! machine; a test of the package compares those in the repository with what this program makes.

mod balls;
mod brilliant;
mod circle;
mod knot;
mod obj;
mod sky;
mod tumbler;
mod wine_glass;

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;
use std::{env, fs, io};

use vitrum::io::image::{self, Display, ImageView};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes"), PathBuf::from);
    let models = [
        ("gallery", knot::NAME, knot::ABOUT, knot::mesh()),
        ("gallery", wine_glass::NAME, wine_glass::ABOUT, wine_glass::mesh(wine_glass::SEGMENTS)),
        ("gallery", brilliant::NAME, brilliant::ABOUT, brilliant::mesh(brilliant::GIRDLE_SIDES)),
        ("bench", knot::FINE, knot::ABOUT_FINE, knot::fine_mesh()),
        ("bench", tumbler::OUTSIDE.0, tumbler::OUTSIDE.1, tumbler::outside()),
        ("bench", tumbler::BELOW.0, tumbler::BELOW.1, tumbler::below()),
        ("bench", tumbler::SURFACE.0, tumbler::SURFACE.1, tumbler::surface()),
        ("bench", tumbler::WHOLE.0, tumbler::WHOLE.1, tumbler::whole()),
        ("bench", tumbler::WATER.0, tumbler::WATER.1, tumbler::water()),
        ("bench", tumbler::ICE.0, tumbler::ICE.1, tumbler::ice()),
    ];
    for (of, name, about, mesh) in models {
        let path = folder.join(of).join("meshes").join(name).with_extension("obj");
        fs::write(&path, obj::text(name, about, &mesh)).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display()))
        })?;
        writeln!(io::stdout(), "{}: {} triangles", path.display(), mesh.triangles.len())?;
    }
    let bench = folder.join("bench");
    let pixels = sky::pixels();
    let sky = ImageView { width: sky::WIDTH, height: sky::HEIGHT, pixels: &pixels };
    image::write(&bench.join("sky.exr"), sky, &[], &[], Display::default())?;
    fs::write(bench.join("11_thousand_balls.toml"), balls::text())?;
    writeln!(io::stdout(), "{}: a sky, and a scene of a thousand balls", bench.display())?;
    Ok(())
}
