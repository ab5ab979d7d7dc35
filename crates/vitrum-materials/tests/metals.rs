//! The table of metals, computed from measured spectra (`tests/metals`), and what it is worth.
//!
//! Needs the folder of assets (`VITRUM_ASSETS`) for the CIE's observer and illuminants. `VITRUM_BLESS=1` writes the table anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use vitrum_bxdf::ComplexIndex;
use vitrum_materials::Metal;
use vitrum_math::DVec3;

/// Wavelengths, nm: every one.
const FIRST: u32 = 380;
const LAST: u32 = 780;

/// From CIE XYZ to linear Rec.709 (IEC 61966-2-1, with more digits). Rows are scaled to the white afterwards.
const REC709: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The numbers of a file, line by line; lines that start with anything else are left out.
fn rows(path: &Path, separator: &[char]) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let numbers = |line: &str| line.split(separator).map(|x| x.parse().expect("a number")).collect();
    text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())).map(numbers).collect()
}

/// Column `column` of a table by wavelength, with straight lines between its rows.
fn at(rows: &[Vec<f64>], column: usize, wavelength: u32) -> f64 {
    let wavelength = f64::from(wavelength);
    let next = rows.partition_point(|row| row[0] <= wavelength).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[next - 1], &rows[next]);
    let t = (wavelength - a[0]) / (b[0] - a[0]);
    a[column] + t * (b[column] - a[column])
}

fn spectrum(rows: &[Vec<f64>], column: usize) -> Vec<f64> {
    (FIRST..=LAST).map(|wavelength| at(rows, column, wavelength)).collect()
}

/// What of each wavelength of a reflectance is in each channel, under D65 and under equal energy: white gives one.
fn channels(assets: &Path) -> [[Vec<f64>; 3]; 2] {
    let observer = rows(&assets.join("reference/cie1931_2deg_cmf.csv"), &[',']);
    let illuminants = rows(&assets.join("reference/illuminants.csv"), &[',']);
    let observer = [1, 2, 3].map(|column| spectrum(&observer, column));
    [1, 3].map(|illuminant| {
        let light = spectrum(&illuminants, illuminant);
        REC709.map(|row| {
            let sensitivity = |i: usize| light[i] * (0..3).map(|c| row[c] * observer[c][i]).sum::<f64>();
            let weights: Vec<f64> = (0..light.len()).map(sensitivity).collect();
            let white: f64 = weights.iter().sum();
            weights.iter().map(|weight| weight / white).collect()
        })
    })
}

fn in_channel(weights: &[f64], reflectance: &[f64]) -> f64 {
    weights.iter().zip(reflectance).map(|(weight, r)| weight * r).sum()
}

fn reflectance(n: f64, k: f64, cos: f64) -> f64 {
    let index: ComplexIndex<f64> =
        ComplexIndex::new(DVec3::splat(n), DVec3::splat(k), 1.0).expect("it is a metal");
    index.reflectance(cos).x
}

/// The mean over all directions, weighted by the cosine: 1000 midpoints of the squared cosine.
fn albedo(n: f64, k: f64) -> f64 {
    let steps = 1000;
    let cos = |i: i32| ((f64::from(i) + 0.5) / f64::from(steps)).sqrt();
    (0..steps).map(|i| reflectance(n, k, cos(i))).sum::<f64>() / f64::from(steps)
}

/// The k that gives a reflectance at normal incidence, where there is one.
fn k_of(normal: f64, n: f64) -> Option<f64> {
    let squared = (normal * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - normal);
    (squared >= 0.0).then(|| squared.sqrt())
}

/// The pair of n and k that gives both reflectances. Of the pairs that give the first, the second falls as n grows.
fn pair(normal: f64, mean: f64) -> [f64; 2] {
    let root = normal.sqrt();
    // Beyond these, no k gives the first.
    let (mut low, mut high) = ((1.0 - root) / (1.0 + root), (1.0 + root) / (1.0 - root));
    (low, high) = (low * (1.0 + 1e-12), high * (1.0 - 1e-12));
    let excess = |n: f64| albedo(n, k_of(normal, n).expect("n is within bounds")) - mean;
    assert!(excess(low) > 0.0 && excess(high) < 0.0, "{normal} {mean}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    [low, k_of(normal, low).expect("n is within bounds")]
}

struct Measured {
    name: String,
    n: Vec<f64>,
    k: Vec<f64>,
}

impl Measured {
    fn all() -> Vec<Self> {
        let files = vitrum_testkit::files_with_extension(&package().join("tests/metals"), "txt");
        let read = |path: PathBuf| {
            let rows = rows(&path, &[' ']);
            let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
            Self { name, n: spectrum(&rows, 1), k: spectrum(&rows, 2) }
        };
        files.into_iter().map(read).collect()
    }

    fn reflectances(&self, of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        self.n.iter().zip(&self.k).map(|(n, k)| of(*n, *k)).collect()
    }

    /// What the channels should have, and no more than the metal reflects anywhere.
    fn seen(&self, channels: &[Vec<f64>; 3], of: impl Fn(f64, f64) -> f64) -> [f64; 3] {
        let reflectances = self.reflectances(of);
        let most = reflectances.iter().copied().fold(0.0, f64::max);
        [0, 1, 2].map(|c| in_channel(&channels[c], &reflectances).min(most))
    }
}

const HEAD: &str = "//! Indices of refraction of metals, per channel. Written by `tests/metals.rs`; how is said in `metal.rs`.

/// How many metals there are.
pub(crate) const COUNT: usize = ";

fn table(daylight: &[Vec<f64>; 3]) -> String {
    let metals = Measured::all();
    let mut text = format!(
        "{HEAD}{};\n\n/// Name, n and k.\npub(crate) const TABLE: [(&str, [f64; 3], [f64; 3]); COUNT] = [\n",
        metals.len()
    );
    for metal in metals {
        let normal = metal.seen(daylight, |n, k| reflectance(n, k, 1.0));
        let mean = metal.seen(daylight, albedo);
        let [r, g, b] = [0, 1, 2].map(|c| pair(normal[c], mean[c]));
        writeln!(
            text,
            "    ({:?}, [{:.5}, {:.5}, {:.5}], [{:.5}, {:.5}, {:.5}]),",
            metal.name, r[0], g[0], b[0], r[1], g[1], b[1]
        )
        .expect("strings take everything");
    }
    text + "];\n"
}

#[test]
fn the_table_is_what_the_spectra_give() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let [daylight, _] = channels(&assets);
    let (computed, path) = (table(&daylight), package().join("src/metal_table.rs"));
    if vitrum_testkit::blessing() {
        std::fs::write(&path, &computed).expect("the table can be written");
    }
    let stored = std::fs::read_to_string(&path).expect("the table is part of the package");
    assert_eq!(stored, computed, "VITRUM_BLESS=1 writes it anew");
}

/// D65 through the observer and the matrix is Rec.709's white.
#[test]
fn the_white_of_daylight_is_the_white_of_the_channels() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let observer = rows(&assets.join("reference/cie1931_2deg_cmf.csv"), &[',']);
    let light = spectrum(&rows(&assets.join("reference/illuminants.csv"), &[',']), 1);
    let xyz = [1, 2, 3].map(|c| in_channel(&spectrum(&observer, c), &light));
    for row in REC709 {
        let white = (0..3).map(|c| row[c] * xyz[c] / xyz[1]).sum::<f64>();
        // Both are rounded to four digits where they are published.
        assert!((white - 1.0).abs() < 5e-4, "{white}");
    }
}

/// The colour at normal incidence and the mean over all directions are those of the spectrum: to half a unit of the table's last
/// digit in n and k under D65; what else lies between is measured and bounded here.
#[test]
fn a_named_metal_reflects_what_its_spectrum_does() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let [daylight, equal] = channels(&assets);
    let mut names = Vec::new();
    for metal in Measured::all() {
        let named = Metal::named(&metal.name).expect("every spectrum has a metal");
        let index: ComplexIndex<f64> = ComplexIndex::new(named.n(), named.k(), 1.0).expect("it is a metal");
        let off = |found: f64, expected: f64| (found - expected).abs();
        let mut worst = [0.0_f64; 4];
        let normal = |n, k| reflectance(n, k, 1.0);
        let at_d65 = metal.seen(&daylight, normal);
        let exact = metal.reflectances(normal);
        for c in 0..3 {
            let found = index.reflectance(1.0).to_array()[c];
            worst[0] = worst[0].max(off(found, at_d65[c]));
            worst[1] = worst[1].max(off(found, in_channel(&equal[c], &exact)));
            worst[2] = worst[2].max(off(albedo(named.n().to_array()[c], named.k().to_array()[c]), {
                metal.seen(&daylight, albedo)[c]
            }));
            for cos in [0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8] {
                let expected = metal.seen(&daylight, |n, k| reflectance(n, k, cos))[c];
                worst[3] = worst[3].max(off(index.reflectance(cos).to_array()[c], expected));
            }
        }
        println!(
            "{:>10}: {:.5} at normal incidence, {:.5} on average, {:.4} at any angle; under equal energy {:.4}",
            metal.name, worst[0], worst[2], worst[3], worst[1]
        );
        // Half a unit of the last digit of n and k changes these by less than a tenth of it.
        assert!(worst[0] < 1e-4 && worst[2] < 1e-4, "{}: {worst:?}", metal.name);
        // Two numbers can't follow a spectrum to all angles and illuminants.
        assert!(worst[3] < 0.02 && worst[1] < 0.04, "{}: {worst:?}", metal.name);
        names.push(metal.name);
    }
    assert_eq!(names, Metal::NAMES);
}
