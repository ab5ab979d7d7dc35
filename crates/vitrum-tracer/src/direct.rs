//! Light that arrives at a surface straight from a light.

use crate::crossing::Nested;
use crate::feature::Feature;
use crate::light::{Arrival, Light};
use crate::settings::ShadowMode;
use crate::stats::Stats;
use crate::whereabouts::Whereabouts;
use vitrum_bxdf::TransportMode;
use vitrum_geometry::{Side, SurfaceInteraction};
use vitrum_materials::{Absorption, Scattering};
use vitrum_math::{DVec3, Frame, Rgb};

/// The tails of a sharp highlight reach down to 1e-300. Less than this, far below what a single-precision sample can hold
/// after any number of crossings, is not worth a shadow ray.
const INVISIBLE: f64 = 1e-60;

/// What there is on the way to the lights.
pub(crate) struct Way<'w, W> {
    pub(crate) nested: Nested<'w>,
    pub(crate) shadow: ShadowMode,
    /// What it starts in, where rays know the solids that they are in.
    pub(crate) from: Option<&'w W>,
    /// What absorbs along it, if anything does.
    pub(crate) medium: Option<Absorption>,
}

/// The radiance that all lights together send by way of `surface` to where the ray came from; `normal` is the one that it
/// is shaded with.
pub(crate) fn direct<W: Whereabouts>(
    way: &Way<'_, W>,
    surface: &SurfaceInteraction,
    normal: DVec3,
    scattering: &Scattering,
    stats: &mut Stats,
) -> Rgb {
    let mut radiance = Rgb::ZERO;
    for light in &way.nested.scene.lights {
        // Light on the other side of the surface can't be reflected, whatever an interpolated normal says. Every light is on
        // the other side of the inner walls of glass, so this comes before anything else.
        if surface.side_of(light.offset(surface.point)) == Side::Incident {
            let reflected = from_one(way, light, surface, normal, scattering, stats);
            // Light that goes through everything comes unweakened, too.
            radiance += match &way.medium {
                Some(medium) if light.casts_shadows() => {
                    reflected * medium.transmittance(light.distance_from(surface.point))
                }
                _ => reflected,
            };
        }
    }
    radiance
}

/// What one light on the viewer's side adds.
#[inline(never)]
fn from_one<W: Whereabouts>(
    way: &Way<'_, W>,
    light: &Light,
    surface: &SurfaceInteraction,
    normal: DVec3,
    scattering: &Scattering,
    stats: &mut Stats,
) -> Rgb {
    let Some(arrival) = light.arriving_at(surface.point) else { return Rgb::ZERO };
    let frame = Frame::around(normal);
    let (wo, wi) = (frame.to_local(surface.wo), frame.to_local(arrival.towards));
    let reflected = scattering.eval(wo, wi, TransportMode::Radiance) * arrival.irradiance;
    if reflected.max_element() <= INVISIBLE {
        return Rgb::ZERO;
    }
    reflected * visibility(way, light, &arrival, surface, stats)
}

/// The share of the light that reaches the surface: zero or one, but through glass in straight mode.
fn visibility<W: Whereabouts>(
    way: &Way<'_, W>,
    light: &Light,
    arrival: &Arrival,
    surface: &SurfaceInteraction,
    stats: &mut Stats,
) -> Rgb {
    if !light.casts_shadows() {
        return Rgb::ONE;
    }
    stats.shadow_rays += 1;
    let mut query = surface.leave(arrival.towards, Side::Incident);
    let &Way { ref nested, shadow, from, .. } = way;
    let scene = nested.scene;
    match (shadow, from) {
        (ShadowMode::Opaque, Some(from)) if W::KNOWS_SOLIDS => {
            let met = { *from }.meet(nested, &mut query, arrival.distance, stats);
            if met.is_some() { Rgb::ZERO } else { Rgb::ONE }
        }
        (ShadowMode::Straight, Some(from)) if W::KNOWS_SOLIDS => {
            stats.uses.count(Feature::StraightShadows);
            let (mut media, mut transmittance) = (*from, Rgb::ONE);
            while let Some(met) = media.meet(nested, &mut query, arrival.distance, stats) {
                let outside = met.outside.map(|outside| *nested.table.medium(outside));
                transmittance *= scene.material(met.hit.object, met.hit.face).straight_transmittance(outside);
                if transmittance == Rgb::ZERO {
                    break;
                }
                media = met.beyond;
                query.pass(met.last.t, met.last.object, met.last.face);
            }
            transmittance
        }
        (ShadowMode::Opaque, _) => {
            let blocked = scene.aggregate().occluded(&query, arrival.distance, &mut stats.geometry);
            if blocked { Rgb::ZERO } else { Rgb::ONE }
        }
        (ShadowMode::Straight, _) => {
            stats.uses.count(Feature::StraightShadows);
            let mut transmittance = Rgb::ONE;
            while let Some(hit) = scene.aggregate().closest(&query, &mut stats.geometry)
                && hit.t < arrival.distance
            {
                transmittance *= scene.material(hit.object, hit.face).straight_transmittance(None);
                if transmittance == Rgb::ZERO {
                    break;
                }
                query.pass(hit.t, hit.object, hit.face);
            }
            transmittance
        }
    }
}
