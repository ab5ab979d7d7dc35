//! How far an image is from its reference, in the measures that the benchmarks and golden tests use.
//!
//! Images are flat slices of linear radiance in any fixed order of pixels and channels; all measures are over pixels
//! and channels together.

use core::fmt;

/// Keeps dark pixels from deciding relMSE: a tenth squared, for images whose mean is near a half.
const DARK: f64 = 0.01;

/// One in so many of the terms of relMSE, the worst, are left out of its trimmed form.
const LEFT_OUT: usize = 1000;

/// The differences between an image x and its reference r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageDifference {
    /// The largest |x - r|.
    pub max_abs: f64,
    /// The mean of |x - r|.
    pub mean_abs: f64,
    /// sqrt(mean((x - r)²)).
    pub rmse: f64,
    /// mean((x - r)² / (r² + 0.01)): relative where it is bright, absolute where it is dark (Rousselle, Knaus and
    /// Zwicker 2011, "Adaptive sampling and reconstruction using greedy error minimization"). Comparable between
    /// scenes only if the mean of the reference is near 0.5: scale both images first by [`scale_to_half`].
    pub rel_mse: f64,
    /// The same with the worst 0.1 % of the terms left out. It hides fireflies, and missing caustics too, so it never
    /// stands alone.
    pub rel_mse_trimmed: f64,
}

impl ImageDifference {
    /// Compares `image` with `reference`. A value that is not finite in either makes every measure infinite.
    ///
    /// # Panics
    /// If the two differ in length or are empty.
    pub fn between(image: &[f32], reference: &[f32]) -> Self {
        assert_eq!(image.len(), reference.len(), "the images differ in size");
        assert!(!image.is_empty(), "the images are empty");
        let (mut max_abs, mut sum_abs, mut sum_square) = (0.0f64, 0.0, 0.0);
        let mut terms = Vec::with_capacity(image.len());
        for (&x, &r) in image.iter().zip(reference) {
            if !(x.is_finite() && r.is_finite()) {
                let all = f64::INFINITY;
                return Self { max_abs: all, mean_abs: all, rmse: all, rel_mse: all, rel_mse_trimmed: all };
            }
            let (x, r) = (f64::from(x), f64::from(r));
            let distance = (x - r).abs();
            max_abs = max_abs.max(distance);
            sum_abs += distance;
            sum_square += distance * distance;
            terms.push(distance * distance / (r * r + DARK));
        }
        terms.sort_by(f64::total_cmp);
        let kept = &terms[..terms.len() - terms.len() / LEFT_OUT];
        let count = terms.len() as f64;
        Self {
            max_abs,
            mean_abs: sum_abs / count,
            rmse: (sum_square / count).sqrt(),
            rel_mse: terms.iter().sum::<f64>() / count,
            rel_mse_trimmed: kept.iter().sum::<f64>() / kept.len() as f64,
        }
    }
}

/// The factor that brings the mean of `reference` to 0.5, for both images of a comparison by relMSE; 1 for an image
/// whose mean is not positive.
pub fn scale_to_half(reference: &[f32]) -> f64 {
    let mean = reference.iter().copied().map(f64::from).sum::<f64>() / reference.len() as f64;
    if mean > 0.0 { 0.5 / mean } else { 1.0 }
}

impl fmt::Display for ImageDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { max_abs, mean_abs, rmse, rel_mse, rel_mse_trimmed } = self;
        write!(
            f,
            "max {max_abs:.3e}, mean {mean_abs:.3e}, RMSE {rmse:.3e}, relMSE {rel_mse:.3e} ({rel_mse_trimmed:.3e} without the \
             worst 0.1 %)"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_images_do_not_differ() {
        let image = [0.0, 0.5, 3.0];
        let ImageDifference { max_abs, mean_abs, rmse, rel_mse, rel_mse_trimmed } =
            ImageDifference::between(&image, &image);
        assert_eq!([max_abs, mean_abs, rmse, rel_mse, rel_mse_trimmed], [0.0; 5]);
    }

    #[test]
    fn the_measures_are_their_formulas() {
        let difference = ImageDifference::between(&[0.0, 1.0, 2.5, 0.5], &[0.0, 0.75, 3.0, 0.5]);
        assert_eq!(difference.max_abs, 0.5);
        assert_eq!(difference.mean_abs, 0.75 / 4.0);
        assert!((difference.rmse - (0.3125f64 / 4.0).sqrt()).abs() < 1e-15);
        assert!((difference.rel_mse - (0.0625 / 0.5725 + 0.25 / 9.01) / 4.0).abs() < 1e-15);
    }

    #[test]
    fn trimming_leaves_out_the_worst_of_a_thousand() {
        let reference = [0.5; 1000];
        let mut image = [0.6; 1000];
        image[17] = 100.0;
        let difference = ImageDifference::between(&image, &reference);
        assert!(difference.rel_mse > 10.0);
        assert!((difference.rel_mse_trimmed - 0.01 / 0.26).abs() < 1e-6);
    }

    #[test]
    fn non_finite_values_are_never_close() {
        for bad in [f32::NAN, f32::INFINITY] {
            assert_eq!(ImageDifference::between(&[bad], &[bad]).rel_mse_trimmed, f64::INFINITY);
        }
    }

    #[test]
    fn the_scale_brings_the_mean_to_a_half() {
        assert_eq!(scale_to_half(&[1.0, 3.0]), 0.25);
        assert_eq!(scale_to_half(&[0.0, 0.0]), 1.0);
    }
}
