//! Mesh files: read once, mended where that needs no guess, and examined.

use super::naming::fnv1a;
use crate::obj::{self, MtlMaterial, ObjError, ObjFile, Part};
use crate::scene::Normals;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vitrum_geometry::mesh::{
    Build, MeshData, MeshError, TriangleMesh, examine, flat_normals, health, mend, smooth_normals,
};

/// What a mesh of a scene is like.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshReport {
    /// The object that it belongs to.
    pub object: String,
    /// The file.
    pub file: PathBuf,
    /// Triangles that can be hit.
    pub triangles: usize,
    /// True when it encloses a volume: every edge joins two faces, in opposite directions.
    pub closed: bool,
    /// The volume, in cubic units of the file, when it is closed.
    pub volume: Option<f64>,
    /// What is wrong with it, a line each.
    pub findings: Vec<String>,
    /// What was mended, a line each.
    pub mended: Vec<String>,
    /// Bytes of memory, with its tree.
    pub memory: usize,
}

/// A part of a file, ready to be traced.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    /// The part's own name; empty in a file without names.
    pub(super) name: String,
    pub(super) mesh: Arc<TriangleMesh>,
    /// What the materials that its faces number are in the file; `None` where the file names none.
    pub(super) materials: Vec<Option<MtlMaterial>>,
    /// Faces without texture coordinates where others have some.
    pub(super) unmapped_faces: usize,
    pub(super) report: MeshReport,
}

/// What was asked for: a file, normals, a build, and the object or group.
type Wanted = (PathBuf, u8, u8, Option<String>);

/// When a mesh keeps its texture coordinates.
#[derive(Clone, Copy, Default)]
pub(super) struct NeedsUvs {
    /// A material of the scene shows an image on it.
    pub(super) always: bool,
    /// It has the materials of its file: if these show images.
    pub(super) by_file: bool,
}

/// All files of a scene, each read once, and each way of using one prepared once. A file is given away to the last thing
/// that is [announced](Self::announce) to be made of it, so that it does not lie beside what is made.
#[derive(Default)]
pub(super) struct Meshes {
    /// Each with whether its warnings are still to be told.
    files: BTreeMap<PathBuf, (ObjFile, bool)>,
    /// What has been read, with a hash of its materials.
    read: Vec<(PathBuf, u64)>,
    /// What is still to be prepared.
    announced: BTreeMap<Wanted, NeedsUvs>,
    /// Whether meshes are looked through at length.
    examine: bool,
    prepared: BTreeMap<Wanted, Result<Vec<Prepared>, PrepareError>>,
}

/// Why a mesh can't be used.
#[derive(Debug, thiserror::Error)]
pub(super) enum PrepareError {
    #[error("{}: there is no such file", path.display())]
    Missing { path: PathBuf },
    #[error(transparent)]
    File(ObjError),
    #[error("{}: {reason}", path.display())]
    Mesh { path: PathBuf, reason: MeshError },
    #[error("{}: there is no object or group named `{name}`; it has {present}", path.display())]
    NoGroup { path: PathBuf, name: String, present: String },
}

impl From<ObjError> for PrepareError {
    /// Where a missing file was looked for is another matter in a scene than on the command line.
    fn from(error: ObjError) -> Self {
        match error {
            ObjError::NotFound { path } => Self::Missing { path },
            other => Self::File(other),
        }
    }
}

impl PrepareError {
    /// True when there is no such file.
    pub(super) fn is_missing(&self) -> bool {
        matches!(self, Self::Missing { .. })
    }
}

impl Meshes {
    /// Nothing yet.
    pub(super) fn new(examine: bool) -> Self {
        Self { examine, ..Self::default() }
    }

    /// With a file that has been read already.
    pub(super) fn holding(self, path: &Path, file: ObjFile) -> Self {
        let read = vec![(path.to_owned(), hash_of_materials(&file))];
        Self { files: BTreeMap::from([(path.to_owned(), (file, true))]), read, ..self }
    }

    /// The files that were read, each with a hash of its materials, which may come from other files.
    pub(super) fn read(&self) -> &[(PathBuf, u64)] {
        &self.read
    }

    /// Says that [`prepare`](Self::prepare) is going to be asked for this.
    pub(super) fn announce(
        &mut self,
        path: &Path,
        normals: Normals,
        build: Build,
        group: Option<&str>,
        needs_uvs: NeedsUvs,
    ) {
        let needs = self.announced.entry(wanted(path, normals, build, group)).or_default();
        needs.always |= needs_uvs.always;
        needs.by_file |= needs_uvs.by_file;
    }

    /// The parts of a file with the given normals, or of it the object or group of a name. `warn` takes what the file itself
    /// gives reason to say, once per file.
    pub(super) fn prepare(
        &mut self,
        path: &Path,
        normals: Normals,
        build: Build,
        group: Option<&str>,
        warn: &mut impl FnMut(&str),
    ) -> Result<&[Prepared], &PrepareError> {
        let key = wanted(path, normals, build, group);
        if !self.prepared.contains_key(&key) {
            let needs_uvs = self.announced.remove(&key).unwrap_or_default();
            let prepared = self.prepare_anew(path, normals, build, group, needs_uvs, warn);
            self.prepared.insert(key.clone(), prepared);
        }
        self.prepared[&key].as_ref().map(Vec::as_slice)
    }

    fn prepare_anew(
        &mut self,
        path: &Path,
        normals: Normals,
        build: Build,
        group: Option<&str>,
        needs_uvs: NeedsUvs,
        warn: &mut impl FnMut(&str),
    ) -> Result<Vec<Prepared>, PrepareError> {
        if !self.files.contains_key(path) {
            let file = obj::read(path)?;
            self.read.push((path.to_owned(), hash_of_materials(&file)));
            self.files.insert(path.to_owned(), (file, true));
        }
        if let Some((file, is_new)) = self.files.get_mut(path)
            && std::mem::take(is_new)
        {
            file.warnings.iter().for_each(|w| warn(w));
        }
        let is_last = self.announced.keys().all(|other| other.0 != path);
        let file = if is_last {
            Cow::Owned(self.files.remove(path).expect("it has just been read").0)
        } else {
            Cow::Borrowed(&self.files[path].0)
        };
        let materials = file.materials.clone();
        let parts = select(file, group).map_err(|present| PrepareError::NoGroup {
            path: path.to_owned(),
            name: group.unwrap_or_default().to_owned(),
            present,
        })?;
        let prepared: Result<Vec<_>, _> = parts
            .into_iter()
            .map(|part| prepare(path, part, &materials, normals, build, needs_uvs, self.examine))
            .collect();
        prepared.map_err(|reason| PrepareError::Mesh { path: path.to_owned(), reason })
    }
}

fn hash_of_materials(file: &ObjFile) -> u64 {
    fnv1a(format!("{:?}", file.materials).as_bytes())
}

fn wanted(path: &Path, normals: Normals, build: Build, group: Option<&str>) -> Wanted {
    (path.to_owned(), normals as u8, build as u8, group.map(str::to_owned))
}

/// The parts of a file that are used; `Err` lists the names that there are.
fn select(file: Cow<'_, ObjFile>, group: Option<&str>) -> Result<Vec<Part>, String> {
    let Some(group) = group else { return Ok(file.into_owned().parts) };
    let selected: Vec<Part> = file
        .parts
        .iter()
        .filter_map(|part| {
            if part.name == group {
                return Some(part.clone());
            }
            let ranges: Vec<_> =
                part.groups.iter().filter(|g| g.name == group).map(|g| g.triangles.clone()).collect();
            (!ranges.is_empty()).then(|| {
                let keep = |index: usize| ranges.iter().any(|r| r.contains(&index));
                Part { name: group.to_owned(), mesh: part_of(&part.mesh, keep), ..part.clone() }
            })
        })
        .collect();
    if selected.is_empty() {
        let mut names: Vec<&str> = file.parts.iter().map(|p| p.name.as_str()).collect();
        names.extend(file.parts.iter().flat_map(|p| &p.groups).map(|g| g.name.as_str()));
        names.retain(|n| !n.is_empty());
        names.sort_unstable();
        names.dedup();
        return Err(if names.is_empty() {
            "no names at all".to_owned()
        } else {
            format!("`{}`", names.join("`, `"))
        });
    }
    Ok(selected)
}

/// The triangles whose index passes, with all vertices.
fn part_of(mesh: &MeshData, keep: impl Fn(usize) -> bool) -> MeshData {
    fn kept<T: Clone>(all: &[T], keep: &impl Fn(usize) -> bool) -> Vec<T> {
        all.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, t)| t.clone()).collect()
    }
    MeshData {
        triangles: kept(&mesh.triangles, &keep),
        normal_triangles: kept(&mesh.normal_triangles, &keep),
        uv_triangles: kept(&mesh.uv_triangles, &keep),
        materials: kept(&mesh.materials, &keep),
        ..mesh.clone()
    }
}

fn prepare(
    path: &Path,
    part: Part,
    materials: &[MtlMaterial],
    normals: Normals,
    build: Build,
    needs_uvs: NeedsUvs,
    at_length: bool,
) -> Result<Prepared, MeshError> {
    let mut data = part.mesh;
    TriangleMesh::check_positions(&data)?;
    // Numbers of the file become positions in the list of those that the part uses.
    let mut used: Vec<u32> = data.materials.clone();
    used.sort_unstable();
    used.dedup();
    for number in &mut data.materials {
        *number = used.partition_point(|u| u < number) as u32;
    }
    let of = |number: usize| materials.get(number).cloned();
    let materials = if used.is_empty() {
        vec![part.material.and_then(of)]
    } else {
        used.iter().map(|&u| of(u as usize)).collect()
    };

    let by_file = needs_uvs.by_file && materials.iter().flatten().any(|m| m.map_kd.is_some());
    if !(needs_uvs.always || by_file) {
        (data.uvs, data.uv_triangles) = (Vec::new(), Vec::new());
    }
    let (data, mended) = mend(data);
    let health = if at_length { examine(&data) } else { health(&data) };
    let data = match normals {
        Normals::File => data,
        Normals::Flat => flat_normals(data),
        Normals::Smooth => smooth_normals(data),
    };
    let mesh = TriangleMesh::with_build(data, build)?;
    let mesh = if health.is_closed() { mesh } else { mesh.left_open() };
    let mesh = if health.bodies_may_overlap() { mesh.with_bodies_that_overlap() } else { mesh };
    let report = MeshReport {
        object: String::new(),
        file: path.to_owned(),
        triangles: mesh.triangle_count(),
        closed: health.is_closed(),
        volume: health.volume(),
        findings: health.findings.iter().map(ToString::to_string).collect(),
        mended: mended.iter().map(ToString::to_string).collect(),
        memory: mesh.memory(),
    };
    Ok(Prepared {
        name: part.name,
        mesh: Arc::new(mesh),
        materials,
        unmapped_faces: part.unmapped_faces,
        report,
    })
}
