//! Scattering models: what light does where it meets a surface, and nothing else.
//!
//! Knows nothing of world space, shapes, textures or any other vitrum crate; `no_std`; generic over `f32` and `f64`.
//!
//! # The local frame
//!
//! ```text
//!            z = shading normal, outward
//!            |        wo: towards where the light goes (known: the camera's side)
//!   wi       |       /
//!     \      |      /        both point away from the surface and are unit length
//!      \     |     /
//!       \    |    /     z > 0: outside ("above")
//!  ----------+----------------------------------------
//!                       z < 0: inside ("below")
//! ```
//!
//! # The contract
//!
//! - [`Bxdf::sample`] chooses `wi` and returns the **weight** `f · |cos θi| / pdf`, which is finite for perfectly
//!   specular models too: no cosine is divided out and multiplied back.
//! - [`Bxdf::eval`] returns `f · |cos θi|`, per steradian; zero for specular models, whose density is discrete.
//! - [`Bxdf::pdf`] is the density of `sample` per steradian of `wi`; zero for specular models.
//! - [`Bxdf::split`] returns both specular children at once, for walkers of ray trees; no random numbers.
//! - `eta = eta_t / eta_i` along the path: the index on the transmitted side over that on the incident side.
//! - The radiance factor (η_i/η_t)² of a crossing is applied in one place, [`TransportMode::crossing_scale`].
//!
//! ```
//! use glam::DVec3;
//! use vitrum_bxdf::{Interface, PerfectTransmitter, TransportMode};
//!
//! // The lecture's glass: one tenth reflected, nine tenths transmitted, from air into n = 1.5.
//! let interface = Interface::new(1.0_f64, 1.5).expect("both indices are positive and finite");
//! let glass = PerfectTransmitter { kr: DVec3::splat(0.1), kt: DVec3::splat(0.9), interface };
//! let split = glass.split(DVec3::Z, TransportMode::Radiance);
//! let through = split.transmitted.expect("no total reflection from outside");
//! assert_eq!(through.wi, -DVec3::Z);
//! assert!((through.weight.x - 0.9 / 2.25).abs() < 1e-15);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "std"))]
extern crate std;

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("vitrum-bxdf needs the feature `std` or, on targets without the standard library, `libm`");

/// The vectors of this crate's interface.
pub use glam;

mod bxdf;
mod compensation;
mod conductor;
mod fresnel;
mod fresnel_dielectric;
mod ggx;
mod glossy_specular;
mod interface;
mod lambertian;
mod perfect_specular;
mod perfect_transmitter;
mod real;
mod rough_dielectric;
mod sample;
mod thin_dielectric;
mod valid;

pub use bxdf::Bxdf;
pub use conductor::Conductor;
pub use fresnel::{ComplexIndex, ComplexIndexError, Reflectance};
pub use fresnel_dielectric::FresnelDielectric;
pub use ggx::{Ggx, RoughnessError};
pub use glossy_specular::GlossySpecular;
pub use interface::{IndexError, Interface, Refraction};
pub use lambertian::Lambertian;
pub use perfect_specular::PerfectSpecular;
pub use perfect_transmitter::PerfectTransmitter;
pub use real::{Real, Vector};
pub use rough_dielectric::RoughDielectric;
pub use sample::{Density, Lobe, Sample, Split, TransportMode};
pub use thin_dielectric::ThinDielectric;
