//! A torus knot: a tube of round cross-section along the (2, 3) torus knot, the trefoil. Metres; the knot
//! stands upright on its axis z, centred on the origin, one lobe up, and fits in a cube of 2 m.
//!
//! The curve winds twice around the axis and three times around a torus of radii `MAJOR` and `MINOR`. It lies
//! on that torus, so the torus's own normal is perpendicular to it everywhere and closes after one round:
//! with the normal and the tangent it makes the frame of the tube, without twist to correct. Normals are
//! those of the round tube.

use glam::{DVec2, DVec3};
use vitrum_geometry::mesh::MeshData;

use crate::circle;

/// Name of the object and, with `.obj`, of the file.
pub(crate) const NAME: &str = "torus_knot";
/// What the head of the file says.
pub(crate) const ABOUT: &str =
    "(2, 3) torus knot: tube of radius 0.14 m, closed, 256 x 24 quads, smooth normals.";
/// The same with 100 000 triangles.
pub(crate) const FINE: &str = "fine_knot";
/// What the head of its file says.
pub(crate) const ABOUT_FINE: &str = "(2, 3) torus knot: tube of radius 0.14 m, closed, 1000 x 50 quads.";

const MAJOR: f64 = 0.6;
const MINOR: f64 = 0.26;
const TUBE: f64 = 0.14;
/// The tube of the gallery.
pub(crate) fn mesh() -> MeshData {
    tube(256, 24)
}

/// The tube with 100 000 triangles: places only, to keep its file small.
pub(crate) fn fine_mesh() -> MeshData {
    let MeshData { positions, triangles, .. } = tube(1000, 50);
    MeshData { positions, triangles, ..MeshData::default() }
}

/// So many quads along the tube and around it.
fn tube(along: usize, around: usize) -> MeshData {
    let mut mesh = MeshData::default();
    for i in 0..along {
        let (centre, normal, binormal) = frame(i, along);
        for j in 0..around {
            let around = circle::point(j, around);
            let outward = around.x * normal + around.y * binormal;
            mesh.positions.push(centre + TUBE * outward);
            mesh.normals.push(outward);
        }
    }
    // Texture coordinates end at 1, so they have a row and a column more than there are vertices.
    for i in 0..=along {
        for j in 0..=around {
            mesh.uvs.push(DVec2::new(i as f64 / along as f64, j as f64 / around as f64));
        }
    }
    let index = |i: usize, j: usize| ((i % along) * around + j % around) as u32;
    let uv_index = |i: usize, j: usize| (i * (around + 1) + j) as u32;
    for i in 0..along {
        for j in 0..around {
            // The frame twists around the tube: this diagonal turns back against the twist. It is the
            // shorter, and a ridge; the other would be a valley.
            for [a, b, c] in [[(0, 0), (1, 0), (0, 1)], [(1, 0), (1, 1), (0, 1)]] {
                mesh.triangles.push([a, b, c].map(|(u, v)| index(i + u, j + v)));
                mesh.uv_triangles.push([a, b, c].map(|(u, v)| uv_index(i + u, j + v)));
            }
        }
    }
    mesh.normal_triangles.clone_from(&mesh.triangles);
    mesh
}

/// Point of the curve, normal of the torus there, and the direction that completes them with the tangent, `step` of so many `along`.
fn frame(step: usize, along: usize) -> (DVec3, DVec3, DVec3) {
    // Twice around the axis, from straight up; three times around the tube of the torus.
    let axial = circle::point(2 * step, along);
    let radial = DVec3::new(-axial.y, axial.x, 0.0);
    let forward = DVec3::new(-axial.x, -axial.y, 0.0);
    let tube = circle::point(3 * step, along);
    let normal = tube.x * radial + tube.y * DVec3::Z;
    let across = tube.x * DVec3::Z - tube.y * radial;
    let tangent = 2.0 * (MAJOR + MINOR * tube.x) * forward + 3.0 * MINOR * across;
    let centre = MAJOR * radial + MINOR * normal;
    (centre, normal, normal.cross(tangent.normalize()))
}
