//! Scenes whose picture is known in closed form, through the whole pipeline: camera, geometry, materials, ray tree, film.
//! Every expected number comes from a formula or a published table, none from this program.

mod bubble;
mod chain;
mod constant_furnace;
mod critical_angle;
mod environment_light;
mod estimate;
mod explained;
mod features;
mod filters;
mod invisible;
mod mesh_sphere;
mod nested_media;
mod path_agreement;
mod path_closed_forms;
mod prism;
mod reference;
mod rounds;
mod slab;
mod stage;
