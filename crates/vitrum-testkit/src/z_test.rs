//! Z-test: does a measured mean agree with an expected value, given how well it was measured?
//!
//! Means of many independent samples are normally distributed, so (mean - expected) / sigma is a standard normal
//! number when nothing is wrong. A mean that agrees because its sigma is large shows nothing: print the outcome, and
//! bound [`ZTest::sigma`] where it matters.

use crate::significance::two_sided_normal_p_value;
use core::fmt;

/// Count, mean and variance of a stream of numbers (Welford 1962, "Note on a method for calculating corrected sums of
/// squares and products": no cancellation, one pass).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    sum_of_squares: f64,
}

impl Moments {
    /// Takes one more number in.
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.sum_of_squares += before * (value - self.mean);
    }

    /// How many numbers were taken in.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; zero when there are none.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased estimate of their variance; infinite for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { self.sum_of_squares / (self.count - 1) as f64 }
    }

    /// The standard error of the mean, one sigma; infinite for fewer than two numbers.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        values.into_iter().for_each(|value| moments.push(value));
        moments
    }
}

/// The outcome of comparing a mean with what it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZTest {
    /// The measured mean.
    pub mean: f64,
    /// The standard error of the mean.
    pub sigma: f64,
    /// The expected value.
    pub expected: f64,
    /// Their distance in sigmas, signed.
    pub z: f64,
    /// The probability of a distance at least this large on either side when nothing is wrong.
    pub p_value: f64,
}

impl ZTest {
    /// Compares `mean`, whose standard error is `sigma` ≥ 0, with `expected`.
    ///
    /// Without noise (`sigma` zero) anything but equality fails. What is not a number always fails; so does an
    /// infinite sigma, which is no measurement.
    pub fn new(mean: f64, sigma: f64, expected: f64) -> Self {
        let distance = mean - expected;
        let z = if sigma.is_nan() || sigma < 0.0 || sigma.is_infinite() {
            f64::NAN
        } else if distance == 0.0 {
            0.0
        } else {
            distance / sigma
        };
        let p_value = if z.is_nan() { 0.0 } else { two_sided_normal_p_value(z) };
        Self { mean, sigma, expected, z, p_value }
    }

    /// Whether the mean agrees with the expected value at this level (say 1e-3, or less by
    /// [`sidak_level`](crate::sidak_level) for many tests).
    pub fn passes(&self, level: f64) -> bool {
        self.p_value >= level
    }
}

/// Compares the mean of what `moments` has seen with `expected`.
pub fn z_test(moments: &Moments, expected: f64) -> ZTest {
    ZTest::new(moments.mean(), moments.standard_error(), expected)
}

impl fmt::Display for ZTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mean, sigma, expected, z, p_value } = self;
        write!(f, "mean {mean} (sigma {sigma:.3e}), expected {expected}: z = {z:.2}, p = {p_value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Uniform;

    #[test]
    fn moments_are_those_of_the_textbook() {
        let moments: Moments = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().collect();
        assert_eq!((moments.count(), moments.mean()), (8, 5.0));
        assert!((moments.variance() - 32.0 / 7.0).abs() < 1e-14);
        assert!((moments.standard_error() - (4.0f64 / 7.0).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn a_large_offset_does_not_cancel_the_variance() {
        let moments: Moments = [1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0].into_iter().collect();
        assert_eq!(moments.variance(), 30.0);
    }

    #[test]
    fn the_right_mean_passes_and_a_wrong_one_fails() {
        let mut uniform = Uniform::new(3);
        let moments: Moments = (0..40_000).map(|_| uniform.number().powi(2)).collect();
        let right = z_test(&moments, 1.0 / 3.0);
        assert!(right.passes(1e-3), "{right}");
        // The sigma of this mean is 0.0015: one per cent of a third is 2.2 sigma, three per cent 6.7.
        assert!(!z_test(&moments, 1.03 / 3.0).passes(1e-3));
    }

    #[test]
    fn p_values_are_uniform_when_nothing_is_wrong() {
        // Of 1000 honest tests about 5 % fail at 5 %: binomial with sigma 6.9, taken at four of them.
        let failed = (0..1000)
            .filter(|&seed| {
                let mut uniform = Uniform::new(seed);
                let moments: Moments = (0..500).map(|_| uniform.number()).collect();
                !z_test(&moments, 0.5).passes(0.05)
            })
            .count();
        assert!((22..=78).contains(&failed), "{failed} of 1000 failed");
    }

    #[test]
    fn what_was_not_measured_does_not_pass() {
        assert!(ZTest::new(1.0, 0.0, 1.0).passes(1e-3));
        for (mean, sigma) in
            [(1.0 + 1e-12, 0.0), (f64::NAN, 0.1), (1.0, f64::NAN), (1.0, f64::INFINITY), (1.0, -1.0)]
        {
            assert!(!ZTest::new(mean, sigma, 1.0).passes(1e-3), "mean {mean}, sigma {sigma}");
        }
        assert!(!z_test(&Moments::default(), 0.0).passes(1e-3));
    }
}
