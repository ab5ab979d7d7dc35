//! Welding of vertices whose positions are exactly equal, by sorting. -0 is +0; a position that is not finite
//! welds to nothing that matters, because faces that use it are left out.

use glam::DVec3;

/// For each position the lowest index of an equal position.
pub(super) fn weld(positions: &[DVec3]) -> Vec<u32> {
    let mut order: Vec<([u64; 3], u32)> = positions.iter().map(|p| key(*p)).zip(0..).collect();
    order.sort_unstable();
    let mut welded = vec![0; positions.len()];
    for equal in order.chunk_by(|a, b| a.0 == b.0) {
        let lowest = equal[0].1;
        for &(_, index) in equal {
            welded[index as usize] = lowest;
        }
    }
    welded
}

/// Equal for equal positions and for no others.
fn key(position: DVec3) -> [u64; 3] {
    // Adding +0 turns -0 into +0 and changes nothing else.
    position.to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}
