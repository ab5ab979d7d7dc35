//! How far an image is from its reference, in the measures that benchmarks and golden tests use.
//!
//! Images are slices of pixels, linear radiance in three channels; all measures are over pixels and channels together.

use core::fmt;

/// Keeps dark pixels from deciding relMSE and MAPE: a tenth, for images whose mean is near a half.
const DARK: f64 = 0.1;

/// One in so many of the terms of relMSE, the worst, are left out of its trimmed form.
const LEFT_OUT: usize = 1000;

/// The differences between an image x and its reference r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest |x - r|.
    pub max_abs: f64,
    /// sqrt(mean((x - r)²)).
    pub rmse: f64,
    /// mean((x - r)² / (r² + 0.01)): relative where it is bright, absolute where it is dark (Rousselle, Knaus and
    /// Zwicker 2011, "Adaptive sampling and reconstruction using greedy error minimization"). Comparable between
    /// scenes only if the mean of the reference is near 0.5.
    pub rel_mse: f64,
    /// The same with the worst 0.1 % of the terms left out. It hides fireflies, and missing caustics too, so it never
    /// stands alone.
    pub rel_mse_trimmed: f64,
    /// mean(|x - r| / (|r| + 0.1)), the mean absolute relative error: 0.01 is one per cent.
    pub mape: f64,
    /// mean(x - r) / mean(r): how much too bright the whole image is. Of a reference without light, the mean itself.
    pub bias: f64,
    /// Standard error of the bias, if each pixel errs by itself: as unbiased pixels that share no samples do.
    pub bias_error: f64,
}

impl Difference {
    /// Compares `image` with `reference`. A value that is not finite in either makes every measure infinite.
    ///
    /// # Panics
    /// If the two differ in length or are empty.
    pub fn between(image: &[[f32; 3]], reference: &[[f32; 3]]) -> Self {
        assert_eq!(image.len(), reference.len(), "the images differ in size");
        assert!(!image.is_empty(), "the images are empty");
        let (mut max_abs, mut sum_square, mut sum_relative) = (0.0f64, 0.0, 0.0);
        let (mut sum, mut sum_reference) = (0.0, 0.0);
        let mut terms = Vec::with_capacity(3 * image.len());
        for (&x, &r) in image.as_flattened().iter().zip(reference.as_flattened()) {
            if !(x.is_finite() && r.is_finite()) {
                let all = f64::INFINITY;
                return Self {
                    max_abs: all,
                    rmse: all,
                    rel_mse: all,
                    rel_mse_trimmed: all,
                    mape: all,
                    bias: all,
                    bias_error: all,
                };
            }
            let (x, r) = (f64::from(x), f64::from(r));
            let distance = (x - r).abs();
            max_abs = max_abs.max(distance);
            sum_square += distance * distance;
            sum_relative += distance / (r.abs() + DARK);
            sum += x - r;
            sum_reference += r;
            terms.push(distance * distance / (r * r + DARK * DARK));
        }
        terms.sort_by(f64::total_cmp);
        let kept = &terms[..terms.len() - terms.len() / LEFT_OUT];
        let count = terms.len() as f64;
        let light = if sum_reference > 0.0 { sum_reference / count } else { 1.0 };
        // The channels of a pixel err together, so it counts as one.
        let pixels = image.iter().zip(reference);
        let mean_of = |(x, r): (&[f32; 3], &[f32; 3])| {
            (0..3).map(|c| f64::from(x[c]) - f64::from(r[c])).sum::<f64>() / 3.0
        };
        let squares: f64 = pixels.map(mean_of).map(|d| (d - sum / count) * (d - sum / count)).sum();
        let pixels = image.len() as f64;
        Self {
            max_abs,
            rmse: (sum_square / count).sqrt(),
            rel_mse: terms.iter().sum::<f64>() / count,
            rel_mse_trimmed: kept.iter().sum::<f64>() / kept.len() as f64,
            mape: sum_relative / count,
            bias: sum / count / light,
            bias_error: (squares / (pixels * (pixels - 1.0).max(1.0))).sqrt() / light,
        }
    }

    /// relMSE of the mean of `images`, told by how far they are apart: of their own mean each is as far as its noise.
    /// None for fewer than two.
    ///
    /// # Panics
    /// If the images differ in length or are empty.
    pub fn rel_mse_of_mean(images: &[&[[f32; 3]]]) -> Option<f64> {
        let (first, count) = (images.first()?, images.len() as f64);
        if images.len() < 2 {
            return None;
        }
        assert!(images.iter().all(|image| image.len() == first.len()), "the images differ in size");
        let terms = (0..3 * first.len()).map(|i| {
            let values = images.iter().map(|image| f64::from(image[i / 3][i % 3]));
            let mean = values.clone().sum::<f64>() / count;
            let squares = values.map(|x| (x - mean) * (x - mean)).sum::<f64>();
            squares / (count * (count - 1.0)) / (mean * mean + DARK * DARK)
        });
        Some(terms.sum::<f64>() / (3 * first.len()) as f64)
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { max_abs, rmse, rel_mse, rel_mse_trimmed, mape, bias, bias_error } = self;
        write!(
            f,
            "max {max_abs:.3e}, RMSE {rmse:.3e}, relMSE {rel_mse:.3e} ({rel_mse_trimmed:.3e} without the worst 0.1 %), MAPE \
             {mape:.3e}, bias {bias:.3e} ± {bias_error:.1e}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: &[f32]) -> Vec<[f32; 3]> {
        values.iter().map(|v| [*v; 3]).collect()
    }

    #[test]
    fn equal_images_do_not_differ() {
        let image = [[0.0, 0.5, 3.0], [1.0, 2.0, 0.1]];
        let Difference { max_abs, rmse, rel_mse, rel_mse_trimmed, mape, bias, bias_error } =
            Difference::between(&image, &image);
        assert_eq!([max_abs, rmse, rel_mse, rel_mse_trimmed, mape, bias, bias_error], [0.0; 7]);
    }

    #[test]
    fn the_measures_are_their_formulas() {
        let image = grey(&[0.0, 1.0, 2.5, 0.5]);
        let difference = Difference::between(&image, &grey(&[0.0, 0.75, 3.0, 0.5]));
        assert_eq!(difference.max_abs, 0.5);
        assert!((difference.rmse - (0.3125f64 / 4.0).sqrt()).abs() < 1e-15);
        assert!((difference.rel_mse - (0.0625 / 0.5725 + 0.25 / 9.01) / 4.0).abs() < 1e-15);
        assert!((difference.mape - (0.25 / 0.85 + 0.5 / 3.1) / 4.0).abs() < 1e-15);
        assert!((difference.bias + 0.25 / 4.25).abs() < 1e-15);
        // The differences of the four pixels are 0, 0.25, -0.5 and 0, their mean is -0.0625.
        let squares = 0.3125 - 4.0 * 0.0625 * 0.0625;
        assert!((difference.bias_error - (squares / 12.0f64).sqrt() / 1.0625).abs() < 1e-15);
    }

    #[test]
    fn trimming_leaves_out_the_worst_of_a_thousand() {
        let (reference, mut image) = (grey(&[0.5; 2000]), grey(&[0.6; 2000]));
        image[17] = [100.0; 3];
        let difference = Difference::between(&image, &reference);
        assert!(difference.rel_mse > 10.0);
        // Six of six thousand values are left out, three of them the bright ones.
        assert!((difference.rel_mse_trimmed - 0.01 / 0.26).abs() < 1e-6);
    }

    #[test]
    fn non_finite_values_are_never_close() {
        for bad in [f32::NAN, f32::INFINITY] {
            let image = [[0.0, bad, 0.0]];
            assert_eq!(Difference::between(&image, &image).rel_mse_trimmed, f64::INFINITY);
        }
    }

    /// Even numbers around a known mean: the variance of one is 1/12 and of the mean of so many that by their number.
    #[test]
    fn the_error_of_a_mean_is_told_by_its_parts() {
        let mut uniform = vitrum_testkit::Uniform::new(7);
        let mut image =
            || (0..7000).map(|_| [0; 3].map(|_| uniform.number() as f32 + 1.0)).collect::<Vec<_>>();
        let images = [0; 8].map(|_| image());
        let images = images.each_ref().map(Vec::as_slice);
        let expected = 1.0 / 12.0 / 8.0 / (1.5 * 1.5 + 0.01);
        let found = Difference::rel_mse_of_mean(&images).expect("there are eight");
        // 147 000 degrees of freedom: the root of two over them is 0.4 %. The mean's own noise in the denominator, 0.5 %.
        assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
        assert_eq!(Difference::rel_mse_of_mean(&images[..1]), None);
    }
}
