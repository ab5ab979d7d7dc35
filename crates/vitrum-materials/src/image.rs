//! Images as textures.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `image` | the texels, shared by all textures that show it | finite, ≥ 0 |
//! | `scale`, `offset` | the place in the image is uv · scale + offset; an image reaches from 0 to 1 | |
//! | `wrap` | what lies beyond 0 and 1 | |
//! | `filter` | what lies between the middles of texels | |
//! | `factor` | what colours are multiplied by, per channel | ≥ 0 |
//!
//! (0, 0) is the lower left corner of the image, (1, 1) the upper right one. Texels have their colour in their middle: that of
//! column i of n at (i + 1/2)/n. Bytes stay bytes, with a table of what they mean: three for a texel, whatever the size.

use std::fmt;
use std::sync::Arc;
use vitrum_math::{DVec2, Rgb};

/// An image with everything resolved.
#[derive(Clone, PartialEq)]
pub struct Image {
    name: String,
    width: u32,
    height: u32,
    texels: Texels,
    mean: Rgb,
    brightest: Rgb,
}

/// Rows from the top, each from the left.
#[derive(Clone, PartialEq)]
enum Texels {
    /// And the number that each byte stands for.
    Bytes(Vec<[u8; 3]>, Box<[f64; 256]>),
    Numbers(Vec<[f32; 3]>),
}

/// What the numbers of an image with whole steps mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Encoding {
    /// Colours for a display: the transfer function of sRGB.
    Srgb,
    /// In proportion to light.
    Linear,
}

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The colours of the edge.
    Clamp,
    /// The image mirrored, and again.
    Mirror,
}

/// What lies between the middles of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// A mixture of four, linear along each axis.
    Bilinear,
}

/// An image on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageTexture {
    /// The texels.
    pub image: Arc<Image>,
    /// How often it repeats from 0 to 1 of u and of v; negative mirrors.
    pub scale: DVec2,
    /// The place in the image of u = v = 0.
    pub offset: DVec2,
    /// Beyond its edges.
    pub wrap: Wrap,
    /// Between its texels.
    pub filter: Filter,
    /// What its colours are multiplied by.
    pub factor: Rgb,
}

/// Texels that make no image.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidImage {
    /// No texels, or not as many as the size says.
    #[error("an image of {width} × {height} pixels has {found} of them")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Texels given.
        found: usize,
    },
    /// Texels that are no colours.
    #[error(
        "pixels that are negative or not finite: {count}, the first in column {column} and row {row} from the top left, {value:?}"
    )]
    Texels {
        /// How many.
        count: usize,
        /// Column of the first, from 0.
        column: usize,
        /// Its row, from 0 at the top.
        row: usize,
        /// What it holds.
        value: [f32; 3],
    },
}

/// The transfer function of sRGB from a share of full scale to linear light (IEC 61966-2-1).
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

impl Encoding {
    /// The linear value of a share of full scale.
    pub fn decode(self, share: f64) -> f64 {
        match self {
            Self::Srgb => srgb_to_linear(share),
            Self::Linear => share,
        }
    }
}

impl Image {
    /// An image of bytes, in rows from the top. `name` is what it is called in messages.
    ///
    /// # Errors
    /// [`InvalidImage`] unless there are as many texels as the size says, and some.
    pub fn from_bytes(
        name: impl Into<String>,
        size: [u32; 2],
        texels: Vec<[u8; 3]>,
        encoding: Encoding,
    ) -> Result<Self, InvalidImage> {
        let [width, height] = checked(size, texels.len())?;
        let linear = Box::new(std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0)));
        let mut counts = [[0_u64; 256]; 3];
        for texel in &texels {
            for (counts, byte) in counts.iter_mut().zip(texel) {
                counts[*byte as usize] += 1;
            }
        }
        let sum = |channel: usize| -> f64 {
            counts[channel].iter().zip(&linear[..]).map(|(count, value)| *count as f64 * value).sum()
        };
        let mean = Rgb::new(sum(0), sum(1), sum(2)) / texels.len() as f64;
        let most = |channel: usize| linear[counts[channel].iter().rposition(|n| *n > 0).unwrap_or(0)];
        let brightest = Rgb::new(most(0), most(1), most(2));
        let texels = Texels::Bytes(texels, linear);
        Ok(Self { name: name.into(), width, height, texels, mean, brightest })
    }

    /// An image of linear colours, in rows from the top. `name` is what it is called in messages.
    ///
    /// # Errors
    /// [`InvalidImage`] unless there are as many texels as the size says, and some, all finite and not negative.
    pub fn from_numbers(
        name: impl Into<String>,
        size: [u32; 2],
        texels: Vec<[f32; 3]>,
    ) -> Result<Self, InvalidImage> {
        let [width, height] = checked(size, texels.len())?;
        let is_bad = |texel: &[f32; 3]| !texel.iter().all(|c| c.is_finite() && *c >= 0.0);
        if let Some(first) = texels.iter().position(is_bad) {
            let count = texels.iter().filter(|t| is_bad(t)).count();
            let (row, column) = (first / width as usize, first % width as usize);
            return Err(InvalidImage::Texels { count, column, row, value: texels[first] });
        }
        let (mut sum, mut brightest) = (Rgb::ZERO, Rgb::ZERO);
        for texel in &texels {
            let colour = linear(*texel);
            sum += colour;
            brightest = brightest.max(colour);
        }
        let mean = sum / texels.len() as f64;
        Ok(Self { name: name.into(), width, height, texels: Texels::Numbers(texels), mean, brightest })
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Width and height, texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The mean of all texels.
    pub fn mean(&self) -> Rgb {
        self.mean
    }

    /// The largest value of each channel.
    pub fn brightest(&self) -> Rgb {
        self.brightest
    }

    /// Bytes on the heap, but for the name.
    pub fn memory(&self) -> usize {
        match &self.texels {
            Texels::Bytes(texels, linear) => size_of_val(&**texels) + size_of_val(&**linear),
            Texels::Numbers(texels) => size_of_val(&**texels),
        }
    }

    /// The colour of the texel in a column from the left and a row from the *bottom*.
    fn texel(&self, column: u32, row: u32) -> Rgb {
        let at = (self.height - 1 - row) as usize * self.width as usize + column as usize;
        match &self.texels {
            Texels::Bytes(texels, linear) => Rgb::from_array(texels[at].map(|byte| linear[byte as usize])),
            Texels::Numbers(texels) => linear(texels[at]),
        }
    }
}

impl fmt::Debug for Image {
    /// Not the texels: there are millions.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, width, height, .. } = self;
        write!(f, "Image({name:?}, {width} × {height}, {:?})", self.mean)
    }
}

fn linear(texel: [f32; 3]) -> Rgb {
    Rgb::from_array(texel.map(f64::from))
}

fn checked([width, height]: [u32; 2], found: usize) -> Result<[u32; 2], InvalidImage> {
    let is_right = found > 0 && u64::from(width) * u64::from(height) == found as u64;
    if is_right { Ok([width, height]) } else { Err(InvalidImage::Size { width, height, found }) }
}

impl Wrap {
    /// The texel of `count` that stands in for the one at `index`.
    fn place(self, index: i64, count: u32) -> u32 {
        let n = i64::from(count);
        let place = match self {
            Self::Repeat => index.rem_euclid(n),
            Self::Clamp => index.clamp(0, n - 1),
            Self::Mirror => {
                let there_and_back = index.rem_euclid(2 * n);
                there_and_back.min(2 * n - 1 - there_and_back)
            }
        };
        place as u32
    }
}

impl ImageTexture {
    /// The whole image once, as it is.
    pub fn new(image: Arc<Image>) -> Self {
        let (scale, offset) = (DVec2::ONE, DVec2::ZERO);
        Self { image, scale, offset, wrap: Wrap::Repeat, filter: Filter::Bilinear, factor: Rgb::ONE }
    }

    /// The colour at texture coordinates; those that are not finite count as zero.
    // Never inlined: most scenes have no images, and must not carry this through their loop.
    #[inline(never)]
    pub fn at(&self, uv: DVec2) -> Rgb {
        let size = DVec2::new(f64::from(self.image.width), f64::from(self.image.height));
        let place = (uv * self.scale + self.offset) * size;
        let place = if place.is_finite() { place } else { DVec2::ZERO };
        let colour = match self.filter {
            Filter::Nearest => self.texel(libm::floor(place.x) as i64, libm::floor(place.y) as i64),
            Filter::Bilinear => {
                let (x, y) = (place.x - 0.5, place.y - 0.5);
                let (left, below) = (libm::floor(x), libm::floor(y));
                let (i, j) = (left as i64, below as i64);
                let (next_i, next_j) = (i.saturating_add(1), j.saturating_add(1));
                let lower = mixed(self.texel(i, j), self.texel(next_i, j), x - left);
                let upper = mixed(self.texel(i, next_j), self.texel(next_i, next_j), x - left);
                mixed(lower, upper, y - below)
            }
        };
        colour * self.factor
    }

    fn texel(&self, column: i64, row: i64) -> Rgb {
        let Image { width, height, .. } = *self.image;
        self.image.texel(self.wrap.place(column, width), self.wrap.place(row, height))
    }

    /// The mean of what it shows.
    pub fn mean(&self) -> Rgb {
        self.image.mean * self.factor
    }

    /// The largest value of each channel.
    pub fn brightest(&self) -> Rgb {
        self.image.brightest * self.factor
    }
}

/// From `a` to `b`; of equal colours exactly these.
fn mixed(a: Rgb, b: Rgb, share: f64) -> Rgb {
    a + (b - a) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red says the column and green the row from the top, in steps of 1/4.
    fn four_by_four() -> ImageTexture {
        let texels = (0..16_u8).map(|i| [f32::from(i % 4) / 4.0, f32::from(i / 4) / 4.0, 0.0]).collect();
        ImageTexture::new(Arc::new(Image::from_numbers("test", [4, 4], texels).expect("valid")))
    }

    fn rg(texture: &ImageTexture, u: f64, v: f64) -> (f64, f64) {
        let colour = texture.at(DVec2::new(u, v));
        (colour.x, colour.y)
    }

    #[test]
    fn texels_have_their_colours_in_their_middles_and_rows_count_from_the_top() {
        let bilinear = four_by_four();
        let nearest = ImageTexture { filter: Filter::Nearest, ..bilinear.clone() };
        for column in 0..4 {
            for row in 0..4 {
                let (u, v) = ((f64::from(column) + 0.5) / 4.0, 1.0 - (f64::from(row) + 0.5) / 4.0);
                let expected = (f64::from(column) / 4.0, f64::from(row) / 4.0);
                assert_eq!(rg(&bilinear, u, v), expected);
                assert_eq!(rg(&nearest, u, v), expected);
            }
        }
        // Halfway between two columns, two rows, four texels, and a quarter of the way.
        assert_eq!(rg(&bilinear, 0.25, 0.875), (0.125, 0.0));
        assert_eq!(rg(&bilinear, 0.125, 0.75), (0.0, 0.125));
        assert_eq!(rg(&bilinear, 0.5, 0.5), (0.375, 0.375));
        assert_eq!(rg(&bilinear, 0.1875, 0.875), (0.0625, 0.0));
        assert_eq!(rg(&nearest, 0.26, 0.74), (0.25, 0.25));
        assert_eq!(rg(&nearest, 0.24, 0.76), (0.0, 0.0));
    }

    #[test]
    fn beyond_the_edges_it_repeats_ends_or_turns_back() {
        let with = |wrap: Wrap| ImageTexture { wrap, filter: Filter::Nearest, ..four_by_four() };
        let row = |texture: &ImageTexture| -> Vec<f64> {
            (-6..10).map(|i| 4.0 * rg(texture, (f64::from(i) + 0.5) / 4.0, 0.875).0).collect()
        };
        let repeat = [2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1].map(f64::from);
        let clamp = [0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3].map(f64::from);
        let mirror = [2, 3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0, 1].map(f64::from);
        for (wrap, expected) in [(Wrap::Repeat, repeat), (Wrap::Clamp, clamp), (Wrap::Mirror, mirror)] {
            assert_eq!(row(&with(wrap)), expected, "{wrap:?}");
        }
        // At the seam, bilinear filtering mixes what lies on both sides of it.
        let seam = |wrap: Wrap| 4.0 * rg(&ImageTexture { wrap, ..four_by_four() }, 1.0, 0.875).0;
        assert_eq!([Wrap::Repeat, Wrap::Clamp, Wrap::Mirror].map(seam), [1.5, 3.0, 3.0]);
    }

    #[test]
    fn scale_repeats_offset_moves_and_the_factor_multiplies() {
        let texture = ImageTexture {
            scale: DVec2::new(2.0, -1.0),
            offset: DVec2::new(0.25, 1.0),
            factor: Rgb::new(8.0, 4.0, 1.0),
            ..four_by_four()
        };
        // u = 0.0625 is 0.375 in the image, the second column; v = 0.125 is 0.875, the first row.
        assert_eq!(rg(&texture, 0.0625, 0.125), (2.0, 0.0));
        assert_eq!(rg(&texture, 0.5625, 0.375), (2.0, 1.0));
        assert_eq!(texture.brightest(), Rgb::new(6.0, 3.0, 0.0));
        assert_eq!(texture.mean(), Rgb::new(3.0, 1.5, 0.0));
    }

    #[test]
    fn any_place_has_a_colour_of_the_image() {
        for filter in [Filter::Nearest, Filter::Bilinear] {
            for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
                let texture = ImageTexture { filter, wrap, scale: DVec2::splat(1e12), ..four_by_four() };
                let far = [0.0, -0.0, 1e-300, -1e-300, 0.1, -7.3, 1e9, -1e17, 1e300, f64::MAX];
                let lost = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
                for u in far.into_iter().chain(lost) {
                    for v in far.into_iter().chain(lost) {
                        let (r, g) = rg(&texture, u, v);
                        assert!((0.0..=0.75).contains(&r) && (0.0..=0.75).contains(&g), "{u} {v}");
                    }
                }
            }
        }
    }

    /// The published function, at its foot, its joint, in the middle and at the top.
    #[test]
    fn bytes_of_srgb_mean_what_the_standard_says() {
        let cases = [
            (0, 0.0, 0.0),
            (1, 0.000_303_526_983_548_837_5, 1e-18),
            (10, 0.003_035_269_835_488_375, 1e-17),
            (11, 0.003_346_535_763_899_158_5, 1e-17),
            (128, 0.215_860_500_113_899_18, 1e-15),
            (188, 0.502_886_458_032_568_4, 1e-15),
            (255, 1.0, 0.0),
        ];
        for (byte, expected, tolerance) in cases {
            let texels = vec![[byte; 3]];
            let image = Image::from_bytes("one", [1, 1], texels.clone(), Encoding::Srgb).expect("valid");
            let found = ImageTexture::new(Arc::new(image)).at(DVec2::ZERO).x;
            assert!((found - expected).abs() <= tolerance, "{byte}: {found}");
            let linear = Image::from_bytes("one", [1, 1], texels, Encoding::Linear).expect("valid");
            assert_eq!(linear.mean(), Rgb::splat(f64::from(byte) / 255.0));
            assert_eq!(linear.brightest(), linear.mean());
        }
    }

    #[test]
    fn what_is_no_image_is_refused() {
        let size = Image::from_numbers("none", [0, 5], vec![]).expect_err("no pixels");
        assert_eq!(size.to_string(), "an image of 0 × 5 pixels has 0 of them");
        assert!(Image::from_bytes("few", [2, 2], vec![[0; 3]; 3], Encoding::Linear).is_err());
        for bad in [f32::NAN, f32::INFINITY, -1e-30] {
            let mut texels = vec![[0.5; 3]; 6];
            texels[4][1] = bad;
            texels[5][0] = bad;
            let refused = Image::from_numbers("bad", [3, 2], texels).expect_err("refused");
            let InvalidImage::Texels { count, column, row, .. } = refused else { panic!("{refused}") };
            assert_eq!((count, column, row), (2, 1, 1), "{refused}");
        }
    }
}
