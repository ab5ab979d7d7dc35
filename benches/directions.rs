//! Directions that a bench feeds to what it measures: random, and the same in every run.

use vitrum::math::DVec3;
use vitrum_testkit::Uniform;

/// How many inputs one pass has.
pub(crate) const INPUTS: usize = 4096;

/// A unit vector, uniform over the sphere.
pub(crate) fn direction(uniform: &mut Uniform) -> DVec3 {
    let z = 1.0 - 2.0 * uniform.number();
    let (sin_phi, cos_phi) = libm::sincos(std::f64::consts::TAU * uniform.number());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos_phi, r * sin_phi, z)
}
