//! Mesh health against a plain count, on small random meshes where every defect is common.

use std::collections::BTreeMap;

use glam::DVec3;
use proptest::prelude::*;
use vitrum_geometry::mesh::{Defect, MeshData, Remedy, Triangle, health, mend};

/// Few places, so that corners weld and lie on lines.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![8 => Just(0.0), 4 => Just(-0.0), 8 => Just(1.0), 8 => Just(2.0), 1 => Just(f64::NAN)]
}

fn mesh() -> impl Strategy<Value = MeshData> {
    let position = [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array);
    // An index past the last vertex is rare.
    let index = prop_oneof![60 => 0..10_u32, 1 => 0..12_u32];
    let triangle = prop::array::uniform3(index);
    (prop::collection::vec(position, 10), prop::collection::vec(triangle, 0..30))
        .prop_map(|(positions, triangles)| MeshData { positions, triangles, ..MeshData::default() })
}

/// What a face is, by the plainest rules: its corners by position, if they are three different usable ones.
fn corners(mesh: &MeshData, triangle: Triangle) -> Option<[[u64; 3]; 3]> {
    let mut places = [[0; 3]; 3];
    for (place, index) in places.iter_mut().zip(triangle) {
        let position = mesh.positions.get(index as usize).filter(|position| position.is_finite())?;
        *place = position.to_array().map(|c| if c == 0.0 { 0 } else { c.to_bits() });
    }
    let [a, b, c] = places;
    (a != b && b != c && c != a).then_some(places)
}

/// Open, non-manifold and clashing edges, and faces with the corners of another.
fn plain_counts(mesh: &MeshData) -> [usize; 4] {
    let mut edges = BTreeMap::<_, Vec<bool>>::new();
    let mut faces = BTreeMap::<_, usize>::new();
    for triangle in &mesh.triangles {
        if let Some([a, b, c]) = corners(mesh, *triangle) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.entry((from.min(to), from.max(to))).or_default().push(from < to);
            }
            let mut sorted = [a, b, c];
            sorted.sort_unstable();
            *faces.entry(sorted).or_default() += 1;
        }
    }
    let edges = |wanted: fn(&[bool]) -> bool| edges.values().filter(|uses| wanted(uses)).count();
    [
        edges(|uses| uses.len() == 1),
        edges(|uses| uses.len() > 2),
        edges(|uses| uses.len() == 2 && uses[0] == uses[1]),
        faces.values().map(|count| count - 1).sum(),
    ]
}

fn counts(mesh: &MeshData) -> [usize; 4] {
    let health = health(mesh);
    [
        health.count(Defect::OpenEdge),
        health.count(Defect::NonManifoldEdge),
        health.count(Defect::ClashingEdge),
        health.count(Defect::DuplicateFace) + health.count(Defect::DoubledFace),
    ]
}

/// The same face, written from its lowest corner.
fn lowest_first([a, b, c]: Triangle) -> Triangle {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// An octahedron with a bubble half its size.
fn hollow() -> MeshData {
    let corner = |radius: f64| DVec3::AXES.into_iter().flat_map(move |axis| [radius * axis, -radius * axis]);
    let outer: [Triangle; 8] =
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let inner = outer.map(|[a, b, c]| [a + 6, c + 6, b + 6]);
    MeshData {
        positions: corner(2.0).chain(corner(1.0)).collect(),
        triangles: outer.into_iter().chain(inner).collect(),
        ..MeshData::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn counts_are_the_plain_ones(mesh in mesh()) {
        prop_assert_eq!(counts(&mesh), plain_counts(&mesh));
    }

    #[test]
    fn the_order_of_faces_and_corners_does_not_matter(
        mesh in mesh(),
        turns in prop::collection::vec(0..3_usize, 30),
    ) {
        let mut other = mesh.clone();
        other.triangles.reverse();
        for (triangle, turn) in other.triangles.iter_mut().zip(turns) {
            triangle.rotate_left(turn);
        }
        let (one, two) = (health(&mesh), health(&other));
        let kinds = |health: &vitrum_geometry::mesh::Health| -> Vec<_> {
            health.findings.iter().map(|finding| (finding.defect, finding.count)).collect()
        };
        prop_assert_eq!(kinds(&one), kinds(&two));
        prop_assert_eq!(one.is_closed(), two.is_closed());
        prop_assert_eq!(one.components.len(), two.components.len());
    }

    #[test]
    fn mending_is_finished_at_once(mesh in mesh()) {
        let whole = health(&mesh).count(Defect::IndexOutOfRange) == 0;
        let (once, report) = mend(mesh.clone());
        let (twice, again) = mend(once.clone());
        prop_assert_eq!(&once.triangles, &twice.triangles);
        let left = again.iter().all(|mended| mended.remedy == Remedy::LeftBubble);
        prop_assert!(left, "{:?} then {:?}", report, again);
        if whole {
            let health = health(&once);
            prop_assert_eq!(health.count(Defect::DuplicateFace) + health.count(Defect::InsideOut), 0);
        }
        let dropped: usize = report
            .iter()
            .filter(|mended| matches!(mended.remedy, Remedy::DroppedDegenerate | Remedy::DroppedDuplicate))
            .map(|mended| mended.triangles.len())
            .sum();
        prop_assert_eq!(once.triangles.len() + dropped, mesh.triangles.len());
    }

    /// Any faces of the outer wall; the bubble stays a bubble, even if the whole wall is turned.
    #[test]
    fn turned_faces_are_turned_back(turned in prop::array::uniform8(any::<bool>())) {
        let right = hollow();
        let mut mesh = right.clone();
        for (triangle, turned) in mesh.triangles.iter_mut().zip(turned) {
            if turned {
                triangle.swap(1, 2);
            }
        }
        let (mended, report) = mend(mesh);
        let cyclic =
            |mesh: &MeshData| -> Vec<_> { mesh.triangles.iter().copied().map(lowest_first).collect() };
        prop_assert_eq!(cyclic(&mended), cyclic(&right), "{:?}", report);
    }
}
