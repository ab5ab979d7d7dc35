//! Refraction and Fresnel's equations in 256-bit arithmetic, from the pair of indices and the cosine taken as exact.

use astro_float::{BigFloat, Consts, Radix, RoundingMode};

const BITS: usize = 256;
const ROUNDING: RoundingMode = RoundingMode::ToEven;

/// A number of 256 bits.
#[derive(Clone)]
pub(crate) struct Exact(BigFloat);

impl Exact {
    pub(crate) fn new(x: f64) -> Self {
        Self(BigFloat::from_f64(x, BITS))
    }

    pub(crate) fn sqrt(&self) -> Self {
        Self(self.0.sqrt(BITS, ROUNDING))
    }

    pub(crate) fn is_positive(&self) -> bool {
        self.0.is_positive() && !self.0.is_zero()
    }

    /// The nearest double, by way of the decimal digits.
    pub(crate) fn to_f64(&self) -> f64 {
        let mut constants = Consts::new().expect("memory for the constants");
        let digits = self.0.format(Radix::Dec, ROUNDING, &mut constants).expect("a number has digits");
        digits.parse().expect("digits are a number")
    }

    /// (found − self)/self.
    pub(crate) fn relative_error_of(&self, found: f64) -> f64 {
        ((Self::new(found) - self.clone()) / self.clone()).to_f64().abs()
    }

    /// found − self.
    pub(crate) fn absolute_error_of(&self, found: f64) -> f64 {
        (Self::new(found) - self.clone()).to_f64().abs()
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl core::ops::$trait for Exact {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(&other.0, BITS, ROUNDING))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

/// What truly happens to light that passes from index `n_i` to `n_t` and arrives with cosine `c`.
pub(crate) struct Truth {
    /// Nothing in total reflection.
    pub(crate) cos_t: Option<Exact>,
    /// Reflected share of unpolarised light.
    pub(crate) reflectance: Exact,
}

/// Snell's law as sin² θt = (n_i/n_t)² (1 − c²), and Fresnel's amplitudes in the form of every textbook:
/// `(n_i c − n_t cos θt)/(n_i c + n_t cos θt)`, and with the indices exchanged.
pub(crate) fn truth(n_i: f64, n_t: f64, c: f64) -> Truth {
    let [n_i, n_t, c, one] = [n_i, n_t, c, 1.0].map(Exact::new);
    let ratio = n_i.clone() / n_t.clone();
    let sin_squared = ratio.clone() * ratio * (one.clone() - c.clone() * c.clone());
    let cos_squared = one.clone() - sin_squared;
    if !cos_squared.is_positive() {
        return Truth { cos_t: None, reflectance: one };
    }
    let cos_t = cos_squared.sqrt();
    let intensity = |a: Exact, b: Exact| {
        let amplitude = (a.clone() - b.clone()) / (a + b);
        amplitude.clone() * amplitude
    };
    let s = intensity(n_i.clone() * c.clone(), n_t.clone() * cos_t.clone());
    let p = intensity(n_t * c, n_i * cos_t.clone());
    Truth { cos_t: Some(cos_t), reflectance: (s + p) * Exact::new(0.5) }
}

/// The cosine of the critical angle, √(1 − (n_t/n_i)²), for n_i > n_t.
pub(crate) fn critical_cosine(n_i: f64, n_t: f64) -> Exact {
    let ratio = Exact::new(n_t) / Exact::new(n_i);
    (Exact::new(1.0) - ratio.clone() * ratio).sqrt()
}
