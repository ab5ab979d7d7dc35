//! The first pass over an OBJ file: checks every statement, so that errors name their line, and writes down the same
//! geometry in the plain form that `tobj` reads without surprises.
//!
//! What the library does not do by itself, and is done here: lines joined by a backslash, trailing comments, names
//! that are not UTF-8, vertices with colours of any length, one-dimensional texture coordinates, groups told from
//! objects, materials found by name after the last line, and errors that name their line. In the plain form a file is
//! one object of faces with at least three corners and positive indices that exist; which object, group and material
//! each face belongs to is kept beside it as [`Run`]s of faces in file order.
//!
//! A face may name vertices that come later in the file. A texture coordinate or normal that does not exist is left
//! out of its face; a position that does not exist is an error.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::ObjError;
use super::lines::{self, Statement};

/// Faces with more corners are refused: cutting one into triangles takes time with the square of their number.
pub(super) const MOST_CORNERS: usize = 1 << 14;

/// Faces in file order that agree in everything but their corners; the next run begins where one ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    /// Number of faces before it.
    pub(super) first_face: usize,
    /// Number of corners before it.
    pub(super) first_corner: usize,
    pub(super) kind: Kind,
}

/// What the faces of a run agree in. Names are positions in the lists of the [`Scan`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kind {
    pub(super) object: usize,
    pub(super) group: Option<usize>,
    pub(super) material: Option<usize>,
    pub(super) has_normals: bool,
    pub(super) has_uvs: bool,
}

/// How often something was seen, and the line of the first time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub(super) count: u64,
    pub(super) first_line: u64,
}

impl Tally {
    fn note(&mut self, line: u64) {
        if self.count == 0 {
            self.first_line = line;
        }
        self.count += 1;
    }
}

/// Different names in the order of their first use, with its line.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub(super) list: Vec<(String, u64)>,
    position: BTreeMap<String, usize>,
}

impl Names {
    fn position_of(&mut self, name: &[u8], line: u64) -> usize {
        let name = lines::readable(name);
        *self.position.entry(name).or_insert_with_key(|name| {
            self.list.push((name.clone(), line));
            self.list.len() - 1
        })
    }
}

/// What the first pass found.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// The geometry in plain form.
    pub(super) plain: Vec<u8>,
    pub(super) runs: Vec<Run>,
    /// Number of faces and corners in the plain form.
    pub(super) faces: usize,
    pub(super) corners: usize,
    pub(super) vertices: u64,
    pub(super) objects: Names,
    /// Names of groups; one entry holds all names of a `g` statement.
    pub(super) groups: Names,
    pub(super) materials: Names,
    pub(super) libraries: Names,
    pub(super) tallies: Tallies,
}

/// What is passed over, and said.
#[derive(Debug, Default)]
pub(super) struct Tallies {
    pub(super) points: Tally,
    pub(super) lines: Tally,
    pub(super) short_faces: Tally,
    pub(super) colours: Tally,
    pub(super) missing_uvs: Tally,
    pub(super) missing_normals: Tally,
    pub(super) unusable_uvs: Tally,
    pub(super) unusable_normals: Tally,
    pub(super) unknown: Tally,
    pub(super) first_unknown: String,
}

/// Reads every statement of `bytes`; `path` is for messages.
pub(super) fn scan(path: &Path, bytes: &[u8]) -> Result<Scan, ObjError> {
    let mut scanner = Scanner::new(path, bytes);
    for statement in lines::statements(bytes) {
        scanner.statement(&statement)?;
    }
    if scanner.not_finite.count > 0 {
        let (Tally { count, first_line: line }, found) = (scanner.not_finite, scanner.first_not_finite);
        return Err(ObjError::NotFinite { path: scanner.path, line, count, found });
    }
    Ok(scanner.scan)
}

/// Numbers of positions, texture coordinates and normals, in the order in which a corner names them.
type Counts = [u64; 3];

struct Scanner {
    path: PathBuf,
    scan: Scan,
    /// How many there are in the whole file, and in the lines read so far.
    total: Counts,
    seen: Counts,
    object: Option<usize>,
    group: Option<usize>,
    material: Option<usize>,
    not_finite: Tally,
    first_not_finite: String,
    /// Corners of the face being read, counted from 1; 0 where it names none.
    face: Vec<[u64; 3]>,
}

impl Scanner {
    fn new(path: &Path, bytes: &[u8]) -> Self {
        let mut total = [0; 3];
        for statement in lines::statements(bytes) {
            match lines::keyword_and_rest(&statement.text).0 {
                b"v" => total[0] += 1,
                b"vt" => total[1] += 1,
                b"vn" => total[2] += 1,
                _ => {}
            }
        }
        Self {
            path: path.to_owned(),
            scan: Scan { vertices: total[0], ..Scan::default() },
            total,
            seen: [0; 3],
            object: None,
            group: None,
            material: None,
            not_finite: Tally::default(),
            first_not_finite: String::new(),
            face: Vec::new(),
        }
    }

    fn statement(&mut self, statement: &Statement<'_>) -> Result<(), ObjError> {
        let line = statement.line;
        let (keyword, rest) = lines::keyword_and_rest(&statement.text);
        let Scan { objects, groups, materials, libraries, tallies, .. } = &mut self.scan;
        match keyword {
            b"v" => self.position(line, rest)?,
            b"vt" => self.texture_coordinate(line, rest)?,
            b"vn" => self.normal(line, rest)?,
            // `fo` is how the format's first version spelled it.
            b"f" | b"fo" => self.face(line, rest)?,
            b"l" => tallies.lines.note(line),
            b"p" => tallies.points.note(line),
            b"o" => self.object = Some(objects.position_of(rest, line)),
            b"g" => self.group = (!rest.is_empty()).then(|| groups.position_of(rest, line)),
            b"usemtl" => self.material = (!rest.is_empty()).then(|| materials.position_of(rest, line)),
            b"mtllib" if !rest.is_empty() => {
                libraries.position_of(rest, line);
            }
            // Smoothing groups, display hints and the points of free-form surfaces change no triangle.
            b"" | b"mtllib" | b"s" | b"mg" | b"vp" | b"lod" | b"bevel" | b"c_interp" | b"d_interp"
            | b"shadow_obj" | b"trace_obj" | b"maplib" | b"usemap" => {}
            unknown => {
                if tallies.unknown.count == 0 {
                    tallies.first_unknown = lines::quoted(unknown);
                }
                tallies.unknown.note(line);
            }
        }
        Ok(())
    }

    /// `v x y z`, then nothing, a weight, or a colour.
    fn position(&mut self, line: u64, rest: &[u8]) -> Result<(), ObjError> {
        const EXPECTED: &str = "three coordinates (numbers, with a point and not a comma)";
        self.seen[0] += 1;
        self.scan.plain.push(b'v');
        let mut words = lines::words(rest);
        let mut finite = true;
        let mut coordinates = [0.0; 3];
        for coordinate in &mut coordinates {
            *coordinate = self.copy_number(line, words.next(), EXPECTED)?;
            finite &= coordinate.is_finite();
        }
        let weight = words.next();
        if weight.is_some() && words.next().is_some() {
            self.scan.tallies.colours.note(line);
        } else if weight.is_some() {
            let weight = self.copy_number(line, weight, "a weight (a number)")?;
            finite &= coordinates.iter().all(|coordinate| (coordinate / weight).is_finite());
        }
        if !finite {
            if self.not_finite.count == 0 {
                self.first_not_finite = lines::quoted(rest);
            }
            self.not_finite.note(line);
        }
        self.scan.plain.push(b'\n');
        Ok(())
    }

    /// `vt u`, `vt u v` or `vt u v w`; of a two-dimensional texture the missing `v` is 0 and `w` means nothing.
    fn texture_coordinate(&mut self, line: u64, rest: &[u8]) -> Result<(), ObjError> {
        const EXPECTED: &str = "texture coordinates (numbers)";
        self.seen[1] += 1;
        self.scan.plain.extend_from_slice(b"vt");
        let mut words = lines::words(rest);
        let u = self.copy_number(line, words.next(), EXPECTED)?;
        let v = self.copy_number(line, words.next().or(Some(b"0")), EXPECTED)?;
        if !(u.is_finite() && v.is_finite()) {
            self.scan.tallies.unusable_uvs.note(line);
        }
        self.scan.plain.push(b'\n');
        Ok(())
    }

    /// `vn x y z`; need not be of unit length.
    fn normal(&mut self, line: u64, rest: &[u8]) -> Result<(), ObjError> {
        const EXPECTED: &str = "the three components of a normal (numbers)";
        self.seen[2] += 1;
        self.scan.plain.extend_from_slice(b"vn");
        let mut words = lines::words(rest);
        let mut usable = false;
        let mut finite = true;
        for _ in 0..3 {
            let component = self.copy_number(line, words.next(), EXPECTED)?;
            usable |= component != 0.0;
            finite &= component.is_finite();
        }
        if !(usable && finite) {
            self.scan.tallies.unusable_normals.note(line);
        }
        self.scan.plain.push(b'\n');
        Ok(())
    }

    /// Reads a number and copies it into the plain form, as 0 if it is not finite: a vertex like that is refused in the
    /// end, a texture coordinate or normal is as good as none.
    fn copy_number(
        &mut self,
        line: u64,
        word: Option<&[u8]>,
        expected: &'static str,
    ) -> Result<f64, ObjError> {
        let Some((word, number)) = word.and_then(|word| Some((word, lines::number(word)?))) else {
            return Err(self.malformed(line, word, expected));
        };
        self.scan.plain.push(b' ');
        self.scan.plain.extend_from_slice(if number.is_finite() { word } else { b"0" });
        Ok(number)
    }

    /// `f` and three or more corners, each `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn face(&mut self, line: u64, rest: &[u8]) -> Result<(), ObjError> {
        self.face.clear();
        let mut missing = [false; 3];
        for word in lines::words(rest) {
            let mut corner = [0; 3];
            let mut fields = word.split(|&byte| byte == b'/');
            for (kind, (index, field)) in corner.iter_mut().zip(fields.by_ref()).enumerate() {
                if field.is_empty() && kind > 0 {
                    continue;
                }
                let Some(written) = std::str::from_utf8(field).ok().and_then(|field| field.parse().ok())
                else {
                    return Err(self.malformed(line, Some(word), CORNER));
                };
                match resolve(written, self.seen[kind], self.total[kind]) {
                    Some(found) => *index = found,
                    None if kind > 0 => missing[kind] = true,
                    None => {
                        let (path, count) = (self.path.clone(), self.total[0]);
                        return Err(ObjError::IndexOutOfRange { path, line, index: written, count });
                    }
                }
            }
            if fields.next().is_some() {
                return Err(self.malformed(line, Some(word), CORNER));
            }
            self.face.push(corner);
        }
        let tallies = &mut self.scan.tallies;
        match self.face.len() {
            0..3 => tallies.short_faces.note(line),
            3..=MOST_CORNERS => {
                if missing[1] {
                    tallies.missing_uvs.note(line);
                }
                if missing[2] {
                    tallies.missing_normals.note(line);
                }
                self.copy_face(line);
            }
            corners => {
                let path = self.path.clone();
                return Err(ObjError::TooManyCorners { path, line, corners, limit: MOST_CORNERS });
            }
        }
        Ok(())
    }

    /// Writes the face that was read into the plain form and adds it to its run.
    fn copy_face(&mut self, line: u64) {
        let has_uvs = self.face.iter().all(|corner| corner[1] != 0);
        let has_normals = self.face.iter().all(|corner| corner[2] != 0);
        let scan = &mut self.scan;
        let object = *self.object.get_or_insert_with(|| scan.objects.position_of(b"", line));
        let kind = Kind { object, group: self.group, material: self.material, has_normals, has_uvs };
        if scan.runs.last().is_none_or(|run| run.kind != kind) {
            scan.runs.push(Run { first_face: scan.faces, first_corner: scan.corners, kind });
        }
        scan.faces += 1;
        scan.corners += self.face.len();
        scan.plain.push(b'f');
        for corner in &self.face {
            push_index(&mut scan.plain, b' ', corner[0]);
            push_index(&mut scan.plain, b'/', if has_uvs { corner[1] } else { 0 });
            push_index(&mut scan.plain, b'/', if has_normals { corner[2] } else { 0 });
        }
        scan.plain.push(b'\n');
    }

    fn malformed(&self, line: u64, word: Option<&[u8]>, expected: &'static str) -> ObjError {
        let found = word.map_or_else(|| "the end of the line".to_owned(), lines::quoted);
        ObjError::Malformed { path: self.path.clone(), line, found, expected }
    }
}

const CORNER: &str = "a corner of a face: v, v/vt, v//vn or v/vt/vn (whole numbers)";

/// The index counted from 1 that is meant by one as written: from 1, or back from the last one read so far (-1).
fn resolve(written: i64, seen: u64, total: u64) -> Option<u64> {
    let index =
        if written < 0 { seen.checked_sub(written.unsigned_abs())? + 1 } else { written.unsigned_abs() };
    (1..=total).contains(&index).then_some(index)
}

/// Writes a separator and an index, or the separator alone for 0.
fn push_index(plain: &mut Vec<u8>, separator: u8, index: u64) {
    plain.push(separator);
    if index != 0 {
        plain.extend_from_slice(index.to_string().as_bytes());
    }
}
