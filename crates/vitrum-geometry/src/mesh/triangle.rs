//! Triangles and one ray: a conservative test in single precision that throws out nearly all candidates, many at a time,
//! and a watertight one in double precision that decides.
//!
//! Both project the triangle along the ray and look at the signs of three edge functions (S. Woop, C. Benthin and I. Wald,
//! Watertight Ray/Triangle Intersection, 2013). Two triangles that share an edge compute the same number for it, up to the
//! sign and exactly, so no ray slips between them. Deciding in single precision would be watertight too, but within 1e-7 of
//! the mesh's size around an edge it decides for a ray that is not the one asked for; a ray that goes on from there can
//! meet a third triangle that the exact ray never touches.
//!
//! Most triangles that a ray meets it meets far from their borders. Single precision is enough to know that, and to know
//! between which two distances: the search goes on with these, and only the nearest is worked out in double precision, once,
//! at the end.

use crate::wide::{BLOCK, Doubles, ExactRay, FrameRay, Lanes, NONE, Numbers, Part, Portable, Processor, Row};
use vitrum_math::{DVec3, Vec3};

/// The corners of sixteen triangles, and which they are. Every row of numbers fills one line of the cache.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct TriangleBlock {
    /// By corner, and then by axis and triangle.
    corners: [[f32; 3 * BLOCK]; 3],
    /// [`NONE`] where there is no triangle.
    pub(crate) faces: Numbers,
}

impl TriangleBlock {
    /// The triangles with these numbers.
    pub(crate) fn new(faces: Numbers, corners: impl Fn(u32) -> [Vec3; 3]) -> Self {
        // Places without a triangle: nothing compares with them.
        let mut block = Self { corners: [[f32::NAN; 3 * BLOCK]; 3], faces };
        for (lane, &face) in faces.iter().enumerate().filter(|(_, face)| **face != NONE) {
            for (corner, position) in corners(face).into_iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis * BLOCK + lane] = position[axis];
                }
            }
        }
        block
    }

    /// The corners of one.
    pub(crate) fn corners(&self, lane: usize) -> Corners {
        Corners([0, 1, 2].map(|axis| self.along(axis, lane)))
    }

    /// The corners of one along an axis, then zero.
    #[inline(always)]
    fn along(&self, axis: usize, lane: usize) -> [f32; 4] {
        let [a, b, c] = &self.corners;
        let at = axis * BLOCK + lane;
        [a[at], b[at], c[at], 0.0]
    }
}

/// The corners of a triangle: by axis and corner, then zero.
#[derive(Clone, Copy)]
pub(crate) struct Corners([[f32; 4]; 3]);

impl Corners {
    #[cfg(test)]
    pub(crate) fn new([a, b, c]: [Vec3; 3]) -> Self {
        Self([0, 1, 2].map(|axis| [a[axis], b[axis], c[axis], 0.0]))
    }

    /// The points.
    pub(crate) fn points(&self) -> [DVec3; 3] {
        let [x, y, z] = &self.0;
        [0, 1, 2].map(|corner| DVec3::new(f64::from(x[corner]), f64::from(y[corner]), f64::from(z[corner])))
    }
}

/// What the conservative test needs to know of a ray: the axis of its largest component, and the shear that lays it along
/// that axis.
pub(crate) struct Sheared {
    /// The axis of the ray's largest component last.
    rows: [Row; 3],
    /// What takes the ray's origin to zero, across the ray.
    offset: [f32; 2],
    shear: [f32; 2],
    /// What takes depths to distances: factor and offset.
    per_depth: f32,
    depth_offset: f32,
}

/// Where a ray's line meets a triangle.
pub(crate) struct Met {
    /// Where on the ray.
    pub(crate) t: f64,
    /// Weights of the second and third corner.
    pub(crate) barycentrics: [f64; 2],
}

/// Triangles of a block that a ray may meet. Aligned, because what lies across two lines of the cache is slow to come back.
#[repr(C, align(64))]
pub(crate) struct Seen {
    /// Bounds on the distances, on the ray as it was advanced.
    pub(crate) near: [f32; BLOCK],
    pub(crate) far: [f32; BLOCK],
    /// A bit for each that it may meet before the limit.
    pub(crate) candidates: u32,
    /// A bit for each that the ray's line meets for certain.
    pub(crate) certain: u32,
}

impl Seen {
    /// The candidates' lanes, one after the other.
    #[inline(always)]
    pub(crate) fn next_lane(&mut self) -> Option<usize> {
        if self.candidates == 0 {
            return None;
        }
        let lane = self.candidates.trailing_zeros() as usize & (BLOCK - 1);
        self.candidates &= self.candidates - 1;
        Some(lane)
    }
}

/// How wrong an edge function may be, in units of the frame times the length of the triangle: 2 · 8e-7 · √2 for displaced
/// corners, (8e-7)² on a triangle as long as 2^-22, and 4e-7 for the roundings of the function itself; two thirds of this.
const ERROR: f32 = 1.0 / (1 << 17) as f32;

/// How far the roundings of the ray may move a point along it, in units of the frame.
const DEPTH_PAD: f32 = 4e-6;

impl Sheared {
    /// A ray that was advanced and rounded.
    #[inline(always)]
    pub(crate) fn new(ray: &FrameRay) -> Self {
        let (rows, [x, y, z]) = (ray.exact.rows(), ray.exact.axes());
        let o = ray.origin.extend(0.0).to_array();
        let d = ray.direction.extend(0.0).to_array();
        let per_depth = ray.reciprocal.extend(0.0).to_array()[z];
        let shear = [d[x] * per_depth, d[y] * per_depth];
        Self {
            rows,
            offset: [shear[0] * o[z] - o[x], shear[1] * o[z] - o[y]],
            shear,
            per_depth,
            depth_offset: -o[z] * per_depth,
        }
    }

    /// The triangles that the ray may meet before `limit`, except for the face that it leaves; `None` if it misses all of
    /// them for certain.
    ///
    /// In a unit frame, the roundings of the ray and of the projection displace a projected corner by less than 8e-7. The
    /// corners of a triangle that is met lie within √2 `reach` of the ray there, so an edge function is wrong by less than
    /// e = [`ERROR`] `reach`. Where the functions sum to S, at least 6 e in magnitude, the true sum is no less than S / 2,
    /// and the weights are wrong by 12 e / |S| in all; they weigh distances that lie within `reach` of their middle. Where S
    /// is less than that, neither the true mean nor the one found is farther from the middle than 12 e `reach` / |S|.
    #[inline(always)]
    pub(crate) fn look<L: Lanes>(
        &self,
        part: &Part<'_, TriangleBlock>,
        left: u32,
        limit: f32,
    ) -> Option<Seen> {
        let [a, b, c] = &part.block.corners;
        let a = self.project::<L>(a, part.from);
        let b = self.project::<L>(b, part.from);
        let c = self.project::<L>(c, part.from);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let (least, most) = (u.min(v).min(w), u.max(v).max(w));
        let e = L::splat(part.reach * ERROR);
        // Misses where one is surely negative and another surely positive.
        let crossed = (L::splat(part.reach * -ERROR).at_most(least) | most.at_most(e))
            & L::others(left, &part.block.faces[part.from..]);
        if crossed == 0 {
            return None;
        }

        let per_sum = L::splat(1.0).div(u.add(v).add(w));
        let depth = u.mul_add(a[2], v.mul_add(b[2], w.mul(c[2])));
        let t = depth.mul(per_sum).mul_add(L::splat(self.per_depth), L::splat(self.depth_offset));
        // 24 e `reach` / |S|, in an order that leaves nothing to be worked out before it is known to be needed.
        let slack = per_sum.abs().mul(e).mul(e).mul_add(L::splat(24.0 / ERROR), L::splat(DEPTH_PAD));
        let (near, far) = (t.sub(slack), t.add(slack));
        // Written so that triangles seen edge on, of which nothing is known, stay.
        let candidates =
            crossed & !(far.at_most(L::splat(-f32::MIN_POSITIVE)) | L::splat(limit).at_most(near));
        if candidates == 0 {
            return None;
        }
        let certain = e.at_most(least.max(L::splat(0.0).sub(most)).sub(e));
        let mut seen = Seen { near: [0.0; BLOCK], far: [0.0; BLOCK], candidates, certain };
        near.store(&mut seen.near);
        far.store(&mut seen.far);
        Some(seen)
    }

    /// A corner as the ray sees it, across, twice, from the ray, and along.
    #[inline(always)]
    fn project<L: Lanes>(&self, corners: &[f32; 3 * BLOCK], from: usize) -> [L; 3] {
        let [x, y, z] = self.rows;
        let x = L::load(&corners[x.start()..][from..]).add(L::splat(self.offset[0]));
        let y = L::load(&corners[y.start()..][from..]).add(L::splat(self.offset[1]));
        let z = L::load(&corners[z.start()..][from..]);
        [z.negated_mul_add(L::splat(self.shear[0]), x), z.negated_mul_add(L::splat(self.shear[1]), y), z]
    }
}

#[inline(always)]
fn edge<L: Lanes>(p: [L; 3], q: [L; 3]) -> L {
    p[0].mul_sub(q[1], p[1].mul(q[0]))
}

/// The triangle laid along the ray, in double precision.
struct Laid<D> {
    /// Edge functions.
    edges: D,
    /// Their sum: twice the area that the ray sees.
    sum: f64,
    /// The corners along the axis of the projection, from the ray's origin.
    depths: D,
    /// The ray along that axis.
    advance: f64,
}

impl<D: Doubles> Laid<D> {
    /// From the corners along the axes of the ray.
    #[inline(always)]
    fn new(ray: &ExactRay, corners: [[f32; 4]; 3]) -> Self {
        let [x, y, z] = ray.axes();
        let (o, d) = (&ray.origin, &ray.direction);
        let depths = D::widen(corners[2]).sub(D::splat(o[z]));
        let across = D::widen(corners[0]).sub(D::splat(o[x])).sub(D::splat(d[x] / d[z]).mul(depths));
        let up = D::widen(corners[1]).sub(D::splat(o[y])).sub(D::splat(d[y] / d[z]).mul(depths));
        // Of each corner's opposite edge, from its end to its beginning.
        let end = across.turned_right().mul(up.turned_left());
        let edges = end.sub(up.turned_right().mul(across.turned_left()));
        let [u, v, w, _] = edges.numbers();
        Self { edges, sum: u + v + w, depths, advance: d[z] }
    }

    /// Where the ray's line meets the triangle's plane.
    #[inline(always)]
    fn met(self) -> Met {
        let [a, b, c, _] = self.edges.mul(self.depths).numbers();
        let [_, v, w, _] = self.edges.div(D::splat(self.sum)).numbers();
        Met { t: (a + b + c) / (self.sum * self.advance), barycentrics: [v, w] }
    }
}

/// Where the ray's line meets the triangle, border included, from either side; `None` when it misses, or sees the triangle
/// exactly edge on: then it meets the neighbours instead.
pub(crate) fn meet(ray: &ExactRay, corners: &Corners) -> Option<Met> {
    let corners = ray.axes().map(|axis| corners.0[axis]);
    let laid = Laid::<<Portable as Processor>::Exact>::new(ray, corners);
    let [u, v, w, _] = laid.edges.numbers();
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) || laid.sum == 0.0 {
        return None;
    }
    Some(laid.met())
}

/// The same for a triangle of a block that the ray is known to meet.
#[inline(always)]
pub(crate) fn meet_for_certain<D: Doubles>(ray: &ExactRay, block: &TriangleBlock, lane: usize) -> Met {
    // No closure: it would be compiled for any processor.
    let [x, y, z] = ray.axes();
    Laid::<D>::new(ray, [block.along(x, lane), block.along(y, lane), block.along(z, lane)]).met()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::{Isa, Task, UnitFrame};
    use vitrum_math::{Bounds, Ray, unit};
    use vitrum_testkit::Uniform;

    const CORNERS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.5, 0.0, 0.5), Vec3::new(0.0, 0.5, 0.5)];

    fn corners() -> [DVec3; 3] {
        CORNERS.map(|c| c.as_dvec3())
    }

    /// The triangle in one place of a block that is otherwise empty.
    fn block(lane: usize) -> TriangleBlock {
        let mut faces = [NONE; BLOCK];
        faces[lane] = 3;
        TriangleBlock::new(faces, |_| CORNERS)
    }

    /// What the conservative test says of one triangle.
    struct Look<'a> {
        sheared: &'a Sheared,
        block: &'a TriangleBlock,
        lane: usize,
        reach: f32,
        limit: f32,
    }

    impl Task for Look<'_> {
        /// Whether the ray meets it for certain, and between which distances.
        type Output = Option<(bool, f32, f32)>;

        #[inline(always)]
        fn run<P: Processor>(&mut self) -> Self::Output {
            let first = self.lane / P::Leaf::COUNT * P::Leaf::COUNT;
            let part = Part { block: self.block, index: 0, from: first, reach: self.reach };
            let seen = self.sheared.look::<P::Leaf>(&part, NONE, self.limit)?;
            let lane = self.lane - first;
            assert_eq!(seen.candidates, 1 << lane, "only this one");
            Some((seen.certain >> lane & 1 == 1, seen.near[lane], seen.far[lane]))
        }
    }

    /// The frame that all of these tests work in: that of the world.
    fn frame() -> UnitFrame {
        UnitFrame::around(&Bounds::around([DVec3::splat(-0.49), DVec3::splat(0.49)]))
    }

    /// A ray that starts there.
    fn framed(ray: &Ray) -> FrameRay {
        frame().enter::<Portable>(ray, false, f64::INFINITY).expect("it starts in the frame")
    }

    fn look_at(
        isa: Isa,
        ray: &Ray,
        block: &TriangleBlock,
        lane: usize,
        limit: f32,
    ) -> Option<(bool, f32, f32)> {
        let sheared = Sheared::new(&framed(ray));
        let [a, b, c] = block.corners(lane).points();
        let reach = a.max(b).max(c) - a.min(b).min(c);
        let reach = (reach.length() as f32).max(1.0 / (1 << 22) as f32);
        isa.run(&mut Look { sheared: &sheared, block, lane, reach, limit })
    }

    fn may_meet(ray: &Ray, limit: f32) -> bool {
        let found = [0, 5, 13].map(|lane| look_at(Isa::best(), ray, &block(lane), lane, limit));
        assert!(found[0] == found[1] && found[1] == found[2], "every lane is alike");
        found[0].is_some()
    }

    fn meet_triangle(ray: &Ray, corners: &Corners) -> Option<Met> {
        super::meet(&framed(ray).exact, corners)
    }

    fn meet(ray: &Ray) -> Option<Met> {
        meet_triangle(ray, &Corners::new(CORNERS))
    }

    #[test]
    fn corners_and_edges_belong_to_the_triangle() {
        for target in
            [CORNERS[0], CORNERS[1], CORNERS[2], Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.25, 0.0, 0.5)]
        {
            let ray = Ray::new(DVec3::new(f64::from(target.x), f64::from(target.y), -0.5), DVec3::Z);
            assert!(may_meet(&ray, f32::INFINITY));
            assert_eq!(meet(&ray).expect("on the border").t, 1.0);
        }
        let beside = Ray::new(DVec3::new(0.3, 0.3, -0.5), DVec3::Z);
        assert!(!may_meet(&beside, f32::INFINITY));
        assert!(meet(&beside).is_none());
    }

    #[test]
    fn what_lies_behind_or_beyond_the_limit_is_thrown_out() {
        let towards = Ray::new(DVec3::new(0.1, 0.1, -0.5), DVec3::Z);
        assert!(may_meet(&towards, 1.0) && !may_meet(&towards, 0.99));
        let away = Ray::new(towards.origin, -DVec3::Z);
        assert!(!may_meet(&away, f32::INFINITY));
        let on_it = Ray::new(DVec3::new(0.1, 0.1, 0.5), DVec3::Z);
        assert!(may_meet(&on_it, 0.0));
    }

    #[test]
    fn the_point_is_exact() {
        let ray = Ray::new(DVec3::new(0.1, 0.2, -0.5), DVec3::new(0.01, -0.02, 0.9));
        let met = meet(&ray).expect("hit");
        assert!((met.t - 1.0 / 0.9).abs() < 1e-15);
        let [v, w] = met.barycentrics;
        let p = corners()[0] * (1.0 - v - w) + corners()[1] * v + corners()[2] * w;
        assert!((p - ray.at(met.t)).length() < 2e-16);
    }

    /// Whatever double precision meets, the conservative test lets through, and between the right distances; what it is
    /// certain of, double precision meets. Triangles of all sizes and shapes, needles among them, and rays that pass their
    /// borders at any distance down to a rounding.
    #[test]
    fn the_conservative_test_loses_nothing_and_claims_nothing_wrong() {
        let mut uniform = Uniform::new(5);
        let mut number = || uniform.number() - 0.5;
        let (mut met, mut certain) = (0, 0);
        for i in 0..200_000 {
            let (size, thin) = (0.5f64.powi(i % 23), 0.1f64.powi(i % 7));
            let mut vector = || DVec3::new(number(), number(), number());
            let (middle, along) = (vector() * (0.98 - size * 0.9), vector() * size);
            let corners = [middle, middle + along, middle + along * 0.5 + vector() * (size * thin)];
            let corners = corners.map(|c| c.clamp(DVec3::splat(-0.49), DVec3::splat(0.49)).as_vec3());
            let lane = (i % 16) as usize;
            let mut faces = [NONE; BLOCK];
            faces[lane] = 1;
            let block = TriangleBlock::new(faces, |_| corners);
            let triangle = block.corners(lane);
            let exact = triangle.points();
            // From a point of an edge, or of the inside, a little away.
            let [u, v] = [number() + 0.5, if i % 3 == 0 { number() + 0.5 } else { 0.0 }];
            let on_it = exact[0] + (exact[1] - exact[0]) * u + (exact[2] - exact[0]) * (v * (1.0 - u));
            let target = on_it + DVec3::new(number(), number(), number()) * (0.1f64.powi(i % 17) * size);
            let origin = DVec3::new(number(), number(), number());
            let ray = Ray::new(origin, unit(target - origin));
            let expected = meet_triangle(&ray, &triangle);
            for &isa in Isa::all() {
                let seen = look_at(isa, &ray, &block, lane, f32::INFINITY);
                if let Some(Met { t, .. }) = expected
                    && t >= 0.0
                {
                    met += 1;
                    let (_, near, far) = seen.unwrap_or_else(|| panic!("{isa:?} lost {i}"));
                    // Nothing compares with what is not known.
                    assert!(!(f64::from(near) > t || t > f64::from(far)), "{isa:?} {i}: {near} {t} {far}");
                }
                if seen.is_some_and(|(certain, ..)| certain) {
                    certain += 1;
                    assert!(expected.is_some(), "{isa:?} is certain of {i}");
                }
            }
        }
        let isas = Isa::all().len();
        assert!(met > 100_000 * isas && certain > 7_000 * isas, "{met} {certain} of {isas}");
    }
}
