//! Scattering models: what light does where it meets a surface, and nothing else. Glass above all: smooth, thin and rough
//! dielectrics, exact to the last digits in `f32` and `f64`, with metals, mirrors, diffuse surfaces and highlights beside it.
//!
//! Knows nothing of world space, shapes, textures, lights or any other crate of a renderer; `no_std`; plain values that live
//! on the stack; no allocation. In any renderer, a hit becomes a few lines (see [From this to a renderer](#from-this-to-a-renderer)).
//!
//! ```
//! use vitrum_bxdf::glam::DVec3;
//! use vitrum_bxdf::{Bxdf, FresnelDielectric, Interface, TransportMode};
//!
//! // Glass: air above the surface (outside), index 1.5 below it (inside).
//! let glass = Bxdf::FresnelDielectric(FresnelDielectric { interface: Interface::new(1.0_f64, 1.5)? });
//!
//! // Both children of a ray that arrives along the normal, for a tree...
//! let split = glass.split(DVec3::Z, TransportMode::Radiance);
//! let (reflected, transmitted) = (split.reflected.unwrap(), split.transmitted.unwrap());
//! assert!((reflected.weight.x - 0.04).abs() < 1e-15);
//! // Radiance is squeezed by 1/1.5² on its way in (and gets it back on the way out).
//! assert!((transmitted.weight.x - 0.96 / 2.25).abs() < 1e-15);
//! assert_eq!(transmitted.wi, -DVec3::Z);
//!
//! // ... or one of them, for a path: 0.5 is a random number in [0, 1), beyond the 4 % that are reflected.
//! let sample = glass.sample(DVec3::Z, 0.5, [0.2, 0.8], TransportMode::Radiance).unwrap();
//! assert_eq!(sample.wi, -DVec3::Z);
//! # Ok::<(), vitrum_bxdf::IndexError>(())
//! ```
//!
//! # Conventions
//!
//! ```text
//!            z = shading normal, outward
//!            |        wo: towards where the light goes (known: the camera's side)
//!   wi       |       /
//!     \      |      /        both point away from the surface and are unit length
//!      \     |     /
//!       \    |    /     z > 0: outside ("above"), the first index of an Interface
//!  ----------+----------------------------------------
//!            |    \     z < 0: inside ("below"), the second index
//!            |     \
//!            |      wi of transmitted light
//! ```
//!
//! - Directions are in this local frame; x and y are tangents, which matter to anisotropic roughness only. z = 0 counts as
//!   above.
//! - A direction must be of unit length (to 1e-3, squared) and finite: in debug builds anything else panics, in release
//!   builds the answer is garbage. For unit directions every answer is finite, also along the normal, along the surface,
//!   and for components that are zero of either sign or subnormal.
//! - `wi` is where light comes from. It is sampled, with density [`Density::SolidAngle`] per steradian or, for perfectly
//!   specular lobes, with probability [`Density::Discrete`]: the type keeps them apart.
//! - [`Bxdf::sample`] returns the **weight** f · |cos θi| / pdf. It is finite for perfectly specular lobes too: no cosine is
//!   divided out and multiplied back.
//! - [`Bxdf::eval`] returns f · |cos θi|, [`Bxdf::pdf`] the density of `sample`; both are zero for discrete lobes.
//! - [`Bxdf::split`] returns both children of a perfectly specular surface, without random numbers.
//! - `eta = eta_t / eta_i`: the index on the transmitted side over that on the incident side, along the path; one where
//!   nothing is crossed. Roulette on throughput should not count the radiance factor: multiply by eta² of each crossing.
//! - [`TransportMode`] says what a path carries. Radiance, along a path from the camera, is scaled by 1/eta² at each
//!   crossing, importance, along a path from a light, is not; in one place, [`TransportMode::crossing_scale`].
//! - Colours are linear, three channels, in the vector type of the scalar: `glam::Vec3` or `glam::DVec3`.
//!
//! # Models
//!
//! Each has a module of its own, whose page is its manual: what it models, parameters with ranges, formulas, sources.
//!
//! | model | densities | energy | reciprocal |
//! |---|---|---|---|
//! | [`Lambertian`] | continuous | reflectance | yes |
//! | [`GlossySpecular`] | continuous | unnormalised: at most 2π ks/(exponent + 1); normalised: at most the reflectance | yes |
//! | [`PerfectSpecular`] | discrete | kr | yes |
//! | [`PerfectTransmitter`] | discrete | kr + kt; one in total reflection | with n² |
//! | [`FresnelDielectric`] | discrete | one, exactly | with n² |
//! | [`ThinDielectric`] | discrete | one when clear, less what it absorbs | yes |
//! | [`RoughDielectric::new`] | continuous, discrete when smooth | one within 5e-3 at any angle, 1e-3 on average ([where](rough_dielectric)) | adjoint: importance is the transpose of radiance |
//! | [`RoughDielectric::single_scattering`] | continuous, discrete when smooth | at most one | with n² |
//! | [`Conductor`] | continuous, discrete when smooth | at most Fresnel's reflectance | yes |
//!
//! "With n²": f(wo, wi)/n(wo)² = f(wi, wo)/n(wi)² for radiance, as for every refracting surface.
//!
//! [`Interface`] is the pair of indices and the one function that refracts; [`Interface::reflectance`] has Fresnel's
//! equations for both polarisations; [`ComplexIndex`] those of metals; [`Ggx`] is the distribution of microscopic normals.
//! They are public because renderers need them elsewhere too: for shadow rays, for manifold walks, for plots.
//!
//! # From this to a renderer
//!
//! At a hit, with `n` the outward normal (never turned towards the viewer), `d` the ray's direction, and random numbers:
//!
//! ```
//! # use vitrum_bxdf::{Bxdf, Density, TransportMode};
//! # use vitrum_bxdf::glam::DVec3;
//! # fn hit(bxdf: &Bxdf<f64>, d: DVec3, n: DVec3, random: [f64; 3], throughput: &mut DVec3) -> Option<DVec3> {
//! let (x, y) = n.any_orthonormal_pair();
//! let wo = DVec3::new(-d.dot(x), -d.dot(y), -d.dot(n));
//! let sample = bxdf.sample(wo, random[0], [random[1], random[2]], TransportMode::Radiance)?;
//! *throughput *= sample.weight;
//! let next = x * sample.wi.x + y * sample.wi.y + n * sample.wi.z;
//! # Some(next)
//! # }
//! ```
//!
//! - Leave the surface on the side that `sample.lobe` says ([`Lobe::is_transmission`]), not by the sign of a rounded cosine.
//! - Lights: where [`Bxdf::is_specular`] is false, add `bxdf.eval(wo, wi, mode)` times the light's radiance over its density,
//!   and combine both ways of finding a light by the densities of `pdf` and the light (multiple importance sampling). A
//!   light found by a discrete sample counts in full.
//! - Nested media, absorption and dispersion are the renderer's: build the [`Interface`] from the two media that meet at the
//!   hit, and multiply by the transmittance of each segment.
//! - `examples/glass_sphere.rs` is a path tracer of sixty lines on this crate alone.
//!
//! # Features
//!
//! - `std` (default): square roots of the standard library.
//! - `libm`: square roots of the `libm` crate, for targets without a standard library. The results are the same: square roots
//!   are exact, and all other functions come from `libm` either way, so that every machine computes the same bits.
//!
//! The table of energy compensation, 246 kB of static data, is computed by the build script in a few seconds. [`glam`] is
//! re-exported, so that versions agree.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "std"))]
extern crate std;

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("vitrum-bxdf needs the feature `std` or, on targets without the standard library, `libm`");

/// The vectors of this crate's interface.
pub use glam;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod bxdf;
mod compensation;
pub mod conductor;
pub mod fresnel;
pub mod fresnel_dielectric;
pub mod ggx;
pub mod glossy_specular;
pub mod interface;
pub mod lambertian;
pub mod perfect_specular;
pub mod perfect_transmitter;
mod real;
pub mod rough_dielectric;
mod sample;
pub mod thin_dielectric;
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
