//! Materials: parameters and textures that give a scattering model at a point.
//!
//! Knows shapes only as points with normals, and neither lights nor files. A [`Material`] is what a scene names; at a point it
//! becomes [`Scattering`]: what the surface emits, what it makes of ambient light, and the models of `vitrum-bxdf` that
//! answer for everything else.

mod absorption;
mod image;
mod index;
mod material;
mod medium;
mod metal;
mod metal_table;
mod named_medium;
mod scattering;
mod texture;

pub use absorption::{Absorption, InvalidAbsorption};
pub use image::{Encoding, Filter, Image, ImageTexture, InvalidImage, Wrap, srgb_to_linear};
pub use index::{IndexOfRefraction, InvalidIndex};
pub use material::{Dielectric, Material, Phong, Transparent};
pub use medium::{Boundary, Media, Medium};
pub use metal::Metal;
pub use named_medium::NamedMedium;
pub use scattering::Scattering;
pub use texture::{Axes, Checker, Place, Texture};
