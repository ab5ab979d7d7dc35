//! Directions of an environment, chosen in proportion to the light that comes from them.
//!
//! A band is chosen by the light of all its cells, a cell of the band by its own, a direction of the cell uniformly: the two
//! inversions keep the stratification of the point of the unit square that they are asked with.
//!
//! A small bright region that holds a good part of the light, such as the sun in a photographed sky, is a part of its own,
//! chosen like a light of its own; the rest is another part. No radiance is changed by that.
//!
//! Where light is met as well as asked for, the rest is asked only for what exceeds the mean: what a scattered ray finds as
//! well is left to it (O. Karlík, M. Šik, P. Vévoda, T. Skřivan and J. Křivánek, MIS Compensation: Optimizing Sampling
//! Techniques in Multiple Importance Sampling, 2019).

use crate::environment::EnvironmentMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use vitrum_math::{DVec3, Rgb};

/// A sun fills less than this, steradians: about four degrees around its middle.
const LARGEST_SUN: f64 = 0.015;
/// It has at least this share of all light,
const LEAST_SHARE: f64 = 0.02;
/// and is at its brightest this many times brighter than the mean of all directions.
const LEAST_PEAK: f64 = 100.0;
/// It ends where radiance falls below this share of its mean.
const EDGE: f64 = 0.02;
/// At most so many are looked for.
const MOST_SUNS: usize = 8;

/// A region of an environment that can be asked.
#[derive(Clone, Debug)]
struct Part {
    region: Region,
    /// For each band the sum of the weights of it and all before it.
    bands: Vec<f64>,
    /// For each cell the sum of the weights of it and all before it in its band.
    cells: Vec<f32>,
    /// Light that it is asked for: radiance, the mean of the channels, times solid angle.
    power: f64,
}

/// A block of cells. Columns go on beyond the last with the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Region {
    column: usize,
    columns: usize,
    band: usize,
    bands: usize,
}

/// The parts of an environment.
#[derive(Clone, Debug)]
pub(crate) struct EnvironmentSampler {
    map: Arc<EnvironmentMap>,
    parts: Vec<Part>,
    /// Whether the last part is the rest of the map.
    has_rest: bool,
}

/// A direction that light is asked for from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) towards: DVec3,
    pub(crate) radiance: Rgb,
    /// Density per steradian.
    pub(crate) pdf: f64,
}

impl EnvironmentSampler {
    /// Parts of `map`; with `compensated` the rest is asked for what exceeds the mean alone.
    pub(crate) fn new(map: Arc<EnvironmentMap>, compensated: bool) -> Self {
        let grid = Grid::new(&map);
        let suns = grid.suns();
        let mut parts: Vec<Part> = suns.iter().map(|sun| grid.part(*sun, &[], 0.0)).collect();
        let mean = if compensated { grid.mean_beside(&suns) } else { 0.0 };
        let rest = grid.part(grid.whole(), &suns, mean);
        let has_rest = rest.power > 0.0;
        if has_rest {
            parts.push(rest);
        }
        Self { map, parts, has_rest }
    }

    /// How many parts there are.
    pub(crate) fn len(&self) -> usize {
        self.parts.len()
    }

    /// Roughly the irradiance that a part gives a surface that faces it.
    #[inline]
    pub(crate) fn irradiance(&self, part: usize) -> f64 {
        let is_rest = self.has_rest && part + 1 == self.parts.len();
        // Of what comes from everywhere half is behind the surface, and the rest meets it at half its cosine on average.
        self.parts[part].power * if is_rest { 0.25 } else { 1.0 }
    }

    /// A direction of a part for a point of the unit square; `None` on the edge of what is dark.
    #[inline]
    pub(crate) fn sample(&self, part: usize, [u, v]: [f64; 2]) -> Option<Asked> {
        let Part { region, bands, cells, power, .. } = &self.parts[part];
        let (band, down) = invert(bands, v, |sum| *sum);
        let row = &cells[band * region.columns..][..region.columns];
        let (column, across) = invert(row, u, |sum| f64::from(*sum));
        let (above, below) =
            (self.map.cos_above(region.band + band), self.map.cos_above(region.band + band + 1));
        let towards =
            self.map.direction((region.column + column) as f64 + across, above + (below - above) * down);
        let solid_angle = TAU / self.map.cells()[0] as f64 * (above - below);
        let pdf = weight(bands, band, |sum| *sum) * share(row, column) / (power * solid_angle);
        (pdf > 0.0).then(|| Asked { towards, radiance: self.map.radiance(towards), pdf })
    }

    /// The part that asks for a direction, and the density per steradian with which it does.
    #[inline]
    pub(crate) fn pdf(&self, direction: DVec3) -> Option<(usize, f64)> {
        let [column, band] = self.map.cell(direction);
        let columns = self.map.cells()[0];
        let part = self.parts.iter().position(|part| part.region.contains([column, band], columns))?;
        let Part { region, bands, cells, power, .. } = &self.parts[part];
        let (column, row) = ((column + columns - region.column) % columns, band - region.band);
        let sums = &cells[row * region.columns..][..region.columns];
        let solid_angle = TAU / columns as f64 * (self.map.cos_above(band) - self.map.cos_above(band + 1));
        Some((part, weight(bands, row, |sum| *sum) * share(sums, column) / (power * solid_angle)))
    }
}

/// A small bright region of an environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector towards its middle.
    pub towards: DVec3,
    /// Irradiance on a surface that faces it, the mean of the channels, W/m².
    pub irradiance: f64,
    /// Its share of all light of the environment.
    pub share: f64,
}

impl EnvironmentMap {
    /// Its small bright regions that hold a good part of the light, which are sampled as lights of their own; the brightest
    /// first.
    pub fn suns(&self) -> Vec<Sun> {
        let grid = Grid::new(self);
        let (all, _) = grid.sum(grid.whole());
        let sun = |region: &Region| {
            let column = region.column as f64 + 0.5 * region.columns as f64;
            let (above, below) = (self.cos_above(region.band), self.cos_above(region.band + region.bands));
            let (irradiance, _) = grid.sum(*region);
            Sun {
                towards: self.direction(column, 0.5 * (above + below)),
                irradiance,
                share: irradiance / all,
            }
        };
        grid.suns().iter().map(sun).collect()
    }
}

/// The interval of a sum that `u` in [0, 1) falls into, and where in it.
#[inline]
fn invert<T>(sums: &[T], u: f64, value: impl Fn(&T) -> f64) -> (usize, f64) {
    let at = u * sums.last().map_or(0.0, &value);
    let index = sums.partition_point(|sum| value(sum) <= at).min(sums.len() - 1);
    let weight = weight(sums, index, &value);
    let before = value(&sums[index]) - weight;
    let within = if weight > 0.0 { (at - before) / weight } else { 0.5 };
    (index, within.clamp(0.0, 1.0))
}

/// What one interval adds to the sums.
#[inline]
fn weight<T>(sums: &[T], index: usize, value: impl Fn(&T) -> f64) -> f64 {
    value(&sums[index]) - if index == 0 { 0.0 } else { value(&sums[index - 1]) }
}

/// The share of a cell in its band.
#[inline]
fn share(sums: &[f32], index: usize) -> f64 {
    let value = |sum: &f32| f64::from(*sum);
    let whole = sums.last().map_or(0.0, value);
    if whole > 0.0 { weight(sums, index, value) / whole } else { 0.0 }
}

impl Region {
    #[inline]
    fn contains(&self, [column, band]: [usize; 2], around: usize) -> bool {
        let after = if column >= self.column { column - self.column } else { column + around - self.column };
        after < self.columns && band.wrapping_sub(self.band) < self.bands
    }
}

/// The cells of a map: mean radiance of each, and solid angle of those of a band.
struct Grid {
    columns: usize,
    radiance: Vec<f64>,
    solid_angle: Vec<f64>,
}

impl Grid {
    fn new(map: &EnvironmentMap) -> Self {
        let [columns, bands] = map.cells();
        let radiance =
            (0..bands * columns).map(|cell| map.mean_of_cell([cell % columns, cell / columns])).collect();
        let solid_angle = (0..bands)
            .map(|band| TAU / columns as f64 * (map.cos_above(band) - map.cos_above(band + 1)))
            .collect();
        Self { columns, radiance, solid_angle }
    }

    fn bands(&self) -> usize {
        self.solid_angle.len()
    }

    fn whole(&self) -> Region {
        Region { column: 0, columns: self.columns, band: 0, bands: self.bands() }
    }

    /// Light and solid angle of a block.
    fn sum(&self, region: Region) -> (f64, f64) {
        let (mut light, mut solid_angle) = (0.0, 0.0);
        for band in region.band..region.band + region.bands {
            let cells = (region.column..region.column + region.columns)
                .map(|column| self.radiance[band * self.columns + column % self.columns]);
            light += cells.sum::<f64>() * self.solid_angle[band];
            solid_angle += region.columns as f64 * self.solid_angle[band];
        }
        (light, solid_angle)
    }

    /// Mean radiance outside the suns.
    fn mean_beside(&self, suns: &[Region]) -> f64 {
        let (mut light, mut solid_angle) = self.sum(self.whole());
        for sun in suns {
            let (its_light, its_solid_angle) = self.sum(*sun);
            light -= its_light;
            solid_angle -= its_solid_angle;
        }
        if solid_angle > 0.0 { (light / solid_angle).max(0.0) } else { 0.0 }
    }

    /// Small bright regions with a good share of the light, the brightest first.
    fn suns(&self) -> Vec<Region> {
        let (all, _) = self.sum(self.whole());
        let mean = all / (4.0 * PI);
        let mut suns: Vec<Region> = Vec::new();
        while suns.len() < MOST_SUNS {
            let taken = |cell: usize| {
                let place = [cell % self.columns, cell / self.columns];
                suns.iter().any(|sun| sun.contains(place, self.columns))
            };
            let free = (0..self.radiance.len()).filter(|cell| !taken(*cell));
            let Some(peak) = free.max_by(|a, b| self.radiance[*a].total_cmp(&self.radiance[*b])) else {
                break;
            };
            if self.radiance[peak] < LEAST_PEAK * mean || self.radiance[peak] == 0.0 {
                break;
            }
            let Some(region) = self.grown([peak % self.columns, peak / self.columns]) else { break };
            let apart = suns.iter().all(|sun| !overlap(*sun, region, self.columns));
            if !apart || self.sum(region).0 < LEAST_SHARE * all {
                break;
            }
            suns.push(region);
        }
        suns
    }

    /// The block around a cell up to where radiance falls; `None` when it grows too large for a sun.
    fn grown(&self, [column, band]: [usize; 2]) -> Option<Region> {
        let mut region = Region { column, columns: 1, band, bands: 1 };
        loop {
            let (light, solid_angle) = self.sum(region);
            if solid_angle > LARGEST_SUN {
                return None;
            }
            let edge = EDGE * light / solid_angle;
            let bright = |strip: Region| {
                let (light, solid_angle) = self.sum(strip);
                light > edge * solid_angle
            };
            let Region { column, columns, band, bands } = region;
            let left = Region { column: (column + self.columns - 1) % self.columns, columns: 1, ..region };
            let right = Region { column: (column + columns) % self.columns, columns: 1, ..region };
            let above = (band > 0).then(|| Region { band: band - 1, bands: 1, ..region });
            let below =
                (band + bands < self.bands()).then(|| Region { band: band + bands, bands: 1, ..region });
            if above.is_some_and(bright) {
                (region.band, region.bands) = (band - 1, bands + 1);
            } else if below.is_some_and(bright) {
                region.bands += 1;
            } else if columns < self.columns && bright(left) {
                (region.column, region.columns) = (left.column, columns + 1);
            } else if columns < self.columns && bright(right) {
                region.columns += 1;
            } else {
                return Some(region);
            }
        }
    }

    /// A block to be asked for its light beyond `base`, without what lies in the blocks `without`.
    fn part(&self, region: Region, without: &[Region], base: f64) -> Part {
        let mut bands = Vec::with_capacity(region.bands);
        let mut cells = Vec::with_capacity(region.bands * region.columns);
        let mut power = 0.0;
        for band in region.band..region.band + region.bands {
            let mut light = 0.0;
            for column in (region.column..region.column + region.columns).map(|c| c % self.columns) {
                if !without.iter().any(|other| other.contains([column, band], self.columns)) {
                    light += (self.radiance[band * self.columns + column] - base).max(0.0);
                }
                cells.push(light as f32);
            }
            power += light * self.solid_angle[band];
            bands.push(power);
        }
        Part { region, bands, cells, power }
    }
}

/// True when two blocks share a cell.
fn overlap(a: Region, b: Region, around: usize) -> bool {
    let bands = a.band < b.band + b.bands && b.band < a.band + a.bands;
    bands && (b.column..b.column + b.columns).any(|column| a.contains([column % around, a.band], around))
}
