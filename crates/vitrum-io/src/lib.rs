//! Files in and out: scenes, meshes and images, and what is wrong with them.
//!
//! The only crate that touches files. The path of the data:
//!
//! ```text
//! scene.toml --scene::parse--> SceneDesc --load--> tracer::Scene --render--> Film --image::write--> .exr, .png
//! model.obj  --obj::read-----> MeshData  --load--^                   Film <--checkpoint--> .checkpoint
//! ```
//!
//! Whatever a file says is checked here, once, and every problem is told with its place ([`diagnostic`]).

mod atomic;
pub mod checkpoint;
pub mod diagnostic;
pub mod image;
pub mod load;
pub mod obj;
pub mod scene;
