//! How much an interface reflects: the Fresnel equations, for insulators and for metals.
//!
//! **Insulators.** With c = cos θi, e = η cos θt and k = η² − 1 (see [`Interface`](crate::Interface)),
//!
//! - r_s = (c − e)/(c + e) = −k/(c + e)², which subtracts nothing: at n = 1.0001 the usual form is wrong by 4e-4 in f32;
//! - r_p = −r_s (c cos θt − S)/(c cos θt + S) with S = sin θi sin θt = (1 − c²)/η.
//!
//! Intensities are the squares, their mean is what unpolarised light sees. Source: A. Fresnel, 1823; M. Born and E. Wolf,
//! Principles of Optics, 7th ed. 1999, section 1.5.2, equations (20a) and (21a).
//!
//! **Metals** have the index n + ik. With u + iv = √((n + ik)² − sin² θi) the intensities are those of Born and Wolf,
//! section 14.2; neither u nor v is taken from a difference, so that k = 0 gives the insulator and k ≫ n loses nothing.

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
    // Times η, both numerator and denominator: S = (1 − c²)/η, cos θt = e/η.
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
