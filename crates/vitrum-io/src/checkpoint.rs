//! A render that was stopped, to go on with.
//!
//! The file holds what the picture was made with, as pairs of key and value, and the film to the last bit. It is little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 20 | `vitrum checkpoint 1` and a line end |
//! | 4, then for each pair 4 + key, 4 + value | number of pairs; each text after its length |
//! | 4 x 4 | area: x, y, width, height |
//! | 4 | number of buffers |
//! | for each buffer 4 for each square | samples that its pixels are to have |
//! | and 76 for each pixel | sums before and of the last round (2 x 3 x 8), samples taken, counted, counted in the last round (3 x 4), weight given up (8), rays (8) |
//! | 8 | FNV-1a hash of all that |

use crate::atomic::{self, WriteError};
use crate::load::fnv1a;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;
use vitrum_math::Rgb;
use vitrum_tracer::{Buffer, Crop, Film, Pixel};

const SIGNATURE: &[u8] = b"vitrum checkpoint 1\n";
const BYTES_OF_PIXEL: usize = 76;

/// A film, and what it was made with.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// What decides the picture, by name.
    pub about: Vec<(String, String)>,
    /// The film.
    pub film: Film,
}

/// A checkpoint that can't be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file could not be read.
    #[error("{}: the checkpoint cannot be read ({source})", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It is none.
    #[error("{}: this is not a checkpoint of this version of vitrum", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It is damaged or cut off.
    #[error("{}: the checkpoint is damaged or cut off; remove it and render anew", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
    },
}

/// Writes a checkpoint; a failure leaves the old file, if any, as it was.
///
/// # Errors
/// When the file can't be written.
pub fn write(path: &Path, about: &[(String, String)], film: &Film) -> Result<(), WriteError> {
    let bytes = encode(about, film);
    atomic::replace(path, |file| file.write_all(&bytes))
}

/// Reads a checkpoint.
///
/// # Errors
/// [`CheckpointError`] when there is none, or it is damaged.
pub fn read(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let bytes =
        fs::read(path).map_err(|source| CheckpointError::Unreadable { path: path.to_owned(), source })?;
    if !bytes.starts_with(SIGNATURE) {
        return Err(CheckpointError::Foreign { path: path.to_owned() });
    }
    decode(&bytes).ok_or_else(|| CheckpointError::Damaged { path: path.to_owned() })
}

fn encode(about: &[(String, String)], film: &Film) -> Vec<u8> {
    let pixels: usize = film.buffers().iter().map(|buffer| buffer.pixels.len()).sum();
    let mut bytes = Vec::with_capacity(4096 + pixels * (BYTES_OF_PIXEL + 1));
    bytes.extend(SIGNATURE);
    let number = |bytes: &mut Vec<u8>, n: usize| bytes.extend((n as u32).to_le_bytes());
    number(&mut bytes, about.len());
    for text in about.iter().flat_map(|(key, value)| [key, value]) {
        number(&mut bytes, text.len());
        bytes.extend(text.as_bytes());
    }
    let area = film.area();
    for n in [area.x, area.y, area.width, area.height] {
        bytes.extend(n.to_le_bytes());
    }
    number(&mut bytes, film.buffers().len());
    for buffer in film.buffers() {
        bytes.extend(buffer.goals.iter().flat_map(|goal| goal.to_le_bytes()));
        for pixel in &buffer.pixels {
            for value in pixel.before.to_array().into_iter().chain(pixel.last.to_array()) {
                bytes.extend(value.to_le_bytes());
            }
            for count in [pixel.taken, pixel.counted, pixel.last_counted] {
                bytes.extend(count.to_le_bytes());
            }
            bytes.extend(pixel.given_up.to_le_bytes());
            bytes.extend(pixel.rays.to_le_bytes());
        }
    }
    let hash = fnv1a(&bytes);
    bytes.extend(hash.to_le_bytes());
    bytes
}

/// What is left to read.
struct Rest<'b>(&'b [u8]);

impl<'b> Rest<'b> {
    fn take(&mut self, length: usize) -> Option<&'b [u8]> {
        let (taken, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_le_bytes)
    }

    fn rgb(&mut self) -> Option<Rgb> {
        Some(Rgb::new(self.f64()?, self.f64()?, self.f64()?))
    }

    fn text(&mut self) -> Option<String> {
        let length = self.u32()? as usize;
        String::from_utf8(self.take(length)?.to_vec()).ok()
    }

    fn pixel(&mut self) -> Option<Pixel> {
        Some(Pixel {
            before: self.rgb()?,
            last: self.rgb()?,
            taken: self.u32()?,
            counted: self.u32()?,
            last_counted: self.u32()?,
            given_up: self.f64()?,
            rays: self.array().map(u64::from_le_bytes)?,
        })
    }
}

fn decode(bytes: &[u8]) -> Option<Checkpoint> {
    let (all, hash) = bytes.split_last_chunk()?;
    if fnv1a(all) != u64::from_le_bytes(*hash) {
        return None;
    }
    let mut rest = Rest(all.strip_prefix(SIGNATURE)?);
    let pairs = rest.u32()?;
    let about = (0..pairs).map(|_| Some((rest.text()?, rest.text()?))).collect::<Option<Vec<_>>>()?;
    let area = Crop { x: rest.u32()?, y: rest.u32()?, width: rest.u32()?, height: rest.u32()? };
    let buffers = rest.u32()?;
    let (squares, pixels) = Film::extent(area)?;
    // What the file says of its size must be what there is, before any memory is taken for it.
    let each = squares.checked_mul(4)?.checked_add(pixels.checked_mul(BYTES_OF_PIXEL)?)?;
    if each.checked_mul(buffers as usize)? != rest.0.len() {
        return None;
    }
    let mut buffer = || {
        let goals = (0..squares).map(|_| rest.u32()).collect::<Option<Vec<_>>>()?;
        let pixels = (0..pixels).map(|_| rest.pixel()).collect::<Option<Vec<_>>>()?;
        Some(Buffer { goals, pixels })
    };
    let buffers = (0..buffers).map(|_| buffer()).collect::<Option<Vec<_>>>()?;
    Some(Checkpoint { about, film: Film::from_parts(area, buffers).ok()? })
}
