//! Lights.

use toml::de::DeTable;

use super::super::schema::{self, Realm};
use super::super::{Falloff, Integrator, Light, LightKind, Render};
use super::{Context, Fields, Problem, Span};

pub(super) fn light(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Light> {
    let mut fields = Fields::open(cx, &schema::LIGHT, table, span);
    let name = fields.name(Realm::Light);
    let kind = match fields.variant() {
        Some("ambient") => fields.colour("radiance").map(|radiance| LightKind::Ambient { radiance }),
        Some("point") => point(&mut fields),
        Some("spot") => spot(&mut fields),
        Some("directional") => directional(&mut fields),
        Some(other) => panic!("no reader for a {other} light"),
        None => None,
    };
    fields.close();
    Some(Light { span, name, kind: kind? })
}

/// Tells ambient light where light is followed by paths.
pub(super) fn check_ambient(cx: &mut Context<'_>, render: &Render, lights: &[Light]) {
    if render.integrator != Some(Integrator::Path) {
        return;
    }
    for light in lights.iter().filter(|light| matches!(light.kind, LightKind::Ambient { .. })) {
        let problem = Problem::error(
            light.span,
            "paths know no ambient light",
            "light from everywhere, without shadows",
        );
        cx.report(problem.help("light the scene by a [background], which paths follow into every corner"));
    }
}

fn point(fields: &mut Fields<'_, '_>) -> Option<LightKind> {
    let position = fields.point("position");
    let intensity = fields.colour("intensity");
    let falloff =
        fields.choice("falloff", &[("inverse-square", Falloff::InverseSquare), ("none", Falloff::None)]);
    let shadows = fields.boolean("shadows");
    Some(LightKind::Point {
        position: position?,
        intensity: intensity?,
        falloff: falloff?,
        shadows: shadows?,
    })
}

fn spot(fields: &mut Fields<'_, '_>) -> Option<LightKind> {
    let position = fields.point("position");
    let direction = fields.vector("direction");
    let intensity = fields.colour("intensity");
    let (outer, inner) = (fields.number("outer"), fields.number("inner"));
    let shadows = fields.boolean("shadows");
    let outer = outer?;
    let inner = inner.unwrap_or(0.8 * outer);
    if inner >= outer {
        let label = format!("{inner} degrees, where `outer` is {outer}");
        let problem =
            Problem::error(fields.span_of("inner"), "the inner cone is not inside the outer one", label);
        fields.cx.report(problem.help("make `inner` less than `outer`; just below it for a sharp edge"));
        return None;
    }
    Some(LightKind::Spot {
        position: position?,
        direction: direction?,
        intensity: intensity?,
        inner,
        outer,
        shadows: shadows?,
    })
}

fn directional(fields: &mut Fields<'_, '_>) -> Option<LightKind> {
    let direction = fields.vector("direction");
    let irradiance = fields.colour("irradiance");
    let shadows = fields.boolean("shadows");
    Some(LightKind::Directional { direction: direction?, irradiance: irradiance?, shadows: shadows? })
}
