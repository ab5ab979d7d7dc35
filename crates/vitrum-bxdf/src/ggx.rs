//! Rough surfaces as a distribution of microscopic mirrors: GGX, with Smith's masking.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `alpha_x`, `alpha_y` | width of the distribution of slopes along the tangents x and y | 0 to 1; below 1e-4 smooth |
//!
//! All directions here are of unit length and on the upper side, z ≥ 0, which debug builds check; a model looks at a surface from below in a mirrored frame.
//!
//! - Normals: `D(m) = 1/(π αx αy q²)` with `q = (m_x/αx)² + (m_y/αy)² + m_z²` (T. Trowbridge and K. Reitz, Average
//!   Irregularity Representation of a Rough Surface for Ray Reflection, 1975; B. Walter and others, Microfacet Models for
//!   Refraction through Rough Surfaces, 2007, equation 33).
//! - Masking: `Λ(w) = (s(w)/w_z − 1)/2` with `s(w) = √(w_z² + (αx w_x)² + (αy w_y)²)`. One direction is seen by
//!   `G1 = 1/(1 + Λ)`, two by the height-correlated `G2 = 1/(1 + Λ(wo) + Λ(wi))` (E. Heitz, Understanding the
//!   Masking-Shadowing Function in Microfacet-Based BRDFs, 2014, equation 99). As in pbrt-v4, the same form serves
//!   transmission.
//! - Visible normals: `G1(wo) max(0, wo·m) D(m)/wo_z`, sampled by spherical caps (J. Dupuy and A. Benyoub, Sampling Visible
//!   GGX Normals with Spherical Caps, 2023).
//!
//! Written with `s(w)`, nothing is divided by a cosine: along the surface every value is finite.

use crate::valid::debug_assert_unit;
use crate::{Real, Vector};
use core::fmt;

/// Below this a surface counts as smooth. Its lobes are a hundredth of a degree wide, and in f32 a half vector does not know
/// its slope much better.
const SMOOTH: f64 = 1e-4;

/// The distribution of a rough surface's microscopic normals, valid by construction.
///
/// [Manual](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx<R> {
    alpha_x: R,
    alpha_y: R,
}

/// A roughness that is not between 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RoughnessError {
    /// Along the tangent x.
    pub alpha_x: f64,
    /// Along the tangent y.
    pub alpha_y: f64,
}

impl fmt::Display for RoughnessError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "roughness must be between 0 and 1, found {} and {}", self.alpha_x, self.alpha_y)
    }
}

impl core::error::Error for RoughnessError {}

impl<R: Real> Ggx<R> {
    /// The distribution with these roughnesses along the tangents x and y. A smooth direction beside a rough one is taken as
    /// 1e-4.
    ///
    /// # Errors
    /// [`RoughnessError`] unless both are between 0 and 1.
    pub fn new(alpha_x: R, alpha_y: R) -> Result<Self, RoughnessError> {
        let allowed = R::zero()..=R::one();
        if !(allowed.contains(&alpha_x) && allowed.contains(&alpha_y)) {
            return Err(RoughnessError { alpha_x: alpha_x.to_f64(), alpha_y: alpha_y.to_f64() });
        }
        let least = R::from_f64(SMOOTH);
        if alpha_x < least && alpha_y < least {
            return Ok(Self::smooth());
        }
        Ok(Self { alpha_x: alpha_x.at_least(least), alpha_y: alpha_y.at_least(least) })
    }

    /// The same roughness in all directions.
    ///
    /// # Errors
    /// [`RoughnessError`] unless it is between 0 and 1.
    pub fn isotropic(alpha: R) -> Result<Self, RoughnessError> {
        Self::new(alpha, alpha)
    }

    /// A perfectly smooth surface.
    pub fn smooth() -> Self {
        Self { alpha_x: R::zero(), alpha_y: R::zero() }
    }

    /// True where the surface counts as smooth: its models have discrete densities, and the functions below don't apply.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.alpha_x == R::zero()
    }

    /// Roughness along the tangent x; zero for a smooth surface.
    pub fn alpha_x(&self) -> R {
        self.alpha_x
    }

    /// Roughness along the tangent y; zero for a smooth surface.
    pub fn alpha_y(&self) -> R {
        self.alpha_y
    }

    /// The roughness of the isotropic surface that stands for this one, √(αx αy).
    #[inline]
    pub(crate) fn mean_alpha(&self) -> R {
        if self.alpha_x == self.alpha_y { self.alpha_x } else { (self.alpha_x * self.alpha_y).sqrt() }
    }

    /// The larger of both roughnesses.
    #[inline]
    pub(crate) fn largest_alpha(&self) -> R {
        self.alpha_x.at_least(self.alpha_y)
    }

    /// D(m), per steradian: the area of the microscopic surface whose normal is `m`, per area of the surface.
    #[inline]
    pub fn normals(&self, m: R::Vec3) -> R {
        let q = (m.x() / self.alpha_x).squared() + (m.y() / self.alpha_y).squared() + m.z().squared();
        if m.z() > R::zero() { R::one() / (R::pi() * self.alpha_x * self.alpha_y * q * q) } else { R::zero() }
    }

    /// `s(w)`: the microscopic surface that faces `w`, hidden parts included, projects to the area `(w_z + s)/2`.
    #[inline]
    fn stretched_length(&self, w: R::Vec3) -> R {
        debug_assert_unit::<R>(w);
        debug_assert!(w.z() >= R::zero(), "a direction on the upper side, found {w:?}");
        (w.z().squared() + (self.alpha_x * w.x()).squared() + (self.alpha_y * w.y()).squared()).sqrt()
    }

    /// G1(w), 0 to 1: the share of the microscopic surface facing `w` that is seen from there.
    #[inline]
    pub fn masking(&self, w: R::Vec3) -> R {
        R::from_f64(2.0) * w.z() / (w.z() + self.stretched_length(w))
    }

    /// G2(wo, wi), 0 to 1: the share that is seen from both. For transmission, mirror the direction below.
    #[inline]
    pub fn masking_shadowing(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        let both = self.stretched_length(wo) * wi.z() + self.stretched_length(wi) * wo.z();
        if both > R::zero() { R::from_f64(2.0) * wo.z() * wi.z() / both } else { R::zero() }
    }

    /// G2/G1(wo), 0 to 1: of what is seen from `wo`, the share that is seen from `wi` too.
    #[inline]
    pub(crate) fn shadowing(&self, wo: R::Vec3, wi: R::Vec3) -> R {
        let (s_o, s_i) = (self.stretched_length(wo), self.stretched_length(wi));
        let both = s_o * wi.z() + s_i * wo.z();
        if both > R::zero() { (wi.z() * (wo.z() + s_o) / both).at_most(R::one()) } else { R::zero() }
    }

    /// The density per steradian of visible normals, divided by wo·m.
    #[inline]
    pub(crate) fn visible_normals_over_cosine(&self, wo: R::Vec3, m: R::Vec3) -> R {
        R::from_f64(2.0) * self.normals(m) / (wo.z() + self.stretched_length(wo))
    }

    /// The density per steradian of the normals that are seen from `wo`: what [`sample`](Self::sample) follows.
    #[inline]
    pub fn visible_normals(&self, wo: R::Vec3, m: R::Vec3) -> R {
        self.visible_normals_over_cosine(wo, m) * wo.dot(m).at_least(R::zero())
    }

    /// A normal that is seen from `wo`, from a point of the unit square.
    #[inline]
    pub fn sample(&self, wo: R::Vec3, [u, v]: [R; 2]) -> R::Vec3 {
        debug_assert_unit::<R>(wo);
        // In the space where roughness is one, visible normals are half vectors of wo and a uniform direction of the cap.
        let wo = R::Vec3::new(wo.x() * self.alpha_x, wo.y() * self.alpha_y, wo.z()).normalised();
        let down = v * (R::one() + wo.z());
        let z = R::one() - down;
        let sin = (down * (R::from_f64(2.0) - down)).at_least(R::zero()).sqrt();
        let (sin_phi, cos_phi) = (R::from_f64(2.0) * R::pi() * u).sin_cos();
        let half = wo + R::Vec3::new(sin * cos_phi, sin * sin_phi, z);
        // Not below, and not zero: at grazing incidence the cap is the upper hemisphere, up to rounding.
        let z = half.z().at_least(R::epsilon() * R::epsilon());
        R::Vec3::new(half.x() * self.alpha_x, half.y() * self.alpha_y, z).normalised()
    }
}

/// The microscopic normal along a half vector, on the upper side, and the square of the half vector's length. `None` for
/// one so short that rounding has turned it: directions that run along the surface, opposite to each other.
#[inline]
pub(crate) fn normal_along<R: Real>(half: R::Vec3) -> Option<(R::Vec3, R)> {
    let length_squared = half.dot(half);
    if length_squared <= R::epsilon().squared().squared() {
        return None;
    }
    let m = half / length_squared.sqrt();
    Some((if m.z() < R::zero() { -m } else { m }, length_squared))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use glam::DVec3;

    const ALPHAS: [[f64; 2]; 4] = [[0.15, 0.15], [0.5, 0.5], [1.0, 1.0], [0.2, 0.7]];

    /// The integral over the upper hemisphere, by the midpoint rule in the square of the cosine and the azimuth.
    fn hemisphere(f: impl Fn(DVec3) -> f64) -> f64 {
        let n = 1000;
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let mut sum = 0.0;
        for (i, j) in (0..n * n).map(|cell| (cell / n, cell % n)) {
            // z = t² puts more points along the surface, where masking changes fast.
            let (t, (sin, cos)) = (at(i), libm::sincos(2.0 * PI * at(j)));
            let z = 1.0 - t * t;
            let r = (1.0 - z * z).sqrt();
            sum += 2.0 * t * f(DVec3::new(r * cos, r * sin, z));
        }
        sum * 2.0 * PI / (f64::from(n) * f64::from(n))
    }

    fn ggx([alpha_x, alpha_y]: [f64; 2]) -> Ggx<f64> {
        Ggx::new(alpha_x, alpha_y).expect("both are roughnesses")
    }

    /// `∫ D(m) m_z = 1`: the microscopic surface covers the surface once.
    #[test]
    fn projected_normals_cover_the_surface_once() {
        for alphas in ALPHAS {
            let area = hemisphere(|m| ggx(alphas).normals(m) * m.z);
            assert!((area - 1.0).abs() < 1e-3, "{alphas:?}: {area}");
        }
    }

    /// `∫ G1(w) max(0, w·m) D(m) = w_z`: what is seen from any side is as large as the surface (Heitz 2014, equation 14).
    #[test]
    fn what_is_seen_is_as_large_as_the_surface() {
        for alphas in ALPHAS {
            for (degrees, azimuth) in [(0.0_f64, 0.0), (40.0, 0.3), (75.0, 1.2), (85.0, 2.0)] {
                let ((sin, cos), (sin_phi, cos_phi)) =
                    (libm::sincos(degrees.to_radians()), libm::sincos(azimuth));
                let w = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
                let ggx = ggx(alphas);
                let seen = ggx.masking(w) * hemisphere(|m| ggx.normals(m) * w.dot(m).max(0.0));
                assert!((seen / cos - 1.0).abs() < 2e-3, "{alphas:?}, {degrees} degrees: {seen}");
                let density = hemisphere(|m| ggx.visible_normals(w, m));
                assert!((density - 1.0).abs() < 2e-3, "{alphas:?}, {degrees} degrees: {density}");
            }
        }
    }

    #[test]
    fn masking_is_a_share_and_correlated_masking_hides_less_than_separable() {
        for alphas in ALPHAS {
            let ggx = ggx(alphas);
            for (a, b) in (0..400).map(|i| (i % 20, i / 20)) {
                let w = |i: i32, phi: f64| {
                    let z = f64::from(i) / 19.0;
                    let r = (1.0 - z * z).sqrt();
                    DVec3::new(r * libm::cos(phi), r * libm::sin(phi), z)
                };
                let (wo, wi) = (w(a, 0.4), w(b, 2.5));
                let (one, other, both) = (ggx.masking(wo), ggx.masking(wi), ggx.masking_shadowing(wo, wi));
                assert!((0.0..=1.0).contains(&one) && both <= one.min(other) + 1e-15);
                assert!(both + 1e-15 >= one * other);
                if one > 0.0 {
                    assert!((ggx.shadowing(wo, wi) - both / one).abs() < 1e-14);
                }
            }
        }
    }

    /// GGX along the normal is seen whole; a direction along the surface sees nothing.
    #[test]
    fn masking_has_its_limits() {
        assert_eq!(ggx([0.3, 0.3]).masking(DVec3::Z), 1.0);
        assert_eq!(ggx([0.3, 0.3]).masking(DVec3::X), 0.0);
        // G1 = 2/(1 + √(1 + α² tan²)) at 45 degrees (Walter and others 2007, equation 34).
        let w = DVec3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
        assert!((ggx([0.3, 0.9]).masking(w) - 2.0 / (1.0 + (1.0_f64 + 0.09).sqrt())).abs() < 1e-15);
    }

    #[test]
    fn roughness_is_between_zero_and_one() {
        for (x, y) in [(-0.1, 0.1), (0.1, 1.1), (f64::NAN, 0.1), (0.1, f64::INFINITY)] {
            assert!(Ggx::new(x, y).is_err());
        }
        assert!(ggx([0.0, 0.5e-4]).is_smooth() && !ggx([0.0, 0.5]).is_smooth());
        assert_eq!(ggx([0.0, 0.5]), ggx([1e-4, 0.5]));
        assert_eq!(Ggx::<f64>::smooth(), ggx([0.0, 0.0]));
    }
}
