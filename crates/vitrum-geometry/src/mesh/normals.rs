//! Vertex normals for meshes that come without.

use super::MeshData;
use vitrum_math::DVec3;

/// The mesh with smooth normals: at each position (equal positions count as one, so that seams of texture coordinates
/// don't show) the mean of the normals of the faces around it, weighted by their angles there (G. Thürmer and C. Wüthrich,
/// Computing Vertex Normals from Polygonal Facets, 1998). Replaces normals that it may have.
pub fn smooth_normals(mut data: MeshData) -> MeshData {
    let welded = weld(&data.positions);
    let count = welded.iter().map(|&i| i as usize + 1).max().unwrap_or(0);
    let mut normals = vec![DVec3::ZERO; count];
    for triangle in &data.triangles {
        let p = triangle.map(|i| data.positions[i as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for corner in 0..3 {
            let to_next = (p[(corner + 1) % 3] - p[corner]).normalize_or_zero();
            let to_last = (p[(corner + 2) % 3] - p[corner]).normalize_or_zero();
            let angle = libm::acos(to_next.dot(to_last).clamp(-1.0, 1.0));
            normals[welded[triangle[corner] as usize] as usize] += face * angle;
        }
    }
    data.normals = normals.into_iter().map(DVec3::normalize_or_zero).collect();
    data.normal_triangles = data.triangles.iter().map(|t| t.map(|i| welded[i as usize])).collect();
    data
}

/// The mesh with flat faces.
pub fn flat_normals(mut data: MeshData) -> MeshData {
    data.normals = Vec::new();
    data.normal_triangles = Vec::new();
    data
}

/// For each position the number of the group of equal positions that it belongs to.
fn weld(positions: &[DVec3]) -> Vec<u32> {
    // Adding zero turns −0 into +0.
    let key = |i: u32| (positions[i as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_by_key(|&i| (key(i), i));
    let mut group = vec![0; positions.len()];
    let mut groups = 0;
    for (rank, &i) in order.iter().enumerate() {
        if rank > 0 && key(order[rank - 1]) != key(i) {
            groups += 1;
        }
        group[i as usize] = groups;
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_gets_diagonal_normals_whatever_its_diagonals() {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles =
            quads.iter().flat_map(|q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        let cube = MeshData { positions: (0..8).map(corner).collect(), triangles, ..MeshData::default() };
        let smooth = smooth_normals(cube);
        for (triangle, normals) in smooth.triangles.iter().zip(&smooth.normal_triangles) {
            for (p, n) in triangle.iter().zip(normals) {
                let expected = (corner(*p) - DVec3::splat(0.5)).normalize();
                assert!((smooth.normals[*n as usize] - expected).length() < 1e-15);
            }
        }
    }
}
