//! Error against seconds.
//!
//! Both spread over powers of ten, so everything happens in their logarithms: means are geometric, what lies between two points
//! is found on the line between their logarithms, and the slope is that of the line that fits them best by least squares. The
//! error of independent samples has a slope of -1; evenly spread samples fall more steeply.

/// Points of error against seconds, by rising seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// (seconds, error), all above zero.
    points: Vec<[f64; 2]>,
}

/// When a curve comes to an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// After so many seconds, between two points.
    After(f64),
    /// Before its first point, which is after so many seconds.
    Before(f64),
    /// Not by its last point, which is after so many seconds.
    Not(f64),
}

impl Curve {
    /// From (seconds, error), in any order; what is not finite and above zero is left out.
    pub fn new(points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut points: Vec<[f64; 2]> =
            points.into_iter().filter(|p| p.iter().all(|v| v.is_finite() && *v > 0.0)).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { points }
    }

    /// (seconds, error), by rising seconds.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// When the error is `error`, for good: where the curve crosses it for the last time. None without points.
    pub fn reaches(&self, error: f64) -> Option<Reached> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        if last[1] > error {
            return Some(Reached::Not(last[0]));
        }
        let crossing = self.points.windows(2).rev().find(|pair| pair[0][1] > error);
        Some(crossing.map_or(Reached::Before(first[0]), |pair| {
            let [[t0, e0], [t1, e1]] = [pair[0], pair[1]].map(|p| p.map(libm::log));
            let share = (libm::log(error) - e0) / (e1 - e0);
            Reached::After(libm::exp(t0 + share * (t1 - t0)))
        }))
    }

    /// d log(error) / d log(seconds) by least squares. None for fewer than two different times.
    pub fn slope(&self) -> Option<f64> {
        let count = self.points.len() as f64;
        let logs: Vec<[f64; 2]> = self.points.iter().map(|p| p.map(libm::log)).collect();
        let mean = |i: usize| logs.iter().map(|p| p[i]).sum::<f64>() / count;
        let [t, e] = [mean(0), mean(1)];
        let square = logs.iter().map(|p| (p[0] - t) * (p[0] - t)).sum::<f64>();
        let product = logs.iter().map(|p| (p[0] - t) * (p[1] - e)).sum::<f64>();
        (square > 0.0).then(|| product / square)
    }
}

/// exp(mean(log(x))): of factors, the one that they come to together. None without values, or with one that is not above zero.
pub fn geometric_mean(values: &[f64]) -> Option<f64> {
    let is_usable = !values.is_empty() && values.iter().all(|v| v.is_finite() && *v > 0.0);
    is_usable.then(|| libm::exp(values.iter().map(|v| libm::log(*v)).sum::<f64>() / values.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// error = 0.3 / seconds^1.25.
    fn power_law() -> Curve {
        Curve::new((0..8).rev().map(|i| {
            let seconds = libm::exp2(f64::from(i)) * 0.1;
            [seconds, 0.3 * libm::pow(seconds, -1.25)]
        }))
    }

    #[test]
    fn a_power_law_is_read_exactly() {
        let curve = power_law();
        assert!((curve.slope().expect("there are eight points") + 1.25).abs() < 1e-12);
        for error in [2.0, 0.1, 0.02] {
            let expected = libm::pow(0.3 / error, 0.8);
            let Some(Reached::After(seconds)) = curve.reaches(error) else { panic!("{error} is between") };
            assert!((seconds / expected - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_outside_is_said() {
        let curve = power_law();
        assert_eq!(curve.reaches(10.0), Some(Reached::Before(0.1)));
        assert_eq!(curve.reaches(1e-4), Some(Reached::Not(12.8)));
        assert_eq!(Curve::new([]).reaches(1.0), None);
        assert_eq!(Curve::new([[1.0, 0.5]]).slope(), None);
        assert_eq!(Curve::new([[1.0, 0.0], [f64::NAN, 1.0]]).points(), &[] as &[[f64; 2]]);
    }

    #[test]
    fn a_curve_that_rises_again_has_not_reached_what_it_passed() {
        let curve = Curve::new([[1.0, 1.0], [2.0, 0.1], [4.0, 0.4], [8.0, 0.1]]);
        let Some(Reached::After(seconds)) = curve.reaches(0.2) else { panic!("it is between") };
        assert!((seconds - libm::sqrt(32.0)).abs() < 1e-12);
    }

    #[test]
    fn factors_come_together() {
        assert!((geometric_mean(&[0.5, 8.0]).expect("both are above zero") - 2.0).abs() < 1e-15);
        assert_eq!(geometric_mean(&[]), None);
        assert_eq!(geometric_mean(&[1.0, 0.0]), None);
    }
}
