//! Bounds on rounding errors.

/// Higham's γₙ = n·u / (1 − n·u) with u = 2⁻⁵³: the relative error of a chain of `n` roundings in f64 is at most this
/// (N. Higham, Accuracy and Stability of Numerical Algorithms, 2002, lemma 3.1).
#[inline]
pub const fn gamma(n: u32) -> f64 {
    let nu = n as f64 * (f64::EPSILON / 2.0);
    nu / (1.0 - nu)
}

/// The smallest power of two that is strictly greater than `x`, for a finite `x ≥ 0`. At least the smallest normal
/// number and at most 2¹⁰²³, so that both it and its reciprocal are exact.
pub fn power_of_two_above(x: f64) -> f64 {
    let exponent_bits = (x.to_bits() >> 52) & 0x7ff;
    f64::from_bits((exponent_bits + 1).clamp(1, 2045) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_of_two_above_is_the_next_one() {
        for (x, expected) in [(1.0, 2.0), (0.75, 1.0), (1.5, 2.0), (2.0, 4.0), (1e-3, 0.001_953_125)] {
            assert_eq!(power_of_two_above(x), expected);
        }
        for x in [0.0, 5e-324, 1e-300, f64::MAX] {
            let p = power_of_two_above(x);
            assert!(p.is_normal() && (1.0 / p).is_normal());
        }
    }

    #[test]
    fn gamma_bounds_a_sum_of_ten_thirds() {
        let sum: f64 = (0..10).map(|_| 1.0 / 3.0).sum();
        assert!((sum - 10.0 / 3.0).abs() <= gamma(11) * (10.0 / 3.0));
    }
}
