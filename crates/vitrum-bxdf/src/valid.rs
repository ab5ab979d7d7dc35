//! What every model expects of a direction, checked where debug assertions are on.

use crate::{Real, Vector};

/// How far a direction's squared length may be from one. Renderers lose a few roundings in a change of frame; a direction
/// that somebody forgot to normalise is off by more.
const TOLERANCE: f64 = 1e-3;

/// Panics in debug builds unless `w` is finite and of unit length.
#[inline]
#[track_caller]
pub(crate) fn debug_assert_unit<R: Real>(w: R::Vec3) {
    debug_assert!(
        (w.dot(w).to_f64() - 1.0).abs() <= TOLERANCE,
        "a direction must have unit length, found {w:?}"
    );
}
