//! How much an interface reflects: the Fresnel equations, for insulators and for metals.
//!
//! **Insulators.** With c = cos θi, e = η cos θt and k = η² − 1 (see [`Interface`](crate::Interface)),
//!
//! - `r_s = (c − e)/(c + e) = −k/(c + e)²`, which subtracts nothing: at n = 1.0001 the usual form is wrong by 4e-4 in f32;
//! - `r_p = −r_s (c e − sin² θi)/(c e + sin² θi)`, which is the textbook's tan(θi − θt)/tan(θi + θt).
//!
//! Intensities are the squares, their mean is what unpolarised light sees. Source: A. Fresnel, 1823; M. Born and E. Wolf,
//! Principles of Optics, 7th ed. 1999, section 1.5.2, equations (20a) and (21a).
//!
//! **Metals** have the index n + ik. With u + iv = √((n + ik)² − sin² θi) the intensities are those of Born and Wolf,
//! section 14.2; the smaller of u and v follows from the larger, so that k ≫ n loses nothing. Errors are those of a
//! difference: 1e-14 in f64 and 1e-5 in f32 at worst, absolute, near k = 0; for metals 1e-6 in f32.

use crate::{Real, Vector};
use core::fmt;

/// Reflected shares of the two polarisations, each 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectance<R> {
    /// For light whose electric field is perpendicular to the plane of incidence.
    pub s: R,
    /// For light whose electric field lies in the plane of incidence.
    pub p: R,
}

impl<R: Real> Reflectance<R> {
    /// Total reflection.
    #[inline]
    pub(crate) fn total() -> Self {
        Self { s: R::one(), p: R::one() }
    }

    /// The share of unpolarised light: the mean of both, 0 to 1.
    #[inline]
    pub fn unpolarised(self) -> R {
        (self.s + self.p) * R::from_f64(0.5)
    }
}

/// An insulator's reflectances: `c` = cos θi in [0, 1], `e` = η cos θt > 0, `k` = η² − 1.
#[inline]
pub(crate) fn dielectric<R: Real>(c: R, e: R, k: R) -> Reflectance<R> {
    // Where c and e are far apart, their difference loses nothing and is the better known: r_s tends to one as the smaller
    // of them tends to zero, whatever the larger one's rounding.
    let (sum, four) = (c + e, R::from_f64(4.0));
    let smaller = c.at_most(e);
    let r_s =
        if smaller * four < sum - smaller { R::one() - (smaller + smaller) / sum } else { k / sum.squared() };
    // sin² θi; below one, 1 − c is exact.
    let sines = ((R::one() - c) * (R::one() + c)).at_least(R::zero());
    let cosines = c * e;
    let r_p = r_s * ((cosines - sines) / (cosines + sines));
    // Rounding may lift a grazing value above one by a unit in the last place.
    Reflectance { s: r_s.squared().at_most(R::one()), p: r_p.squared().at_most(R::one()) }
}

/// The index of refraction of a metal against the medium outside it, n + ik, per colour channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexIndex<R: Real> {
    n: R::Vec3,
    k: R::Vec3,
}

/// An index of refraction of a metal that no metal has.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ComplexIndexError {
    /// The real part in the medium outside.
    pub n: f64,
    /// The imaginary part in the medium outside.
    pub k: f64,
}

impl fmt::Display for ComplexIndexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a metal's index over that of the medium outside must have a real part between 1e-3 and 1e3 and an imaginary \
             part between 0 and 1e3, found {} and {}",
            self.n, self.k
        )
    }
}

impl core::error::Error for ComplexIndexError {}

impl<R: Real> ComplexIndex<R> {
    /// The index n + ik of a metal, absolute, in a medium of index `outside`.
    ///
    /// # Errors
    /// [`ComplexIndexError`] unless, for each channel, n/outside is within 1e-3 and 1e3 and k/outside within 0 and 1e3.
    pub fn new(n: R::Vec3, k: R::Vec3, outside: R) -> Result<Self, ComplexIndexError> {
        let (n, k) = (n / outside, k / outside);
        let channels = [(n.x(), k.x()), (n.y(), k.y()), (n.z(), k.z())];
        for (n, k) in channels.map(|(n, k)| (n.to_f64(), k.to_f64())) {
            if !((1e-3..=1e3).contains(&n) && (0.0..=1e3).contains(&k)) {
                return Err(ComplexIndexError { n, k });
            }
        }
        Ok(Self { n, k })
    }

    /// The real part against the medium outside, per channel.
    pub fn n(&self) -> R::Vec3 {
        self.n
    }

    /// The imaginary part against the medium outside, per channel.
    pub fn k(&self) -> R::Vec3 {
        self.k
    }

    /// The reflected share of unpolarised light that arrives with `cos` = cos θi in [0, 1], per channel.
    #[inline]
    pub fn reflectance(&self, cos: R) -> R::Vec3 {
        self.n.zip(self.k, |n, k| conductor(cos, n, k).unpolarised())
    }
}

/// A metal's reflectances for cos θi = `c` in [0, 1].
#[inline]
fn conductor<R: Real>(c: R, n: R, k: R) -> Reflectance<R> {
    let half = R::from_f64(0.5);
    let sin_squared = ((R::one() - c) * (R::one() + c)).at_least(R::zero());
    // (u + iv)² = x + iy. The larger of u and v is a root of a sum, the other one follows from 2uv = y.
    let x = (n - k) * (n + k) - sin_squared;
    let y = R::from_f64(2.0) * n * k;
    let modulus = (x * x + y * y).sqrt();
    let larger = ((modulus + x.abs()) * half).sqrt();
    let smaller = if larger > R::zero() { half * y / larger } else { R::zero() };
    let u = if x >= R::zero() { larger } else { smaller };
    let cross = R::from_f64(2.0) * u * c;

    let sum = modulus + c * c;
    let s = if sum > R::zero() { (sum - cross) / (sum + cross) } else { R::one() };
    let sum = c * c * modulus + sin_squared * sin_squared;
    let cross = cross * sin_squared;
    let p = if sum > R::zero() { s * ((sum - cross) / (sum + cross)) } else { s };
    Reflectance { s: s.at_least(R::zero()).at_most(R::one()), p: p.at_least(R::zero()).at_most(R::one()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Interface;
    use glam::DVec3;

    fn reflectance(n_i: f64, n_t: f64, cos: f64) -> Reflectance<f64> {
        Interface::new(n_i, n_t).expect("both are indices").reflectance(cos)
    }

    const PAIRS: [(f64, f64); 6] =
        [(1.0, 1.5), (1.0, 1.33), (1.33, 1.5), (1.0, 2.42), (1.0, 1.0003), (1.0, 100.0)];

    /// The square of (`n_i` − `n_t`)/(`n_i` + `n_t`).
    #[test]
    fn normal_incidence_has_its_closed_form() {
        for (a, b) in PAIRS {
            for (n_i, n_t) in [(a, b), (b, a)] {
                let expected = ((n_i - n_t) / (n_i + n_t)).squared();
                let found = reflectance(n_i, n_t, 1.0);
                for share in [found.s, found.p, found.unpolarised()] {
                    // The closed form itself loses digits where indices nearly match.
                    assert!((share - expected).abs() < 1e-12 * expected, "{n_i} to {n_t}");
                }
            }
        }
    }

    /// At tan θ = n_t/n_i nothing of the p polarisation is reflected (D. Brewster, 1815).
    #[test]
    fn brewsters_angle_reflects_no_p() {
        // At 100 : 1 it is so close to the critical angle that rounding its cosine shows.
        for (a, b) in PAIRS.into_iter().filter(|pair| pair.1 < 3.0) {
            for (n_i, n_t) in [(a, b), (b, a)] {
                let cos = 1.0 / libm::hypot(1.0, n_t / n_i);
                let found = reflectance(n_i, n_t, cos);
                assert!(found.p < 1e-28 && found.s > 0.0, "{n_i} to {n_t}: {found:?}");
                let beside = reflectance(n_i, n_t, cos * 0.99).p.min(reflectance(n_i, n_t, cos * 1.005).p);
                assert!(beside > 100.0 * found.p, "{n_i} to {n_t}");
            }
        }
    }

    /// Light that comes back the way it went is reflected in the same share (G. Stokes, 1849).
    #[test]
    fn reflection_is_symmetric_under_reversal() {
        for (n_i, n_t) in PAIRS {
            for i in 0..100 {
                let cos = f64::from(i) / 100.0 + 0.005;
                let cos_t = (1.0 - (1.0 - cos * cos) * (n_i / n_t).squared()).sqrt();
                let (there, back) = (reflectance(n_i, n_t, cos), reflectance(n_t, n_i, cos_t));
                // Inside, the angle is close to critical when it is grazing outside, and its cosine was rounded.
                let tolerance = 1e-12 / cos.squared();
                assert!(
                    (there.s - back.s).abs() < tolerance && (there.p - back.p).abs() < tolerance,
                    "{cos}"
                );
            }
        }
    }

    #[test]
    fn beyond_the_critical_angle_everything_is_reflected() {
        let critical = (1.0 - (1.0_f64 / 1.5).squared()).sqrt();
        assert_eq!(reflectance(1.5, 1.0, critical - 1e-12), Reflectance::total());
        assert!(reflectance(1.5, 1.0, critical + 1e-12).unpolarised() < 1.0);
        assert_eq!(reflectance(1.5, 1.0, 0.0), Reflectance::total());
        // Seen from below, the sign of the cosine says so.
        assert_eq!(reflectance(1.0, 1.5, -0.5), Reflectance::total());
    }

    /// The most that is reflected of s is more than of p, and both grow to one along the surface.
    #[test]
    fn grazing_light_is_reflected() {
        for (n_i, n_t) in PAIRS {
            let found = reflectance(n_i, n_t, 1e-12);
            assert!(
                found.p > 1.0 - 1e-7 && found.s > 1.0 - 1e-7 && found.s <= 1.0,
                "{n_i} to {n_t}: {found:?}"
            );
        }
    }

    fn metal(n: f64, k: f64) -> ComplexIndex<f64> {
        ComplexIndex::new(DVec3::splat(n), DVec3::splat(k), 1.0).expect("it is a metal")
    }

    #[test]
    fn a_metal_that_absorbs_nothing_is_an_insulator() {
        for n in [0.4, 0.9, 1.0003, 1.33, 1.5, 2.42, 30.0] {
            for i in 1..=1000 {
                let cos = f64::from(i) / 1000.0;
                let expected = reflectance(1.0, n, cos).unpolarised();
                let found = metal(n, 0.0).reflectance(cos).x;
                assert!((found - expected).abs() < 1e-12, "{n} at {cos}: {found} and {expected}");
            }
        }
    }

    /// ((n − 1)² + k²)/((n + 1)² + k²); aluminium reflects 91 % of 633 nm, gold 94 %.
    #[test]
    fn metals_have_their_closed_form_at_normal_incidence() {
        for (n, k, percent) in
            [(1.374, 7.618, 91.0), (0.183, 3.431, 94.0), (0.05, 40.0, 100.0), (3.0, 1e-8, 25.0)]
        {
            let expected = ((n - 1.0).squared() + k * k) / ((n + 1.0).squared() + k * k);
            let found = metal(n, k).reflectance(1.0).x;
            assert!((found - expected).abs() < 1e-14, "{n} + {k}i: {found}");
            assert!((found * 100.0 - percent).abs() < 1.0, "{n} + {k}i: {found}");
        }
    }

    /// The amplitudes in complex numbers, as Born and Wolf have them.
    #[test]
    fn metals_agree_with_complex_arithmetic() {
        #[derive(Clone, Copy)]
        struct Complex(f64, f64);
        let product = |a: Complex, b: Complex| Complex(a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let sum = |a: Complex, b: Complex| Complex(a.0 + b.0, a.1 + b.1);
        let square = |a: Complex| a.0 * a.0 + a.1 * a.1;
        let root = |a: Complex| {
            let modulus = libm::hypot(a.0, a.1);
            Complex(((modulus + a.0) / 2.0).sqrt(), ((modulus - a.0) / 2.0).sqrt().copysign(a.1))
        };
        for (n, k) in [(0.2, 3.9), (1.5, 7.3), (2.9, 3.1), (0.05, 2.0), (1.0, 1.0), (0.3, 0.2)] {
            for i in 0..=100 {
                let c = f64::from(i) / 100.0;
                let squared = product(Complex(n, k), Complex(n, k));
                let inside = root(sum(squared, Complex(c * c - 1.0, 0.0)));
                let share = |a: Complex, b: Complex| square(sum(a, Complex(-b.0, -b.1))) / square(sum(a, b));
                let s = share(Complex(c, 0.0), inside);
                let p = share(product(squared, Complex(c, 0.0)), inside);
                let found = metal(n, k).reflectance(c).x;
                assert!((found - 0.5 * (s + p)).abs() < 1e-13, "{n} + {k}i at {c}: {found}");
            }
        }
    }

    #[test]
    fn impossible_metals_are_refused() {
        for (n, k) in [(0.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0), (1.0, f64::INFINITY), (1e9, 1.0)] {
            assert!(ComplexIndex::new(DVec3::splat(n), DVec3::splat(k), 1.0).is_err(), "{n} + {k}i");
        }
        let in_water: ComplexIndex<f64> =
            ComplexIndex::new(DVec3::splat(0.2), DVec3::splat(3.4), 1.33).expect("it is a metal");
        assert!(in_water.reflectance(1.0).x < metal(0.2, 3.4).reflectance(1.0).x);
    }
}
