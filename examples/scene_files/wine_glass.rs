//! A wine glass: a profile turned around the y axis. Metres; 0.20 m high, it stands on y = 0.
//!
//! The profile is one smooth curve in the (r, y) half-plane, from the axis below the foot, around the foot,
//! up the stem, up the outside of the bowl, over the rounded lip, and down the inside to the axis again: the
//! glass is solid throughout, its wall 1.2 mm thick at the lip and some 4 mm near the stem. It is a chain of
//! cubic Bézier curves that share their tangents at the knots, so the normals are continuous everywhere.

use glam::{DVec2, DVec3};
use vitrum_geometry::mesh::MeshData;

use crate::circle;

/// Name of the object and, with `.obj`, of the file.
pub(crate) const NAME: &str = "wine_glass";
/// What the head of the file says.
pub(crate) const ABOUT: &str =
    "Wine glass: solid of revolution about y, 0.20 m high, walls with two sides, closed, smooth normals.";

/// Segments around the axis, in the gallery.
pub(crate) const SEGMENTS: usize = 64;

/// A knot of the profile, and how it is left and reached.
struct Knot {
    /// (r, y), metres.
    at: DVec2,
    /// Direction of the profile here; any length.
    heading: DVec2,
    /// Lengths of the Bézier handles before and after the knot, metres.
    handles: [f64; 2],
    /// Number of straight pieces from here to the next knot.
    pieces: usize,
}

const fn knot(at: [f64; 2], heading: [f64; 2], handles: [f64; 2], pieces: usize) -> Knot {
    Knot { at: DVec2::from_array(at), heading: DVec2::from_array(heading), handles, pieces }
}

/// The handle of a quarter of a circle, for a radius of 1: (4/3) tan(π/8).
const QUARTER: f64 = 0.552_284_749_830_793_4;
const EDGE: f64 = 0.0012;
const LIP: f64 = 0.0006;

const PROFILE: [Knot; 12] = [
    // Under the foot, and around its edge.
    knot([0.0, 0.0], [1.0, 0.0], [0.0, 0.011], 3),
    knot([0.0338, 0.0], [1.0, 0.0], [0.011, QUARTER * EDGE], 4),
    knot([0.0350, 0.0012], [0.0, 1.0], [QUARTER * EDGE, QUARTER * EDGE], 4),
    // Over the foot to the stem, and up to the bowl.
    knot([0.0338, 0.0024], [-1.0, 0.0], [QUARTER * EDGE, 0.022], 10),
    knot([0.0042, 0.0240], [0.0, 1.0], [0.015, 0.012], 4),
    knot([0.0038, 0.0720], [0.0, 1.0], [0.016, 0.007], 7),
    // The outside of the bowl.
    knot([0.0140, 0.0870], [0.92, 0.39], [0.006, 0.015], 10),
    knot([0.0410, 0.1280], [0.0, 1.0], [0.021, 0.024], 10),
    // The lip, half a circle across the direction of the wall.
    knot([0.0320, 0.1994], [-0.08, 1.0], [0.024, QUARTER * LIP], 3),
    knot([0.0314, 0.2000], [-1.0, 0.0], [QUARTER * LIP, QUARTER * LIP], 3),
    // The inside of the bowl, to the axis.
    knot([0.0308, 0.1994], [0.08, -1.0], [QUARTER * LIP, 0.024], 10),
    knot([0.0396, 0.1280], [0.0, -1.0], [0.024, 0.022], 11),
];
const BOTTOM: Knot = knot([0.0, 0.0900], [-1.0, 0.0], [0.020, 0.0], 0);

/// The glass, of 156 triangles a segment.
pub(crate) fn mesh(segments: usize) -> MeshData {
    let (points, normals): (Vec<_>, Vec<_>) = profile().into_iter().unzip();
    let rings = points.len() - 2;
    let mut mesh = MeshData::default();
    // One vertex on the axis below, the rings, and one vertex on the axis inside the bowl.
    for (values, of) in [(&mut mesh.positions, &points), (&mut mesh.normals, &normals)] {
        values.push(on_axis(of[0]));
        for &DVec2 { x: r, y } in &of[1..=rings] {
            values.extend((0..segments).map(|segment| circle::around_y(segment, segments, r, y)));
        }
        values.push(on_axis(of[rings + 1]));
    }
    let index = |ring: usize, segment: usize| (1 + ring * segments + segment % segments) as u32;
    let last = index(rings, 0);
    for segment in 0..segments {
        mesh.triangles.push([0, index(0, segment + 1), index(0, segment)]);
        for ring in 0..rings - 1 {
            let [a, b] = [index(ring, segment), index(ring, segment + 1)];
            let [d, c] = [index(ring + 1, segment), index(ring + 1, segment + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.triangles.push([index(rings - 1, segment), index(rings - 1, segment + 1), last]);
    }
    mesh.normal_triangles.clone_from(&mesh.triangles);
    mesh
}

fn on_axis(value: DVec2) -> DVec3 {
    DVec3::new(0.0, value.y, 0.0)
}

/// The points of the profile with their outward normals, from axis to axis.
fn profile() -> Vec<(DVec2, DVec2)> {
    let mut points = Vec::new();
    for (from, to) in PROFILE.iter().zip(PROFILE[1..].iter().chain([&BOTTOM])) {
        let controls = [
            from.at,
            from.at + from.handles[1] * from.heading.normalize(),
            to.at - to.handles[0] * to.heading.normalize(),
            to.at,
        ];
        points.extend((0..from.pieces).map(|piece| bezier(controls, piece as f64 / from.pieces as f64)));
    }
    points.push((BOTTOM.at, normal(BOTTOM.heading)));
    points
}

/// Point and outward normal of a cubic Bézier curve at `t` in [0, 1] (de Casteljau).
fn bezier([a, b, c, d]: [DVec2; 4], t: f64) -> (DVec2, DVec2) {
    let mix = |from: DVec2, to: DVec2| from + t * (to - from);
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    (mix(abc, bcd), normal(bcd - abc))
}

/// To the right of the direction of the profile lies the air.
fn normal(heading: DVec2) -> DVec2 {
    DVec2::new(heading.y, -heading.x).normalize()
}
