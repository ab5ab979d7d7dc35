//! What can be wrong with writing or reading an image.

use std::path::PathBuf;

use thiserror::Error;

pub use crate::atomic::WriteError;

/// An image that could not be written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The format of the file is not known by its name.
    #[error(
        "{}: {}, expected .exr (linear, for further work) or .png (for looking at)", path.display(),
        found.as_ref().map_or_else(|| "the name has no extension".to_owned(), |found| format!("found the extension .{found}"))
    )]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// Its extension, if it has one.
        found: Option<String>,
    },
    /// The file is not of a kind that holds radiance.
    #[error(
        "{}: {}, expected .hdr (Radiance) or .exr (OpenEXR)", path.display(),
        found.as_ref().map_or_else(|| "the name has no extension".to_owned(), |found| format!("found the extension .{found}"))
    )]
    NoRadiance {
        /// The file.
        path: PathBuf,
        /// Its extension, if it has one.
        found: Option<String>,
    },
    /// The image has no pixels, too many for its format, or not as many as its size says.
    #[error(
        "the image is {width} x {height} and has {pixels} pixels, expected 1 to 2147483647 each way and as many \
             pixels as their product"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Number of pixels given.
        pixels: usize,
    },
    /// A key or value that the formats cannot hold.
    #[error(
        "the metadata `{key}` cannot be stored, expected a key of 1 to 72 letters, digits and punctuation marks \
             of ASCII, and a value without NUL"
    )]
    Metadata {
        /// The key.
        key: String,
    },
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The library for the format refused the image.
    #[error("{}: the image cannot be encoded ({message})", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the library said.
        message: String,
    },
    /// The file could not be read.
    #[error("{}: the file cannot be read ({source}); check the path and its permissions", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not an image of this format, is damaged, or lacks what is needed.
    #[error("{}: the file cannot be read as {format} ({message}); it may be damaged or cut off", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// What it was expected to be.
        format: &'static str,
        /// What the library said.
        message: String,
    },
    /// There is no file of this name.
    #[error("{}: there is no such file", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
    },
    /// The file is no image that can be read.
    #[error("{}: {found}, expected an image: PNG, JPEG, Radiance HDR or OpenEXR", path.display())]
    NotAnImage {
        /// The file.
        path: PathBuf,
        /// What it is, or begins with.
        found: String,
    },
    /// The file is damaged or cut off.
    #[error("{}: the file cannot be read as {format} ({message}); it may be damaged or cut off", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What it seems to be.
        format: &'static str,
        /// What the library said.
        message: String,
    },
    /// The image is larger than this reader takes.
    #[error("{}: the image has {width} x {height} pixels, the limit is {limit} together; scale it down", path.display())]
    TooManyPixels {
        /// The file.
        path: PathBuf,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The largest number taken.
        limit: u64,
    },
    /// The image holds pixels that are no colours.
    #[error("{}: {reason}; write the image again without them", path.display())]
    BadPixels {
        /// The file.
        path: PathBuf,
        /// How many, and the first.
        reason: String,
    },
    /// A linear image is said to be encoded for a display.
    #[error("{}: {format} is linear, and was said to be encoded as sRGB; leave out `encoding`", path.display())]
    Encoding {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: &'static str,
    },
}
