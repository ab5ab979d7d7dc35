//! Light from infinitely far away, as a picture of all directions.
//!
//! The picture is a latitude-longitude map. Its rows go from straight up (+Y) down to straight below, its columns once around:
//! the middle of the picture is in the direction -Z, what is right of it towards +X. Between the centres of texels radiance is
//! interpolated linearly, around the seam too; beyond the first and the last row of centres it is that of the row.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `width`, `height` | texels | at least 1 each |
//! | `texels` | linear Rec.709 radiance in rows from the top, W/(m² sr) | finite, not negative |
//! | `rotation` | about +Y, counterclockwise seen from above, radians | finite |
//! | `scale` | factor of all radiance | finite, not negative |

use std::f64::consts::{PI, TAU};
use vitrum_math::{DVec3, Rgb};

/// A picture of all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
    rotation: f64,
    scale: f64,
    /// Cosines of the upper edges of the bands, and of the lower edge of the last.
    cosines: Vec<f64>,
}

/// A picture that is no environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// No texels, or not as many as the size says.
    #[error("an environment of {width} x {height} needs as many texels, at least one; found {texels}")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Texels.
        texels: usize,
    },
    /// Texels that are infinite, not a number, or negative.
    #[error(
        "{count} texels are no radiance (not a number, infinite or negative), the first in column {x} of row {y}"
    )]
    NoRadiance {
        /// How many.
        count: usize,
        /// Column of the first, from 0.
        x: usize,
        /// Row of the first, from 0.
        y: usize,
    },
    /// A rotation or a scale that is not finite, or a negative scale.
    #[error("the rotation must be finite, and the scale finite and not negative")]
    Placement,
}

/// A point of the grid of texel centres: the cell that it lies in, and where in it.
#[derive(Clone, Copy, Debug)]
struct Place {
    column: usize,
    band: usize,
    across: f64,
    down: f64,
}

impl EnvironmentMap {
    /// A picture of all directions; see the table above.
    ///
    /// # Errors
    /// [`EnvironmentError`] for values outside their ranges.
    pub fn new(
        width: usize,
        height: usize,
        texels: Vec<[f32; 3]>,
        rotation: f64,
        scale: f64,
    ) -> Result<Self, EnvironmentError> {
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            return Err(EnvironmentError::Size { width, height, texels: texels.len() });
        }
        if !rotation.is_finite() || !scale.is_finite() || scale < 0.0 {
            return Err(EnvironmentError::Placement);
        }
        let is_wrong = |texel: &[f32; 3]| texel.iter().any(|c| !c.is_finite() || *c < 0.0);
        if let Some(first) = texels.iter().position(is_wrong) {
            let count = texels.iter().filter(|texel| is_wrong(texel)).count();
            return Err(EnvironmentError::NoRadiance { count, x: first % width, y: first / width });
        }
        let cos_above = |band: usize| match band {
            0 => 1.0,
            band if band > height => -1.0,
            band => libm::cos(PI * (band as f64 - 0.5) / height as f64),
        };
        let cosines = (0..height + 2).map(cos_above).collect();
        // The same direction, in a number that angles can be added to.
        let rotation = libm::fmod(rotation, TAU);
        Ok(Self { width, height, texels, rotation, scale, cosines })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The radiance that arrives from the unit vector `direction`.
    #[inline]
    pub fn radiance(&self, direction: DVec3) -> Rgb {
        self.interpolated(self.place(direction))
    }

    /// The largest radiance of any channel from any direction.
    pub fn brightest(&self) -> f64 {
        self.texels.iter().flatten().fold(0.0, |most: f64, c| most.max(f64::from(*c))) * self.scale
    }

    /// Cells of the grid: columns, each between the centres of two texels, and bands, each between two rows of centres or
    /// beyond the first or last.
    pub(crate) fn cells(&self) -> [usize; 2] {
        [self.width, self.height + 1]
    }

    /// The cell that a direction lies in: column and band.
    #[cfg(test)]
    pub(crate) fn cell(&self, direction: DVec3) -> [usize; 2] {
        let Place { column, band, .. } = self.place(direction);
        [column, band]
    }

    /// The mean of the channels at the corners of a cell.
    pub(crate) fn mean_of_cell(&self, [column, band]: [usize; 2]) -> f64 {
        self.corners(column, band).iter().map(|c| c.element_sum()).sum::<f64>() / 12.0
    }

    /// Cosine of the angle between straight up and the upper edge of a band; the lower edge is that of the next.
    #[inline]
    pub(crate) fn cos_above(&self, band: usize) -> f64 {
        self.cosines[band]
    }

    /// The radiance from a direction, and the cell that it lies in: column and band.
    #[inline]
    pub(crate) fn radiance_and_cell(&self, direction: DVec3) -> (Rgb, [usize; 2]) {
        let place = self.place(direction);
        (self.interpolated(place), [place.column, place.band])
    }

    /// The radiance at a point of a cell: `across` its columns, 0 to 1, in a direction of the cosine `cos_theta`.
    #[inline]
    pub(crate) fn radiance_in(&self, [column, band]: [usize; 2], across: f64, cos_theta: f64) -> Rgb {
        let y = libm::acos(cos_theta.clamp(-1.0, 1.0)) / PI * self.height as f64 - 0.5;
        self.interpolated(Place { column, band, across, down: y - (band as f64 - 1.0) })
    }

    /// The direction of a point of the map: columns from the centre of the first texel, and the cosine of the angle from straight up.
    #[inline]
    pub(crate) fn direction(&self, column: f64, cos_theta: f64) -> DVec3 {
        let phi = TAU * ((column + 0.5) / self.width as f64 - 0.5) - self.rotation;
        let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        let (sin_phi, cos_phi) = libm::sincos(phi);
        DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
    }

    #[inline]
    fn place(&self, direction: DVec3) -> Place {
        let turns = (libm::atan2(direction.x, -direction.z) + self.rotation) / TAU + 0.5;
        let x = (turns - libm::floor(turns)) * self.width as f64 - 0.5;
        let y = libm::acos(direction.y.clamp(-1.0, 1.0)) / PI * self.height as f64 - 0.5;
        let left = libm::floor(x);
        let above = libm::floor(y);
        // Half a column left of the first centre is the last cell, and rounding may reach one beyond it.
        let column = if left < 0.0 { self.width - 1 } else { (left as usize).min(self.width - 1) };
        let band = ((above + 1.0) as usize).min(self.height);
        Place { column, band, across: x - left, down: y - above }
    }

    /// The radiance at the upper left, upper right, lower left and lower right corner of a cell.
    #[inline]
    fn corners(&self, column: usize, band: usize) -> [Rgb; 4] {
        let right = if column + 1 == self.width { 0 } else { column + 1 };
        let above = band.saturating_sub(1) * self.width;
        let below = band.min(self.height - 1) * self.width;
        [
            self.texel(above + column),
            self.texel(above + right),
            self.texel(below + column),
            self.texel(below + right),
        ]
    }

    #[inline]
    fn texel(&self, at: usize) -> Rgb {
        let [r, g, b] = self.texels[at];
        Rgb::new(f64::from(r), f64::from(g), f64::from(b)) * self.scale
    }

    #[inline]
    fn interpolated(&self, place: Place) -> Rgb {
        let [a, b, c, d] = self.corners(place.column, place.band);
        let upper = a * (1.0 - place.across) + b * place.across;
        let lower = c * (1.0 - place.across) + d * place.across;
        upper * (1.0 - place.down) + lower * place.down
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> [f32; 3] {
        [value; 3]
    }

    /// Four columns and two rows: from the left they are centred on the azimuths -135, -45, 45 and 135 degrees from -Z towards
    /// +X, at 45 degrees above and below the horizon.
    fn compass(rotation: f64) -> EnvironmentMap {
        let texels = (1u8..=8).map(|i| grey(f32::from(i))).collect();
        EnvironmentMap::new(4, 2, texels, rotation, 1.0).expect("valid")
    }

    #[test]
    fn the_middle_is_minus_z_and_right_of_it_is_plus_x() {
        let map = compass(0.0);
        let up = 0.5_f64.sqrt();
        let at = |x: f64, y: f64, z: f64| map.radiance(DVec3::new(x, y, z)).x;
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} instead of {b}");
        close(at(-0.5, up, 0.5), 1.0);
        close(at(-0.5, up, -0.5), 2.0);
        close(at(0.5, up, -0.5), 3.0);
        close(at(0.5, up, 0.5), 4.0);
        close(at(-0.5, -up, 0.5), 5.0);
        close(at(0.5, -up, 0.5), 8.0);
        // Halfway between two columns, two rows, and across the seam.
        close(at(0.0, up, -up), 2.5);
        close(at(0.0, up, up), 2.5);
        close(at(0.0, 0.0, -1.0), 4.5);
        // At the poles the nearest rows go on.
        close(at(0.0, 1.0, -0.0), 2.5);
    }

    #[test]
    fn a_rotation_turns_the_picture_counterclockwise_seen_from_above() {
        let up = 0.5_f64.sqrt();
        // A quarter turn brings what was at 45 degrees right of -Z to 45 degrees left of it.
        let radiance = compass(0.5 * PI).radiance(DVec3::new(-0.5, up, -0.5)).x;
        assert!((radiance - 3.0).abs() < 1e-9, "{radiance}");
    }

    #[test]
    fn a_single_texel_is_the_same_everywhere() {
        let map = EnvironmentMap::new(1, 1, vec![grey(0.25)], 1.0, 2.0).expect("valid");
        for direction in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
            assert_eq!(map.radiance(direction), Rgb::splat(0.5));
        }
        assert_eq!(map.brightest(), 0.5);
    }

    #[test]
    fn directions_of_cells_lie_in_them() {
        let map = compass(2.3);
        let [columns, bands] = map.cells();
        for band in 0..bands {
            let (above, below) = (map.cos_above(band), map.cos_above(band + 1));
            for column in 0..columns {
                for (across, down) in [(0.01, 0.01), (0.5, 0.5), (0.99, 0.99)] {
                    let direction = map.direction(column as f64 + across, above + (below - above) * down);
                    assert_eq!(map.cell(direction), [column, band]);
                }
            }
        }
    }

    #[test]
    fn wrong_texels_are_counted() {
        let texels = vec![grey(0.0), grey(f32::NAN), grey(-1.0), grey(f32::INFINITY)];
        let refused = EnvironmentMap::new(2, 2, texels, 0.0, 1.0).expect_err("not finite");
        assert_eq!(refused, EnvironmentError::NoRadiance { count: 3, x: 1, y: 0 });
        assert!(EnvironmentMap::new(2, 2, vec![grey(0.0)], 0.0, 1.0).is_err());
        assert!(EnvironmentMap::new(1, 1, vec![grey(0.0)], 0.0, -1.0).is_err());
    }
}
