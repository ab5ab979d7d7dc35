//! A scene around a model: in the middle of the picture, on a checkered floor, under a light and a pale sky.

use crate::diagnostic::Span;
use crate::obj::{self, ObjFile};
use crate::scene::{
    Around, Background, Camera, ColourOrTexture, Falloff, Lens, Light, LightKind, Material, MaterialChoice,
    Model, Name, Normals, Object, Output, Pattern, Phong, Render, SceneDesc, Shape, Texture, Tone, Transform,
};
use std::path::Path;
use vitrum_geometry::mesh::Build;
use vitrum_math::{Bounds, DVec3, Rgb, unit};

/// What the model is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelMaterial {
    /// Glass, whatever the file says.
    Glass,
    /// Matte and grey, to look at the shape.
    Matte,
    /// What the file says.
    File,
}

/// How a model is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelOptions {
    /// What it is made of.
    pub material: ModelMaterial,
    /// Index of refraction of the glass.
    pub ior: f64,
    /// The normals that it is shaded with; `None` for the file's, and smooth ones where it has none.
    pub normals: Option<Normals>,
    /// Width and height of the picture, pixels: the model fits into it.
    pub size: [u32; 2],
}

impl Default for ModelOptions {
    fn default() -> Self {
        Self { material: ModelMaterial::Glass, ior: 1.5, normals: None, size: [640, 640] }
    }
}

/// Vertical field of view, degrees: a short telephoto.
const FOV: f64 = 30.0;

/// Largest coordinate, and smallest extent, of a model around which a scene is built: their squares and cubes are numbers.
const LARGEST: f64 = 1e100;
const SMALLEST: f64 = 1e-100;

/// The description of a scene that shows the model `file`, which was read from `path`; else why there is none.
pub(super) fn frame(path: &Path, file: &ObjFile, options: &ModelOptions) -> Result<SceneDesc, String> {
    let bounds = bounds(file);
    let (centre, size) = (bounds.centre(), size(&bounds)?);
    // The bounding sphere keeps a margin to the nearer borders of the picture.
    let [width, height] = options.size;
    let narrow = (f64::from(width) / f64::from(height)).min(1.0);
    let half_angle = libm::atan(libm::tan(0.5 * FOV.to_radians()) * narrow);
    let distance = 0.5 * size / libm::sin(half_angle) * 1.02;
    let towards_camera = unit(DVec3::new(0.35, 0.35, 1.0));
    let mut desc = SceneDesc::new(Camera {
        span: Span::default(),
        position: centre + towards_camera * distance,
        target: centre,
        target_span: Span::default(),
        up: DVec3::Y,
        lens: Lens::Pinhole { fov: FOV },
        medium: None,
    });
    // Light through a solid, around a bend, and out again.
    desc.render = Render { size: options.size, max_depth: Some(12), cutoff: 1e-2, ..Render::default() };
    desc.output = Output { tone: Tone::Neutral, ..desc.output };
    desc.background = Background::Gradient { bottom: Rgb::splat(0.25), top: Rgb::new(0.75, 0.85, 1.0) };
    desc.lights = vec![
        light(LightKind::Ambient { radiance: Rgb::splat(0.15) }),
        light(LightKind::Point {
            position: centre + unit(DVec3::new(-0.6, 1.2, 0.8)) * (3.0 * size),
            intensity: Rgb::splat(2.6),
            falloff: Falloff::None,
            shadows: true,
        }),
    ];
    desc.textures = vec![Texture {
        span: Span::default(),
        name: Name::new("floor"),
        pattern: Pattern::Checker {
            even: Rgb::new(0.82, 0.80, 0.76),
            odd: Rgb::new(0.16, 0.20, 0.26),
            size: 0.2 * size,
            origin: centre,
            axes: [true, false, true],
        },
    }];
    desc.objects = vec![model(path, file, options), floor(&bounds, size)];
    Ok(desc)
}

fn model(path: &Path, file: &ObjFile, options: &ModelOptions) -> Object {
    let has_normals = file.parts.iter().any(|part| !part.mesh.normal_triangles.is_empty());
    let normals = options.normals.unwrap_or(if has_normals { Normals::File } else { Normals::Smooth });
    let material = match options.material {
        ModelMaterial::File => None,
        ModelMaterial::Glass => Some(Model::Transparent {
            phong: Phong {
                color: ColourOrTexture::Colour(Rgb::ONE),
                ka: 0.0,
                kd: 0.0,
                ks: 0.2,
                exponent: 2000.0,
            },
            kr: Rgb::splat(0.1),
            kt: Rgb::splat(0.9),
            ior: options.ior,
            around: Around::default(),
        }),
        ModelMaterial::Matte => {
            Some(Model::Matte { color: ColourOrTexture::Colour(Rgb::splat(0.6)), ka: 1.0, kd: 1.0 })
        }
    };
    let shape = Shape::Mesh {
        file: path.to_owned(),
        file_span: Span::default(),
        normals,
        build: Build::default(),
        group: None,
        force: true,
    };
    object("model", shape, material)
}

fn floor(bounds: &Bounds, size: f64) -> Object {
    let point = DVec3::new(bounds.centre().x, bounds.min.y, bounds.centre().z);
    // A hair below what stands on it: the lowest point of the model touches, its faces don't coincide.
    let point = point - DVec3::Y * (1e-3 * size);
    let color = ColourOrTexture::Texture(Name::new("floor"));
    object("floor", Shape::Plane { point, normal: DVec3::Y }, Some(Model::Matte { color, ka: 1.0, kd: 0.9 }))
}

fn object(name: &str, shape: Shape, model: Option<Model>) -> Object {
    let inline =
        |model| MaterialChoice::Inline(Box::new(Material { span: Span::default(), name: None, model }));
    Object {
        span: Span::default(),
        name: Some(Name::new(name)),
        shape,
        material: model.map(inline),
        transform: Transform::default(),
        flip: false,
    }
}

fn light(kind: LightKind) -> Light {
    Light { span: Span::default(), name: None, kind }
}

/// The diagonal of the model, or why no scene can be built around it.
fn size(bounds: &Bounds) -> Result<f64, String> {
    let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
    if farthest > LARGEST {
        return Err(format!(
            "a vertex has the coordinate {farthest:e}, expected at most {LARGEST:e}; scale the model down"
        ));
    }
    match bounds.extent().max_element() {
        // All vertices in one point: that the mesh has no area is told with the mesh.
        0.0 => Ok(1.0),
        extent if extent < SMALLEST => {
            Err(format!("the model is {extent:e} across, expected at least {SMALLEST:e}; scale the model up"))
        }
        _ => Ok(bounds.extent().length()),
    }
}

/// The box around all vertices that faces use.
fn bounds(file: &ObjFile) -> Bounds {
    let used = |part: &obj::Part| {
        Bounds::around(part.mesh.triangles.iter().flatten().map(|&i| part.mesh.positions[i as usize]))
    };
    file.parts.iter().map(used).fold(Bounds::EMPTY, Bounds::union)
}
