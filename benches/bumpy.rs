//! A generated mesh of any size.

use vitrum::geometry::mesh::MeshData;
use vitrum::math::DVec3;

/// A ball with bumps of several sizes, of 2 · (rings - 1) · segments triangles.
pub(crate) fn bumpy(rings: u32, segments: u32) -> MeshData {
    let mut positions = vec![DVec3::Y, -DVec3::Y];
    for ring in 1..rings {
        for segment in 0..segments {
            let theta = f64::from(ring) / f64::from(rings) * std::f64::consts::PI;
            let phi = f64::from(segment) / f64::from(segments) * std::f64::consts::TAU;
            let ((sin, cos), (sin_phi, cos_phi)) = (libm::sincos(theta), libm::sincos(phi));
            let wave = |n: f64| libm::sin(n * theta) * libm::cos((n * 0.8).round() * phi) * sin;
            let radius = 1.0 + 0.1 * wave(5.0) + 0.02 * wave(37.0) + 0.004 * wave(211.0);
            positions.push(DVec3::new(sin * cos_phi, cos, sin * sin_phi) * radius);
        }
    }
    let at = |ring: u32, segment: u32| 2 + (ring - 1) * segments + segment % segments;
    let mut triangles = Vec::new();
    for s in 0..segments {
        triangles.push([0, at(1, s + 1), at(1, s)]);
        triangles.push([1, at(rings - 1, s), at(rings - 1, s + 1)]);
        for ring in 1..rings - 1 {
            let (a, b, c, d) = (at(ring, s), at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    MeshData { positions, triangles, ..MeshData::default() }
}
