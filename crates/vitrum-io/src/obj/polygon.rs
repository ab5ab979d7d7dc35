//! Cuts a face with any number of corners into triangles, so that a closed surface stays closed.
//!
//! A face of n corners always gives n − 2 triangles that use every corner and every edge of the face exactly once, in
//! its own winding. Corners that lie on a straight line are kept: the neighbour across that edge has them too, and a
//! triangulation that drops them (as fast ear-clipping libraries do) tears a crack that light leaks through. For the
//! same reason no triangle has zero area, if the face leaves any choice.
//!
//! A face that is convex as seen from its first corner becomes a fan, as everywhere. Others (concave, or with a hole
//! joined to the rim by a seam) are cut by ear clipping in the plane of the two axes that the face spreads over most
//! (G. H. Meisters, Polygons have ears, 1975; bookkeeping after D. Eberly, Triangulation by ear clipping, 1998). It
//! takes time O(n²) at worst, whatever the input. A face without area or that crosses itself has no right answer: it
//! is cut all the same, and said.

use vitrum_math::{DVec2, DVec3};

/// Appends the triangles of a face, as positions in `corners`, to `triangles`. False: the face crosses itself or has
/// no area, and the triangles are a guess.
pub(super) fn triangulate(corners: &[DVec3], triangles: &mut Vec<[usize; 3]>) -> bool {
    match corners.len() {
        0..3 => false,
        3 => {
            triangles.push([0, 1, 2]);
            true
        }
        count => {
            let normal = area_vector(corners);
            let fan = |i: usize| [0, i, i + 1];
            let faces_along = |i| area_vector(&fan(i).map(|corner| corners[corner])).dot(normal) > 0.0;
            if (1..count - 1).all(faces_along) {
                triangles.extend((1..count - 1).map(fan));
                true
            } else if normal.is_finite() && normal != DVec3::ZERO {
                clip_ears(&project(corners, normal), triangles)
            } else {
                triangles.extend((1..count - 1).map(fan));
                false
            }
        }
    }
}

/// Normal of a face by the right-hand rule; its length is twice the area (M. E. Newell). Differences are taken
/// from the first corner, so that a face far from the origin loses no digits.
pub(super) fn area_vector(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    corners.windows(2).map(|edge| (edge[0] - origin).cross(edge[1] - origin)).sum()
}

/// The corners without the coordinate along which the face is thinnest, anticlockwise.
fn project(corners: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let size = normal.abs();
    let drop = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let (mut right, mut up) = ((drop + 1) % 3, (drop + 2) % 3);
    if normal[drop] < 0.0 {
        std::mem::swap(&mut right, &mut up);
    }
    corners.iter().map(|corner| DVec2::new(corner[right], corner[up])).collect()
}

/// Twice the signed area of a triangle, positive if it is anticlockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Ear clipping of an anticlockwise polygon.
fn clip_ears(points: &[DVec2], triangles: &mut Vec<[usize; 3]>) -> bool {
    let mut ring = Ring::new(points);
    let mut remaining = points.len();
    let mut is_simple = true;
    // In exact arithmetic a look at an ear's two neighbours keeps all marks right. Rounding, and corners that touch, can
    // leave a stale one; a few looks at everything mend that and keep the time quadratic.
    let mut fresh_looks = 4;
    let mut at = 0;
    let mut since_last = 0;
    while remaining > 3 {
        if !ring.is_ear[at] && since_last <= remaining {
            since_last += 1;
            at = ring.next[at];
            continue;
        }
        if !ring.is_ear[at] && fresh_looks > 0 {
            fresh_looks -= 1;
            since_last = 0;
            ring.mark_all(at);
            continue;
        }
        is_simple &= ring.is_ear[at];
        triangles.push(ring.corner(at));
        at = ring.clip(at);
        remaining -= 1;
        since_last = 0;
    }
    let last = ring.corner(at);
    let [a, b, c] = last.map(|corner| points[corner]);
    triangles.push(last);
    is_simple && turn(a, b, c) >= 0.0
}

/// What is left of a polygon while its ears are cut off.
struct Ring<'a> {
    points: &'a [DVec2],
    previous: Vec<usize>,
    next: Vec<usize>,
    is_ear: Vec<bool>,
    /// Corners that do not turn left. Only these can lie in an ear.
    blockers: Vec<usize>,
}

impl<'a> Ring<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let count = points.len();
        let mut ring = Self {
            points,
            previous: (0..count).map(|i| (i + count - 1) % count).collect(),
            next: (0..count).map(|i| (i + 1) % count).collect(),
            is_ear: vec![false; count],
            blockers: Vec::new(),
        };
        ring.blockers = (0..count).filter(|&i| !ring.turns_left(i)).collect();
        ring.mark_all(0);
        ring
    }

    fn corner(&self, i: usize) -> [usize; 3] {
        [self.previous[i], i, self.next[i]]
    }

    fn turns_left(&self, i: usize) -> bool {
        let [a, b, c] = self.corner(i).map(|corner| self.points[corner]);
        turn(a, b, c) > 0.0
    }

    /// Looks at every corner again, going around from `start`.
    fn mark_all(&mut self, start: usize) {
        let mut i = start;
        loop {
            self.is_ear[i] = self.check_ear(i);
            i = self.next[i];
            if i == start {
                break;
            }
        }
    }

    /// Whether the triangle at a corner lies inside the polygon. A corner that touches one of the triangle's own three
    /// (the seam to a hole visits its ends twice) does not count as inside.
    fn check_ear(&self, i: usize) -> bool {
        let [a, b, c] = self.corner(i).map(|corner| self.points[corner]);
        turn(a, b, c) > 0.0
            && !self.blockers.iter().any(|&blocker| {
                let p = self.points[blocker];
                p != a
                    && p != b
                    && p != c
                    && turn(a, b, p) >= 0.0
                    && turn(b, c, p) >= 0.0
                    && turn(c, a, p) >= 0.0
            })
    }

    /// Takes a corner out, and returns where to go on: past the next one, so that the triangles do not all meet in
    /// one corner.
    fn clip(&mut self, i: usize) -> usize {
        let [before, _, after] = self.corner(i);
        self.next[before] = after;
        self.previous[after] = before;
        let neighbour_turns_left = [before, after].map(|neighbour| (neighbour, self.turns_left(neighbour)));
        self.blockers.retain(|&blocker| blocker != i && !neighbour_turns_left.contains(&(blocker, true)));
        for (neighbour, turns_left) in neighbour_turns_left {
            // A corner can turn from left to right only where the face crosses itself.
            if !turns_left && !self.blockers.contains(&neighbour) {
                self.blockers.push(neighbour);
            }
        }
        for neighbour in [before, after] {
            self.is_ear[neighbour] = self.check_ear(neighbour);
        }
        self.next[after]
    }
}
