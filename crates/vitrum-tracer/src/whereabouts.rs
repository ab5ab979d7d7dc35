//! What a ray remembers of the media that it goes through: nothing, the medium, or all solids that it is in. A scene gets the least
//! that it can do with.

use crate::crossing::{Met, Nested};
use crate::media::MediumId;
use crate::media_list::MediaList;
use crate::stats::Stats;
use vitrum_geometry::Query;
use vitrum_math::DVec3;

/// What a ray remembers.
pub(crate) trait Whereabouts: Copy {
    /// Whether it knows the medium that it is in.
    const KNOWS_MEDIUM: bool;
    /// Whether it knows all solids that it is in.
    const KNOWS_SOLIDS: bool;
    /// What is known at first.
    const START: Self;

    /// In a medium of which something says that it is there.
    fn saying(medium: MediumId) -> Self;

    /// Where the camera stands at a point, where solids are known.
    fn around(_: &Nested<'_>, _: DVec3, _: &mut Stats) -> Self {
        Self::START
    }

    /// The medium.
    fn medium(&self, nested: &Nested<'_>) -> MediumId;

    /// The first surface that is there, nearer than a limit, where solids are known; `self` becomes what the ray is in before it.
    fn meet(
        &mut self,
        nested: &Nested<'_>,
        query: &mut Query,
        limit: f64,
        stats: &mut Stats,
    ) -> Option<Met<Self>>;

    /// A surface that is none of a solid has this medium on the side that the ray comes from.
    fn is_told(&mut self, nested: &Nested<'_>, medium: MediumId);
}

/// Nothing: no medium absorbs, and each surface knows what is on both sides of it.
impl Whereabouts for () {
    const KNOWS_MEDIUM: bool = false;
    const KNOWS_SOLIDS: bool = false;
    const START: Self = ();

    #[inline(always)]
    fn saying(_: MediumId) -> Self {}

    #[inline(always)]
    fn medium(&self, _: &Nested<'_>) -> MediumId {
        MediumId::AROUND
    }

    fn meet(&mut self, _: &Nested<'_>, _: &mut Query, _: f64, _: &mut Stats) -> Option<Met<Self>> {
        unreachable!("solids are not known")
    }

    #[inline(always)]
    fn is_told(&mut self, _: &Nested<'_>, _: MediumId) {}
}

/// The medium: each surface knows what is on both sides of it.
impl Whereabouts for MediumId {
    const KNOWS_MEDIUM: bool = true;
    const KNOWS_SOLIDS: bool = false;
    const START: Self = Self::AROUND;

    #[inline(always)]
    fn saying(medium: MediumId) -> Self {
        medium
    }

    #[inline(always)]
    fn medium(&self, _: &Nested<'_>) -> MediumId {
        *self
    }

    fn meet(&mut self, _: &Nested<'_>, _: &mut Query, _: f64, _: &mut Stats) -> Option<Met<Self>> {
        unreachable!("solids are not known")
    }

    #[inline(always)]
    fn is_told(&mut self, _: &Nested<'_>, medium: MediumId) {
        *self = medium;
    }
}

/// All solids, `N` at most at a time.
impl<const N: usize> Whereabouts for MediaList<N> {
    const KNOWS_MEDIUM: bool = true;
    const KNOWS_SOLIDS: bool = true;
    const START: Self = Self::EMPTY;

    #[inline]
    fn saying(medium: MediumId) -> Self {
        Self::saying(medium)
    }

    fn around(nested: &Nested<'_>, point: DVec3, stats: &mut Stats) -> Self {
        nested.around_camera(point, stats)
    }

    #[inline]
    fn medium(&self, nested: &Nested<'_>) -> MediumId {
        nested.medium(self)
    }

    #[inline]
    fn meet(
        &mut self,
        nested: &Nested<'_>,
        query: &mut Query,
        limit: f64,
        stats: &mut Stats,
    ) -> Option<Met<Self>> {
        nested.meet(query, self, limit, stats)
    }

    fn is_told(&mut self, nested: &Nested<'_>, medium: MediumId) {
        self.cross_interface(medium, |solid| nested.filled(solid));
    }
}
