//! From a description to a scene: every name resolved, every number in the tracer's own units.

use super::matter::{Matter, Told};
use super::meshes::{MeshReport, Meshes, NeedsUvs, Prepared};
use super::naming::{self, Names, fnv1a};
use super::origin::Origin;
use super::{LoadError, Loaded, SceneOptions, environment, error};
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::image::{Display, Tone};
use crate::scene::{self, MaterialChoice, Normals, SceneDesc, Step};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use vitrum_geometry::Object;
use vitrum_geometry::mesh::Build;
use vitrum_geometry::shape::{Cuboid, Cylinder, Disk, Plane, Rectangle, Shape, ShapeError, Sphere};
use vitrum_materials::{Material, Texture};
use vitrum_math::{Rgb, Transform, unit};
use vitrum_tracer::{
    Background, Branching, Camera, Falloff, Filter, Integrator, Light, Projection, Scene, SceneObject,
    Settings, ShadowMode,
};

/// Everything that lowering an object needs and adds to.
struct Lowering<'a> {
    desc: &'a SceneDesc,
    /// The objects that instances can refer to.
    named: BTreeMap<&'a str, &'a scene::Object>,
    source: &'a Source<'a>,
    folder: &'a Path,
    matter: Matter<'a>,
    meshes: Meshes,
    names: Names,
    problems: Diagnostics,
    objects: Vec<SceneObject>,
    reports: Vec<MeshReport>,
}

/// Lowers a description; `meshes` holds files that have been read already, `problems` those that reading it has found.
pub(super) fn lower(
    desc: &SceneDesc,
    source: &Source<'_>,
    folder: &Path,
    meshes: Meshes,
    problems: Diagnostics,
    options: SceneOptions,
) -> Result<Loaded, LoadError> {
    let mut lowering = Lowering {
        desc,
        named: objects_by_name(desc),
        source,
        folder,
        matter: Matter::new(desc, folder),
        meshes,
        names: Names::default(),
        problems,
        objects: Vec::new(),
        reports: Vec::new(),
    };
    if let Err(reason) = lowering.matter.medium_of(&desc.surroundings) {
        lowering.problems.push(error(source, desc.surroundings.span, reason, "what surrounds everything"));
    }
    let camera_medium = desc.camera.medium.as_ref().and_then(|name| match lowering.matter.medium_of(name) {
        Ok(medium) => Some(medium),
        Err(reason) => {
            lowering.problems.push(error(source, name.span, reason, "where the camera stands"));
            None
        }
    });
    for object in &desc.objects {
        if let scene::Shape::Mesh { file, normals, build, group, .. } = &lowering.original(object).shape {
            let needs_uvs = lowering.needs_uvs(object);
            lowering.meshes.announce(
                &folder.join(file),
                *normals,
                *build,
                group.as_ref().map(|name| &*name.text),
                needs_uvs,
            );
        }
    }
    for object in &desc.objects {
        lowering.object(object);
    }
    let camera = lowering.camera();
    let background = background(&desc.background, source, folder, options, &mut lowering.problems);
    let mut origin = Origin { hashes: vec![fnv1a(format!("{desc:?}").as_bytes())], files: Vec::new() };
    for (file, materials) in lowering.meshes.read() {
        origin.files.push(file.clone());
        origin.hashes.push(*materials);
    }
    origin.files.extend(lowering.matter.images().files().cloned());
    if let scene::Background::Image { file, .. } = &desc.background {
        origin.files.push(folder.join(file));
    }
    let Lowering { matter, mut problems, objects, reports, .. } = lowering;
    let scene = camera.filter(|_| !problems.has_errors()).map(|camera| Scene::new(objects, camera));
    match scene {
        Some(Ok(mut scene)) => {
            scene.background = background;
            scene.medium = matter.medium;
            scene.camera_medium = camera_medium;
            (scene.ambient, scene.lights) = lights(desc, source, &scene, &mut problems);
            problems.sort();
            Ok(Loaded {
                scene,
                settings: settings(&desc.render, integrator(desc)),
                display: display(&desc.output),
                meshes: reports,
                media: matter.media(),
                origin,
                warnings: problems,
            })
        }
        Some(Err(reason)) => {
            problems.push(Diagnostic::error(source.name(), reason.to_string()));
            Err(LoadError::Invalid(problems))
        }
        None => {
            problems.sort();
            Err(LoadError::Invalid(problems))
        }
    }
}

impl<'a> Lowering<'a> {
    fn camera(&mut self) -> Option<Camera> {
        let c = &self.desc.camera;
        let projection = match c.lens {
            scene::Lens::Pinhole { fov } => Projection::Pinhole { fov: fov.to_radians() },
            scene::Lens::Thin { fov, radius, focus_distance } => {
                Projection::ThinLens { fov: fov.to_radians(), lens_radius: radius, focus_distance }
            }
            scene::Lens::Orthographic { height } => Projection::Orthographic { height },
        };
        match Camera::new(c.position, c.target, c.up, projection) {
            Ok(camera) => Some(camera),
            Err(reason) => {
                self.problems.push(error(self.source, c.span, reason.to_string(), "this camera"));
                None
            }
        }
    }

    /// Adds an object, or the problems that keep it out. A model file adds one for each of its parts.
    fn object(&mut self, object: &scene::Object) {
        let Some(transform) = self.transform(&object.transform) else { return };
        let shape = &self.original(object).shape;
        if let scene::Shape::Instance { of } = shape {
            // Reading has seen to it; a description built in code may still do it.
            let message = format!("there is no object `{}` with a shape of its own to repeat", of.text);
            self.problems.push(error(self.source, object.span, message, "this instance"));
            return;
        }
        if let scene::Shape::Mesh { file, file_span, normals, build, group, force } = shape {
            self.mesh(
                object,
                file,
                *file_span,
                *normals,
                *build,
                group.as_ref().map(|g| g.text.as_str()),
                *force,
                &transform,
            );
            return;
        }
        let analytic = match analytic(shape) {
            Ok(analytic) => analytic,
            Err(reason) => {
                self.problems.push(error(self.source, object.span, reason.to_string(), "this object"));
                return;
            }
        };
        let Some(material) = self.material_of(object) else { return };
        let kind = analytic.name();
        let content = || format!("{analytic:?} {material:?} {:?} {}", object.transform.steps, object.flip);
        let name = match &object.name {
            Some(name) => name.text.clone(),
            None => self.names.for_content(kind, &content()),
        };
        self.place(object, analytic, &transform, name, vec![material]);
    }

    /// The object, or of an instance the one that it repeats.
    fn original<'o>(&self, object: &'o scene::Object) -> &'o scene::Object
    where
        'a: 'o,
    {
        match &object.shape {
            scene::Shape::Instance { of } => self.named.get(of.text.as_str()).copied().unwrap_or(object),
            _ => object,
        }
    }

    fn transform(&mut self, transform: &scene::Transform) -> Option<Transform> {
        let step = |step: &Step| match *step {
            Step::Translate(offset) => Ok(Transform::translate(offset)),
            Step::Rotate { axis, angle } => Ok(Transform::rotate(unit(axis), angle.to_radians())),
            Step::Scale(factors) => Transform::scale(factors),
        };
        let all = transform.steps.iter().try_fold(Transform::IDENTITY, |all, s| all.then(&step(s)?));
        match all {
            Ok(all) => Some(all),
            Err(reason) => {
                self.problems.push(error(
                    self.source,
                    transform.span,
                    reason.to_string(),
                    "these steps together",
                ));
                None
            }
        }
    }

    /// The material that an object, or the original of an instance, chooses; `None` where it leaves the choice to a file.
    fn choice<'o>(&self, object: &'o scene::Object) -> Option<&'o MaterialChoice>
    where
        'a: 'o,
    {
        object.material.as_ref().or_else(|| self.original(object).material.as_ref())
    }

    /// When the mesh of an object needs texture coordinates.
    fn needs_uvs(&self, object: &scene::Object) -> NeedsUvs {
        let described = match self.choice(object) {
            None => return NeedsUvs { always: false, by_file: true },
            Some(MaterialChoice::Inline(material)) => Some(&**material),
            Some(MaterialChoice::Named(name)) => self.matter.named(&name.text),
        };
        NeedsUvs { always: described.is_some_and(|d| self.matter.shows_image(d)), by_file: false }
    }

    /// The material of a choice that an object makes.
    fn chosen(&mut self, choice: &MaterialChoice, object: &scene::Object) -> Option<Material> {
        let described = match choice {
            MaterialChoice::Inline(material) => material,
            MaterialChoice::Named(name) => match self.matter.named(&name.text) {
                Some(material) => material,
                None => {
                    let message = format!("there is no material `{}`", name.text);
                    self.problems.push(error(self.source, object.span, message, "this object"));
                    return None;
                }
            },
        };
        let told = Told { source: self.source, problems: &mut self.problems };
        let material = self.matter.material(described, told)?;
        if matches!(&material, Material::Emissive { radiance: Texture::Constant(Rgb::ZERO) }) {
            let warning =
                Diagnostic::warning(self.source.name(), "an emissive object without power lights nothing");
            self.problems.push(warning.at(self.source, object.span, "its radiance is 0: it is black"));
        }
        Some(material)
    }

    fn material_of(&mut self, object: &scene::Object) -> Option<Material> {
        let choice = self.choice(object).cloned();
        let Some(choice) = choice else {
            self.problems.push(error(
                self.source,
                object.span,
                "the object has no material".to_owned(),
                "this object",
            ));
            return None;
        };
        self.chosen(&choice, object)
    }

    #[expect(clippy::too_many_arguments, reason = "the fields of one variant, taken apart")]
    fn mesh(
        &mut self,
        object: &scene::Object,
        file: &Path,
        file_span: crate::diagnostic::Span,
        normals: Normals,
        build: Build,
        group: Option<&str>,
        force: bool,
        transform: &Transform,
    ) {
        let choice = self.choice(object).cloned();
        let chosen = choice.as_ref().map(|choice| self.chosen(choice, object));
        let path = self.folder.join(file);
        let (source, problems) = (self.source, &mut self.problems);
        let mut warn =
            |warning: &str| problems.push(Diagnostic::warning(path.display().to_string(), warning));
        let parts = match self.meshes.prepare(&path, normals, build, group, &mut warn) {
            Ok(parts) => parts.to_vec(),
            Err(reason) => {
                let mut problem = error(source, file_span, reason.to_string(), "this file");
                if reason.is_missing() {
                    problem = problem.help("paths are relative to the folder of the scene file");
                }
                self.problems.push(problem);
                return;
            }
        };
        let base = match &object.name {
            Some(name) => name.text.clone(),
            None => {
                let content = format!(
                    "{file:?} {normals:?} {group:?} {force} {chosen:?} {:?} {}",
                    object.transform.steps, object.flip
                );
                self.names.for_content("mesh", &content)
            }
        };
        let own: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
        let names = naming::of_parts(&base, &own);
        for (part, name) in parts.into_iter().zip(names) {
            let materials = match &chosen {
                Some(Some(material)) => vec![material.clone()],
                Some(None) => continue,
                None => self.imported(&part.materials, &path, part.mesh.has_uvs(), object),
            };
            if !self.check_coordinates(&part, name.strip_prefix(&base), &materials, file_span) {
                continue;
            }
            let report = MeshReport { object: name.clone(), ..part.report };
            let is_glass = materials.iter().any(Material::is_dielectric);
            self.check_solid(&report, name.strip_prefix(&base), is_glass, force, file_span);
            self.reports.push(report);
            self.place(object, Shape::Mesh(part.mesh), transform, name, materials);
        }
    }

    /// The materials of a model file.
    fn imported(
        &mut self,
        materials: &[Option<crate::obj::MtlMaterial>],
        path: &Path,
        has_uvs: bool,
        object: &scene::Object,
    ) -> Vec<Material> {
        let undefined = crate::obj::MtlMaterial::undefined("");
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let mut imported = Vec::new();
        for material in materials {
            let material = material.as_ref().unwrap_or(&undefined);
            let problems = &mut self.problems;
            let mut warn =
                |warning: String| problems.push(Diagnostic::warning(path.display().to_string(), warning));
            match self.matter.imported(material, folder, has_uvs, &mut warn) {
                Ok(material) => imported.push(material),
                Err(reason) => {
                    let label = "the material library of this model";
                    self.problems.push(error(self.source, object.span, reason, label));
                }
            }
        }
        imported
    }

    /// An image needs texture coordinates; a mesh without any is refused. `part` as for [`check_solid`](Self::check_solid).
    fn check_coordinates(
        &mut self,
        prepared: &Prepared,
        part: Option<&str>,
        materials: &[Material],
        span: crate::diagnostic::Span,
    ) -> bool {
        let Some(texture) = materials.iter().find_map(Material::image) else { return true };
        let (mesh, image) = (named(&prepared.report, part), texture.image.name());
        if !prepared.mesh.has_uvs() {
            let message = format!("{mesh} has no texture coordinates (vt), so `{image}` has no place on it");
            let problem = error(self.source, span, message, "this mesh");
            self.problems.push(problem.help(
                "unwrap the mesh in a modelling tool and export it with UVs, or take a texture of type \"checker\"",
            ));
            return false;
        }
        if prepared.unmapped_faces > 0 {
            let count = prepared.unmapped_faces;
            let message = format!(
                "{mesh} has faces without texture coordinates, which show the lower left corner of `{image}`: {count}"
            );
            self.problems.push(Diagnostic::warning(self.source.name(), message));
        }
        true
    }

    /// Glass needs an inside. A mesh without one is refused, or taken on demand. `part` is a slash and the name of the part,
    /// or nothing where there is only one.
    fn check_solid(
        &mut self,
        report: &MeshReport,
        part: Option<&str>,
        is_glass: bool,
        force: bool,
        span: crate::diagnostic::Span,
    ) {
        let mesh = named(report, part);
        for mended in &report.mended {
            let message = format!("{mesh} was mended: {mended}");
            self.problems.push(Diagnostic::warning(self.source.name(), message));
        }
        if !is_glass || report.closed {
            return;
        }
        let findings = report.findings.join("; ");
        let message = format!("{mesh} does not enclose a volume, so glass has no inside: {findings}");
        let problem = if force {
            let message = format!(
                "{message}. A ray that leaves through a gap counts as still inside, and is dimmer by 1/ior² for it"
            );
            Diagnostic::warning(self.source.name(), message)
        } else {
            error(self.source, span, message, "this mesh")
                .help("close the mesh in a modelling tool, or write `force = true` to take it as it is")
        };
        self.problems.push(problem);
    }

    fn place(
        &mut self,
        object: &scene::Object,
        shape: Shape,
        transform: &Transform,
        name: String,
        materials: Vec<Material>,
    ) {
        if materials.iter().any(Material::is_rough) && integrator(self.desc) == Integrator::Whitted {
            let message = format!("`{name}` is rough, and a ray tree can't follow light that it scatters");
            let problem = error(self.source, object.span, message, "this object");
            self.problems.push(problem.help("write integrator = \"path\" in [render], or roughness = 0"));
            return;
        }
        let shows_image = materials.iter().any(|m| m.image().is_some());
        let make = if shows_image { Object::with_uvs } else { Object::new };
        match make(shape, transform, object.flip) {
            Ok(placed) => self.objects.push(SceneObject { name, object: placed, materials }),
            Err(reason) => {
                let message = format!("transformed, the object is degenerate: {reason}");
                self.problems.push(error(self.source, object.span, message, "this object"));
            }
        }
    }
}

/// A mesh in messages. `part` is a slash and the name of the part, or nothing where there is only one.
fn named(report: &MeshReport, part: Option<&str>) -> String {
    match part.and_then(|part| part.strip_prefix('/')) {
        Some(part) => format!("{}, part `{part}`,", report.file.display()),
        None => report.file.display().to_string(),
    }
}

/// The objects that have a name; of several of one name the first.
fn objects_by_name(desc: &SceneDesc) -> BTreeMap<&str, &scene::Object> {
    desc.objects.iter().rev().filter_map(|o| Some((o.name.as_ref()?.text.as_str(), o))).collect()
}

fn analytic(shape: &scene::Shape) -> Result<Shape, ShapeError> {
    use scene::Shape as Described;
    Ok(match *shape {
        Described::Sphere { center, radius } => Shape::Sphere(Sphere::new(center, radius)?),
        Described::Plane { point, normal } => Shape::Plane(Plane::new(point, normal)?),
        Described::Disk { center, normal, radius } => Shape::Disk(Disk::new(center, normal, radius)?),
        Described::Rectangle { corner, edge_u, edge_v } => {
            Shape::Rectangle(Rectangle::new(corner, edge_u, edge_v)?)
        }
        Described::Box { min, max } => Shape::Cuboid(Cuboid::new(min, max)?),
        Described::Cylinder { bottom, top, radius, capped } => {
            Shape::Cylinder(Cylinder::new(bottom, top, radius, capped)?)
        }
        Described::Mesh { .. } | Described::Instance { .. } => {
            unreachable!("meshes are read from files, and an instance never refers to another")
        }
    })
}

/// Ambient radiance, and the other lights in the order of their names (unnamed ones by what they are), so that sums over
/// them never depend on the order in the file. Lights without power are left out, and said; lights that glass keeps in are said.
fn lights(
    desc: &SceneDesc,
    source: &Source<'_>,
    within: &Scene,
    problems: &mut Diagnostics,
) -> (Rgb, Vec<Light>) {
    let mut ambient: Vec<(String, Rgb)> = Vec::new();
    let mut lights: Vec<(String, Light)> = Vec::new();
    for light in &desc.lights {
        let lowered = match light.kind {
            scene::LightKind::Ambient { radiance } => {
                ambient.push((format!("{radiance:?}"), radiance));
                continue;
            }
            scene::LightKind::Point { position, intensity, falloff, shadows } => Light::Point {
                position,
                intensity,
                falloff: match falloff {
                    scene::Falloff::InverseSquare => Falloff::InverseSquare,
                    scene::Falloff::None => Falloff::None,
                },
                shadows,
            },
            scene::LightKind::Spot { position, direction, intensity, inner, outer, shadows } => Light::Spot {
                position,
                axis: unit(direction),
                intensity,
                cos_inner: libm::cos(inner.to_radians()),
                cos_outer: libm::cos(outer.to_radians()),
                shadows,
            },
            scene::LightKind::Directional { direction, irradiance, shadows } => {
                Light::Directional { towards: -unit(direction), irradiance, shadows }
            }
        };
        if lowered.is_dark() {
            let warning = Diagnostic::warning(source.name(), "a light without power is left out");
            problems.push(warning.at(source, light.span, "it shines with 0"));
        } else {
            let straight = desc.render.shadow == scene::Shadow::Straight;
            if let Some(glass) = kept_in_by(&lowered, within).filter(|_| !straight) {
                let message = format!("a light inside the glass of `{glass}` lights nothing outside of it");
                let help = "glass refracts every ray, and none finds a point: a small sphere of an emissive material is found";
                let warning = Diagnostic::warning(source.name(), message).help(help);
                problems.push(warning.at(source, light.span, "this light has no size"));
            }
            let key = light
                .name
                .as_ref()
                .map_or_else(|| format!("\u{10ffff}{lowered:?}"), |name| name.text.clone());
            lights.push((key, lowered));
        }
    }
    ambient.sort_by(|a, b| a.0.cmp(&b.0));
    lights.sort_by(|a, b| a.0.cmp(&b.0));
    let ambient = ambient.into_iter().fold(Rgb::ZERO, |sum, (_, radiance)| sum + radiance);
    (ambient, lights.into_iter().map(|(_, light)| light).collect())
}

/// The name of the glass around a light from one point, where it casts shadows.
fn kept_in_by<'s>(light: &Light, scene: &'s Scene) -> Option<&'s str> {
    let (Light::Point { position, .. } | Light::Spot { position, .. }) = light else { return None };
    let glass = if light.casts_shadows() { scene.glass_around(*position) } else { None };
    glass.map(|object| &*scene.names()[object as usize])
}

fn background(
    described: &scene::Background,
    source: &Source<'_>,
    folder: &Path,
    options: SceneOptions,
    problems: &mut Diagnostics,
) -> Background {
    match described {
        scene::Background::Constant { color } => Background::Constant(*color),
        scene::Background::Gradient { bottom, top } => Background::Gradient { bottom: *bottom, top: *top },
        scene::Background::Image { file, file_span, rotation, scale } => {
            let path = folder.join(file);
            match environment::read(&path, rotation.to_radians(), *scale, options.repair) {
                Ok((map, repaired)) => {
                    if let Some(repaired) = repaired {
                        problems.push(Diagnostic::warning(path.display().to_string(), repaired));
                    }
                    Background::Environment(Arc::new(map))
                }
                Err(refused) => {
                    let problem = error(source, *file_span, refused.message, "this file");
                    problems.push(match refused.help {
                        Some(help) => problem.help(help),
                        None => problem,
                    });
                    Background::Constant(Rgb::ZERO)
                }
            }
        }
    }
}

/// The one that is asked for; else the ray tree for what only that knows, and paths for the rest.
fn integrator(desc: &SceneDesc) -> Integrator {
    let ambient = desc.lights.iter().any(|light| matches!(light.kind, scene::LightKind::Ambient { .. }));
    match desc.render.integrator {
        Some(scene::Integrator::Whitted) => Integrator::Whitted,
        Some(scene::Integrator::Path) => Integrator::Path,
        None if ambient || desc.render.shadow == scene::Shadow::Straight => Integrator::Whitted,
        None => Integrator::Path,
    }
}

fn settings(render: &scene::Render, integrator: Integrator) -> Settings {
    Settings {
        integrator,
        branching: match render.branching {
            scene::Branching::Auto => Branching::Auto,
            scene::Branching::One => Branching::One,
            scene::Branching::First => Branching::First,
            scene::Branching::Tree => Branching::Tree,
        },
        size: render.size,
        spp: render.spp,
        max_depth: render.max_depth,
        cutoff: render.cutoff,
        filter: match render.filter {
            scene::Filter::Box => Filter::Box,
            scene::Filter::Tent => Filter::Tent,
            scene::Filter::BlackmanHarris => Filter::BlackmanHarris,
        },
        seed: render.seed,
        shadow: match render.shadow {
            scene::Shadow::Opaque => ShadowMode::Opaque,
            scene::Shadow::Straight => ShadowMode::Straight,
        },
        ..Settings::default()
    }
}

fn display(output: &scene::Output) -> Display {
    let tone = match output.tone {
        scene::Tone::Clip => Tone::Clip,
        scene::Tone::Neutral => Tone::Neutral,
    };
    Display { exposure_stops: output.exposure, tone }
}
