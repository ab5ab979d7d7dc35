//! The interface between two media, and the one function that refracts.
//!
//! An [`Interface`] is made from the pair of indices, not from their ratio: 1/1.5 is not a double, and a rounded
//! reciprocal is another index. From the pair, in doubled precision, come for each direction of travel the ratio
//! η = n_t/n_i, k = η² − 1 and the cosine c* of the critical angle in two parts. Then, with c = cos θi and
//! e = η cos θt,
//!
//! - η ≥ 1: e² = c² + k;
//! - η < 1: e² = ((c − c*_hi) − c*_lo) (c + c*_hi), which keeps its relative accuracy down to the critical angle,
//!   where η² − sin² θi loses all of it.
//!
//! Total internal reflection is e² ≤ 0, exactly the radicand that the refracted direction needs: the verdict and the
//! direction can't disagree. Relative error of cos θt: 4e-16 in f64, 2.1e-7 in f32, at any angle.

use crate::fresnel::dielectric;
use crate::valid::{debug_assert_cosine, debug_assert_unit};
use crate::{Real, Reflectance, Vector};
use core::fmt;

/// The surface between the medium above (outside, z > 0) and the one below (inside, z < 0).
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface<R> {
    /// For a ray that comes from above.
    downward: Crossing<R>,
    /// For a ray that comes from below.
    upward: Crossing<R>,
}

/// One direction of travel through an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing<R> {
    /// η = n_t / n_i.
    pub(crate) eta: R,
    /// η² − 1.
    pub(crate) k: R,
    /// The cosine of the critical angle, leading part; zero for η ≥ 1.
    pub(crate) critical_hi: R,
    /// What `critical_hi` lacks.
    critical_lo: R,
}

/// An index of refraction that is not a positive finite number, or a pair whose ratio is out of range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IndexError {
    /// The index above.
    pub above: f64,
    /// The index below.
    pub below: f64,
}

impl fmt::Display for IndexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "indices of refraction must be positive and finite and their ratio between 1e-6 and 1e6, found {} and {}",
            self.above, self.below
        )
    }
}

impl core::error::Error for IndexError {}

/// What happens to a ray at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refraction<R: Real> {
    /// Nothing crosses.
    TotalInternalReflection,
    /// The ray goes on in another direction.
    Refracted {
        /// The refracted direction, unit length, on the other side from `wo`.
        wt: R::Vec3,
        /// |cos| of the angle between `wt` and the normal.
        cos_t: R,
        /// Index ratio η = n_t/n_i of this crossing.
        eta: R,
    },
}

impl<R: Real> Interface<R> {
    /// The interface between a medium of index `above` (outside) and one of index `below` (inside).
    ///
    /// # Errors
    /// [`IndexError`] unless both are positive and finite and their ratio is within 1e-6 and 1e6.
    pub fn new(above: R, below: R) -> Result<Self, IndexError> {
        let (above, below) = (above.to_f64(), below.to_f64());
        let ratio = above / below;
        if above > 0.0
            && above.is_finite()
            && below > 0.0
            && below.is_finite()
            && (1e-6..=1e6).contains(&ratio)
        {
            // Only the ratio counts: by a power of two, which is exact, both come near one, so that no square overflows.
            let (_, exponent) = libm::frexp(above);
            let [above, below] = [above, below].map(|n| libm::scalbn(n, -exponent));
            Ok(Self { downward: Crossing::new(above, below), upward: Crossing::new(below, above) })
        } else {
            Err(IndexError { above, below })
        }
    }

    /// Index ratio below over above: η of a ray that comes from above.
    pub fn eta(&self) -> R {
        self.downward.eta
    }

    /// The cosine of the critical angle, below which light from the denser side is reflected totally; zero where indices
    /// match.
    pub fn critical_cosine(&self) -> R {
        self.downward.critical_hi.at_least(self.upward.critical_hi)
    }

    /// True when both sides have the same index: rays cross undeflected.
    pub fn is_matched(&self) -> bool {
        self.downward.eta == R::one()
    }

    /// The direction of travel of a ray that comes from that side.
    #[inline]
    pub(crate) fn crossing(&self, from_above: bool) -> &Crossing<R> {
        if from_above { &self.downward } else { &self.upward }
    }

    /// The reflected shares of light that arrives at this angle: `cos` in [-1, 1] is the z component of `wo`, whose sign
    /// says from which side. One in total internal reflection.
    #[inline]
    pub fn reflectance(&self, cos: R) -> Reflectance<R> {
        debug_assert_cosine(cos);
        let crossing = self.crossing(cos >= R::zero());
        let c = cos.abs();
        let e_squared = crossing.e_squared(c);
        if e_squared <= R::zero() { Reflectance::total() } else { crossing.reflectance(c, e_squared.sqrt()) }
    }

    /// The ray that goes on when `wo` points back along the incoming one. `wo` is a unit vector; its side decides the
    /// direction of travel, and z = 0 counts as above.
    ///
    /// Snell's law: the tangential part is divided by η.
    #[inline]
    pub fn refract(&self, wo: R::Vec3) -> Refraction<R> {
        debug_assert_unit::<R>(wo);
        let crossing = self.crossing(wo.z() >= R::zero());
        let e_squared = crossing.e_squared(wo.z().abs());
        // Zero is total reflection: at exactly the critical angle nothing crosses.
        if e_squared <= R::zero() {
            return Refraction::TotalInternalReflection;
        }
        let (wt, cos_t) = crossing.refracted(wo, e_squared.sqrt());
        Refraction::Refracted { wt, cos_t, eta: crossing.eta }
    }
}

impl<R: Real> Crossing<R> {
    fn new(n_i: f64, n_t: f64) -> Self {
        // (n_t − n_i)(n_t + n_i) / n_i², each step in doubled precision.
        let k = DoubleDouble::sum(n_t, -n_i) * DoubleDouble::sum(n_t, n_i) / DoubleDouble::product(n_i, n_i);
        let critical =
            if k.hi < 0.0 { critical_cosine(n_i, n_t, libm::sqrt(-k.hi)) } else { DoubleDouble::ZERO };
        let critical_hi = R::from_f64(critical.hi);
        Self {
            eta: R::from_f64(n_t / n_i),
            k: R::from_f64(k.hi),
            critical_hi,
            critical_lo: R::from_f64((critical.hi - critical_hi.to_f64()) + critical.lo),
        }
    }

    /// The direction that `wo` goes on in, and |cos| of its angle to the normal, for `e` = η cos θt > 0.
    #[inline]
    pub(crate) fn refracted(&self, wo: R::Vec3, e: R) -> (R::Vec3, R) {
        let cos_t = e / self.eta;
        let z = if wo.z() >= R::zero() { -cos_t } else { cos_t };
        (self.of_unit_length(R::Vec3::new(-(wo.x() / self.eta), -(wo.y() / self.eta), z)), cos_t)
    }

    /// Snell's law carries the rounding of `wo`'s length on, divided by η². Where that begins to show it is taken out: in
    /// single precision below η = 1/4. (In double precision it is 1e-10 at η = 1e-3.)
    #[inline]
    pub(crate) fn of_unit_length(&self, wt: R::Vec3) -> R::Vec3 {
        let single = size_of::<R>() == size_of::<f32>();
        if single && self.eta < R::from_f64(0.25) { wt.normalised() } else { wt }
    }

    /// Reflected shares for cos θi = `c` and `e` = η cos θt > 0.
    #[inline]
    pub(crate) fn reflectance(&self, c: R, e: R) -> Reflectance<R> {
        dielectric(c, e, self.k)
    }

    /// e² = (η cos θt)² for cos θi = `c` ≥ 0; zero or less in total internal reflection.
    #[inline]
    pub(crate) fn e_squared(&self, c: R) -> R {
        if self.k >= R::zero() {
            c * c + self.k
        } else {
            ((c - self.critical_hi) - self.critical_lo) * (c + self.critical_hi)
        }
    }
}

/// The cosine of the critical angle, `√(n_i² − n_t²)/n_i`, from a double next to it. Its low part has all digits of its own,
/// because what is left at the neighbouring doubles may be as small: one step of Newton's method from an exact remainder.
fn critical_cosine(n_i: f64, n_t: f64, hi: f64) -> DoubleDouble {
    // n_i² − n_t² − (hi n_i)², every product in two parts, exactly.
    let (a, b, c) =
        (DoubleDouble::product(n_i, n_i), DoubleDouble::product(n_t, n_t), DoubleDouble::product(hi, n_i));
    let (squared, mixed) = (DoubleDouble::product(c.hi, c.hi), DoubleDouble::product(2.0 * c.hi, c.lo));
    let terms = [a.hi, -squared.hi, -b.hi, a.lo, -squared.lo, -b.lo, -mixed.hi, -mixed.lo, -(c.lo * c.lo)];
    let remainder = exact_sum(terms) / a.hi;
    DoubleDouble { hi, lo: remainder / (2.0 * hi) }
}

/// The sum, rounded once (J. Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997: growing an expansion).
fn exact_sum<const N: usize>(terms: [f64; N]) -> f64 {
    let mut expansion = [0.0; N];
    for (count, term) in terms.into_iter().enumerate() {
        let mut carried = term;
        for part in &mut expansion[..count] {
            let sum = DoubleDouble::sum(carried, *part);
            (*part, carried) = (sum.lo, sum.hi);
        }
        expansion[count] = carried;
    }
    expansion.into_iter().sum()
}

/// An unevaluated sum of two doubles, about 106 bits (T. Dekker, A Floating-Point Technique for Extending the Available
/// Precision, 1971). Only for building interfaces.
#[derive(Clone, Copy)]
struct DoubleDouble {
    hi: f64,
    lo: f64,
}

impl DoubleDouble {
    const ZERO: Self = Self { hi: 0.0, lo: 0.0 };

    fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let from_b = hi - a;
        Self { hi, lo: (a - (hi - from_b)) + (b - from_b) }
    }

    fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self { hi, lo: libm::fma(a, b, -hi) }
    }
}

impl core::ops::Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let p = Self::product(self.hi, other.hi);
        Self::sum(p.hi, p.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl core::ops::Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let q = self.hi / other.hi;
        let p = Self::product(q, other.hi);
        let rest = ((self.hi - p.hi) - p.lo) + self.lo - q * other.lo;
        Self::sum(q, rest / other.hi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use std::vec::Vec;

    fn at_angle(theta: f64, below: bool) -> DVec3 {
        let (sin, cos) = libm::sincos(theta);
        DVec3::new(sin, 0.0, if below { -cos } else { cos })
    }

    #[test]
    fn snell_holds_on_both_sides() {
        let glass = Interface::new(1.0, 1.5).expect("valid");
        for (below, n_i, n_t) in [(false, 1.0, 1.5), (true, 1.5, 1.0)] {
            for theta in [0.0, 0.1, 0.5, 0.7] {
                let Refraction::Refracted { wt, cos_t, eta } = glass.refract(at_angle(theta, below)) else {
                    panic!("refracts at {theta}");
                };
                assert_eq!(eta, n_t / n_i);
                assert!((n_i * libm::sin(theta) - n_t * -wt.x).abs() < 4.0 * f64::EPSILON);
                assert!((wt.length() - 1.0).abs() < 4.0 * f64::EPSILON && cos_t == wt.z.abs());
                assert!((wt.z > 0.0) == below);
            }
        }
    }

    #[test]
    fn total_reflection_begins_at_the_critical_angle() {
        let glass = Interface::new(1.0, 1.5).expect("valid");
        let critical = libm::asin(1.0 / 1.5);
        assert_eq!(glass.refract(at_angle(critical + 1e-12, true)), Refraction::TotalInternalReflection);
        assert!(matches!(glass.refract(at_angle(critical - 1e-12, true)), Refraction::Refracted { .. }));
        // Going into the denser medium there is none, even at grazing incidence.
        assert!(matches!(glass.refract(DVec3::X), Refraction::Refracted { .. }));
        // And exactly along the surface from inside it is total.
        assert_eq!(glass.refract(DVec3::new(1.0, 0.0, -0.0)), glass.refract(DVec3::X));
        let bubble = Interface::new(1.0, 0.75).expect("valid");
        assert_eq!(bubble.refract(DVec3::X), Refraction::TotalInternalReflection);
    }

    #[test]
    fn equal_indices_change_no_bit_of_the_direction() {
        let matched = Interface::new(1.33, 1.33).expect("valid");
        assert!(matched.is_matched());
        for theta in [0.0, 0.3, 1.0, 1.57] {
            let wo = at_angle(theta, false);
            let Refraction::Refracted { wt, .. } = matched.refract(wo) else { panic!("never total") };
            assert_eq!(wt, -wo);
        }
    }

    /// Against the exact value for cosines just above critical, where cos θt² = (c − c*)(c + c*)/η² needs c* to more than
    /// 53 bits: with n = 5/3 outside over 1 inside the critical cosine is exactly 4/5.
    #[test]
    fn cos_t_is_accurate_next_to_the_critical_angle() {
        let interface = Interface::new(5.0, 3.0).expect("valid");
        for step in 3..60 {
            let delta = libm::exp2(-f64::from(step) * 0.8);
            let c = 0.8 + delta;
            let exact_delta = DoubleDouble::sum(c, -0.8); // 0.8 is not a double: its error is known
            let error_of_point_eight = libm::fma(5.0, 0.8, -4.0) / 5.0;
            let difference = exact_delta.hi + (exact_delta.lo + error_of_point_eight);
            let expected = libm::sqrt(difference * (c + 0.8)) / 0.6;
            let Refraction::Refracted { cos_t, .. } =
                interface.refract(DVec3::new(libm::sqrt(1.0 - c * c), 0.0, c))
            else {
                panic!("above critical")
            };
            assert!((cos_t / expected - 1.0).abs() < 8e-16, "at 2^-{step}: {cos_t} against {expected}");
        }
    }

    #[test]
    fn single_precision_agrees_with_double() {
        for (n_i, n_t) in [(1.0, 1.5), (1.5, 1.0), (1.33, 1.5), (1.0003, 1.0), (1.0, 2.42)] {
            let single = Interface::new(n_i as f32, n_t as f32).expect("valid");
            let double = Interface::new(f64::from(n_i as f32), f64::from(n_t as f32)).expect("valid");
            for i in 1..2000 {
                let c = i as f32 / 2000.0;
                let s = single.downward.e_squared(c).sqrt() / single.downward.eta;
                let d = double.downward.e_squared(f64::from(c)).sqrt() / double.downward.eta;
                assert!(s.is_nan() && d.is_nan() || (f64::from(s) / d - 1.0).abs() < 4e-7, "{n_i} {n_t} {c}");
            }
        }
        assert!(matches!(
            Interface::new(1.0f32, 1.5).expect("valid").refract(Vec3::Z),
            Refraction::Refracted { .. }
        ));
    }

    #[test]
    fn impossible_indices_are_refused() {
        for (a, b) in [(0.0, 1.0), (1.0, -1.5), (f64::NAN, 1.0), (1.0, f64::INFINITY), (1.0, 1e9)] {
            assert!(Interface::new(a, b).is_err());
        }
    }

    #[test]
    fn only_the_ratio_of_the_indices_counts() {
        let near = Interface::new(1.0, 1.5).expect("valid");
        for exponent in [-1070, -500, 500, 1022] {
            let scale = libm::scalbn(1.0, exponent);
            assert_eq!(Interface::new(scale, 1.5 * scale).expect("valid"), near, "{scale}");
        }
    }

    #[test]
    fn refraction_is_reversible() {
        let glass = Interface::new(1.0, 1.7).expect("valid");
        let angles: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.0157).collect();
        for theta in angles {
            let wo = at_angle(theta, false);
            let Refraction::Refracted { wt, .. } = glass.refract(wo) else { panic!("never total") };
            let Refraction::Refracted { wt: back, .. } = glass.refract(wt) else {
                panic!("no total reflection back")
            };
            let off: DVec3 = back - wo;
            assert!(off.length() < 1e-13, "{theta}");
        }
    }
}
