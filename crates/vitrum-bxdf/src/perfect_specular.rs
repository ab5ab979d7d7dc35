//! A perfect mirror with a constant coefficient.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `kr` | reflected share, per channel | 0 ≤ kr ≤ 1 |
//!
//! f = kr δ(wi − mirror(wo)) / |cos θi|. Energy: kr. Reciprocal. Mirrors on both sides.
//! Source: K. Suffern, Ray Tracing from the Ground Up, 2007, chapter 24.

use crate::valid::debug_assert_unit;
use crate::{Real, Sample, Split, Vector};

/// Reflects `kr` of the light in exactly the mirror direction.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerfectSpecular<R: Real> {
    /// Reflected share, per channel, 0 to 1.
    pub kr: R::Vec3,
}

impl<R: Real> PerfectSpecular<R> {
    /// The mirror direction; `None` when nothing is reflected.
    #[inline]
    pub fn sample(&self, wo: R::Vec3) -> Option<Sample<R>> {
        debug_assert_unit::<R>(wo);
        (!self.kr.is_zero()).then(|| Sample::mirror(wo, self.kr))
    }

    /// The one child.
    #[inline]
    pub fn split(&self, wo: R::Vec3) -> Split<R> {
        Split { reflected: self.sample(wo), transmitted: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Density, Lobe};
    use glam::DVec3;

    #[test]
    fn mirrors_on_both_sides() {
        let mirror = PerfectSpecular::<f64> { kr: DVec3::new(0.5, 0.25, 1.0) };
        for z in [0.8, -0.8] {
            let sample = mirror.sample(DVec3::new(0.6, 0.0, z)).expect("reflects");
            assert_eq!((sample.wi, sample.weight), (DVec3::new(-0.6, 0.0, z), mirror.kr));
            assert_eq!((sample.pdf, sample.lobe), (Density::Discrete(1.0), Lobe::SpecularReflection));
        }
    }

    #[test]
    fn a_zero_coefficient_has_no_child() {
        assert_eq!(PerfectSpecular::<f64> { kr: DVec3::ZERO }.split(DVec3::Z), Split::NONE);
    }
}
