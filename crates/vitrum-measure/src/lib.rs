//! How far pictures are from their reference, and what a series of such errors says.
//!
//! - [`difference`]: RMSE, relMSE, MAPE and bias of a picture against its reference.
//! - [`flip`](mod@flip): the difference that somebody sees who flips between two pictures (ꟻLIP).
//! - [`curve`]: error against seconds: when an error is reached, how steeply it falls.
//! - [`bootstrap`]: intervals of a mean, where nothing is known of how it is distributed.
//!
//! Pictures are slices of pixels, of linear Rec.709 radiance or of the bytes of a display. Everything is a function of what it is
//! given: no files, no clock.

pub mod bootstrap;
pub mod curve;
pub mod difference;
pub mod flip;

pub use bootstrap::{Interval, interval_of_mean};
pub use curve::{Curve, Reached};
pub use difference::Difference;
pub use flip::{flip, mean};
