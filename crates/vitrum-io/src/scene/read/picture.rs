//! Settings, output, camera, surroundings and background.

use toml::de::DeTable;
use vitrum_math::DVec3;

use super::super::schema::{self, SMALLEST};
use super::super::{
    Background, Branching, Camera, Filter, Integrator, Lens, MAX_PIXELS, Name, Output, Render, Shadow, Tone,
};
use super::{Context, Fields, Problem, Source, Span, value};

/// Sine of the angle between `up` and the line of sight below which the picture's orientation is noise.
const LEAST_TILT: f64 = 1e-9;

pub(super) fn render(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Render> {
    let mut fields = Fields::open(cx, &schema::RENDER, table, span);
    let size = fields.read("size", value::size);
    let spp = fields.small_integer("spp");
    let max_depth = fields.small_integer("max_depth");
    let cutoff = fields.number("cutoff");
    let seed = fields.integer("seed");
    let filter = fields.choice(
        "filter",
        &[("box", Filter::Box), ("tent", Filter::Tent), ("blackman-harris", Filter::BlackmanHarris)],
    );
    let integrator =
        fields.choice("integrator", &[("whitted", Integrator::Whitted), ("path", Integrator::Path)]);
    let branching = fields.choice(
        "branching",
        &[
            ("auto", Branching::Auto),
            ("one", Branching::One),
            ("first", Branching::First),
            ("tree", Branching::Tree),
        ],
    );
    let shadow = fields.choice("shadow", &[("opaque", Shadow::Opaque), ("straight", Shadow::Straight)]);
    if integrator == Some(Integrator::Path) && shadow == Some(Shadow::Straight) {
        let message = "paths know no straight shadows";
        let label = "light through glass is found where it goes";
        let problem = Problem::error(fields.span_of("shadow"), message, label);
        let problem = problem.also(fields.span_of("integrator"), "paths are asked for here");
        fields.cx.report(problem.help("leave out `shadow`, or write integrator = \"whitted\""));
    }
    if let Some([width, height]) = size {
        let pixels = u64::from(width) * u64::from(height);
        if pixels > MAX_PIXELS {
            let label = format!("{pixels} pixels, at most {MAX_PIXELS} (2^28) fit");
            let problem = Problem::error(fields.span_of("size"), "the picture is too large", label);
            fields.cx.report(problem.help("a square picture can have up to 16384 pixels a side"));
        }
    }
    fields.close();
    Some(Render {
        size: size?,
        spp: spp?,
        max_depth,
        cutoff: cutoff?,
        filter: filter?,
        seed: seed?,
        integrator,
        branching: branching?,
        shadow: shadow?,
    })
}

pub(super) fn output(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Output> {
    let mut fields = Fields::open(cx, &schema::OUTPUT, table, span);
    let exposure = fields.number("exposure");
    let tone = fields.choice("tone", &[("clip", Tone::Clip), ("neutral", Tone::Neutral)]);
    fields.close();
    Some(Output { exposure: exposure?, tone: tone? })
}

pub(super) fn surroundings(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Name> {
    let mut fields = Fields::open(cx, &schema::SURROUNDINGS, table, span);
    let medium = fields.reference("medium");
    fields.close();
    medium
}

pub(super) fn camera(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Camera> {
    let mut fields = Fields::open(cx, &schema::CAMERA, table, span);
    let position = fields.point("position");
    let target = fields.point("target");
    let up = fields.vector("up");
    if let (Some(position), Some(target)) = (position, target) {
        check_view(&mut fields, position, target, up);
    }
    let distance = position.zip(target).map(|(position, target)| position.distance(target));
    let lens = match fields.variant() {
        Some("pinhole") => fields.number("fov").map(|fov| Lens::Pinhole { fov }),
        Some("thin-lens") => {
            let (fov, radius) = (fields.number("fov"), fields.number("lens_radius"));
            let focus_distance = fields.number("focus_distance").or(distance);
            fov.zip(radius).zip(focus_distance).map(|((fov, radius), focus_distance)| Lens::Thin {
                fov,
                radius,
                focus_distance,
            })
        }
        Some("orthographic") => fields.number("height").map(|height| Lens::Orthographic { height }),
        Some(other) => panic!("no reader for a {other} camera"),
        None => None,
    };
    let target_span = fields.span_of("target");
    let medium = fields.reference("medium");
    fields.close();
    Some(Camera { span, position: position?, target: target?, target_span, up: up?, lens: lens?, medium })
}

fn check_view(fields: &mut Fields<'_, '_>, position: DVec3, target: DVec3, up: Option<DVec3>) {
    let view = target - position;
    if view.length() < SMALLEST {
        let at = fields.span_of("target");
        let problem = Problem::error(at, "the camera stands at its target", "the same point as `position`");
        let problem = problem.also(fields.span_of("position"), "the camera stands here");
        fields.cx.report(problem.help("move either: the camera looks from `position` to `target`"));
        return;
    }
    let Some(up) = up else { return };
    if view.normalize().cross(up.normalize()).length() >= LEAST_TILT {
        return;
    }
    let (place, label) = if fields.has("up") {
        ("up", format!("the view goes along {}", three(view)))
    } else {
        ("target", "the view goes straight along the default, up = [0, 1, 0]".to_string())
    };
    let other = if view.x.abs() < view.z.abs() { "[1, 0, 0]" } else { "[0, 0, -1]" };
    let problem = Problem::error(fields.span_of(place), "`up` lies along the line of sight", label);
    fields.cx.report(problem.help(format!("choose what is up in the picture, for example up = {other}")));
}

fn three(v: DVec3) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

pub(super) fn background(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Background> {
    let mut fields = Fields::open(cx, &schema::BACKGROUND, table, span);
    let background = match fields.variant() {
        Some("constant") => fields.colour("color").map(|color| Background::Constant { color }),
        Some("gradient") => {
            let (bottom, top) = (fields.colour("bottom"), fields.colour("top"));
            bottom.zip(top).map(|(bottom, top)| Background::Gradient { bottom, top })
        }
        Some("image") => {
            let (file, rotation, scale) =
                (fields.text("file"), fields.number("rotation"), fields.number("scale"));
            file.zip(rotation).zip(scale).map(|((file, rotation), scale)| Background::Image {
                file: file.text.into(),
                file_span: file.span,
                rotation,
                scale,
            })
        }
        Some(other) => panic!("no reader for a {other} background"),
        None => None,
    };
    fields.close();
    background
}

/// The defaults of the schema, through its own reader.
fn defaults<T>(read: impl FnOnce(&mut Context<'_>, &DeTable<'_>, Span) -> Option<T>) -> T {
    let mut cx = Context::new(Source::new("", ""));
    read(&mut cx, &DeTable::new(), Span::default()).expect("every key has a default")
}

impl Default for Render {
    fn default() -> Self {
        defaults(render)
    }
}

impl Default for Output {
    fn default() -> Self {
        defaults(output)
    }
}
