//! The media of a scene by number, and what the surfaces of its solids become in each of them.

use crate::overlaps::{Overlaps, Solid};
use crate::scene::Scene;
use std::collections::BTreeMap;
use vitrum_bxdf::Bxdf;
use vitrum_geometry::{Object, Shape, SurfaceInteraction};
use vitrum_materials::{Absorption, Material, Media, Medium};
use vitrum_math::{Bounds, DVec3};

/// A medium by number: equal ones have the same. Four bytes, because nodes of ray trees are copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MediumId(u32);

impl MediumId {
    /// What surrounds everything.
    pub(crate) const AROUND: Self = Self::new(0);

    pub(crate) const fn new(number: u32) -> Self {
        Self(number)
    }
}

/// The media of a scene.
pub(crate) struct MediaTable {
    media: Vec<Medium>,
    /// For each material the media outside and inside, where it divides two.
    sides: Vec<Option<[MediumId; 2]>>,
    /// What the camera is said to stand in.
    camera: Option<MediumId>,
    /// False where no surface of a solid, and no closed interface, comes near to where camera rays start: all of them start in the same.
    is_at_camera: bool,
    /// For each object, if its surface is one of a solid; empty where nobody asks.
    interiors: Vec<Option<Interior>>,
    /// Closed interfaces; empty where nobody asks.
    shells: Vec<Shell>,
    /// For each object a bound on the distance of its surface from where it was described; empty where nobody asks.
    errors: Vec<f64>,
}

/// The surface of a solid.
pub(crate) struct Interior {
    pub(crate) priority: i16,
    /// The solid that it is part of.
    pub(crate) owner: u32,
    /// What that is filled with.
    pub(crate) medium: MediumId,
    /// Whether it winds around some places more than once.
    pub(crate) overlaps_itself: bool,
    /// The largest rounding of a surface that may reach into it.
    pub(crate) reach: f64,
    /// These surfaces, by object, with their boxes.
    neighbours: Vec<(u32, Bounds)>,
    /// Its own box, padded by its rounding.
    bounds: Bounds,
    /// What it does to light where something else is outside than its material says: by material and medium.
    bodies: Vec<(usize, MediumId, Bxdf<f64>)>,
}

/// An interface around a space.
pub(crate) struct Shell {
    pub(crate) object: u32,
    pub(crate) bounds: Bounds,
    /// What is in it.
    pub(crate) medium: MediumId,
}

/// Beyond so many neighbours, looking at what lies behind a hit costs less than to ask each of them.
const MANY: usize = 8;

impl Interior {
    /// False where no other surface is near a point, as `is_near` finds out for those whose boxes hold it.
    #[inline]
    pub(crate) fn may_share(&self, point: DVec3, mut is_near: impl FnMut(u32) -> bool) -> bool {
        let near = |(object, bounds): &(u32, Bounds)| holds(bounds, point) && is_near(*object);
        self.neighbours.len() > MANY || self.neighbours.iter().any(near)
    }

    /// True when its box holds another.
    pub(crate) fn holds(&self, other: &Bounds) -> bool {
        holds(&self.bounds, other.min) && holds(&self.bounds, other.max)
    }
}

fn holds(bounds: &Bounds, point: DVec3) -> bool {
    bounds.min.cmple(point).all() && point.cmple(bounds.max).all()
}

/// Numbers for media.
#[derive(Default)]
struct Numbers {
    media: Vec<Medium>,
    known: BTreeMap<[u64; 4], MediumId>,
}

impl Numbers {
    fn of(&mut self, medium: Medium) -> MediumId {
        let [r, g, b] = medium.absorption.sigma_a().to_array();
        let key = [medium.index.value(), r, g, b].map(f64::to_bits);
        *self.known.entry(key).or_insert_with(|| {
            self.media.push(medium);
            MediumId::new(self.media.len() as u32 - 1)
        })
    }
}

impl MediaTable {
    /// Of a scene whose picture has so many pixels, with solids if anybody asks for them.
    pub(crate) fn new(scene: &Scene, size: [u32; 2], with_solids: bool) -> Self {
        let mut numbers = Numbers::default();
        numbers.of(scene.medium);
        let camera = scene.camera_medium.map(|medium| numbers.of(medium));
        let mut both = |media: &Media| [numbers.of(media.outside), numbers.of(media.inside)];
        let sides: Vec<_> = scene.materials().iter().map(|m| m.media().map(&mut both)).collect();
        let (interiors, shells, errors) = (vec![], vec![], vec![]);
        let mut table =
            Self { media: numbers.media, sides, camera, is_at_camera: false, interiors, shells, errors };
        if with_solids {
            table.errors = scene.aggregate().objects().iter().map(Object::surface_error).collect();
            table.interiors = interiors_of(scene, scene.overlaps(), &table);
            table.shells = shells_of(scene, &table);
            table.is_at_camera = table.may_hold(&scene.camera.origins(size));
        }
        table
    }

    /// What a medium absorbs.
    #[inline]
    pub(crate) fn absorption_of(&self, MediumId(number): MediumId) -> &Absorption {
        &self.media[number as usize].absorption
    }

    /// The medium of a number.
    pub(crate) fn medium(&self, MediumId(number): MediumId) -> &Medium {
        &self.media[number as usize]
    }

    /// What the camera is said to stand in.
    pub(crate) fn at_camera(&self) -> Option<MediumId> {
        self.camera
    }

    /// The medium beside a surface, on the side that its normal points to or on the other one; `None` where it does not say.
    #[inline]
    pub(crate) fn beside(
        &self,
        scene: &Scene,
        surface: &SurfaceInteraction,
        inside: bool,
    ) -> Option<MediumId> {
        let sides = self.sides[scene.material_at(surface.object, surface.face)]?;
        Some(sides[usize::from(inside)])
    }

    /// The solid whose surface this is, if it is one's. Faces of it that are not of glass are none.
    #[inline]
    pub(crate) fn solid(&self, scene: &Scene, object: u32, face: u32) -> Option<&Interior> {
        let interior = self.interiors.get(object as usize)?.as_ref()?;
        self.sides[scene.material_at(object, face)].and(Some(interior))
    }

    /// The solid of an object.
    pub(crate) fn interior(&self, object: u32) -> Option<&Interior> {
        self.interiors.get(object as usize)?.as_ref()
    }

    /// A bound on the distance of the surface of an object from where it was described.
    #[inline]
    pub(crate) fn error(&self, object: u32) -> f64 {
        self.errors[object as usize]
    }

    /// The surfaces of solids whose boxes hold a point, by object.
    pub(crate) fn around(&self, point: DVec3) -> impl Iterator<Item = (u32, &Interior)> {
        let solids = (0u32..).zip(&self.interiors).filter_map(|(id, solid)| Some((id, solid.as_ref()?)));
        solids.filter(move |(_, solid)| holds(&solid.bounds, point))
    }

    /// The interfaces whose boxes hold a point.
    pub(crate) fn shells_around(&self, point: DVec3) -> impl Iterator<Item = &Shell> {
        self.shells.iter().filter(move |shell| holds(&shell.bounds, point))
    }

    /// Whether rays of the camera may start in different media.
    #[inline]
    pub(crate) fn is_at_camera(&self) -> bool {
        self.is_at_camera
    }

    /// False where nothing of a box is in a solid or in a closed interface.
    fn may_hold(&self, place: &Bounds) -> bool {
        let solids = self.interiors.iter().flatten().map(|solid| &solid.bounds);
        solids.chain(self.shells.iter().map(|shell| &shell.bounds)).any(|bounds| bounds.touches(place))
    }

    /// What the surface of a solid does to light with a medium outside of it; `None` where the material knows.
    pub(crate) fn body(
        &self,
        scene: &Scene,
        surface: &SurfaceInteraction,
        outside: MediumId,
    ) -> Option<Bxdf<f64>> {
        if outside == MediumId::AROUND {
            return None;
        }
        let material = scene.material_at(surface.object, surface.face);
        let mut known = self.interior(surface.object)?.bodies.iter();
        let known = known.find(|(m, o, _)| (*m, *o) == (material, outside)).map(|(_, _, body)| *body);
        // Where boxes say that both can't meet, an interface was crossed that nothing closes: rare, and right all the same.
        known.or_else(|| scene.materials()[material].within(*self.medium(outside)))
    }
}

fn interiors_of(scene: &Scene, overlaps: &Overlaps, table: &MediaTable) -> Vec<Option<Interior>> {
    let objects = scene.aggregate().objects();
    let media_of = |id: u32| scene.materials_at(id).filter_map(|at| table.sides[at]).flatten();
    let interior = |(id, solid): (u32, &Option<Solid>)| {
        let Solid { priority, owner, solids, interfaces, .. } = solid.as_ref()?;
        let object = &objects[id as usize];
        let error = table.error(id);
        let near = |other: &u32| {
            Some((*other, objects[*other as usize].bounds()?.padded(error + table.error(*other))))
        };
        let overlaps_itself = matches!(object.shape(), Shape::Mesh(mesh) if mesh.overlaps_itself());
        let mut neighbours: Vec<(u32, Bounds)> = solids.iter().filter_map(near).collect();
        neighbours.extend(object.bounds().filter(|_| overlaps_itself).map(|bounds| (id, bounds)));
        let mut outside: Vec<MediumId> =
            solids.iter().chain(interfaces).flat_map(|&other| media_of(other)).collect();
        outside.extend(table.camera);
        outside.sort_unstable_by_key(|m| m.0);
        outside.dedup();
        outside.retain(|m| *m != MediumId::AROUND);
        let of_glass = scene.materials_at(id).filter(|at| table.sides[*at].is_some());
        let bodies = of_glass
            .flat_map(|at| outside.iter().map(move |m| (at, *m)))
            .filter_map(|(at, m)| Some((at, m, Material::within(&scene.materials()[at], *table.medium(m))?)))
            .collect();
        Some(Interior {
            priority: *priority,
            owner: *owner,
            // All of glass say the same.
            medium: scene.materials_at(id).find_map(|at| table.sides[at])?[1],
            overlaps_itself,
            reach: solids.iter().map(|other| table.error(*other)).fold(error, f64::max),
            neighbours,
            bounds: object.bounds()?.padded(error),
            bodies,
        })
    };
    (0u32..).zip(&overlaps.solids).map(interior).collect()
}

fn shells_of(scene: &Scene, table: &MediaTable) -> Vec<Shell> {
    let shell = |(object, shape): (u32, &Object)| {
        let is_interface = table.interior(object).is_none() && shape.is_closed();
        let sides = scene.materials_at(object).find_map(|at| table.sides[at]).filter(|_| is_interface)?;
        // Turned inside out, its outside is the space that it encloses.
        let medium = sides[usize::from(!shape.is_flipped())];
        Some(Shell { object, bounds: shape.bounds()?, medium })
    };
    (0u32..).zip(scene.aggregate().objects()).filter_map(shell).collect()
}
