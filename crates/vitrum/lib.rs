//! vitrum renders glass, accurately and fast.
//!
//! This crate is the front door: it re-exports the library crates under short names. Each can be used alone; the lower, the
//! freer of dependencies.
//!
//! | module | crate | what it is for |
//! |---|---|---|
//! | [`math`] | `vitrum-math` | rays, transforms, frames, rounding errors, sample addresses |
//! | [`bxdf`] | `vitrum-bxdf` | scattering models; no dependency on any other crate here |
//! | [`geometry`] | `vitrum-geometry` | shapes, meshes, mesh health, ray queries |
//! | [`materials`] | `vitrum-materials` | materials and textures |
//! | [`tracer`] | `vitrum-tracer` | scene, plan, camera, film, lights, ray tree |
//! | [`measure`] | `vitrum-measure` | errors of images, curves of error against seconds |
//! | [`io`] | `vitrum-io` | scene files, OBJ, images |
//!
//! A glass sphere in front of a white sky, in memory:
//!
//! ```
//! use vitrum::bxdf::Ggx;
//! use vitrum::geometry::{Object, Shape, shape::Sphere};
//! use vitrum::materials::{Dielectric, IndexOfRefraction, Material, Media, Medium};
//! use vitrum::math::{DVec3, Rgb, Transform};
//! use vitrum::tracer::{Background, Camera, Integrator, Projection, Scene, SceneObject, Settings, render};
//!
//! let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0)?);
//! let inside = Medium::clear(IndexOfRefraction::new(1.5)?);
//! let glass = Dielectric::new(Media::solid(Medium::AIR, inside, 0), Ggx::smooth());
//! let object = SceneObject {
//!     name: "ball".to_owned(),
//!     object: Object::new(sphere, &Transform::IDENTITY, false)?,
//!     materials: vec![Material::Dielectric(glass)],
//! };
//! let pinhole = Projection::Pinhole { fov: 0.6 };
//! let camera = Camera::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, pinhole)?;
//! let mut scene = Scene::new(vec![object], camera)?;
//! scene.background = Background::Constant(Rgb::ONE);
//! let settings = Settings { size: [32, 32], spp: 4, integrator: Integrator::Path, ..Settings::default() };
//! let rendering = render(&scene, &settings, &())?;
//! // All light that enters comes out again: nobody sees a clear ball where everything is equally bright.
//! let image = rendering.film.image();
//! let mean = image.iter().map(|p| f64::from(p[0])).sum::<f64>() / image.len() as f64;
//! assert!((mean - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use vitrum_bxdf as bxdf;
pub use vitrum_geometry as geometry;
pub use vitrum_io as io;
pub use vitrum_materials as materials;
pub use vitrum_math as math;
pub use vitrum_measure as measure;
pub use vitrum_tracer as tracer;
