//! Media, textures and materials.

use std::path::PathBuf;

use vitrum_materials::{Encoding, Filter, Metal, Wrap};
use vitrum_math::{DVec2, DVec3, Rgb};

use super::Name;
use crate::diagnostic::Span;

/// A medium that objects can lie in.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Its name.
    pub name: Name,
    /// Absolute index of refraction, 0.1 to 10.
    pub ior: f64,
    /// What it absorbs.
    pub absorption: Absorption,
}

/// What a medium absorbs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Absorption {
    /// Nothing.
    #[default]
    Clear,
    /// So much per metre.
    PerMetre(Rgb),
    /// So much that a share is left after a distance.
    Transmittance {
        /// More than 0, at most 1.
        share: Rgb,
        /// Metres.
        distance: f64,
    },
}

/// What is inside of a dielectric.
#[derive(Clone, Debug, PartialEq)]
pub enum Index {
    /// A medium with this absolute index.
    Absolute(f64),
    /// A medium with this index over that of the medium outside.
    Relative(f64),
    /// One of the scene's media.
    Medium(Name),
}

/// What is around glass.
#[derive(Clone, Debug, PartialEq)]
pub enum Around {
    /// Whatever is there; where solids overlap, the one of the highest priority fills the space.
    Anything {
        /// 0 to 1000.
        priority: i16,
    },
    /// This medium: the surface is an interface to it.
    Medium(Name),
}

impl Default for Around {
    fn default() -> Self {
        Self::Anything { priority: 0 }
    }
}

/// A colour that varies in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The table's header.
    pub span: Span,
    /// Its name.
    pub name: Name,
    /// How it varies.
    pub pattern: Pattern,
}

/// How a texture varies.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// Cells of two colours in turn.
    Checker {
        /// Colour of the cell from `origin` to `origin + size`.
        even: Rgb,
        /// Colour of its neighbours.
        odd: Rgb,
        /// Edge of a cell, metres.
        size: f64,
        /// A corner of a cell, metres.
        origin: DVec3,
        /// Along which of x, y and z cells alternate; at least one.
        axes: [bool; 3],
    },
    /// An image.
    Image {
        /// As written: relative to the scene file.
        file: PathBuf,
        /// Where the path stands.
        file_span: Span,
        /// How often it repeats from 0 to 1 of u and of v; none is zero.
        scale: DVec2,
        /// The place in the image of u = v = 0.
        offset: DVec2,
        /// What lies beyond its edges.
        wrap: Wrap,
        /// What lies between the middles of pixels.
        filter: Filter,
        /// What its numbers mean; none is what the format of the file says.
        encoding: Option<Encoding>,
        /// What its colours are multiplied by, 0 or more.
        factor: Rgb,
    },
}

/// A colour, or the name of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum ColourOrTexture {
    /// The same everywhere.
    Colour(Rgb),
    /// By this texture.
    Texture(Name),
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The table's header, or the whole of a material written at its object.
    pub span: Span,
    /// Its name; none for a material written at its object.
    pub name: Option<Name>,
    /// How it scatters.
    pub model: Model,
}

/// How a material scatters.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// Evenly to all sides.
    Matte {
        /// 0 to 1.
        color: ColourOrTexture,
        /// Share of ambient light, 0 to 1.
        ka: f64,
        /// Diffuse share, 0 to 1.
        kd: f64,
    },
    /// With a highlight.
    Phong(Phong),
    /// Phong and a mirror.
    Reflective {
        /// What it is beside the mirror.
        phong: Phong,
        /// Share mirrored, 0 to 1.
        kr: Rgb,
    },
    /// Clear with constant shares.
    Transparent {
        /// What it is beside clear.
        phong: Phong,
        /// Share mirrored, 0 to 1.
        kr: Rgb,
        /// Share let through, 0 to 1.
        kt: Rgb,
        /// Index of refraction, inside over outside, 0.001 to 1000.
        ior: f64,
        /// What is around it, and what `ior` is relative to.
        around: Around,
    },
    /// Clear by Fresnel's equations.
    Dielectric {
        /// What is inside.
        inside: Index,
        /// What is around it.
        around: Around,
        /// Alpha, 0 to 1.
        roughness: f64,
        /// Whether the energy of repeated scattering is made up for.
        compensation: bool,
        /// What is absorbed inside, unless a medium of the scene says so.
        absorption: Absorption,
    },
    /// A sheet of glass without thickness.
    Thin {
        /// Absolute index of the sheet, 0.001 to 1000.
        ior: f64,
        /// What is on both sides; none is the scene's medium.
        outside: Option<Name>,
        /// Share that crossing it at a right angle leaves, 0 to 1.
        transmittance: Rgb,
    },
    /// Metal.
    Conductor {
        /// Its index.
        index: MetalIndex,
        /// What is outside; none is the scene's medium.
        outside: Option<Name>,
        /// Alpha, 0 to 1.
        roughness: f64,
    },
    /// Shining.
    Emissive {
        /// W/(m² sr)
        radiance: ColourOrTexture,
    },
}

/// Which index a metal has, against vacuum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetalIndex {
    /// That of a metal with a name.
    Named(Metal),
    /// Given in numbers.
    Given {
        /// Real part.
        n: Rgb,
        /// Imaginary part.
        k: Rgb,
    },
}

/// Ambient, diffuse and glossy part.
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Of the ambient and diffuse part, 0 to 1.
    pub color: ColourOrTexture,
    /// Share of ambient light, 0 to 1.
    pub ka: f64,
    /// Diffuse share, 0 to 1.
    pub kd: f64,
    /// Strength of the highlight, 0 to 1.
    pub ks: f64,
    /// Sharpness of the highlight, 1 to 1e6.
    pub exponent: f64,
}
