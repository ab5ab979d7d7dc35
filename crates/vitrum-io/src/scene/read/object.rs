//! Objects and where they stand.

use std::collections::BTreeMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vitrum_geometry::mesh::Build;

use super::super::schema::{self, Key, Realm, SMALLEST};
use super::super::{MaterialChoice, Normals, Object, Shape, Step, Transform};
use super::context::shorten;
use super::{Context, Fields, Problem, Span, matter, value};

/// Sine of the angle between two edges below which they are parallel.
const LEAST_ANGLE: f64 = 1e-9;

pub(super) fn object(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Object> {
    let mut fields = Fields::open(cx, &schema::OBJECT, table, span);
    let name = fields.name(Realm::Object);
    let steps = fields.tables("transform", step);
    let transform = Transform { span: fields.span_of("transform"), steps };
    let flip = fields.boolean("flip");
    let shape = match fields.variant() {
        Some("sphere") => sphere(&mut fields),
        Some("plane") => plane(&mut fields),
        Some("disk") => disk(&mut fields),
        Some("rectangle") => rectangle(&mut fields),
        Some("box") => cuboid(&mut fields),
        Some("cylinder") => cylinder(&mut fields),
        Some("mesh") => mesh(&mut fields),
        Some("instance") => fields.reference("of").map(|of| Shape::Instance { of }),
        Some(other) => panic!("no reader for the shape {other}"),
        None => None,
    };
    let material = if fields.variant().is_some() { fields.read("material", material) } else { None };
    fields.close();
    Some(Object { span, name, shape: shape?, material, transform, flip: flip? })
}

fn material(cx: &mut Context<'_>, key: &Key, value: &Spanned<DeValue<'_>>) -> Option<MaterialChoice> {
    match value.get_ref() {
        DeValue::Table(table) => {
            let material = matter::material(cx, &schema::INLINE_MATERIAL, table, value.span().into())?;
            Some(MaterialChoice::Inline(Box::new(material)))
        }
        _ => value::used_name(cx, key, Realm::Material, value).map(MaterialChoice::Named),
    }
}

fn sphere(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let (center, radius) = (fields.point("center"), fields.number("radius"));
    Some(Shape::Sphere { center: center?, radius: radius? })
}

fn plane(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let (point, normal) = (fields.point("point"), fields.vector("normal"));
    Some(Shape::Plane { point: point?, normal: normal? })
}

fn disk(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let (center, normal, radius) = (fields.point("center"), fields.vector("normal"), fields.number("radius"));
    Some(Shape::Disk { center: center?, normal: normal?, radius: radius? })
}

fn rectangle(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let corner = fields.point("corner");
    let (edge_u, edge_v) = (fields.vector("edge_u"), fields.vector("edge_v"));
    let (edge_u, edge_v) = (edge_u?, edge_v?);
    if edge_u.normalize().cross(edge_v.normalize()).length() < LEAST_ANGLE {
        let problem = Problem::error(
            fields.span_of("edge_v"),
            "the edges of the rectangle are parallel",
            "parallel to `edge_u`",
        )
        .also(fields.span_of("edge_u"), "`edge_u`")
        .help("turn one of the edges, so that they span an area");
        fields.cx.report(problem);
    }
    Some(Shape::Rectangle { corner: corner?, edge_u, edge_v })
}

fn cuboid(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let (min, max) = (fields.point("min"), fields.point("max"));
    let (min, max) = (min?, max?);
    let axes: Vec<&str> = ["x", "y", "z"]
        .into_iter()
        .zip((max - min).to_array())
        .filter(|(_, d)| *d < SMALLEST)
        .map(|(a, _)| a)
        .collect();
    if !axes.is_empty() {
        let message = format!("the box has no extent along {}", axes.join(" and "));
        let problem =
            Problem::error(fields.span_of("max"), message, "expected more than `min` on every axis")
                .also(fields.span_of("min"), "`min`")
                .help("swap the numbers, or use shape = \"rectangle\" for something flat");
        fields.cx.report(problem);
    }
    Some(Shape::Box { min, max })
}

fn cylinder(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let (bottom, top) = (fields.point("bottom"), fields.point("top"));
    let (radius, capped) = (fields.number("radius"), fields.boolean("capped"));
    let (bottom, top) = (bottom?, top?);
    if bottom.distance(top) < SMALLEST {
        let problem =
            Problem::error(fields.span_of("top"), "the cylinder has no height", "the same point as `bottom`")
                .also(fields.span_of("bottom"), "`bottom`")
                .help("`bottom` and `top` are the ends of the axis; for something flat use shape = \"disk\"");
        fields.cx.report(problem);
    }
    Some(Shape::Cylinder { bottom, top, radius: radius?, capped: capped? })
}

fn mesh(fields: &mut Fields<'_, '_>) -> Option<Shape> {
    let file = fields.text("file");
    let normals = fields
        .choice("normals", &[("smooth", Normals::Smooth), ("flat", Normals::Flat), ("file", Normals::File)]);
    let build =
        fields.choice("build", &[("fast", Build::Fast), ("medium", Build::Medium), ("best", Build::Best)]);
    let group = fields.text("group");
    let force = fields.boolean("force");
    let file = file?;
    Some(Shape::Mesh {
        file: file.text.into(),
        file_span: file.span,
        normals: normals?,
        build: build?,
        group,
        force: force?,
    })
}

fn step(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Step> {
    let mut fields = Fields::open(cx, &schema::STEP, table, span);
    let translate = fields.point("translate").map(Step::Translate);
    let rotate = fields.table("rotate", rotation);
    let scale = fields.read("scale", value::scale).map(Step::Scale);
    let written = ["translate", "rotate", "scale"].into_iter().filter(|key| fields.has(key)).count();
    // With an unknown key in it, that one has been told.
    if written > 1 || table.is_empty() {
        let message =
            if written > 1 { "a step of a transform does one thing" } else { "this step does nothing" };
        let label =
            if written > 1 { format!("found {written} in one step") } else { "found an empty table".into() };
        let help = "one of `translate`, `rotate` and `scale` a step: [{ translate = ... }, { scale = ... }]";
        fields.cx.report(Problem::error(span, message, label).help(help));
    }
    fields.close();
    translate.or(rotate).or(scale)
}

fn rotation(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Step> {
    let mut fields = Fields::open(cx, &schema::ROTATION, table, span);
    let (axis, angle) = (fields.vector("axis"), fields.number("angle"));
    fields.close();
    Some(Step::Rotate { axis: axis?, angle: angle? })
}

/// Tells instances of instances.
pub(super) fn check_instances(cx: &mut Context<'_>, objects: &[Object]) {
    let instances: BTreeMap<&str, &str> = objects
        .iter()
        .filter_map(|object| match (&object.name, &object.shape) {
            (Some(name), Shape::Instance { of }) => Some((name.text.as_str(), of.text.as_str())),
            _ => None,
        })
        .collect();
    for object in objects {
        let Shape::Instance { of } = &object.shape else { continue };
        let Some(original) = instances.get(of.text.as_str()) else { continue };
        let message = format!("\"{}\" is itself an instance", shorten(&of.text));
        let problem = Problem::error(of.span, message, "expected an object with a shape of its own");
        let help = if instances.contains_key(original) {
            "name the object whose shape is meant".to_string()
        } else {
            format!("write of = \"{}\", the object whose shape it shares", shorten(original))
        };
        cx.report(problem.help(help));
    }
}
