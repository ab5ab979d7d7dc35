//! What is seen in each pixel beside light: objects, distances, normals, and what lies behind glass. For compositing, for denoisers, and
//! to find what is wrong with a model.
//!
//! The rays are those of a pixel's first samples, so that edges are where they are in the picture. Numbers of things come from the
//! ray through the middle of the pixel, since means of them say nothing; everything else is a mean.

use crate::crossing::{Met, Nested};
use crate::filter::FilterSampler;
use crate::media::MediaTable;
use crate::media_list::MediaList;
use crate::overlaps::MOST;
use crate::render::RenderError;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::stats::Stats;
use crate::threads::{on_each, on_threads};
use crate::walker::{shading_normal, side, split};
use vitrum_bxdf::Bxdf;
use vitrum_geometry::{Query, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{DVec3, NodeKey, Purpose, Ray, Rgb, SampleAddress};

/// Rays for a pixel: as many as there are samples, but no more.
const MOST_RAYS: u32 = 16;

/// A ray follows glass and mirrors through so many surfaces.
const MOST_SURFACES: u32 = 32;

/// What is seen in a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// The object in its middle, as its place in the list of names plus one; 0 for none.
    pub object: u32,
    /// The material there, as its place among those of the scene plus one; 0 for none.
    pub material: u32,
    /// Distance from the camera, metres, of the rays that meet something; infinite where none does.
    pub depth: f64,
    /// Shading normal towards the camera; zero where nothing is met.
    pub normal: DVec3,
    /// Share of light that the surface gives back: 1 for glass and mirrors without a colour; of a background, its radiance up to 1.
    pub albedo: Rgb,
    /// The normal of the first surface behind glass and mirrors.
    pub normal_behind: DVec3,
    /// And what that gives back.
    pub albedo_behind: Rgb,
    /// The most solids that the ray in the middle is in at a time, on its way there.
    pub media: u32,
    /// How often rays left solids that they were not in, or came to an interface out of another medium than that expects.
    pub unmatched: f64,
}

/// What is seen in the pixels of the area that the settings name, row by row.
///
/// # Errors
/// [`RenderError::Threads`] where the system gives none.
pub fn seen(scene: &Scene, settings: &Settings) -> Result<Vec<Seen>, RenderError> {
    let table = MediaTable::new(scene, settings.size, true);
    let nested = Nested { scene, table: &table };
    let filter = FilterSampler::new(settings.filter);
    let area = settings.area();
    let rows: Vec<u32> = (area.y..area.y + area.height).collect();
    let look = |y: &u32| -> Vec<Seen> {
        (area.x..area.x + area.width).map(|x| of_pixel(&nested, settings, &filter, [x, *y])).collect()
    };
    Ok(on_threads(settings.threads, || on_each(settings, &rows, look))?.concat())
}

fn of_pixel(nested: &Nested<'_>, settings: &Settings, filter: &FilterSampler, [x, y]: [u32; 2]) -> Seen {
    let camera = &nested.scene.camera;
    let at = |dx: f64, dy: f64, lens: [f64; 2]| {
        camera.ray(f64::from(x) + dx, f64::from(y) + dy, settings.size, || lens)
    };
    let middle = along(nested, at(0.5, 0.5, [0.5, 0.5]));
    let count = settings.spp.min(MOST_RAYS);
    let (mut sum, mut hits) = (Seen::default(), 0);
    for sample in 0..count {
        let address = SampleAddress::new(settings.seed, x, y, sample).of_sequence(settings.sequence);
        let [dx, dy] = filter.sample(address.pair(NodeKey::ROOT, Purpose::Film));
        let one = along(nested, at(dx, dy, address.pair(NodeKey::ROOT, Purpose::Lens)));
        if one.depth < f64::INFINITY {
            sum.depth += one.depth;
            hits += 1;
        }
        sum.normal += one.normal;
        sum.albedo += one.albedo;
        sum.normal_behind += one.normal_behind;
        sum.albedo_behind += one.albedo_behind;
        sum.unmatched += one.unmatched;
    }
    let share = 1.0 / f64::from(count.max(1));
    Seen {
        depth: if hits > 0 { sum.depth / f64::from(hits) } else { f64::INFINITY },
        normal: sum.normal * share,
        albedo: sum.albedo * share,
        normal_behind: sum.normal_behind * share,
        albedo_behind: sum.albedo_behind * share,
        unmatched: sum.unmatched * share,
        ..middle
    }
}

/// What one ray sees.
fn along(nested: &Nested<'_>, ray: Ray) -> Seen {
    let mut stats = Stats::default();
    let mut list: MediaList<MOST> = nested.around_camera(ray.origin, &mut stats);
    let mut query = Query::new(ray);
    let mut seen = Seen { depth: f64::INFINITY, ..Seen::default() };
    for surfaces in 0..=MOST_SURFACES {
        seen.media = seen.media.max(list.solids().count() as u32);
        let Some(Met { hit, surface, body, beyond, .. }) =
            nested.meet(&mut query, &mut list, f64::INFINITY, &mut stats)
        else {
            let sky = nested.scene.background.radiance(query.ray.direction).min(Rgb::ONE);
            seen.albedo_behind = sky;
            if surfaces == 0 {
                seen.albedo = sky;
            }
            break;
        };
        if surfaces == 0
            && let Some(here) = nested.said_to_camera(&surface)
        {
            list.cross_interface(here, |solid| nested.filled(solid));
        }
        let scattering = nested.scene.scattering(&hit, surface.point, &mut stats.uses);
        let scattering = body.map_or(scattering, |body| scattering.with_body(body));
        seen.unmatched += f64::from(u8::from(!nested.expects(&surface, &list)));
        let towards = if surface.front { shading_normal(&surface) } else { -shading_normal(&surface) };
        let albedo = albedo(&scattering);
        if surfaces == 0 {
            seen.object = hit.object + 1;
            seen.material = nested.scene.material_at(hit.object, hit.face) as u32 + 1;
            (seen.depth, seen.normal, seen.albedo) = (hit.t, towards, albedo);
        }
        (seen.normal_behind, seen.albedo_behind) = (towards, albedo);
        let Some(next) = scattering.specular().and_then(|body| stronger(body, &surface)) else { break };
        if next.is_through {
            list = beyond;
        }
        query = surface.leave(next.direction, next.side);
    }
    seen.unmatched += stats.unmatched_exits as f64;
    seen
}

struct Next {
    direction: DVec3,
    side: vitrum_geometry::Side,
    is_through: bool,
}

/// The stronger of the two rays that glass makes of one.
fn stronger(body: &Bxdf<f64>, surface: &SurfaceInteraction) -> Option<Next> {
    let (split, frame, _) = split(body, surface);
    let weight = |child: &vitrum_bxdf::Sample<f64>| child.weight.max_element() * (child.eta * child.eta);
    let both = [split.reflected, split.transmitted];
    let child = both.into_iter().flatten().max_by(|a, b| weight(a).total_cmp(&weight(b)))?;
    let is_through = child.lobe.is_transmission();
    Some(Next { direction: frame.to_world(child.wi).normalize(), side: side(&child), is_through })
}

/// The share of light that comes back, roughly: what a denoiser divides by.
fn albedo(scattering: &Scattering) -> Rgb {
    let own = match scattering.body() {
        Some(Bxdf::Conductor(metal)) => metal.index.reflectance(1.0),
        Some(Bxdf::PerfectSpecular(mirror)) => mirror.kr,
        Some(Bxdf::PerfectTransmitter(glass)) => glass.kr.max(glass.kt),
        Some(_) => Rgb::ONE,
        None => Rgb::ZERO,
    };
    let diffuse = scattering.diffuse.map_or(Rgb::ZERO, |d| d.reflectance);
    (own + diffuse + scattering.emitted).min(Rgb::ONE)
}
