//! The solids of a scene that reach into each other: only where there are any, rays have to know which they are in.
//!
//! A solid is a closed object of glass whose material leaves open what is around it ([`Boundary::Solid`]). One that is turned inside out
//! is an inner wall of the smallest solid of the same medium and priority around it. Everything else is an interface: what is open,
//! what has `outside`, what has faces of several media. Its material says what is on both sides.

use crate::scene::SceneError;
use vitrum_geometry::{Aggregate, Shape};
use vitrum_materials::{Boundary, Material, Medium};
use vitrum_math::{Bounds, DVec3};

/// So many solids can share a point.
pub(crate) const MOST: usize = 8;

/// Points along each axis where boxes of more than that share a place: there it is seen whether the solids do.
const PROBES: u32 = 12;

/// What is known of the inside of an object.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    pub(crate) priority: i16,
    /// The solid that its surface is part of: itself, or for an inner wall the one around it.
    pub(crate) owner: u32,
    /// Surfaces of other solids that may reach into it.
    pub(crate) solids: Vec<u32>,
    /// Interfaces that may.
    pub(crate) interfaces: Vec<u32>,
    /// False where what is on its outside may be another medium than its material says.
    pub(crate) knows: bool,
}

/// What may reach into what.
#[derive(Clone, Debug, Default)]
pub(crate) struct Overlaps {
    /// For each object, if it is a solid.
    pub(crate) solids: Vec<Option<Solid>>,
    /// How many solids share a point at most; 0 where every surface knows what is on both sides of it.
    pub(crate) depth: usize,
}

impl Overlaps {
    /// Of the objects, given what each is made of; `is_seen` is false for those that are left out if they can be.
    ///
    /// # Errors
    /// [`SceneError::Overlap`] where more than eight share a point.
    pub(crate) fn new<'m>(
        aggregate: &Aggregate,
        materials_of: impl Fn(u32) -> &'m [Material],
        names: &[String],
        is_seen: impl Fn(u32) -> bool,
    ) -> Result<Self, SceneError> {
        let objects = aggregate.objects();
        let bounds = |id: u32| objects[id as usize].bounds();
        let of_glass = |id: &u32| materials_of(*id).iter().any(Material::is_dielectric);
        let glass: Vec<u32> = (0..objects.len() as u32).filter(of_glass).collect();
        let mut solids = solids(aggregate, &materials_of);
        let pairs = aggregate.overlaps(&glass);
        for (a, b) in pairs.into_iter().flat_map(|(a, b)| [(a, b), (b, a)]) {
            let other = solids[b as usize].as_ref().map(|other| other.owner);
            let Some(solid) = &mut solids[a as usize] else { continue };
            match other {
                Some(owner) if owner == solid.owner => {}
                Some(_) => solid.solids.push(b),
                None => solid.interfaces.push(b),
            }
        }
        let holds = |outer: u32, inner: u32| {
            let [whole, part] = [outer, inner].map(|id| &objects[id as usize]);
            let middle = part.bounds().filter(|_| !whole.surface_may_meet(part)).map(|b| b.centre());
            middle.is_some_and(|middle| aggregate.winding(outer, middle) != 0)
        };
        let says = |shell: u32, solid: u32| {
            let media = |id: u32| materials_of(id).iter().find_map(Material::media);
            let flipped = objects[shell as usize].is_flipped();
            let inner = media(shell).map(|media| if flipped { media.outside } else { media.inside });
            inner == media(solid).map(|media| media.outside)
        };
        for id in 0..objects.len() as u32 {
            let Some(solid) = &solids[id as usize] else { continue };
            let closed = || solid.interfaces.iter().copied().filter(|b| objects[*b as usize].is_closed());
            // What lies inside of a solid is met from within it, and its walls know that. A solid that lies in another knows what is
            // around it if it is held by an interface that says so, as a bead by a bubble.
            let knows = |other: &u32| {
                let is_met = || objects[id as usize].surface_may_meet(&objects[*other as usize]);
                let mut around = closed().filter(|shell| holds(*shell, id) && says(*shell, id));
                !is_met() || around.any(|shell| shell == *other || holds(*other, shell))
            };
            let others = solid.solids.iter().filter(|other| is_seen(id) || is_seen(**other));
            let know = others.chain(&solid.interfaces).all(knows);
            if let Some(solid) = &mut solids[id as usize] {
                solid.knows = know;
            }
        }
        // Open interfaces may enclose something together.
        let is_open = |id: &u32| solids[*id as usize].is_none() && !objects[*id as usize].is_closed();
        let open: Vec<u32> = glass.iter().copied().filter(is_open).collect();
        let around = open.iter().filter_map(|id| bounds(*id)).fold(Bounds::EMPTY, Bounds::union);
        let is_infinite = open.iter().any(|id| bounds(*id).is_none());
        for (id, solid) in (0u32..).zip(&mut solids).filter_map(|(id, solid)| Some((id, solid.as_mut()?))) {
            if is_infinite || bounds(id).is_some_and(|b| b.touches(&around)) {
                solid.interfaces.extend(&open);
                solid.knows = false;
            }
            if let Shape::Mesh(mesh) = objects[id as usize].shape() {
                solid.knows &= !mesh.overlaps_itself();
            }
        }
        if solids.iter().flatten().all(|solid| solid.knows) {
            return Ok(Self { solids, depth: 0 });
        }
        let together = deepest(aggregate, &solids);
        if together.len() > MOST
            && let Some(shared) = shared(aggregate, &together)
        {
            return Err(SceneError::Overlap(shared.iter().map(|id| names[*id as usize].clone()).collect()));
        }
        Ok(Self { solids, depth: together.len().clamp(1, MOST) })
    }
}

/// The objects that are solids.
fn solids<'m>(aggregate: &Aggregate, materials_of: impl Fn(u32) -> &'m [Material]) -> Vec<Option<Solid>> {
    let objects = aggregate.objects();
    let filling = |id: u32| objects[id as usize].is_closed().then(|| filling(materials_of(id))).flatten();
    let filled: Vec<Option<(i16, Medium)>> = (0..objects.len() as u32).map(filling).collect();
    let around = |wall: u32| {
        let within = objects[wall as usize].bounds()?;
        let volume =
            |id: &u32| objects[*id as usize].bounds().map_or(f64::INFINITY, |b| b.extent().element_product());
        (0..objects.len() as u32)
            .filter(|id| filled[*id as usize] == filled[wall as usize] && !objects[*id as usize].is_flipped())
            .filter(|id| objects[*id as usize].bounds().is_some_and(|outer| contains(&outer, &within)))
            .min_by(|a, b| volume(a).total_cmp(&volume(b)))
    };
    let solid = |(id, filled): (u32, &Option<(i16, Medium)>)| {
        let (priority, _) = (*filled)?;
        let owner = if objects[id as usize].is_flipped() { around(id)? } else { id };
        Some(Solid { priority, owner, solids: vec![], interfaces: vec![], knows: true })
    };
    (0u32..).zip(&filled).map(solid).collect()
}

/// The priority and the medium inside, if the materials of an object are those of a solid and agree on them.
fn filling(materials: &[Material]) -> Option<(i16, Medium)> {
    let mut all = materials.iter().filter_map(Material::media).map(|media| match media.boundary {
        Boundary::Solid { priority } => Some((priority, media.inside)),
        Boundary::Interface => None,
    });
    let first = all.next()??;
    all.all(|other| other == Some(first)).then_some(first)
}

/// A largest set of solids whose boxes share a point and of which each may overlap the first; once it has more than [`MOST`], no larger
/// one is looked for.
fn deepest(aggregate: &Aggregate, solids: &[Option<Solid>]) -> Vec<u32> {
    let bounds = padded(aggregate);
    let spans = |id: &u32, axis: usize, at: f64| {
        let b = &bounds[*id as usize];
        b.min[axis] <= at && at <= b.max[axis]
    };
    let is_owner = |id: &u32| solids[*id as usize].as_ref().is_some_and(|solid| solid.owner == *id);
    let mut most = Vec::new();
    for (id, solid) in (0u32..).zip(solids).filter_map(|(id, solid)| Some((id, solid.as_ref()?))) {
        if !is_owner(&id) {
            continue;
        }
        // Boxes that share any point share one with the least x, y and z that all of them have: each coordinate is where one of them
        // starts. This one is the last to start along x.
        let x = bounds[id as usize].min.x;
        let near = solid.solids.iter().copied().chain([id]).filter(is_owner);
        let near: Vec<u32> = near.filter(|other| spans(other, 0, x)).collect();
        for j in &near {
            let y = bounds[*j as usize].min.y;
            let level: Vec<u32> = near.iter().copied().filter(|other| spans(other, 1, y)).collect();
            for k in &level {
                let z = bounds[*k as usize].min.z;
                let here = level.iter().copied().filter(|other| spans(other, 2, z));
                if here.clone().count() > most.len() {
                    most = here.collect();
                    if most.len() > MOST {
                        return most;
                    }
                }
            }
        }
    }
    most
}

/// More than [`MOST`] of these solids that do share a point, if one is found on a grid where all their boxes are.
fn shared(aggregate: &Aggregate, together: &[u32]) -> Option<Vec<u32>> {
    let all = padded(aggregate);
    let place = together
        .iter()
        .map(|id| all[*id as usize])
        .reduce(|a, b| Bounds { min: a.min.max(b.min), max: a.max.min(b.max) })?;
    let at = |step: u32| (f64::from(step) + 0.5) / f64::from(PROBES);
    (0..PROBES.pow(3)).find_map(|i| {
        let share = DVec3::new(at(i % PROBES), at(i / PROBES % PROBES), at(i / (PROBES * PROBES)));
        let point = place.min + place.extent() * share;
        let here: Vec<u32> =
            together.iter().copied().filter(|id| aggregate.winding(*id, point) != 0).collect();
        (here.len() > MOST).then_some(here)
    })
}

/// The boxes around all objects, with what rounding may move their surfaces by; empty for infinite ones.
fn padded(aggregate: &Aggregate) -> Vec<Bounds> {
    let padded = aggregate.objects().iter().map(|o| o.bounds().map(|b| b.padded(o.surface_error())));
    padded.map(|bounds| bounds.unwrap_or(Bounds::EMPTY)).collect()
}

fn contains(outer: &Bounds, inner: &Bounds) -> bool {
    outer.min.cmple(inner.min).all() && inner.max.cmple(outer.max).all()
}
