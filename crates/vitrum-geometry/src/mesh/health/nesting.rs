//! Which body lies inside which: a bubble is a body inside another.
//!
//! A point is inside a closed surface when a ray from it crosses the surface an odd number of times. The ray
//! runs along +x. The plane y = constant through the point cuts every closed surface in closed polygons whose
//! corners lie on edges of the mesh; each corner is computed from its edge alone, the same for both faces, so
//! no ray slips between two faces, and with half-open comparisons none counts a vertex twice. Parity does not
//! care about winding.

use glam::DVec3;

use super::{bodies::Bodies, surface::Surface};

/// A point of a body.
#[derive(Clone, Copy)]
struct Sample {
    point: DVec3,
    body: usize,
    /// Which of the body's samples.
    number: usize,
}

/// Samples of neighbouring y, ordered by z.
struct Block {
    low_y: f64,
    high_y: f64,
    samples: Vec<Sample>,
}

/// Points taken from each body; it lies inside another when most of its points do.
const SAMPLES: usize = 3;

/// For each body the closed bodies around it, ascending. None for bodies that are not closed.
pub(super) fn containers(surface: &Surface<'_>, bodies: &Bodies) -> Vec<Vec<usize>> {
    let mut containers = vec![Vec::new(); bodies.components.len()];
    let closed = |body: usize| bodies.components[body].closed;
    if (0..bodies.components.len()).filter(|&body| closed(body)).count() < 2 {
        return containers;
    }

    let mut samples = Vec::new();
    for (body, faces) in bodies.faces().iter().enumerate().filter(|(body, _)| closed(*body)) {
        for number in 0..SAMPLES {
            let [a, b, c] = surface.points(faces[number * (faces.len() - 1) / (SAMPLES - 1)]);
            samples.push(Sample { point: (a + b + c) / 3.0, body, number });
        }
    }
    let blocks = blocks(samples);

    let mut crossings = Vec::new();
    for (face, body) in bodies.of_face.iter().enumerate() {
        let Some(body) = body.filter(|&body| closed(body)) else { continue };
        let points = surface.points(face);
        let low = points[0].min(points[1]).min(points[2]);
        let high = points[0].max(points[1]).max(points[2]);
        let first = blocks.partition_point(|block| block.high_y < low.y);
        for block in blocks[first..].iter().take_while(|block| block.low_y < high.y) {
            let first = block.samples.partition_point(|sample| sample.point.z < low.z);
            for sample in block.samples[first..].iter().take_while(|sample| sample.point.z < high.z) {
                let DVec3 { x, y, .. } = sample.point;
                let beside = y < low.y || y >= high.y || x > high.x;
                if !beside && sample.body != body && crosses(surface, face, sample.point) {
                    crossings.push((sample.body, body, sample.number));
                }
            }
        }
    }

    crossings.sort_unstable();
    for pair in crossings.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let inside =
            pair.chunk_by(|a, b| a.2 == b.2).filter(|same_sample| same_sample.len() % 2 == 1).count();
        if inside > SAMPLES / 2 {
            containers[pair[0].0].push(pair[0].1);
        }
    }
    containers
}

/// Divides the samples by y into about as many blocks as each has samples, and orders those by z: what lies in the
/// (y, z) rectangle of a face is then found without a look at most of the others.
fn blocks(mut samples: Vec<Sample>) -> Vec<Block> {
    samples.sort_by(|a, b| a.point.y.total_cmp(&b.point.y));
    let block = |by_y: &[Sample]| {
        let mut samples = by_y.to_vec();
        samples.sort_by(|a, b| a.point.z.total_cmp(&b.point.z));
        Block { low_y: by_y[0].point.y, high_y: by_y[by_y.len() - 1].point.y, samples }
    };
    samples.chunks(samples.len().isqrt().max(1)).map(block).collect()
}

/// Whether the ray along +x from a point crosses a face.
fn crosses(surface: &Surface<'_>, face: usize, point: DVec3) -> bool {
    let [a, b, c] = surface.corners[face];
    let mut cut = [(a, b), (b, c), (c, a)].into_iter().filter_map(|(from, to)| {
        // In one order for both faces of the edge.
        let [low, high] = [from.min(to), from.max(to)].map(|vertex| surface.data.positions[vertex as usize]);
        ((low.y > point.y) != (high.y > point.y)).then(|| {
            let along = (point.y - low.y) / (high.y - low.y);
            // Clamped, so that a corner never leaves the box of its face.
            (low + along * (high - low)).clamp(low.min(high), low.max(high))
        })
    });
    let (Some(from), Some(to)) = (cut.next(), cut.next()) else { return false };
    (from.z > point.z) != (to.z > point.z)
        && from.x + (point.z - from.z) / (to.z - from.z) * (to.x - from.x) > point.x
}
