//! What the tests of the vitrum crates measure with: statistics for samplers.
//!
//! - [`chi_square`]: do the directions of a sampler follow the density that it claims?
//! - [`z_test()`]: is a measured mean the expected one, given its standard error?
//! - [`sphere`]: cells of the unit sphere, and integrals over them.
//! - [`significance`]: p-values, and the correction for asking many questions at once.
//! - [`environment`]: where the test assets are, and whether expected outputs are to be rewritten.
//! - [`uniform`]: the random numbers that feed a sampler under test.
//!
//! Everything takes closures and plain slices, so that any model can be measured. Directions are unit
//! vectors, z is the polar axis, densities are per steradian. Every test is a pure function of its seed: a test
//! that passed will pass again.

pub mod chi_square;
pub mod environment;
pub mod significance;
pub mod sphere;
pub mod uniform;
pub mod z_test;

pub use chi_square::{ChiSquare, chi_square_of_directions};
pub use environment::{assets, blessing, files_with_extension, times};
pub use significance::sidak_level;
pub use sphere::{SphereGrid, integrate_sphere};
pub use uniform::Uniform;
pub use z_test::{Moments, ZTest, z_test};
