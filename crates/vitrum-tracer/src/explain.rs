//! The ray tree through one point of a picture, told in full: what each ray meets, in which medium, and what becomes of it.
//!
//! The tree follows both children of glass and the mirrored one of mirrors, as Whitted's does, whatever the integrator; it ends at
//! surfaces that scatter, at the depth limit, and below a weight. It knows the solids around each ray in every scene, so that a surface
//! that contradicts them is seen: light that leaves what it never entered came through a gap.

use crate::crossing::{Met, Nested, Step};
use crate::media::MediaTable;
use crate::media_list::MediaList;
use crate::overlaps::MOST;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::stats::Stats;
use crate::walker::{side, split};
use vitrum_geometry::Query;
use vitrum_materials::Medium;
use vitrum_math::{DVec3, Rgb};

/// Weight below which a ray is not followed.
const FAINT: f64 = 1e-3;

/// A ray of the tree.
#[derive(Clone, Debug)]
pub struct ExplainedRay {
    /// The ray that it comes from; none for that of the camera.
    pub parent: Option<usize>,
    /// How it left the surface that its parent meets.
    pub way: Way,
    /// 0 for the camera ray.
    pub depth: u32,
    /// Where it starts, and its unit direction.
    pub ray: (DVec3, DVec3),
    /// What its radiance counts for in the picture.
    pub throughput: Rgb,
    /// What it goes through.
    pub medium: Medium,
    /// The solids that it is in, by id, the one that fills the place first.
    pub solids: Vec<u32>,
    /// Surfaces of solids on its way that are not there, with their distances, because another solid fills both sides.
    pub passed: Vec<(f64, u32)>,
    /// What it meets.
    pub met: Option<ExplainedHit>,
    /// Why it has no children, or not all.
    pub ended: Ending,
}

/// How a ray goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// From the camera.
    Camera,
    /// Mirrored.
    Reflected,
    /// Through the surface.
    Transmitted,
}

/// What a ray meets.
#[derive(Clone, Debug)]
pub struct ExplainedHit {
    /// The object, by id.
    pub object: u32,
    /// Its face.
    pub face: u32,
    /// Metres along the ray.
    pub distance: f64,
    /// Where that is.
    pub point: DVec3,
    /// The unit normal, away from the inside.
    pub normal: DVec3,
    /// True where the ray comes from the side of the normal.
    pub front: bool,
    /// Cosine of the angle of incidence.
    pub cos_theta_i: f64,
    /// What is beyond the surface, where it divides two media.
    pub beyond: Option<Medium>,
    /// Index beyond over index before.
    pub eta: Option<f64>,
    /// The shares that are reflected and transmitted, without the change of radiance by the square of `eta`.
    pub shares: Option<[Rgb; 2]>,
    /// True where the ray leaves a solid that it was not in, or comes to an interface out of another medium than that expects.
    pub unmatched: bool,
}

/// Why a ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It goes on.
    Divides,
    /// It meets nothing: it brings this radiance of the background.
    Escapes(Rgb),
    /// The surface scatters light into all directions, or absorbs it, or shines with this radiance.
    Scatters(Rgb),
    /// Its children would be deeper than the limit.
    TooDeep,
    /// Its children would weigh less than a thousandth.
    TooFaint,
}

/// The ray tree through a point of the picture, in pixels from its upper left corner; each ray stands before its children. Ends at
/// `most` rays.
pub fn explain(scene: &Scene, settings: &Settings, [x, y]: [f64; 2], most: usize) -> Vec<ExplainedRay> {
    let table = MediaTable::new(scene, settings.size, true);
    let nested = Nested { scene, table: &table };
    // Through the middle of a lens.
    let ray = scene.camera.ray(x, y, settings.size, || [0.5, 0.5]);
    let mut stats = Stats::default();
    let list: MediaList<MOST> = nested.around_camera(ray.origin, &mut stats);
    let mut waiting = vec![Waiting {
        parent: None,
        way: Way::Camera,
        depth: 0,
        query: Query::new(ray),
        throughput: Rgb::ONE,
        eta_squared: 1.0,
        list,
    }];
    let mut tree: Vec<ExplainedRay> = Vec::new();
    while let Some(node) = waiting.pop() {
        if tree.len() == most {
            break;
        }
        let id = tree.len();
        let (told, children) = follow(&nested, settings, &node, id, &mut stats);
        tree.push(told);
        waiting.extend(children.into_iter().rev());
    }
    tree
}

/// The medium at a point, and the solids that it lies in by id, the one that fills the place first. What open interfaces enclose is not
/// found so.
pub fn medium_at(scene: &Scene, point: DVec3) -> (Medium, Vec<u32>) {
    let table = MediaTable::new(scene, [1, 1], true);
    let nested = Nested { scene, table: &table };
    let list: MediaList<MOST> = nested.around(point, &mut Stats::default());
    (*table.medium(nested.medium(&list)), list.solids().collect())
}

struct Waiting {
    parent: Option<usize>,
    way: Way,
    depth: u32,
    query: Query,
    throughput: Rgb,
    eta_squared: f64,
    list: MediaList<MOST>,
}

/// What becomes of a ray, and its children.
fn follow(
    nested: &Nested<'_>,
    settings: &Settings,
    node: &Waiting,
    id: usize,
    stats: &mut Stats,
) -> (ExplainedRay, Vec<Waiting>) {
    let Waiting { parent, way, depth, mut query, throughput, eta_squared, mut list } = *node;
    let scene = nested.scene;
    let mut passed = Vec::new();
    let exits = stats.unmatched_exits;
    let met = loop {
        match nested.step(&mut query, &mut list, f64::INFINITY, stats) {
            Some(Step::Passed(hit)) => passed.push((hit.t, hit.object)),
            Some(Step::Ignored) => {}
            Some(Step::Met(met)) => break Some(met),
            None => break None,
        }
    };
    // Where the camera stands, an interface that it sees knows.
    if let (0, Some(met)) = (depth, &met)
        && let Some(here) = nested.said_to_camera(&met.surface)
    {
        list.cross_interface(here, |solid| nested.filled(solid));
    }
    let medium = *nested.table.medium(nested.medium(&list));
    let mut told = ExplainedRay {
        parent,
        way,
        depth,
        ray: (query.ray.origin, query.ray.direction),
        throughput,
        medium,
        solids: list.solids().collect(),
        passed,
        met: None,
        ended: Ending::Divides,
    };
    let Some(Met { hit, surface, body, beyond, .. }) = met else {
        told.ended = Ending::Escapes(scene.background.radiance(query.ray.direction));
        return (told, vec![]);
    };
    let throughput = throughput * medium.absorption.transmittance(hit.t);
    let scattering = scene.scattering(&hit, surface.point, &mut stats.uses);
    let scattering = body.map_or(scattering, |body| scattering.with_body(body));
    let specular = scattering
        .specular()
        .map(|body| split(body, &surface))
        .map(|(split, frame, _)| ([split.reflected, split.transmitted], frame));
    let divides = scene.material(hit.object, hit.face).is_dielectric();
    let after = *nested.table.medium(nested.medium(&beyond));
    let shares = specular
        .as_ref()
        .map(|(children, _)| children.map(|child| child.map_or(Rgb::ZERO, |c| c.weight * (c.eta * c.eta))));
    let unmatched = stats.unmatched_exits > exits || !nested.expects(&surface, &list);
    told.met = Some(ExplainedHit {
        object: hit.object,
        face: hit.face,
        distance: hit.t,
        point: surface.point,
        normal: surface.ng,
        front: surface.front,
        cos_theta_i: surface.wo.dot(surface.ng).abs(),
        beyond: divides.then_some(after),
        eta: divides.then(|| after.index.value() / medium.index.value()),
        shares,
        unmatched,
    });
    let Some((children, frame)) = specular else {
        told.ended = Ending::Scatters(if surface.front { scattering.emitted } else { Rgb::ZERO });
        return (told, vec![]);
    };
    let mut followed = Vec::new();
    for (child, way) in children.into_iter().zip([Way::Reflected, Way::Transmitted]) {
        let Some(child) = child else { continue };
        let (throughput, eta_squared) = (throughput * child.weight, eta_squared * (child.eta * child.eta));
        if depth + 1 > settings.deepest() {
            told.ended = Ending::TooDeep;
        } else if throughput.max_element() * eta_squared < FAINT {
            told.ended = Ending::TooFaint;
        } else {
            let side = side(&child);
            let list = if way == Way::Transmitted { beyond } else { list };
            let query = surface.leave(frame.to_world(child.wi).normalize(), side);
            followed.push(Waiting {
                parent: Some(id),
                way,
                depth: depth + 1,
                query,
                throughput,
                eta_squared,
                list,
            });
        }
    }
    (told, followed)
}
