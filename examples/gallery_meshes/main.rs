//! Writes the meshes of the gallery as OBJ files: `cargo run --example gallery_meshes -- [FOLDER]`.
//!
//! FOLDER is `scenes/gallery/meshes` if it is not given, and has to exist. The files are the same bytes on
//! every machine; a test of the package compares those in the repository with what this program makes.

mod brilliant;
mod circle;
mod knot;
mod obj;
mod wine_glass;

use std::{
    env, fs,
    io::{self, Write},
    path::PathBuf,
};

fn main() -> io::Result<()> {
    let folder = env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes/gallery/meshes"), PathBuf::from);
    let models = [
        (knot::NAME, knot::ABOUT, knot::mesh()),
        (wine_glass::NAME, wine_glass::ABOUT, wine_glass::mesh(wine_glass::SEGMENTS)),
        (brilliant::NAME, brilliant::ABOUT, brilliant::mesh(brilliant::GIRDLE_SIDES)),
    ];
    for (name, about, mesh) in models {
        let path = folder.join(name).with_extension("obj");
        let text = obj::text(name, about, &mesh);
        fs::write(&path, &text).map_err(|error| {
            io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display()))
        })?;
        writeln!(
            io::stdout(),
            "{}: {} triangles, {} bytes",
            path.display(),
            mesh.triangles.len(),
            text.len()
        )?;
    }
    Ok(())
}
