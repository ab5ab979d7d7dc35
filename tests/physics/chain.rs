//! One ray through several interfaces, always by transmission.

use crate::stage::THROUGH;
use vitrum::bxdf::TransportMode;
use vitrum::geometry::{Counters, Query};
use vitrum::math::{Frame, Ray};
use vitrum::tracer::{Scene, Uses};

/// The ray after `crossings` interfaces; `None` when it meets fewer, or is totally reflected.
pub(crate) fn transmit(scene: &Scene, ray: Ray, crossings: usize) -> Option<Ray> {
    let mut query = Query::new(ray);
    for _ in 0..crossings {
        let hit = scene.aggregate().closest(&query, &mut Counters::default())?;
        let surface = scene.aggregate().interaction(&query, &hit, &mut Counters::default());
        let scattering = scene.scattering(&hit, surface.point, &mut Uses::default());
        let frame = Frame::around(surface.ns);
        let child =
            scattering.specular()?.split(frame.to_local(surface.wo), TransportMode::Radiance).transmitted?;
        query = surface.leave(frame.to_world(child.wi), THROUGH);
    }
    Some(query.ray)
}
