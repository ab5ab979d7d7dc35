//! The meshes of the comparison.

use crate::bumpy::bumpy;
use crate::{brilliant, wine_glass};
use std::collections::BTreeMap;
use std::path::Path;
use vitrum::geometry::mesh::MeshData;
use vitrum::io::obj;
use vitrum::math::DVec3;

pub(crate) struct Named {
    pub(crate) name: &'static str,
    pub(crate) mesh: MeshData,
}

/// All of them; those that stand among the assets only where these are.
pub(crate) fn all(assets: Option<&Path>) -> Vec<Named> {
    let mut meshes = vec![
        Named { name: "gem", mesh: brilliant::mesh(128) },
        Named { name: "gallery's gem", mesh: brilliant::mesh(brilliant::GIRDLE_SIDES) },
        Named { name: "wine glass", mesh: wine_glass::mesh(128) },
        Named { name: "gallery's wine glass", mesh: wine_glass::mesh(wine_glass::SEGMENTS) },
    ];
    if let Some(assets) = assets {
        let bunny = close(read(&assets.join("obj/stanford-bunny.obj")));
        meshes.push(Named { name: "bunny", mesh: bunny });
        meshes.push(Named { name: "dragon", mesh: read(&assets.join("obj/stanford-dragon.obj")) });
    }
    meshes.push(Named { name: "generated", mesh: bumpy(800, 813) });
    meshes
}

fn read(file: &Path) -> MeshData {
    let parts = obj::read(file).unwrap_or_else(|error| panic!("{error}")).parts;
    let mut whole = MeshData::default();
    for part in parts {
        let base = whole.positions.len() as u32;
        whole.positions.extend(part.mesh.positions);
        whole.triangles.extend(part.mesh.triangles.iter().map(|t| t.map(|corner| corner + base)));
    }
    whole
}

/// The same with every hole closed by a fan around its middle.
fn close(mut mesh: MeshData) -> MeshData {
    let mut open: BTreeMap<(u32, u32), i32> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *open.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    // An edge of one face is followed the other way round by the fan.
    let next: BTreeMap<u32, u32> = open
        .into_iter()
        .filter(|(_, count)| *count != 0)
        .map(|((low, high), count)| if count > 0 { (high, low) } else { (low, high) })
        .collect();
    let mut left = next.clone();
    while let Some((&start, _)) = left.iter().next() {
        let mut rim = Vec::new();
        let mut at = start;
        while let Some(to) = left.remove(&at) {
            rim.push([at, to]);
            at = to;
        }
        let middle =
            rim.iter().map(|edge| mesh.positions[edge[0] as usize]).sum::<DVec3>() / rim.len() as f64;
        let centre = mesh.positions.len() as u32;
        mesh.positions.push(middle);
        mesh.triangles.extend(rim.iter().map(|&[from, to]| [from, to, centre]));
    }
    mesh
}
