//! Light that arrives at a surface straight from a light.

use crate::light::{Arrival, Light};
use crate::scene::Scene;
use crate::settings::ShadowMode;
use crate::stats::Stats;
use vitrum_geometry::{Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{Frame, Rgb};

/// The radiance that all lights together send by way of `surface` to where the ray came from.
pub(crate) fn direct(
    scene: &Scene,
    shadow: ShadowMode,
    surface: &SurfaceInteraction,
    frame: &Frame,
    scattering: &Scattering,
    stats: &mut Stats,
) -> Rgb {
    let wo = frame.to_local(surface.wo);
    let mut radiance = Rgb::ZERO;
    for light in &scene.lights {
        let Some(arrival) = light.arriving_at(surface.point) else { continue };
        // Light on the other side of the surface can't be reflected, whatever an interpolated normal says.
        if surface.side_of(arrival.towards) != Side::Incident {
            continue;
        }
        let reflected = scattering.eval(wo, frame.to_local(arrival.towards)) * arrival.irradiance;
        if reflected != Rgb::ZERO {
            radiance += reflected * visibility(scene, shadow, light, &arrival, surface, stats);
        }
    }
    radiance
}

/// The share of the light that reaches the surface: zero or one, but through glass in straight mode.
fn visibility(
    scene: &Scene,
    shadow: ShadowMode,
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
    match shadow {
        ShadowMode::Opaque => {
            let blocked = scene.aggregate().occluded(&query, arrival.distance, &mut stats.geometry);
            if blocked { Rgb::ZERO } else { Rgb::ONE }
        }
        ShadowMode::Straight => {
            let mut transmittance = Rgb::ONE;
            while let Some(hit) = scene.aggregate().closest(&query, &mut stats.geometry)
                && hit.t < arrival.distance
            {
                transmittance *= scene.material(hit.object, hit.face).straight_transmittance();
                if transmittance == Rgb::ZERO {
                    break;
                }
                query.pass(hit.t, hit.object, hit.face);
            }
            transmittance
        }
    }
}
