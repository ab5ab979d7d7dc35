//! What can be wrong with an OBJ file so that it is refused. Each message says where, what was found, what was
//! expected and what to do; lines count from 1.

use std::path::PathBuf;

use thiserror::Error;

/// An OBJ file that could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ObjError {
    /// There is no file of this name.
    #[error("{}: there is no such file; check the path (it is taken from the current folder)", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
    },
    /// The path names a directory, a device or a pipe.
    #[error("{}: this is {found}, expected an OBJ file", path.display())]
    NotAFile {
        /// The path given.
        path: PathBuf,
        /// What stands there.
        found: &'static str,
    },
    /// The system refused to hand out the bytes.
    #[error("{}: the file cannot be read ({source}); check its permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file has no bytes at all.
    #[error("{}: the file is empty, expected vertices and faces; was it written completely?", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is larger than this reader takes.
    #[error("{}: the file has {bytes} bytes, the limit is {limit}; split it into several files", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size in bytes.
        bytes: u64,
        /// The largest size taken, in bytes.
        limit: u64,
    },
    /// Nothing in the file has a surface.
    #[error(
        "{}: there are no faces to render (vertices: {vertices}, points: {points}, lines: {lines}, faces with fewer \
         than three corners: {short_faces}); export the model as a mesh", path.display()
    )]
    NoFaces {
        /// The file.
        path: PathBuf,
        /// Number of vertices (`v`).
        vertices: u64,
        /// Number of point elements (`p`).
        points: u64,
        /// Number of line elements (`l`).
        lines: u64,
        /// Number of faces (`f`) that have one or two corners, or none.
        short_faces: u64,
    },
    /// A number or an index is not one.
    #[error("{}:{line}: found {found}, expected {expected}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line of the statement.
        line: u64,
        /// What stands there, in quotes, or "the end of the line".
        found: String,
        /// What should stand there.
        expected: &'static str,
    },
    /// A face names a vertex that is not in the file.
    #[error(
        "{}:{line}: a face names vertex {index}, but the vertices end at {count} (they count from 1, or back from -1); \
         the file may be cut off or damaged: export it again", path.display()
    )]
    IndexOutOfRange {
        /// The file.
        path: PathBuf,
        /// Line of the face.
        line: u64,
        /// The index as written.
        index: i64,
        /// Number of vertices that it could name.
        count: u64,
    },
    /// Some vertices have coordinates that are infinite or not a number.
    #[error(
        "{}:{line}: vertices that are not finite: {count}, the first is {found}; \
         repair the model or export it again", path.display()
    )]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Line of the first.
        line: u64,
        /// How many there are.
        count: u64,
        /// The first, as written, in quotes.
        found: String,
    },
    /// A face has more corners than this reader cuts into triangles.
    #[error("{}:{line}: a face has {corners} corners, the limit is {limit}; triangulate the model", path.display())]
    TooManyCorners {
        /// The file.
        path: PathBuf,
        /// Line of the face.
        line: u64,
        /// How many corners it has.
        corners: usize,
        /// The largest number taken.
        limit: usize,
    },
    /// The statements were in order, but the OBJ library still refused them.
    #[error("{}: the file cannot be read as OBJ ({source})", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What the library said.
        source: tobj::LoadError,
    },
}
