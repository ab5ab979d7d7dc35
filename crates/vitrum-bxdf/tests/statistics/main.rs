//! The models that have a density: do their samplers follow it, is it one, and is what they return what they claim?
//!
//! All directions are in the local frame. Every test that asks a random number shares its level with the others of its
//! kind, so that a right model fails once in a thousand seeds, and the seeds are fixed.

mod chi_square;
mod densities;
mod energy;
mod reciprocity;
mod stage;
mod weights;
