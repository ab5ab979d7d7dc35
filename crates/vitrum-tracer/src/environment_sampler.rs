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
/// At most so many are looked for, among at most so many bright places.
const MOST_SUNS: usize = 8;
const MOST_TRIED: usize = 64;

/// A region of an environment that can be asked.
#[derive(Clone, Debug)]
struct Part {
    region: Region,
    /// For each band the sum of the weights of it and all before it.
    bands: Vec<f64>,
    /// For each cell the share of it and all before it in the weight of its band.
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
        if rest.power > 0.0 {
            parts.push(rest);
        }
        Self { map, parts }
    }

    /// The map.
    pub(crate) fn map(&self) -> &EnvironmentMap {
        &self.map
    }

    /// How many parts there are.
    pub(crate) fn len(&self) -> usize {
        self.parts.len()
    }

    /// Roughly the irradiance that a part gives: what it would be if all of it came from one direction.
    #[inline]
    pub(crate) fn irradiance(&self, part: usize) -> f64 {
        self.parts[part].power
    }

    /// A direction of a part for a point of the unit square; `None` on the edge of what is dark.
    #[inline]
    pub(crate) fn sample(&self, part: usize, [u, v]: [f64; 2]) -> Option<Asked> {
        let Part { region, bands, cells, power, .. } = &self.parts[part];
        let (band, down) = invert(bands, v, |sum| *sum);
        let row = &cells[band * region.columns..][..region.columns];
        let (column, across) = invert(row, u, |sum| f64::from(*sum));
        let cell = [(region.column + column) % self.map.cells()[0], region.band + band];
        let (above, below) = (self.map.cos_above(cell[1]), self.map.cos_above(cell[1] + 1));
        let cos_theta = above + (below - above) * down;
        let solid_angle = TAU / self.map.cells()[0] as f64 * (above - below);
        let pdf = weight(bands, band, |sum| *sum) * share(row, column) / (power * solid_angle);
        (pdf > 0.0).then(|| Asked {
            towards: self.map.direction(cell[0] as f64 + across, cos_theta),
            radiance: self.map.radiance_in(cell, across, cos_theta),
            pdf,
        })
    }

    /// The part that asks for directions of a cell, and the density per steradian with which it does.
    #[inline]
    pub(crate) fn pdf(&self, [column, band]: [usize; 2]) -> Option<(usize, f64)> {
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
        // The glow around a sun, and what is too large for one.
        let mut tried: Vec<Region> = Vec::new();
        while suns.len() < MOST_SUNS && tried.len() < MOST_TRIED {
            let taken = |cell: usize| {
                let place = [cell % self.columns, cell / self.columns];
                suns.iter().chain(&tried).any(|sun| sun.contains(place, self.columns))
            };
            let free = (0..self.radiance.len()).filter(|cell| !taken(*cell));
            let Some(peak) = free.max_by(|a, b| self.radiance[*a].total_cmp(&self.radiance[*b])) else {
                break;
            };
            if self.radiance[peak] < LEAST_PEAK * mean || self.radiance[peak] == 0.0 {
                break;
            }
            let (region, is_small) = self.grown([peak % self.columns, peak / self.columns]);
            let apart = suns.iter().all(|sun| !overlap(*sun, region, self.columns));
            if is_small && apart && self.sum(region).0 >= LEAST_SHARE * all {
                suns.push(region);
            } else {
                tried.push(region);
            }
        }
        suns
    }

    /// The block around a cell up to where radiance falls, or to where it is too large for a sun; and whether it is not.
    fn grown(&self, [column, band]: [usize; 2]) -> (Region, bool) {
        let mut region = Region { column, columns: 1, band, bands: 1 };
        loop {
            let (light, solid_angle) = self.sum(region);
            if solid_angle > LARGEST_SUN {
                return (region, false);
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
                return (region, true);
            }
        }
    }

    /// A block to be asked for its light beyond `base`, without what lies in the blocks `without`.
    fn part(&self, region: Region, without: &[Region], base: f64) -> Part {
        let mut bands = Vec::with_capacity(region.bands);
        let mut cells = Vec::with_capacity(region.bands * region.columns);
        let (mut power, mut shares) = (0.0, Vec::with_capacity(region.columns));
        for band in region.band..region.band + region.bands {
            let mut light = 0.0;
            for column in (region.column..region.column + region.columns).map(|c| c % self.columns) {
                if !without.iter().any(|other| other.contains([column, band], self.columns)) {
                    light += (self.radiance[band * self.columns + column] - base).max(0.0);
                }
                shares.push(light);
            }
            // As shares of the band: single precision has no room for all radiances.
            cells.extend(shares.drain(..).map(|sum| if light > 0.0 { (sum / light) as f32 } else { 0.0 }));
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;
    use vitrum_math::{NodeKey, Purpose, SampleAddress};

    /// A sky that is bright above and dim below, with suns of radius `radius` at the given azimuths, 0.6 above the horizon.
    fn sky(width: usize, suns: &[f64], radius: f64) -> EnvironmentMap {
        let height = width / 2;
        let towards = |azimuth: f64| {
            let (sin, cos) = libm::sincos(azimuth);
            DVec3::new(libm::cos(0.6) * sin, libm::sin(0.6), -libm::cos(0.6) * cos)
        };
        let texel = |at: usize| {
            let phi = TAU * (((at % width) as f64 + 0.5) / width as f64 - 0.5);
            let theta = PI * ((at / width) as f64 + 0.5) / height as f64;
            let direction = DVec3::new(
                libm::sin(theta) * libm::sin(phi),
                libm::cos(theta),
                -libm::sin(theta) * libm::cos(phi),
            );
            let is_sun = suns.iter().any(|s| towards(*s).dot(direction) > libm::cos(radius));
            let light = if is_sun { 5000.0 } else { 0.2 + 0.3 * (direction.y + 1.0) };
            [light as f32, light as f32, 0.5 * light as f32]
        };
        EnvironmentMap::new(width, height, (0..width * height).map(texel).collect(), 0.4, 1.5).expect("valid")
    }

    fn points(count: u32) -> impl Iterator<Item = [f64; 2]> {
        (0..count).map(|i| SampleAddress::new(3, 0, 0, i).pair(NodeKey::ROOT, Purpose::Light))
    }

    /// Uniformly over all directions.
    fn directions(count: u32) -> impl Iterator<Item = DVec3> {
        points(count).map(|[u, v]| {
            let z = 1.0 - 2.0 * u;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let (sin, cos) = libm::sincos(TAU * v);
            DVec3::new(r * cos, z, r * sin)
        })
    }

    fn maps() -> Vec<EnvironmentMap> {
        vec![
            sky(64, &[], 0.0),
            sky(256, &[0.5], 0.02),
            sky(256, &[-PI + 0.41, 2.0], 0.03),
            EnvironmentMap::new(1, 1, vec![[1.0, 2.0, 3.0]], 0.0, 1.0).expect("valid"),
            EnvironmentMap::new(
                3,
                2,
                vec![[0.0; 3], [4.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [1.0; 3]],
                0.0,
                1.0,
            )
            .expect("valid"),
        ]
    }

    /// What is sampled has the density that the direction is said to have, in the same part.
    #[test]
    fn samples_have_their_density() {
        for map in maps() {
            for compensated in [false, true] {
                let sampler = EnvironmentSampler::new(Arc::new(map.clone()), compensated);
                for part in 0..sampler.len() {
                    for point in points(4096) {
                        let asked = sampler.sample(part, point).expect("there is light everywhere asked for");
                        assert!((asked.towards.length() - 1.0).abs() < 1e-14);
                        let apart = asked.radiance - map.radiance(asked.towards);
                        assert!(apart.abs().max_element() < 1e-6 * map.brightest(), "{apart}");
                        let (found, pdf) =
                            sampler.pdf(sampler.map.cell(asked.towards)).expect("it was sampled");
                        // Rounding may put a direction from the edge of a cell into its neighbour.
                        if found == part && (pdf / asked.pdf - 1.0).abs() > 1e-9 {
                            let near = points(9).any(|[u, v]| {
                                let by = DVec3::new(u - 0.5, v - 0.5, 0.5 - u) * 1e-12;
                                sampler
                                    .pdf(sampler.map.cell(asked.towards + by))
                                    .is_some_and(|(_, p)| (p / asked.pdf - 1.0).abs() < 1e-9)
                            });
                            assert!(near, "{pdf} instead of {}", asked.pdf);
                        }
                    }
                }
            }
        }
    }

    /// The density integrates to one over the directions of each part.
    #[test]
    fn densities_integrate_to_one() {
        for map in maps() {
            let sampler = EnvironmentSampler::new(Arc::new(map), false);
            let mut sums = vec![0.0; sampler.len()];
            let count = 1 << 20;
            for direction in directions(count) {
                if let Some((part, pdf)) = sampler.pdf(sampler.map.cell(direction)) {
                    sums[part] += pdf * 4.0 * PI / f64::from(count);
                }
            }
            for (part, sum) in sums.iter().enumerate() {
                // A sun fills a thousandth of the sphere: a thousand of these directions, which are stratified.
                let is_sun = part + 1 < sums.len();
                assert!((sum - 1.0).abs() < if is_sun { 0.02 } else { 2e-3 }, "part {part}: {sum}");
            }
        }
    }

    /// All parts together give the light that arrives from everywhere, summed over the texels.
    #[test]
    fn parts_hold_all_light() {
        for map in maps() {
            let grid = Grid::new(&map);
            let (all, solid_angle) = grid.sum(grid.whole());
            assert!((solid_angle - 4.0 * PI).abs() < 1e-9);
            let sampler = EnvironmentSampler::new(Arc::new(map), false);
            let count = 1 << 14;
            let estimate: f64 = (0..sampler.len())
                .flat_map(|part| points(count).map(move |point| (part, point)))
                .map(|(part, point)| {
                    let asked = sampler.sample(part, point).expect("light");
                    asked.radiance.element_sum() / 3.0 / asked.pdf / f64::from(count)
                })
                .sum();
            assert!((estimate / all - 1.0).abs() < 2e-3, "{estimate} instead of {all}");
        }
    }

    /// Suns are found where they are, at the seam too, with the irradiance of their disk; a lamp of twenty degrees is none.
    #[test]
    fn suns_are_found() {
        let expected = |radius: f64| 1.5 * 5000.0 * (2.5 / 3.0) * TAU * (1.0 - libm::cos(radius));
        // A rotation of 0.4 counterclockwise takes an azimuth of a to a - 0.4.
        for (azimuth, radius) in [(0.5, 0.02), (-PI + 0.001, 0.02), (PI - 0.01, 0.03)] {
            let suns = sky(512, &[azimuth], radius).suns();
            let [sun] = suns[..] else { panic!("found {suns:?}") };
            let azimuth = azimuth - 0.4;
            let towards = DVec3::new(
                libm::cos(0.6) * libm::sin(azimuth),
                libm::sin(0.6),
                -libm::cos(0.6) * libm::cos(azimuth),
            );
            assert!(sun.towards.dot(towards) > libm::cos(0.01), "{sun:?} instead of {towards}");
            // Texels are in the disk or not: its edge is a texel, 0.012 wide, rough.
            assert!((sun.irradiance / expected(radius) - 1.0).abs() < 0.25, "{sun:?}");
        }
        assert_eq!(sky(512, &[0.5, 2.0, -2.0], 0.02).suns().len(), 3);
        assert_eq!(sky(512, &[0.5], 0.35).suns(), []);
        assert_eq!(sky(512, &[], 0.0).suns(), []);
    }

    /// A sun straight up is a row around all of the map.
    #[test]
    fn a_sun_at_the_zenith_is_one_sun() {
        let (width, height) = (256, 128);
        let texel = |at: usize| if at / width == 0 { [1e5; 3] } else { [0.1; 3] };
        let map = EnvironmentMap::new(width, height, (0..width * height).map(texel).collect(), 0.0, 1.0);
        let suns = map.expect("valid").suns();
        assert_eq!(suns.len(), 1);
        // Its half of the band of interpolation below belongs to it.
        assert!(suns[0].share > 0.9, "{suns:?}");
    }

    #[test]
    fn what_is_the_same_everywhere_or_dark_is_not_asked_for() {
        let of =
            |texel: [f32; 3]| Arc::new(EnvironmentMap::new(8, 4, vec![texel; 32], 0.0, 1.0).expect("valid"));
        assert_eq!(EnvironmentSampler::new(of([0.5; 3]), true).len(), 0);
        assert_eq!(EnvironmentSampler::new(of([0.0; 3]), false).len(), 0);
        let even = EnvironmentSampler::new(of([0.5; 3]), false);
        assert_eq!(even.len(), 1);
        let (_, pdf) = even.pdf(even.map.cell(DVec3::new(0.0, libm::cos(FRAC_PI_2), -1.0))).expect("a part");
        assert!((pdf * 4.0 * PI - 1.0).abs() < 1e-6, "uniform, but for the rounding of the sums");
    }
}
