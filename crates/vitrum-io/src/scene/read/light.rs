//! Lights.

use toml::de::DeTable;

use super::super::schema::{self, Realm};
use super::super::{Falloff, Light, LightKind};
use super::{Context, Fields, Span};

pub(super) fn light(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Light> {
    let mut fields = Fields::open(cx, &schema::LIGHT, table, span);
    let name = fields.name(Realm::Light);
    let kind = match fields.variant() {
        Some("ambient") => fields.colour("radiance").map(|radiance| LightKind::Ambient { radiance }),
        Some("point") => point(&mut fields),
        Some("directional") => directional(&mut fields),
        Some(other) => panic!("no reader for a {other} light"),
        None => None,
    };
    fields.close();
    Some(Light { span, name, kind: kind? })
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

fn directional(fields: &mut Fields<'_, '_>) -> Option<LightKind> {
    let direction = fields.vector("direction");
    let irradiance = fields.colour("irradiance");
    let shadows = fields.boolean("shadows");
    Some(LightKind::Directional { direction: direction?, irradiance: irradiance?, shadows: shadows? })
}
