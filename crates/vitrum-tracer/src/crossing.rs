//! A ray on its way through solids that reach into each other: which of their surfaces it meets are there at all.
//!
//! At a surface the medium before it and the one behind it are those of the solids of the highest priority. Where both are the same,
//! nothing is there: the ray goes on, the same to the last bit. Where they are not, the surface is that of the solid which fills one of
//! the two sides, in the medium of the other.
//!
//! Two solids may be modelled to share a wall, as liquid in a glass. Rounding puts one of both walls before the other, here this and
//! there that. So surfaces within their rounding of each other are crossed together, and make one. A ray that starts there might find
//! the other one again: what is so near to where a ray starts, and says that it leaves what it is not in or enters what it is in, is
//! ignored.

use crate::feature::Feature;
use crate::media::{Interior, MediaTable, MediumId, Shell};
use crate::media_list::MediaList;
use crate::scene::Scene;
use crate::stats::Stats;
use vitrum_bxdf::Bxdf;
use vitrum_geometry::{Hit, Query, SurfaceInteraction};
use vitrum_math::{DVec3, Ray, gamma};

/// A ray goes straight through so many surfaces at most; what it would find beyond is taken for nothing, and counted.
const MOST_PASSED: u32 = 1_000_000;

/// Walls are taken to be one up to this ratio of the distance along a ray to that between them: more is a ray along both.
const MOST_SLANTED: f64 = 1e4;

/// So many walls of one place are remembered; more can't be told apart anyway.
const WALLS: usize = 4;

/// A surface that is there.
pub(crate) struct Met<W> {
    pub(crate) hit: Hit,
    pub(crate) surface: SurfaceInteraction,
    /// What it does to light, where that is not what its material says alone.
    pub(crate) body: Option<Bxdf<f64>>,
    /// The medium outside of it, where that is not what its material says.
    pub(crate) outside: Option<MediumId>,
    /// What a ray is in that crosses it.
    pub(crate) beyond: W,
    /// The last of the surfaces that make it: a ray that passes it straight goes on from there.
    pub(crate) last: Hit,
}

/// What a ray comes to.
#[expect(clippy::large_enum_variant, reason = "it is taken apart where it is made")]
pub(crate) enum Step<W> {
    /// A surface that is not there: the same medium is on both sides.
    Passed(Hit),
    /// A surface that the ray has crossed already.
    Ignored,
    /// A surface that is there.
    Met(Met<W>),
}

/// A scene, as its media have it.
#[derive(Clone, Copy)]
pub(crate) struct Nested<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) table: &'s MediaTable,
}

/// Surfaces of one place, and what a ray is in beyond them.
struct Together<const N: usize> {
    beyond: MediaList<N>,
    walls: [Option<Hit>; WALLS],
    last: Hit,
}

impl Nested<'_> {
    /// The medium that a ray is in.
    #[inline]
    pub(crate) fn medium<const N: usize>(&self, list: &MediaList<N>) -> MediumId {
        match list.filling() {
            Ok(solid) => self.filled(Some(solid)),
            Err(said) => said.unwrap_or(MediumId::AROUND),
        }
    }

    /// The medium of a solid, or of none.
    pub(crate) fn filled(&self, solid: Option<u32>) -> MediumId {
        solid.and_then(|id| self.table.interior(id)).map_or(MediumId::AROUND, |interior| interior.medium)
    }

    /// The first surface that is there, nearer than `limit`; `None` when there is none. What the ray passes on the way is crossed in
    /// `list`, and the query goes on behind that.
    pub(crate) fn meet<const N: usize>(
        &self,
        query: &mut Query,
        list: &mut MediaList<N>,
        limit: f64,
        stats: &mut Stats,
    ) -> Option<Met<MediaList<N>>> {
        stats.uses.count(Feature::NestedMedia);
        for _ in 0..MOST_PASSED {
            match self.step(query, list, limit, stats) {
                None => {
                    // Solids end, so a ray that goes on for ever has got out of them by a gap.
                    stats.unmatched_exits += u64::from(limit == f64::INFINITY && list.filling().is_ok());
                    return None;
                }
                Some(Step::Ignored) => stats.contradictions += 1,
                Some(Step::Passed(_)) => stats.passed += 1,
                Some(Step::Met(met)) => return Some(met),
            }
        }
        stats.unending += 1;
        None
    }

    /// The next surface, whether it is there or not; `None` when there is none. If it is not, the query goes on behind it.
    #[inline(always)]
    pub(crate) fn step<const N: usize>(
        &self,
        query: &mut Query,
        list: &mut MediaList<N>,
        limit: f64,
        stats: &mut Stats,
    ) -> Option<Step<MediaList<N>>> {
        let aggregate = self.scene.aggregate();
        let hit = aggregate.closest_within(query, limit, &mut stats.geometry).filter(|hit| hit.t < limit)?;
        let surface = aggregate.interaction(query, &hit, &mut stats.geometry);
        let Some(solid) = self.table.solid(self.scene, hit.object, hit.face) else {
            let beyond = self.beyond_interface(list, &surface);
            return Some(Step::Met(Met { hit, surface, body: None, outside: None, beyond, last: hit }));
        };
        if self.contradicts(query, list, &hit, &surface, solid) {
            query.pass(hit.t, hit.object, hit.face);
            return Some(Step::Ignored);
        }
        let Together { beyond, walls, last } = self.together(query, list, &hit, &surface, solid, stats);
        let (before, after) = (self.medium(list), self.medium(&beyond));
        // Between two solids of one medium there is no surface. Around a single one there may be what its material adds.
        let are_filled = list.filling().is_ok() && beyond.filling().is_ok();
        let is_clear = || are_filled || self.scene.material(hit.object, hit.face).is_clear();
        // Of the two solids that fill the sides, those that were crossed here know where the surface is; the stronger one first.
        let crossed = |list: &MediaList<N>, other: &MediaList<N>| {
            list.filling().ok().filter(|solid| list.count(*solid) != other.count(*solid))
        };
        let (left, entered) = (crossed(list, &beyond), crossed(&beyond, list));
        let is_nothing = list.filling() == beyond.filling() || before == after && is_clear();
        let strength = |id: u32| self.table.interior(id).map(|s| (s.priority, std::cmp::Reverse(id)));
        let (of, outside) = match (left, entered) {
            _ if is_nothing => (None, before),
            (Some(left), Some(entered)) if strength(left) > strength(entered) => (Some(left), after),
            (_, Some(entered)) => (Some(entered), before),
            (Some(left), None) => (Some(left), after),
            (None, None) => (None, before),
        };
        let Some(of) = of else {
            *list = beyond;
            query.pass(last.t, last.object, last.face);
            return Some(Step::Passed(hit));
        };
        let is_of = |wall: &Hit| self.table.interior(wall.object).is_some_and(|solid| solid.owner == of);
        let wall = walls.into_iter().flatten().find(is_of).unwrap_or(hit);
        let surface = if wall.object == hit.object {
            surface
        } else {
            aggregate.interaction(query, &wall, &mut stats.geometry)
        };
        let body = self.table.body(self.scene, &surface, outside);
        Some(Step::Met(Met { hit: wall, surface, body, outside: Some(outside), beyond, last }))
    }

    /// False where a ray that is in this comes to an interface out of another medium than that says.
    pub(crate) fn expects<const N: usize>(&self, surface: &SurfaceInteraction, list: &MediaList<N>) -> bool {
        let said = self.said_before(surface);
        said.is_none_or(|medium| medium == self.medium(list))
    }

    /// What an interface says of the side that a ray comes from.
    fn said_before(&self, surface: &SurfaceInteraction) -> Option<MediumId> {
        let is_solid = self.table.interior(surface.object).is_some();
        if is_solid { None } else { self.table.beside(self.scene, surface, !surface.front) }
    }

    /// The same of the first surface that a camera ray meets, unless the camera is said to stand in something.
    pub(crate) fn said_to_camera(&self, surface: &SurfaceInteraction) -> Option<MediumId> {
        self.said_before(surface).filter(|_| self.table.at_camera().is_none())
    }

    /// What a ray is in beyond a surface that is none of a solid.
    fn beyond_interface<const N: usize>(
        &self,
        list: &MediaList<N>,
        surface: &SurfaceInteraction,
    ) -> MediaList<N> {
        let mut beyond = *list;
        if let Some(medium) = self.table.beside(self.scene, surface, surface.front)
            && self.table.interior(surface.object).is_none()
        {
            beyond.cross_interface(medium, |solid| self.filled(solid));
        }
        beyond
    }

    /// What a ray's own arithmetic may move a hit by.
    fn ray_error(query: &Query, t: f64) -> f64 {
        gamma(16) * (query.ray.origin.abs().max_element() + t)
    }

    /// Whether a hit is so near to where the ray started that its being there is rounding, and says what can't be.
    fn contradicts<const N: usize>(
        &self,
        query: &Query,
        list: &MediaList<N>,
        hit: &Hit,
        surface: &SurfaceInteraction,
        solid: &Interior,
    ) -> bool {
        let departed = query.departed.map(|departed| departed.object);
        if departed == Some(hit.object) || solid.overlaps_itself {
            return false;
        }
        let start = departed.map_or(0.0, |object| self.table.error(object));
        let rounding = start + self.table.error(hit.object) + Self::ray_error(query, hit.t);
        let distance = hit.t * surface.wo.dot(surface.ng).abs();
        distance <= rounding && surface.front == (list.count(solid.owner) > 0)
    }

    /// Crosses a surface of a solid, and with it those of others that are the same but for rounding.
    fn together<const N: usize>(
        &self,
        query: &Query,
        list: &MediaList<N>,
        hit: &Hit,
        surface: &SurfaceInteraction,
        solid: &Interior,
        stats: &mut Stats,
    ) -> Together<N> {
        let mut all = Together { beyond: *list, walls: [None; WALLS], last: *hit };
        all.walls[0] = Some(*hit);
        Self::cross(&mut all.beyond, solid, surface.front, stats);
        let aggregate = self.scene.aggregate();
        let (own, of_ray) = (self.table.error(hit.object), Self::ray_error(query, hit.t));
        let slant = |surface: &SurfaceInteraction| surface.wo.dot(surface.ng).abs();
        let farthest = (own + solid.reach + of_ray) * (1.0 / slant(surface)).min(MOST_SLANTED);
        // A short ray through the point meets few nodes of a tree; the whole one would meet all that it has passed.
        let direction = query.ray.direction;
        let short = Query::new(Ray::new(surface.point - direction * (2.0 * farthest), direction));
        let is_near = |other: u32| aggregate.meets(other, &short, 4.0 * farthest, &mut stats.geometry);
        if !solid.may_share(surface.point, is_near) {
            return all;
        }
        let mut behind = *query;
        behind.pass(hit.t, hit.object, hit.face);
        while let Some(wall) = aggregate.closest_within(&behind, hit.t + farthest, &mut stats.geometry)
            && let Some(other) = self.table.solid(self.scene, wall.object, wall.face)
        {
            let there = aggregate.interaction(&behind, &wall, &mut stats.geometry);
            let rounding = own + self.table.error(wall.object) + of_ray;
            // Between the planes of both: a wall across the ray's way is not the same as one along it.
            if (wall.t - hit.t) * slant(surface).max(slant(&there)) > rounding {
                break;
            }
            Self::cross(&mut all.beyond, other, there.front, stats);
            behind.pass(wall.t, wall.object, wall.face);
            stats.merged += 1;
            all.last = wall;
            if let Some(free) = all.walls.iter_mut().find(|place| place.is_none()) {
                *free = Some(wall);
            }
        }
        all
    }

    /// Counts a crossing of a solid.
    fn cross<const N: usize>(list: &mut MediaList<N>, solid: &Interior, entering: bool, stats: &mut Stats) {
        if !entering && list.count(solid.owner) <= 0 {
            stats.unmatched_exits += 1;
        }
        if list.cross(solid.owner, solid.priority, if entering { 1 } else { -1 }).is_err() {
            stats.overfull += 1;
        }
    }

    /// What the camera stands in: what is said, else what is found there.
    pub(crate) fn around_camera<const N: usize>(&self, point: DVec3, stats: &mut Stats) -> MediaList<N> {
        let mut list = self.around(point, stats);
        if let Some(said) = self.table.at_camera() {
            list.cross_interface(said, |solid| self.filled(solid));
        }
        list
    }

    /// What a point is in: the solids that wind around it, those that the smallest interface around it lies in being hidden by what
    /// that says.
    pub(crate) fn around<const N: usize>(&self, point: DVec3, stats: &mut Stats) -> MediaList<N> {
        let winding = |object: u32| self.scene.aggregate().winding(object, point);
        let shells = self.table.shells_around(point).filter(|shell| winding(shell.object) != 0);
        let volume = |shell: &&Shell| shell.bounds.extent().element_product();
        let shell = shells.min_by(|a, b| volume(a).total_cmp(&volume(b)));
        let mut list = MediaList::EMPTY;
        let mut enter = |list: &mut MediaList<N>, holding: bool| {
            for (object, solid) in self.table.around(point) {
                if shell.is_some_and(|shell| solid.holds(&shell.bounds)) == holding {
                    let count = winding(object).clamp(i32::from(i8::MIN), i32::from(i8::MAX)) as i8;
                    if count != 0 && list.cross(solid.owner, solid.priority, count).is_err() {
                        stats.overfull += 1;
                    }
                }
            }
        };
        enter(&mut list, true);
        if let Some(shell) = shell {
            list.cross_interface(shell.medium, |solid| self.filled(solid));
        }
        enter(&mut list, false);
        list
    }
}
