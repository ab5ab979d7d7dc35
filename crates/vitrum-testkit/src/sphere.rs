//! Cells of the unit sphere, and integrals over them.
//!
//! The sphere is cut into cells of equal size in θ (from the pole +z, 0 to π) and φ (from +x towards +y, 0 to 2π).
//! With an even number of cells in θ the horizon z = 0 runs between cells, where the densities of surfaces jump.

use core::f64::consts::{PI, TAU};
use vitrum_math::DVec3;

/// A division of the sphere: `theta` rows by `phi` columns, numbered row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SphereGrid {
    /// Rows from pole to pole, at least 1; even, so that the horizon is a border.
    pub theta: usize,
    /// Columns around the pole, at least 1.
    pub phi: usize,
}

impl Default for SphereGrid {
    /// 40 by 80: cells of 4.5 degrees each way.
    fn default() -> Self {
        Self { theta: 40, phi: 80 }
    }
}

impl SphereGrid {
    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.theta * self.phi
    }

    /// The cell that holds this direction (any length but zero).
    pub fn cell_of(&self, direction: DVec3) -> usize {
        let d = direction.normalize();
        let theta = libm::acos(d.z.clamp(-1.0, 1.0));
        let phi = libm::atan2(d.y, d.x).rem_euclid(TAU);
        // The last border belongs to the last cell, and rounding in rem_euclid may give 2π itself.
        let row = ((theta / PI * self.theta as f64) as usize).min(self.theta - 1);
        let column = ((phi / TAU * self.phi as f64) as usize).min(self.phi - 1);
        row * self.phi + column
    }

    /// The integral of `density` (per steradian) over every cell, in the cells' order.
    ///
    /// Absolute error about 1e-9 in a cell where the density is smooth and about 1e-5 of the jump where it jumps
    /// inside the cell. A lobe much narrower than a tenth of a cell may be missed: take a finer grid for it.
    pub fn integrals(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        let integrand = |theta: f64, phi: f64| {
            let (sin_theta, cos_theta) = libm::sincos(theta);
            let (sin_phi, cos_phi) = libm::sincos(phi);
            sin_theta * density(DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta))
        };
        let (height, width) = (PI / self.theta as f64, TAU / self.phi as f64);
        (0..self.cells())
            .map(|cell| {
                let (row, column) = ((cell / self.phi) as f64, (cell % self.phi) as f64);
                let patch = Patch { x: row * height, y: column * width, width: height, height: width };
                patch
                    .quarters()
                    .iter()
                    .map(|quarter| quarter.refine(&integrand, quarter.gauss(&integrand), 0))
                    .sum()
            })
            .collect()
    }
}

/// The integral of `density` (per steradian) over the whole sphere, by the cells of `grid`
/// (see [`SphereGrid::integrals`] for the error). A density of directions integrates to one minus the probability
/// that its sampler returns nothing.
pub fn integrate_sphere(density: impl Fn(DVec3) -> f64, grid: SphereGrid) -> f64 {
    grid.integrals(density).iter().sum()
}

/// A rectangle of the (θ, φ) plane.
#[derive(Clone, Copy)]
struct Patch {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// Abscissae in [0, 1] and weights of Gauss-Legendre quadrature with four points (Abramowitz and Stegun, table 25.4).
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_92),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_92),
];

/// Where a side is cut. Not in the middle: there a symmetric rule can see a jump equally wrong before and after, and
/// take that for agreement.
const CUT: f64 = 0.4;

/// Cutting the sides this often resolves a jump to a 1/400 of a cell or better.
const DEEPEST: u32 = 12;

/// A patch is good when its quarters agree with it to this, in probability: 1/100 of a sample in 10^6.
const TOLERANCE: f64 = 1e-8;

impl Patch {
    /// Sixteen points.
    fn gauss(&self, f: &impl Fn(f64, f64) -> f64) -> f64 {
        let mut sum = 0.0;
        for (u, weight_u) in GAUSS {
            for (v, weight_v) in GAUSS {
                sum += weight_u * weight_v * f(self.x + u * self.width, self.y + v * self.height);
            }
        }
        sum * self.width * self.height
    }

    fn quarters(&self) -> [Self; 4] {
        let (left, low) = (CUT * self.width, CUT * self.height);
        let (right, high) = (self.width - left, self.height - low);
        [
            Self { width: left, height: low, ..*self },
            Self { x: self.x + left, width: right, height: low, ..*self },
            Self { y: self.y + low, width: left, height: high, ..*self },
            Self { x: self.x + left, y: self.y + low, width: right, height: high },
        ]
    }

    /// Adaptive quadrature: `whole` is this patch's estimate, replaced by that of its quarters until both agree.
    fn refine(&self, f: &impl Fn(f64, f64) -> f64, whole: f64, depth: u32) -> f64 {
        let quarters = self.quarters();
        let estimates = quarters.map(|quarter| quarter.gauss(f));
        let sum = estimates.iter().sum::<f64>();
        // What is not finite will not get better by looking closer.
        if depth == DEEPEST || !sum.is_finite() || (sum - whole).abs() <= TOLERANCE {
            return sum;
        }
        quarters.iter().zip(estimates).map(|(quarter, estimate)| quarter.refine(f, estimate, depth + 1)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_have_their_closed_forms() {
        let grid = SphereGrid::default();
        // Area of the sphere; cosine of a hemisphere; a lobe z^e over a hemisphere: 2π/(e + 1); and a cap z > 0.9,
        // whose border runs inside 80 cells: 2π(1 - 0.9).
        assert!((integrate_sphere(|_| 1.0, grid) - 4.0 * PI).abs() < 1e-9);
        assert!((integrate_sphere(|d| d.z.max(0.0), grid) - PI).abs() < 1e-9);
        assert!((integrate_sphere(|d| d.z.max(0.0).powi(500), grid) - TAU / 501.0).abs() < 1e-7);
        assert!((integrate_sphere(|d| f64::from(d.z > 0.9), grid) - 0.1 * TAU).abs() < 1e-4);
        // A lobe about another axis has the same integral.
        let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
        assert!((integrate_sphere(|d| d.dot(axis).max(0.0).powi(500), grid) - TAU / 501.0).abs() < 1e-6);
    }

    #[test]
    fn the_cells_are_where_their_integrals_are() {
        let grid = SphereGrid { theta: 4, phi: 6 };
        for direction in [DVec3::new(0.3, 0.2, 0.9), DVec3::new(-0.3, -0.8, -0.1), DVec3::new(0.9, -0.1, 0.2)]
        {
            let axis = direction.normalize();
            let integrals = grid.integrals(|d| d.dot(axis).max(0.0).powi(200));
            let largest = (0..grid.cells()).max_by(|&a, &b| integrals[a].total_cmp(&integrals[b]));
            assert_eq!(largest, Some(grid.cell_of(direction)));
        }
        // The corners of the numbering.
        assert!(grid.cell_of(DVec3::Z) < grid.phi);
        assert!(grid.cell_of(-DVec3::Z) >= grid.cells() - grid.phi);
        assert_eq!(grid.cell_of(DVec3::new(1.0, -1e-300, 0.5)) % grid.phi, grid.phi - 1);
    }
}
