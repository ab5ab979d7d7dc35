//! The models with microscopic normals, rough glass and rough metal: do the samplers follow their densities, is energy
//! kept, do both directions of transport agree, and what happens in the limits?

mod chi_square;
mod energy;
mod limits;
mod reciprocity;
mod stage;
