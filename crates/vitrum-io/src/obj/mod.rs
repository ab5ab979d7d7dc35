//! Wavefront OBJ models and their MTL materials.
//!
//! - One [`Part`] per object (`o`; the whole file where there is none): a closed solid stays in one piece, whatever
//!   materials and groups it is made of. Groups (`g`) are named ranges of its triangles.
//! - Coordinates are taken as they stand, in f64: right-handed, unit of the file. Faces are anticlockwise from
//!   outside. Positions, normals and texture coordinates keep their separate indices.
//! - Faces with more than three corners are cut into triangles, concave ones too (`polygon.rs`).
//! - A corner without a usable normal takes its face's normal where other faces of the part have normals; a part
//!   without any has none. Smoothing groups, vertex colours and texture maps but that of the colour
//!   (`map_Kd`) are not used.
//! - What is passed over is said in [`ObjFile::warnings`], once per kind. What makes the geometry doubtful (a vertex
//!   that does not exist or is not finite, a number that is none) refuses the file: [`ObjError`].
//! - Materials: the table in `material.rs`. A missing library is a warning.
//!
//! Limits: 4 GiB per file, 2^14 corners per face, 64 libraries of at most 16 MiB. Memory: up to about fifteen times
//! the size of the file while it is read.
//!
//! Sources: Alias Wavefront, Advanced Visualizer manual, appendix B1, Object files, 1995; read with the crate `tobj`.

mod error;
mod lines;
mod material;
mod mtl;
mod parts;
mod polygon;
mod scan;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::Path;

use vitrum_geometry::mesh::MeshData;

pub use error::ObjError;
pub use material::{MtlMap, MtlMaterial, MtlMeaning};

use parts::Assembly;
use scan::{Scan, Tally};

/// Larger files are refused. Below it, all indices fit 32 bits.
const LARGEST_FILE: u64 = 4 << 30;
/// Larger material libraries are not read, and no more of them.
const LARGEST_LIBRARY: u64 = 16 << 20;
const MOST_LIBRARIES: usize = 64;

/// An OBJ file with the materials that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjFile {
    /// Objects that have faces, in the order in which the file first names them; never empty.
    pub parts: Vec<Part>,
    /// Materials of the libraries that could be read, then those that are used but not defined.
    pub materials: Vec<MtlMaterial>,
    /// What was passed over or assumed: one sentence each.
    pub warnings: Vec<String>,
}

/// One object of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name given by `o`; empty for the faces before the first.
    pub name: String,
    /// Its triangles. Not checked: it may be open, inside out or degenerate. Where the part has several materials, its
    /// triangles number them as in [`ObjFile::materials`].
    pub mesh: MeshData,
    /// The material of all its faces, in [`ObjFile::materials`]; `None` if the file names none, or several.
    pub material: Option<usize>,
    /// Its faces without texture coordinates where others have some: they take the place u = v = 0.
    pub unmapped_faces: usize,
    /// Its groups in the order of their triangles; one that was left and entered again is there twice.
    pub groups: Vec<Group>,
}

/// A named stretch of triangles of a [`Part`]. Triangles can be in several, or in none.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Name given by `g`.
    pub name: String,
    /// Its triangles.
    pub triangles: Range<usize>,
}

/// Reads an OBJ file and the material libraries beside it.
///
/// # Errors
/// When the file is missing, empty, too large, unreadable or not a file, or when its geometry is in doubt.
pub fn read(path: &Path) -> Result<ObjFile, ObjError> {
    let unreadable = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => ObjError::NotFound { path: path.to_owned() },
        _ => ObjError::Unreadable { path: path.to_owned(), source },
    };
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() { "a folder" } else { "a device or a pipe" };
        return Err(ObjError::NotAFile { path: path.to_owned(), found });
    }
    check_size(path, metadata.len())?;
    let bytes = fs::read(path).map_err(unreadable)?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    parse(path, &bytes, |name| read_library(folder, name))
}

/// Reads the bytes of an OBJ file. `name` stands in messages; `library` hands out the bytes of a material library by
/// the name that the file gives it.
///
/// # Errors
/// When the bytes are empty or too many, or when their geometry is in doubt.
pub fn parse(
    name: impl AsRef<Path>,
    bytes: &[u8],
    library: impl Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<ObjFile, ObjError> {
    let path = name.as_ref();
    check_size(path, bytes.len() as u64)?;
    let mut scan = scan::scan(path, bytes)?;
    if scan.faces == 0 {
        let tallies = &scan.tallies;
        return Err(ObjError::NoFaces {
            path: path.to_owned(),
            vertices: scan.vertices,
            points: tallies.points.count,
            lines: tallies.lines.count,
            short_faces: tallies.short_faces.count,
        });
    }
    let options = tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    let plain = std::mem::take(&mut scan.plain);
    let (models, _) = tobj::load_obj_buf(&mut &plain[..], &options, |_| Err(tobj::LoadError::OpenFileFailed))
        .map_err(|source| ObjError::Refused { path: path.to_owned(), source })?;
    drop(plain);
    let model = &models.first().expect("the plain form is one object").mesh;

    let mut warnings = Vec::new();
    let mut materials = load_libraries(&scan, library, &mut warnings);
    let material_of = find_materials(&scan, &mut materials, &mut warnings);
    let unnamed = materials.len();
    let assembly = parts::assemble(&scan, model, &material_of, unnamed);
    if assembly.parts.iter().any(|part| part.mesh.materials.contains(&(unnamed as u32))) {
        materials.push(MtlMaterial::undefined(""));
    }
    say_what_was_passed_over(&scan, &assembly, &mut warnings);
    Ok(ObjFile { parts: assembly.parts, materials, warnings })
}

fn check_size(path: &Path, bytes: u64) -> Result<(), ObjError> {
    match bytes {
        0 => Err(ObjError::Empty { path: path.to_owned() }),
        1..=LARGEST_FILE => Ok(()),
        _ => Err(ObjError::TooLarge { path: path.to_owned(), bytes, limit: LARGEST_FILE }),
    }
}

/// The bytes of a library that an OBJ file in `folder` names, with either kind of slash.
fn read_library(folder: &Path, name: &str) -> io::Result<Vec<u8>> {
    let read = |name: &str| {
        let path = folder.join(name);
        let metadata = fs::metadata(&path)?;
        if !metadata.is_file() {
            return Err(io::Error::other("not a file"));
        }
        if metadata.len() > LARGEST_LIBRARY {
            return Err(io::Error::other(format!("larger than {LARGEST_LIBRARY} bytes")));
        }
        fs::read(path)
    };
    read(name).or_else(|error| read(&name.replace('\\', "/")).map_err(|_| error))
}

/// The materials of all libraries. `mtllib` takes several names, but also names with blanks: the whole is tried first.
fn load_libraries(
    scan: &Scan,
    library: impl Fn(&str) -> io::Result<Vec<u8>>,
    warnings: &mut Vec<String>,
) -> Vec<MtlMaterial> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    let mut position: BTreeMap<String, usize> = BTreeMap::new();
    let mut redefined = Vec::new();
    let mut add = |name: &str, bytes: &[u8], warnings: &mut Vec<String>| {
        let (read, said) = mtl::parse(name, bytes);
        warnings.extend(said);
        for material in read {
            if let Some(&at) = position.get(&material.name) {
                redefined.push(material.name.clone());
                materials[at] = material;
            } else {
                position.insert(material.name.clone(), materials.len());
                materials.push(material);
            }
        }
    };
    let names = &scan.libraries.list;
    for (name, line) in names.iter().take(MOST_LIBRARIES) {
        let mut missing = |error: io::Error| {
            warnings.push(format!(
                "material library `{name}` (line {line}) cannot be read: {error}; its materials are plain grey"
            ));
        };
        match library(name) {
            Ok(bytes) => add(name, &bytes, warnings),
            Err(error) if !name.contains(char::is_whitespace) => missing(error),
            Err(error) => {
                let read: Result<Vec<_>, _> = name
                    .split_whitespace()
                    .take(MOST_LIBRARIES)
                    .map(|name| Ok::<_, io::Error>((name, library(name)?)))
                    .collect();
                match read {
                    Ok(libraries) => libraries.iter().for_each(|(name, bytes)| add(name, bytes, warnings)),
                    Err(_) => missing(error),
                }
            }
        }
    }
    if names.len() > MOST_LIBRARIES {
        warnings
            .push(format!("material libraries after the first {MOST_LIBRARIES}, not read: {}", names.len()));
    }
    if let Some(first) = redefined.first() {
        let count = redefined.len();
        warnings.push(format!(
            "materials defined again, of which the last definition counts: {count} (first `{first}`)"
        ));
    }
    materials
}

/// The index of each material that is used; those that nothing defines are added.
fn find_materials(scan: &Scan, materials: &mut Vec<MtlMaterial>, warnings: &mut Vec<String>) -> Vec<usize> {
    let position: BTreeMap<String, usize> =
        (0..).zip(&*materials).map(|(at, m)| (m.name.clone(), at)).collect();
    let mut undefined = 0_u64;
    let mut first_undefined = String::new();
    let found = scan.materials.list.iter().map(|(name, line)| {
        if let Some(&at) = position.get(name) {
            warnings.extend(materials[at].remarks());
            return at;
        }
        if undefined == 0 {
            first_undefined = format!("`{name}` at line {line}");
        }
        undefined += 1;
        materials.push(MtlMaterial::undefined(name));
        materials.len() - 1
    });
    let found = found.collect();
    if undefined > 0 {
        warnings.push(format!(
            "materials used but not defined, taken as plain grey: {undefined} (first {first_undefined})"
        ));
    }
    found
}

/// One sentence for each kind of thing that the file holds and that is not used.
fn say_what_was_passed_over(scan: &Scan, assembly: &Assembly, warnings: &mut Vec<String>) {
    let tallies = &scan.tallies;
    let mut say = |tally: &Tally, what: &str| {
        let Tally { count, first_line } = tally;
        if *count > 0 {
            warnings.push(format!("{what}: {count} (first at line {first_line})"));
        }
    };
    say(&tallies.points, "point elements (p) left out, for only faces are rendered");
    say(&tallies.lines, "line elements (l) left out, for only faces are rendered");
    say(&tallies.short_faces, "faces with fewer than three corners left out");
    say(&tallies.colours, "vertices with more than four numbers (vertex colours), of which three are used");
    say(&tallies.missing_uvs, "faces that name texture coordinates which do not exist, and go without");
    say(&tallies.missing_normals, "faces that name normals which do not exist, and go without");
    say(&tallies.unusable_uvs, "texture coordinates that are not finite, taken as 0");
    say(&tallies.unusable_normals, "normals that are zero or not finite, replaced by those of their faces");
    let unknown = format!("statements passed over, such as {}", tallies.first_unknown);
    say(&tallies.unknown, &unknown);
    if assembly.flat_faces > 0 {
        let count = assembly.flat_faces;
        warnings.push(format!("faces without normals in parts where others have some, shaded flat: {count}"));
    }
    if assembly.guessed_faces > 0 {
        let count = assembly.guessed_faces;
        warnings.push(format!(
            "faces that cross themselves or have no area, cut into triangles by a guess: {count}"
        ));
    }
}
