//! How a scene is rendered, apart from what is in it.

/// What glass does to shadow rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ShadowMode {
    /// It blocks them, like everything else.
    #[default]
    Opaque,
    /// They go straight through, undeflected, and lose what each surface does not transmit. Biased: real light is refracted.
    Straight,
}

/// A part of the image, in pixels from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns, at least one.
    pub width: u32,
    /// Rows, at least one.
    pub height: u32,
}

/// How a scene is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Width and height of the whole image, pixels.
    pub size: [u32; 2],
    /// The part that is rendered; its pixels are the same bytes as in the whole image.
    pub crop: Option<Crop>,
    /// Samples per pixel.
    pub spp: u32,
    /// A ray deeper than this is not traced; the camera ray has depth 0.
    pub max_depth: u32,
    /// A child ray is not traced when the largest channel of its weight, corrected for the radiance factor of the media, is
    /// below this. What is given up is summed and reported. Zero: never.
    pub cutoff: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// What glass does to shadow rays.
    pub shadow: ShadowMode,
    /// Threads; zero for as many as the machine has. No effect on the image.
    pub threads: usize,
    /// Edge of the squares that threads work on, pixels. No effect on the image.
    pub tile: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: [640, 480],
            crop: None,
            spp: 16,
            max_depth: 10,
            cutoff: 1e-3,
            seed: 0,
            shadow: ShadowMode::Opaque,
            threads: 0,
            tile: 16,
        }
    }
}

impl Settings {
    /// The part of the image that is rendered.
    pub fn area(&self) -> Crop {
        self.crop.unwrap_or(Crop { x: 0, y: 0, width: self.size[0], height: self.size[1] })
    }
}
