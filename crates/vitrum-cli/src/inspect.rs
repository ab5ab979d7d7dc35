//! `vitrum inspect`: what is in a scene, what is wrong with it, and what rendering it needs. Renders nothing.

use crate::args::Inspect;
use crate::failure::Failure;
use crate::input;
use crate::terminal;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::process::ExitCode;
use vitrum_io::load::{Loaded, MeshReport, SceneOptions};
use vitrum_materials::{Boundary, Material, Media, Phong, Texture};
use vitrum_math::{DVec3, Rgb};
use vitrum_tracer::{
    Background, Branching, Falloff, Feature, Integrator, Light, Plan, Projection, Scene, Settings, medium_at,
};

pub(crate) fn run(arguments: &Inspect) -> Result<ExitCode, Failure> {
    let loaded = input::load(
        arguments.scene.as_deref(),
        SceneOptions { repair: arguments.repair, examine: true },
        &arguments.model,
        None,
    )?;
    let mut report = String::new();
    // Writing to a String can't fail.
    let _ = describe(&mut report, &loaded);
    terminal::answer(&report)?;
    Ok(ExitCode::SUCCESS)
}

fn describe(out: &mut String, loaded: &Loaded) -> std::fmt::Result {
    let scene = &loaded.scene;
    let settings = &loaded.settings;
    let [width, height] = settings.size;
    writeln!(
        out,
        "picture    {width} x {height}, {} per pixel, {}, seed {}",
        count(settings.spp as usize, "sample"),
        method(settings),
        settings.seed
    )?;
    let projection = match *scene.camera.projection() {
        Projection::Pinhole { fov } => format!("pinhole, {:.3}° high", fov.to_degrees()),
        Projection::ThinLens { fov, lens_radius, focus_distance } => format!(
            "thin lens, {:.3}° high, radius {lens_radius} m, sharp at {focus_distance:.4} m",
            fov.to_degrees()
        ),
        Projection::Orthographic { height } => format!("orthographic, {height} m high"),
    };
    let within_what = within(scene, scene.camera.position());
    writeln!(out, "camera     at {}, {projection}{within_what}", point(scene.camera.position()))?;
    let bounds = scene.aggregate().bounds();
    if !bounds.is_empty() {
        writeln!(out, "bounds     {} to {}", point(bounds.min), point(bounds.max))?;
    }
    let media: Vec<String> =
        loaded.media.iter().map(|(name, medium)| format!("{name} {}", medium.index.value())).collect();
    writeln!(out, "media      {}; around everything: {}", media.join(", "), scene.medium.index.value())?;
    if scene.ambient != Rgb::ZERO {
        writeln!(out, "light      ambient, radiance {}", colour(scene.ambient))?;
    }
    for light in &scene.lights {
        let around = match light {
            Light::Point { position, .. } | Light::Spot { position, .. } => within(scene, *position),
            Light::Directional { .. } => String::new(),
        };
        writeln!(out, "light      {}{around}", describe_light(light))?;
    }
    if let Background::Environment(map) = &scene.background {
        let [width, height] = map.size();
        writeln!(out, "background {width} x {height} texels, brightest {:.4}", map.brightest())?;
        for sun in map.suns() {
            writeln!(
                out,
                "  sun      from direction {}, irradiance {:.4}, {:.1} % of all light",
                point(sun.towards),
                sun.irradiance,
                100.0 * sun.share
            )?;
        }
    }
    writeln!(out)?;
    objects(out, loaded)?;
    overlaps(out, scene)?;
    plan(out, &Plan::new(scene, settings), loaded, settings.integrator)?;
    if !loaded.warnings.is_empty() {
        write!(out, "\n{}", loaded.warnings)?;
    }
    Ok(())
}

/// The solids of glass that a point lies in.
fn within(scene: &Scene, at: DVec3) -> String {
    let (_, solids) = medium_at(scene, at);
    let names: Vec<String> = solids.iter().map(|id| format!("`{}`", scene.names()[*id as usize])).collect();
    if names.is_empty() { String::new() } else { format!(", inside {}", names.join(", ")) }
}

/// How light is followed.
fn method(settings: &Settings) -> String {
    let depth = match settings.deepest() {
        u32::MAX => "any depth".to_owned(),
        deepest => format!("depth {deepest}"),
    };
    match settings.integrator {
        Integrator::Whitted => format!("ray trees, {depth}, cut-off {}", settings.cutoff),
        Integrator::Path => {
            let followed = match settings.branching {
                Branching::Auto => "as many rays as pay",
                Branching::One => "one ray",
                Branching::First => "all rays at the first hit, then one,",
                Branching::Tree => "all rays that weigh enough",
            };
            format!("paths, {depth}, {followed} of those that glass divides")
        }
    }
}

fn objects(out: &mut String, loaded: &Loaded) -> std::fmt::Result {
    let scene = &loaded.scene;
    let names = scene.names();
    writeln!(out, "{}", count(names.len() + scene.invisible().len(), "object"))?;
    let meshes: BTreeMap<&str, &MeshReport> = loaded.meshes.iter().map(|m| (m.object.as_str(), m)).collect();
    for (id, (name, object)) in (0u32..).zip(names.iter().zip(scene.aggregate().objects())) {
        let materials: Vec<String> = scene.materials_of(id).iter().map(describe_material).collect();
        writeln!(out, "  {name}: {}, {}", object.shape().name(), materials.join("; "))?;
        if let Some(mesh) = meshes.get(name.as_str()) {
            describe_mesh(out, mesh)?;
        }
    }
    for name in scene.invisible() {
        writeln!(
            out,
            "  {name}: invisible (matched index, nothing reflected, everything transmitted); left out"
        )?;
    }
    Ok(())
}

fn describe_mesh(out: &mut String, mesh: &MeshReport) -> std::fmt::Result {
    let solid = match mesh.volume {
        Some(volume) => format!("closed, volume {volume:.6}"),
        None => "not closed".to_owned(),
    };
    writeln!(
        out,
        "    {}: {}, {solid}, {:.1} kB",
        mesh.file.display(),
        count(mesh.triangles, "triangle"),
        mesh.memory as f64 / 1e3
    )?;
    for finding in &mesh.findings {
        writeln!(out, "    found: {finding}")?;
    }
    for mended in &mesh.mended {
        writeln!(out, "    mended: {mended}")?;
    }
    Ok(())
}

/// So many pairs of solids are looked at: more than a person reads.
const MOST_PAIRS: usize = 64;

/// Gaps are looked for up to this share of the smaller solid.
const REACH: f64 = 2e-3;

/// The solids that may reach into each other, and how near their surfaces come to each other.
fn overlaps(out: &mut String, scene: &Scene) -> std::fmt::Result {
    let pairs = scene.overlapping_solids();
    if pairs.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n{} may overlap",
        if pairs.len() == 1 {
            "1 pair of solids".to_owned()
        } else {
            format!("{} pairs of solids", pairs.len())
        }
    )?;
    let aggregate = scene.aggregate();
    let size = |id: u32| aggregate.objects()[id as usize].bounds().map_or(0.0, |b| b.extent().max_element());
    for (a, b) in pairs.iter().copied().take(MOST_PAIRS) {
        let found = aggregate.nearness(a, b, REACH * size(a).min(size(b)));
        let share = |points: u32| 100.0 * f64::from(points) / f64::from(found.points.max(1));
        write!(out, "  `{}` and `{}`", scene.names()[a as usize], scene.names()[b as usize])?;
        if found.flush > 0 {
            write!(out, ", flush on {:.1} % of the first, where both walls are one", share(found.flush))?;
        }
        if let Some((width, at)) = found.narrowest {
            write!(
                out,
                ", a gap on {:.1} % of the first, down to {width:.3e} m at {}: light is totally reflected there; let one reach into the \
                 other, and give what is to be seen the higher priority",
                share(found.gaps),
                point(at)
            )?;
        }
        writeln!(out)?;
    }
    if pairs.len() > MOST_PAIRS {
        writeln!(out, "  ... and {} more", pairs.len() - MOST_PAIRS)?;
    }
    Ok(())
}

/// A line for each feature: used or skipped.
fn plan(out: &mut String, plan: &Plan, loaded: &Loaded, integrator: Integrator) -> std::fmt::Result {
    writeln!(out, "\nplan")?;
    let objects = loaded.scene.names().len();
    let asked = match integrator {
        Integrator::Whitted => format!("{} asked at each point that reflects", count(plan.lights, "light")),
        Integrator::Path => format!(
            "one of {} ({}, {} of the background) asked at each point that scatters",
            count(plan.lights, "light"),
            count(plan.area_lights, "shining object"),
            count(plan.environment_lights, "part")
        ),
    };
    for feature in Feature::ALL {
        let how = match feature {
            _ if !plan.needs(feature) => "skipped".to_owned(),
            Feature::Lights => asked.clone(),
            Feature::ShadowRays => format!("towards {}", count(plan.shadow_lights, "light")),
            Feature::AmbientLight => "added at each hit".to_owned(),
            Feature::Refraction => "trees of rays".to_owned(),
            Feature::Absorption => "a factor for each segment".to_owned(),
            Feature::NestedMedia => {
                format!("solids overlap: rays keep count of up to {}", plan.nested_media)
            }
            Feature::ThinSheets => "light that is asked for goes through".to_owned(),
            Feature::Roughness => "scattered rays".to_owned(),
            Feature::Mirrors => "reflected rays".to_owned(),
            Feature::Textures => "looked up at each hit".to_owned(),
            Feature::Images => "texture coordinates where one is seen".to_owned(),
            Feature::Meshes => count(plan.meshes, "mesh tree"),
            Feature::SmoothNormals => "interpolated at each hit".to_owned(),
            Feature::ObjectTree => format!("over {}", count(objects, "object")),
            Feature::Lens => "a point of it for each sample".to_owned(),
            Feature::StraightShadows => "through glass, undeflected (biased)".to_owned(),
        };
        writeln!(out, "  {:<18} {how}", feature.name())?;
    }
    let [width, height] = loaded.settings.size.map(f64::from);
    let background =
        vitrum_tracer::background_pixels(&loaded.scene, &loaded.settings) as f64 / (width * height);
    writeln!(out, "  {:<18} {:.0} % of the pixels, not searched", "background alone", 100.0 * background)?;
    if plan.invisible > 0 {
        writeln!(out, "  {:<18} {} left out", "invisible", count(plan.invisible, "object"))?;
    }
    Ok(())
}

fn describe_light(light: &Light) -> String {
    match light {
        Light::Point { position, intensity, falloff, .. } => {
            let falloff = match falloff {
                Falloff::InverseSquare => "falls off with the square of the distance",
                Falloff::None => "no falloff",
            };
            format!("point at {}, intensity {}, {falloff}", point(*position), colour(*intensity))
        }
        Light::Spot { position, axis, intensity, cos_outer, .. } => format!(
            "spot at {} towards {}, {:.3}° wide, intensity {}",
            point(*position),
            point(*axis),
            2.0 * cos_outer.acos().to_degrees(),
            colour(*intensity)
        ),
        Light::Directional { towards, irradiance, .. } => {
            format!("from direction {}, irradiance {}", point(*towards), colour(*irradiance))
        }
    }
}

fn describe_material(material: &Material) -> String {
    let phong = material.phong().map(describe_phong).unwrap_or_default();
    match material {
        Material::Matte(_) | Material::Phong(_) => format!("{}{phong}", material.name()),
        Material::Reflective { kr, .. } => format!("reflective kr {}{phong}", colour(*kr)),
        Material::Transparent(t) => {
            let (eta, priority) = (t.media.interface().eta(), priority(&t.media));
            format!("transparent ior {eta} kr {} kt {}{priority}{phong}", colour(t.kr), colour(t.kt))
        }
        Material::Dielectric(glass) => {
            let roughness = if glass.is_smooth() { "" } else { ", rough" };
            let media = glass.media();
            let absorbs = match media.inside.absorption {
                clear if clear.is_none() => String::new(),
                inside => format!(", sigma_a {} per metre inside", colour(inside.sigma_a())),
            };
            let (eta, priority) = (media.interface().eta(), priority(media));
            format!("dielectric, index {eta} inside over outside{roughness}{absorbs}{priority}")
        }
        Material::Thin(sheet) => {
            format!(
                "thin sheet, index {}, transmittance {}",
                sheet.interface.eta(),
                colour(sheet.transmittance)
            )
        }
        Material::Conductor(metal) => {
            let roughness = if metal.is_specular() {
                String::new()
            } else {
                format!(", roughness {}", metal.roughness.alpha_x())
            };
            format!("conductor n {} k {}{roughness}", colour(metal.index.n()), colour(metal.index.k()))
        }
        Material::Emissive { radiance } => format!("emissive {}", texture(radiance)),
    }
}

/// What is said of a solid that has one.
fn priority(media: &Media) -> String {
    match media.boundary {
        Boundary::Solid { priority: 0 } => String::new(),
        Boundary::Solid { priority } => format!(", priority {priority}"),
        Boundary::Interface => ", an interface".to_owned(),
    }
}

fn describe_phong(p: &Phong) -> String {
    let mut text = String::new();
    if p.ka > 0.0 || p.kd > 0.0 {
        text += &format!(" ka {} kd {} colour {}", p.ka, p.kd, texture(&p.colour));
    }
    if p.ks != Rgb::ZERO {
        text += &format!(" ks {} exponent {}", colour(p.ks), p.exponent);
    }
    text
}

fn texture(texture: &Texture) -> String {
    match texture {
        Texture::Constant(c) => colour(*c),
        Texture::Checker(c) => format!("checker {} / {}, {} m", colour(c.even), colour(c.odd), c.size),
        Texture::Image(texture) => {
            let [width, height] = texture.image.size();
            format!("image {} ({width} × {height})", texture.image.name())
        }
    }
}

/// So many of something whose plural ends in s.
fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

fn colour(c: Rgb) -> String {
    if c.x == c.y && c.y == c.z { c.x.to_string() } else { format!("[{}, {}, {}]", c.x, c.y, c.z) }
}

fn point(p: DVec3) -> String {
    let short = |x: f64| {
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}
