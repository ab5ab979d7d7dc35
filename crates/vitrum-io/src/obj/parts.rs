//! Puts a file's faces together into one mesh per object: cut into triangles, with its own vertices only.
//!
//! Positions, normals and texture coordinates keep their separate indices, so that a closed solid stays closed where
//! its normals or textures have seams, and where it changes its material.

use vitrum_geometry::mesh::MeshData;
use vitrum_math::{DVec2, DVec3};

use super::polygon;
use super::scan::{Run, Scan};
use super::{Group, Part};

/// All parts, and how many faces needed a guess.
#[derive(Default)]
pub(super) struct Assembly {
    pub(super) parts: Vec<Part>,
    /// Faces that cross themselves or have no area, and more than three corners.
    pub(super) guessed_faces: u64,
    /// Faces without normals of their own in a part where others have some.
    pub(super) flat_faces: u64,
}

/// Builds the parts, in the order in which the file first names their objects. `mesh` is what was read from the scan's
/// plain form; `material_of` turns the scan's materials into indices of the final list, whose entry `unnamed` stands
/// for the faces that name no material where others do.
pub(super) fn assemble(scan: &Scan, mesh: &tobj::Mesh, material_of: &[usize], unnamed: usize) -> Assembly {
    let mut runs_of = vec![Vec::new(); scan.objects.list.len()];
    for (at, run) in scan.runs.iter().enumerate() {
        let next_face = scan.runs.get(at + 1).map_or(scan.faces, |next| next.first_face);
        runs_of[run.kind.object].push((run, next_face));
    }
    let mut assembler = Assembler {
        scan,
        mesh,
        positions: Renumbering::new(mesh.positions.len() / 3),
        normals: Renumbering::new(mesh.normals.len() / 3),
        uvs: Renumbering::new(mesh.texcoords.len() / 2),
        corners: Vec::new(),
        cut: Vec::new(),
        assembly: Assembly::default(),
    };
    for ((name, _), runs) in scan.objects.list.iter().zip(&runs_of) {
        if !runs.is_empty() {
            let mut part = assembler.part(name, runs);
            set_materials(&mut part, runs, material_of, unnamed);
            assembler.assembly.parts.push(part.part);
        }
    }
    assembler.assembly
}

/// A run and the number of faces before the one after it.
type RunOfFaces<'a> = (&'a Run, usize);

/// A part whose materials are not set yet, and the number of its triangles at the end of each run.
struct Unpainted {
    part: Part,
    run_ends: Vec<usize>,
}

/// One material for the whole part where that is enough, else one for each triangle.
fn set_materials(unpainted: &mut Unpainted, runs: &[RunOfFaces<'_>], material_of: &[usize], unnamed: usize) {
    let part = &mut unpainted.part;
    let first = runs[0].0.kind.material;
    if runs.iter().all(|(run, _)| run.kind.material == first) {
        part.material = first.map(|material| material_of[material]);
        return;
    }
    for ((run, _), &end) in runs.iter().zip(&unpainted.run_ends) {
        let material = run.kind.material.map_or(unnamed, |material| material_of[material]);
        let material = u32::try_from(material).expect("a file of 4 GiB names fewer materials");
        part.mesh.materials.resize(end, material);
    }
}

struct Assembler<'a> {
    scan: &'a Scan,
    mesh: &'a tobj::Mesh,
    positions: Renumbering,
    normals: Renumbering,
    uvs: Renumbering,
    /// Positions of the face at hand, and its triangles.
    corners: Vec<DVec3>,
    cut: Vec<[usize; 3]>,
    assembly: Assembly,
}

impl Assembler<'_> {
    fn part(&mut self, name: &str, runs: &[RunOfFaces<'_>]) -> Unpainted {
        for list in [&mut self.positions, &mut self.normals, &mut self.uvs] {
            list.start_part();
        }
        let has_uvs = runs.iter().any(|(run, _)| run.kind.has_uvs);
        let has_normals = runs.iter().any(|run| self.has_usable_normal(run));
        let mut data = MeshData::default();
        let mut groups: Vec<(usize, std::ops::Range<usize>)> = Vec::new();
        let mut run_ends = Vec::with_capacity(runs.len());
        for &(run, next_face) in runs {
            let start = data.triangles.len();
            let mut corner = run.first_corner;
            for face in run.first_face..next_face {
                let next_corner = corner + self.arity(face);
                self.face(&mut data, run, corner..next_corner, has_normals, has_uvs);
                corner = next_corner;
            }
            let end = data.triangles.len();
            run_ends.push(end);
            match (run.kind.group, groups.last_mut()) {
                (Some(group), Some((last, range))) if *last == group && range.end == start => range.end = end,
                (Some(group), _) => groups.push((group, start..end)),
                (None, _) => {}
            }
        }
        let groups = groups.into_iter().flat_map(|(group, triangles)| {
            let names = self.scan.groups.list[group].0.split_ascii_whitespace();
            names.map(move |name| Group { name: name.to_owned(), triangles: triangles.clone() })
        });
        let unmapped = runs.iter().filter(|(run, _)| has_uvs && !run.kind.has_uvs);
        let unmapped_faces = unmapped.map(|(run, next_face)| next_face - run.first_face).sum();
        let groups = groups.collect();
        let part = Part { name: name.to_owned(), mesh: data, material: None, unmapped_faces, groups };
        Unpainted { part, run_ends }
    }

    /// Number of corners of a face; the library leaves the list out where all have three.
    fn arity(&self, face: usize) -> usize {
        self.mesh.face_arities.get(face).map_or(3, |&arity| arity as usize)
    }

    fn has_usable_normal(&self, (run, next_face): &RunOfFaces<'_>) -> bool {
        let corners: usize = (run.first_face..*next_face).map(|face| self.arity(face)).sum();
        run.kind.has_normals
            && self.mesh.normal_indices[run.first_corner..run.first_corner + corners]
                .iter()
                .any(|&index| is_usable(self.normal(index)))
    }

    fn normal(&self, index: u32) -> DVec3 {
        DVec3::from_slice(&self.mesh.normals[3 * index as usize..])
    }

    /// Adds the triangles of one face, whose corners stand at `range` in the lists of indices.
    fn face(
        &mut self,
        data: &mut MeshData,
        run: &Run,
        range: std::ops::Range<usize>,
        has_normals: bool,
        has_uvs: bool,
    ) {
        let mesh = self.mesh;
        let position = |index: u32| DVec3::from_slice(&mesh.positions[3 * index as usize..]);
        let indices = &mesh.indices[range.clone()];
        self.corners.clear();
        self.corners.extend(indices.iter().map(|&index| position(index)));
        self.cut.clear();
        if !polygon::triangulate(&self.corners, &mut self.cut) {
            self.assembly.guessed_faces += 1;
        }
        let mut add = |cut: [usize; 3]| {
            cut.map(|corner| {
                self.positions.place(indices[corner], &mut data.positions, || self.corners[corner])
            })
        };
        data.triangles.extend(self.cut.iter().map(|&cut| add(cut)));
        if has_uvs {
            let uv = |index: u32| DVec2::from_slice(&mesh.texcoords[2 * index as usize..]);
            let placed: Vec<u32> = if run.kind.has_uvs {
                let indices = &mesh.texcoord_indices[range.clone()];
                indices.iter().map(|&index| self.uvs.place(index, &mut data.uvs, || uv(index))).collect()
            } else {
                vec![self.uvs.stand_in(&mut data.uvs, DVec2::ZERO); indices.len()]
            };
            data.uv_triangles.extend(self.cut.iter().map(|cut| cut.map(|corner| placed[corner])));
        }
        if has_normals {
            let placed = self.place_normals(data, run, range);
            data.normal_triangles.extend(self.cut.iter().map(|cut| cut.map(|corner| placed[corner])));
        }
    }

    /// The normals of a face's corners; those without a usable one take the face's own.
    fn place_normals(&mut self, data: &mut MeshData, run: &Run, range: std::ops::Range<usize>) -> Vec<u32> {
        if !run.kind.has_normals {
            self.assembly.flat_faces += 1;
        }
        let mut flat = None;
        range
            .map(|corner| {
                let given = run.kind.has_normals.then(|| self.mesh.normal_indices[corner]);
                match given.map(|index| (index, self.normal(index))) {
                    Some((index, normal)) if is_usable(normal) => {
                        self.normals.place(index, &mut data.normals, || normal)
                    }
                    _ => *flat.get_or_insert_with(|| push(&mut data.normals, flat_normal(&self.corners))),
                }
            })
            .collect()
    }
}

fn is_usable(normal: DVec3) -> bool {
    normal.is_finite() && normal != DVec3::ZERO
}

/// Unit normal of a face. One without area is never hit: any direction will do.
fn flat_normal(corners: &[DVec3]) -> DVec3 {
    polygon::area_vector(corners).try_normalize().unwrap_or(DVec3::Y)
}

/// Adds to a list and returns the new entry's index.
fn push<T>(list: &mut Vec<T>, value: T) -> u32 {
    list.push(value);
    u32::try_from(list.len() - 1).expect("a file of 4 GiB has fewer corners than that")
}

/// New indices for those values of a list that a part uses, in the order of their first use.
struct Renumbering {
    /// For each value of the whole file: the part that last used it, and its index there.
    last_use: Vec<(u32, u32)>,
    /// Number of the part at hand, counted from 1.
    part: u32,
    /// Index of the value that stands in for missing ones, if the part has one.
    stand_in: Option<u32>,
}

impl Renumbering {
    fn new(count: usize) -> Self {
        Self { last_use: vec![(0, 0); count], part: 0, stand_in: None }
    }

    fn start_part(&mut self) {
        self.part += 1;
        self.stand_in = None;
    }

    fn place<T>(&mut self, index: u32, list: &mut Vec<T>, value: impl FnOnce() -> T) -> u32 {
        let (part, placed) = &mut self.last_use[index as usize];
        if *part != self.part {
            (*part, *placed) = (self.part, push(list, value()));
        }
        *placed
    }

    fn stand_in<T>(&mut self, list: &mut Vec<T>, value: T) -> u32 {
        *self.stand_in.get_or_insert_with(|| push(list, value))
    }
}
