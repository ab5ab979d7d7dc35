//! The solids that a ray is in, in the order in which they fill space: the one of the highest priority first, of equal ones that with
//! the lowest number. Nothing depends on the order in which they were entered.
//!
//! A solid is counted each time that its surface is crossed, up on the way in and down on the way out; it is in the list while its count
//! is not zero. So walls may be doubled and parts of a mesh overlap, and a count below zero (out of what was never entered) is made up
//! for by the next way in.
//!
//! An interface says what is beyond it, whatever the list says: until another says otherwise, this hides all solids that the ray is in,
//! though not those that it comes to after it.

use crate::media::MediumId;

/// Up to `N` solids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MediaList<const N: usize> {
    entries: [Entry; N],
    len: u32,
    /// What the last interface said is there.
    said: Option<MediumId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    object: u32,
    priority: i16,
    count: i8,
    hidden: bool,
}

/// There is no place for another solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct IsFull;

impl<const N: usize> MediaList<N> {
    /// In nothing.
    pub(crate) const EMPTY: Self =
        Self { entries: [Entry { object: 0, priority: 0, count: 0, hidden: false }; N], len: 0, said: None };

    /// Counts a crossing of a solid's surface, or `by` of them, into it where that is positive.
    ///
    /// # Errors
    /// [`IsFull`], and nothing is counted.
    #[inline]
    pub(crate) fn cross(&mut self, object: u32, priority: i16, by: i8) -> Result<(), IsFull> {
        let held = &self.entries[..self.len as usize];
        if let Some(at) = held.iter().position(|e| e.object == object) {
            let count = &mut self.entries[at].count;
            *count = count.saturating_add(by);
            if *count == 0 {
                self.entries.copy_within(at + 1..self.len as usize, at);
                self.len -= 1;
            }
            return Ok(());
        }
        if self.len as usize == N {
            return Err(IsFull);
        }
        let before = |e: &Entry| e.priority > priority || e.priority == priority && e.object < object;
        let at = held.iter().position(|e| !before(e)).unwrap_or(held.len());
        self.entries.copy_within(at..self.len as usize, at + 1);
        self.entries[at] = Entry { object, priority, count: by, hidden: false };
        self.len += 1;
        Ok(())
    }

    /// An interface has been crossed, beyond which is this medium; `filled` is what a solid is filled with, and what is where
    /// there is none.
    pub(crate) fn cross_interface(&mut self, beyond: MediumId, filled: impl Fn(Option<u32>) -> MediumId) {
        let held = &mut self.entries[..self.len as usize];
        let agrees = filled(held.iter().find(|e| e.count > 0).map(|e| e.object)) == beyond;
        held.iter_mut().for_each(|e| e.hidden = !agrees);
        self.said = (!agrees).then_some(beyond);
    }

    /// The solid that fills the place where the ray is; else what an interface said is there.
    #[inline]
    pub(crate) fn filling(&self) -> Result<u32, Option<MediumId>> {
        let held = &self.entries[..self.len as usize];
        held.iter().find(|e| e.count > 0 && !e.hidden).map(|e| e.object).ok_or(self.said)
    }

    /// How often the ray is in a solid.
    #[inline]
    pub(crate) fn count(&self, object: u32) -> i8 {
        self.entries[..self.len as usize].iter().find(|e| e.object == object).map_or(0, |e| e.count)
    }

    /// The solids that it is in, the strongest first, without those that an interface hides.
    pub(crate) fn solids(&self) -> impl Iterator<Item = u32> {
        self.entries[..self.len as usize].iter().filter(|e| e.count > 0 && !e.hidden).map(|e| e.object)
    }

    /// Says what is there, in a list of no solids.
    #[inline]
    pub(crate) fn saying(medium: MediumId) -> Self {
        Self { said: Some(medium), ..Self::EMPTY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Solids by number: each has the medium of its number plus one; nothing is in medium 0.
    fn filled(solid: Option<u32>) -> MediumId {
        MediumId::new(solid.map_or(0, |s| s + 1))
    }

    #[test]
    fn the_highest_priority_fills_and_the_lowest_number_of_equals() {
        let mut list = MediaList::<8>::EMPTY;
        for (object, priority) in [(5, 0), (3, 0), (9, 2), (4, 0), (1, -7)] {
            list.cross(object, priority, 1).expect("there is room");
        }
        assert_eq!(list.solids().collect::<Vec<_>>(), [9, 3, 4, 5, 1]);
        for (left, next) in [(9, Ok(3)), (4, Ok(3)), (3, Ok(5)), (5, Ok(1)), (1, Err(None))] {
            list.cross(left, 0, -1).expect("it is there");
            assert_eq!(list.filling(), next);
        }
        assert_eq!(list.solids().count(), 0);
    }

    #[test]
    fn what_is_full_keeps_what_it_has() {
        let mut list = MediaList::<2>::EMPTY;
        list.cross(0, 0, 1).and(list.cross(1, 0, 1)).expect("there is room");
        let before = list;
        assert_eq!(list.cross(2, 9, 1), Err(IsFull));
        assert_eq!(list, before);
        list.cross(1, 0, 1).expect("it is there already");
        assert_eq!(list.count(1), 2);
    }

    /// Glass with a bubble whose wall is an interface, and in that a bead that knows of neither.
    #[test]
    fn an_interface_hides_what_it_lies_in() {
        const GLASS: u32 = 0;
        const BEAD: u32 = 7;
        let (air, in_glass) = (MediumId::new(20), filled(Some(GLASS)));
        let mut list = MediaList::<8>::EMPTY;
        list.cross(GLASS, 0, 1).expect("there is room");
        list.cross_interface(air, filled);
        assert_eq!(list.filling(), Err(Some(air)));
        list.cross(BEAD, 0, 1).expect("there is room");
        assert_eq!(list.filling(), Ok(BEAD));
        list.cross(BEAD, 0, -1).expect("it is there");
        assert_eq!(list.filling(), Err(Some(air)));
        list.cross_interface(in_glass, filled);
        assert_eq!(list.filling(), Ok(GLASS));
        list.cross(GLASS, 0, -1).expect("it is there");
        assert_eq!(list.filling(), Err(None));
    }

    proptest! {
        /// Whatever the order of the crossings, the list is that of their sums.
        #[test]
        fn order_does_not_matter(
            crossings in prop::collection::vec((0_u32..8, prop::sample::select(vec![-1_i8, 1])), 0..40),
            seed in any::<u64>(),
        ) {
            let priority = |object: u32| [0, 3, 0, -2, 3, 0, 1, -2][object as usize];
            let walk = |order: &[(u32, i8)]| {
                let mut list = MediaList::<8>::EMPTY;
                order.iter().for_each(|&(o, by)| list.cross(o, priority(o), by).expect("there are eight"));
                list
            };
            let mut shuffled = crossings.clone();
            let mut state = seed | 1;
            for i in (1..shuffled.len()).rev() {
                state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
                shuffled.swap(i, (state >> 33) as usize % (i + 1));
            }
            let (a, b) = (walk(&crossings), walk(&shuffled));
            prop_assert_eq!(a.filling(), b.filling());
            for object in 0..8 {
                let sum: i8 = crossings.iter().filter(|c| c.0 == object).map(|c| c.1).sum();
                prop_assert_eq!((a.count(object), b.count(object)), (sum, sum));
            }
            let inside = (0..8).filter(|o| a.count(*o) > 0);
            let first = inside.min_by_key(|&o| (-priority(o), o));
            prop_assert_eq!(a.filling().ok(), first);
        }
    }
}
