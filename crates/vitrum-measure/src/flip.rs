//! ꟻLIP: the difference that somebody sees who flips between two pictures on the same display.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "ꟻLIP: A difference evaluator for
//! alternating images", 2020. What the eye resolves of colours is compared in a space of even distances (section 4.1), edges and
//! points by their strength (4.2), and where these differ the colours count for more (4.3). 0 is no difference, 1 that of a
//! primary green from a primary blue.
//!
//! It is for what a display shows, so both pictures come as its bytes, and the distance of the viewer matters: a display of 3840
//! pixels on 0.7 metres, seen from 0.7 metres, which is the authors' default.
//!
//! The steps are those of the authors' program where the paper leaves a choice (borders are repeated; the smallest kernel that
//! holds three standard deviations of the widest filter). Every filter is a product of one along rows and one along columns, or
//! a sum of two such.

use core::f64::consts::PI;
use std::sync::LazyLock;

/// Pixels that a degree of the field of view holds: 3840 pixels over 0.7 m, at 0.7 m.
const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponent of colour distances.
const COLOUR_EXPONENT: f64 = 0.7;
/// Colour distances up to this share of the largest fill this share of the range.
const LARGE: [f64; 2] = [0.4, 0.95];
/// Width of the edges and points that are looked for, degrees.
const FEATURE: f64 = 0.082;

/// Contrast sensitivity of the eye: sums of two Gaussians (a, b): a sqrt(π/b) exp(-π² x²/b), x in degrees. Of lightness, red
/// against green, and blue against yellow.
const SENSITIVITY: [[[f64; 2]; 2]; 3] =
    [[[1.0, 0.0047], [0.0, 1e-5]], [[1.0, 0.0053], [0.0, 1e-5]], [[34.1, 0.04], [13.5, 0.025]]];

/// The mean of a map: the one number for two pictures.
pub fn mean(map: &[f32]) -> f64 {
    map.iter().copied().map(f64::from).sum::<f64>() / map.len() as f64
}

/// The difference at each pixel, 0 to 1, of two pictures in sRGB with rows of `width` pixels.
///
/// # Panics
/// If the pictures differ in size or have no whole rows.
pub fn flip(image: &[[u8; 3]], reference: &[[u8; 3]], width: usize) -> Vec<f32> {
    assert_eq!(image.len(), reference.len(), "the pictures differ in size");
    assert!(width > 0 && !image.is_empty() && image.len().is_multiple_of(width), "the rows are not whole");
    let [image, reference] = [image, reference].map(|bytes| Seen::new(bytes, width));
    let largest = libm::pow(distance(perceived(GREEN), perceived(BLUE)), COLOUR_EXPONENT);
    let pixels = (0..image.colours.len()).map(|i| {
        let colour = libm::pow(distance(image.colours[i], reference.colours[i]), COLOUR_EXPONENT) / largest;
        let feature = |which: usize| (image.features[which][i] - reference.features[which][i]).abs();
        let feature = libm::sqrt(feature(0).max(feature(1)) / libm::sqrt(2.0));
        libm::pow(spread(colour), 1.0 - feature) as f32
    });
    pixels.collect()
}

const GREEN: [f64; 3] = [0.0, 1.0, 0.0];
const BLUE: [f64; 3] = [0.0, 0.0, 1.0];

/// What the eye sees of a picture.
struct Seen {
    /// L*a*b* after the filters of the eye, with chroma that fades in the dark.
    colours: Vec<[f64; 3]>,
    /// Strength of edges, and of points.
    features: [Vec<f64>; 2],
}

impl Seen {
    fn new(bytes: &[[u8; 3]], width: usize) -> Self {
        let opponent: Vec<[f64; 3]> = bytes.iter().map(|p| opponent(p.map(linear))).collect();
        let channel = |c: usize| Plane { values: opponent.iter().map(|p| p[c]).collect(), width };
        let planes = [0, 1, 2].map(channel);
        let [y, cx, cz] = [0, 1, 2].map(|c| planes[c].as_resolved(&SENSITIVITY[c]));
        let colours = (0..bytes.len())
            .map(|i| perceived(from_opponent([y[i], cx[i], cz[i]]).map(|v| v.clamp(0.0, 1.0))));
        // 0 is black and 1 is white.
        let lightness =
            Plane { values: planes[0].values.iter().map(|y| (y + 16.0) / 116.0).collect(), width };
        Self { colours: colours.collect(), features: lightness.features() }
    }
}

/// One number a pixel.
struct Plane {
    values: Vec<f64>,
    width: usize,
}

impl Plane {
    /// Filtered by the sensitivity of the eye.
    fn as_resolved(&self, gaussians: &[[f64; 2]; 2]) -> Vec<f64> {
        let widest = 0.04;
        let radius = libm::ceil(3.0 * libm::sqrt(widest / (2.0 * PI * PI)) * PIXELS_PER_DEGREE);
        let mut sum = vec![0.0; self.values.len()];
        let mut total = 0.0;
        for &[a, b] in gaussians.iter().filter(|g| g[0] > 0.0) {
            let row = kernel(radius, |x| {
                let degrees = x / PIXELS_PER_DEGREE;
                libm::exp(-PI * PI * degrees * degrees / b)
            });
            let weight = a * libm::sqrt(PI / b);
            let one = row.iter().sum::<f64>();
            total += weight * one * one;
            for (sum, value) in sum.iter_mut().zip(self.filtered(&row, &row)) {
                *sum += weight * value;
            }
        }
        sum.iter_mut().for_each(|value| *value /= total);
        sum
    }

    /// Strength of edges, and of points: lengths of the first and of the second derivative of a Gaussian.
    fn features(&self) -> [Vec<f64>; 2] {
        let deviation = 0.5 * FEATURE * PIXELS_PER_DEGREE;
        let radius = libm::ceil(3.0 * deviation);
        let bell = |x: f64| libm::exp(-x * x / (2.0 * deviation * deviation));
        let across = kernel(radius, bell);
        let one = across.iter().sum::<f64>();
        let edge = kernel(radius, |x| -x * bell(x));
        let point = kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * bell(x));
        [edge, point].map(|along| {
            // What is positive sums to one, and so does what is negative.
            let part = |sign: f64| along.iter().map(|v| (v * sign).max(0.0)).sum::<f64>() * one;
            let (above, below) = (part(1.0), part(-1.0));
            let along: Vec<f64> =
                along.iter().map(|v| if *v > 0.0 { v / above } else { v / below }).collect();
            let [x, y] = [self.filtered(&along, &across), self.filtered(&across, &along)];
            x.iter().zip(&y).map(|(x, y)| libm::hypot(*x, *y)).collect()
        })
    }

    /// The values under a kernel that is `row` along rows times `column` along columns; borders are repeated.
    fn filtered(&self, row: &[f64], column: &[f64]) -> Vec<f64> {
        let (width, height) = (self.width, self.values.len() / self.width);
        let along = |kernel: &[f64], at: usize, length: usize, value: &dyn Fn(usize) -> f64| {
            let radius = kernel.len() / 2;
            let place = |k: usize| (at + k).saturating_sub(radius).min(length - 1);
            kernel.iter().enumerate().map(|(k, weight)| weight * value(place(k))).sum::<f64>()
        };
        let mut rows = Vec::with_capacity(self.values.len());
        for y in 0..height {
            rows.extend((0..width).map(|x| along(row, x, width, &|x| self.values[y * width + x])));
        }
        let mut both = Vec::with_capacity(rows.len());
        for y in 0..height {
            both.extend((0..width).map(|x| along(column, y, height, &|y| rows[y * width + x])));
        }
        both
    }
}

/// The values of a function at whole numbers from -radius to radius.
fn kernel(radius: f64, value: impl Fn(f64) -> f64) -> Vec<f64> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| value(f64::from(x))).collect()
}

/// The share of the range that a share of the largest colour distance gets.
fn spread(share: f64) -> f64 {
    let [knee, height] = LARGE;
    if share < knee { height / knee * share } else { height + (share - knee) / (1.0 - knee) * (1.0 - height) }
}

/// Distance of colours that are far apart (Abasi, Tehran, Fairchild 2020): lightness and chroma are added.
fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + libm::hypot(a[1] - b[1], a[2] - b[2])
}

/// L*a*b* of linear RGB, with chroma in proportion to lightness (Hunt 1952): colours fade in the dark.
fn perceived(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let relative = relative_xyz(rgb);
    let [x, y, z] = relative.map(|t| {
        if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// Y, Cx, Cz: the opponent colours of the eye, linear in light, of linear RGB.
fn opponent(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear RGB of opponent colours.
fn from_opponent([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (y + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    let xyz = [0, 1, 2].map(|i| relative[i] * white()[i]);
    XYZ_TO_RGB.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}

/// X, Y, Z over those of white.
fn relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    let white = white();
    [0, 1, 2].map(|i| RGB_TO_XYZ[i].iter().zip(rgb).map(|(m, v)| m * v).sum::<f64>() / white[i])
}

/// X, Y, Z of RGB (1, 1, 1).
fn white() -> [f64; 3] {
    RGB_TO_XYZ.map(|row| row.iter().sum())
}

/// The primaries and the white of sRGB (IEC 61966-2-1).
const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// The inverse, by cofactors.
static XYZ_TO_RGB: LazyLock<[[f64; 3]; 3]> = LazyLock::new(|| {
    let m = &RGB_TO_XYZ;
    let cofactor = |r: usize, c: usize| {
        let [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(c, r) / determinant))
});

/// The transfer function of sRGB, backwards.
fn linear(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 48;
    const HEIGHT: usize = 32;

    /// Slanted ramps of colour; and the same with a block, a line and dots.
    fn pictures() -> [Vec<[u8; 3]>; 2] {
        let ramps = |x: usize, y: usize| {
            [(5 * x + 3 * y) % 256, (7 * x) % 200 + 20, (11 * y + 2 * x) % 256].map(|v| v as u8)
        };
        let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
        let reference: Vec<[u8; 3]> = places.clone().map(|(x, y)| ramps(x, y)).collect();
        let image = places.map(|(x, y)| {
            let mut pixel = ramps(x, y);
            if (8..16).contains(&y) && (10..30).contains(&x) {
                pixel[0] = pixel[0].saturating_add(60);
            }
            if y == 20 && (5..40).contains(&x) {
                pixel = [255; 3];
            }
            if [25, 27, 29].contains(&y) && (30..44).contains(&x) && x % 3 == 0 {
                pixel = [0; 3];
            }
            pixel
        });
        [image.collect(), reference]
    }

    /// Of `flip-evaluator` 1.7, the authors' program for Python, for the same pictures, LDR, its default viewer. It works in single
    /// precision.
    #[test]
    fn the_map_is_that_of_the_authors() {
        let [image, reference] = pictures();
        let map = flip(&image, &reference, WIDTH);
        let expected = [
            ([20, 12], 0.505_022_76),
            ([10, 8], 0.312_022_36),
            ([5, 20], 0.767_659_19),
            ([20, 20], 0.600_804_15),
            ([33, 27], 0.378_043_20),
            ([36, 25], 0.412_882_21),
            ([0, 0], 0.0),
            ([47, 31], 0.008_086_29),
            ([30, 17], 0.097_230_52),
        ];
        for ([x, y], value) in expected {
            let found = map[y * WIDTH + x];
            assert!((f64::from(found) - value).abs() < 2e-4, "({x}, {y}): {found}, not {value}");
        }
        let mean = mean(&map);
        assert!((mean - 0.168_855_295).abs() < 2e-5, "{mean}");
    }

    #[test]
    fn the_ends_of_the_range() {
        let [green, blue, black, white] =
            [[0, 255, 0], [0, 0, 255], [0; 3], [255; 3]].map(|p: [u8; 3]| vec![p; 16 * 16]);
        assert!((mean(&flip(&green, &blue, 16)) - 1.0).abs() < 1e-6);
        let contrast = mean(&flip(&black, &white, 16));
        assert!((contrast - 0.967_390_954).abs() < 2e-5, "{contrast}");
        assert_eq!(mean(&flip(&white, &white, 16)), 0.0);
    }
}
