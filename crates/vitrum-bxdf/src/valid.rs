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

/// Panics in debug builds unless `cos` is between −1 and 1.
#[inline]
#[track_caller]
pub(crate) fn debug_assert_cosine<R: Real>(cos: R) {
    debug_assert!(cos.abs().to_f64() <= 1.0 + TOLERANCE, "a cosine lies between -1 and 1, found {cos:?}");
}

#[cfg(all(test, debug_assertions))]
mod tests {
    use crate::{FresnelDielectric, Interface, Lambertian, TransportMode};
    use glam::{DVec3, Vec3};

    #[test]
    #[should_panic(expected = "a direction must have unit length")]
    fn a_direction_that_was_not_normalised_is_refused() {
        let interface = Interface::new(1.0, 1.5).expect("both are indices");
        FresnelDielectric { interface }.split(DVec3::new(0.0, 0.0, 2.0), TransportMode::Radiance);
    }

    #[test]
    #[should_panic(expected = "a cosine lies between -1 and 1")]
    fn a_cosine_beyond_one_is_refused() {
        Interface::new(1.0, 1.5).expect("both are indices").reflectance(1.5);
    }

    #[test]
    #[should_panic(expected = "a direction must have unit length")]
    fn a_direction_that_is_not_a_number_is_refused() {
        Lambertian::<f32> { reflectance: Vec3::ONE }.eval(Vec3::Z, Vec3::NAN);
    }
}
