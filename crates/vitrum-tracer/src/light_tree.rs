//! A tree over many lights, in which a point finds one of them in proportion to what it may get from it, roughly, in as many
//! steps as the tree is deep.
//!
//! After A. Conty Estevez and C. Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018, without the
//! splitting: one light is chosen. A node knows a ball around its lights, the sum of their intensities, and a cone that bounds the
//! directions into which they shine ([`Reach`]); its importance to a point is the intensity, times the cosine of the least angle
//! that is possible, over the square of the distance. A number in [0, 1) chooses between the two children of a node, and what is
//! left of it is the number for the next one, so that evenly spread numbers stay so. How probable a light is is found by walking
//! the same way, which is kept as one bit a step.
//!
//! The tree is built from the top. Each division is the cheapest of some between bins along the three axes, by intensity, size and
//! solid angle (their surface area orientation heuristic, with the square of the diagonal in the place of the surface, which
//! rows and sheets of lights have none of).

use std::f64::consts::PI;
use vitrum_geometry::AreaSampler;
use vitrum_math::{Bounds, DVec3, unit};

/// Bins along each axis.
const BINS: usize = 12;

/// From this depth on nodes are halved, so that the way to any of 2³² lights has no more steps than 64 bits tell.
const HALVED: u32 = 32;

/// Cosines are trusted to this. Twice the rounding of angles that were added up along the tree would do.
const SLACK: f64 = 1e-9;

/// More irradiance than this is not told from it, so that sums stay finite.
const BRIGHTEST: f64 = 1e100;

/// A child that reaches a point is chosen at least this often, however bright its sibling is.
const RAREST: f64 = 1e-12;

/// Where some lights are, and where they shine to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    bounds: Bounds,
    centre: DVec3,
    radius_squared: f64,
    /// Roughly the largest radiant intensity, W/sr.
    intensity: f64,
    /// The cone of their axes or normals.
    axis: DVec3,
    cos: f64,
    sin: f64,
    /// How far beyond it they shine: a right angle for surfaces.
    beyond: Beyond,
}

/// How far light spreads from the cone of axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Beyond {
    /// Not at all.
    Nothing,
    /// To a right angle, fading by the cosine.
    Cosine,
}

impl Reach {
    /// A point that shines to all sides.
    pub(crate) fn point(position: DVec3, intensity: f64) -> Self {
        let bounds = Bounds::around([position]);
        Self::new(bounds, intensity, (DVec3::Z, -1.0), Beyond::Nothing)
    }

    /// A point that shines into a cone.
    pub(crate) fn spot(position: DVec3, intensity: f64, axis: DVec3, cos_outer: f64) -> Self {
        Self::new(Bounds::around([position]), intensity, (axis, cos_outer), Beyond::Nothing)
    }

    /// A surface that shines.
    pub(crate) fn surface(sampler: &AreaSampler) -> Self {
        let (cone, (_, radius)) = (sampler.normals(), sampler.ball());
        let reach = Self::new(*sampler.bounds(), sampler.intensity(), (cone.axis, cone.cos), Beyond::Cosine);
        Self { radius_squared: radius * radius, ..reach }
    }

    fn new(bounds: Bounds, intensity: f64, (axis, cos): (DVec3, f64), beyond: Beyond) -> Self {
        let cos = (cos - SLACK).max(-1.0);
        let half = bounds.extent() * 0.5;
        Self {
            bounds,
            centre: bounds.centre(),
            radius_squared: half.dot(half),
            intensity,
            axis,
            cos,
            sin: (1.0 - cos * cos).max(0.0).sqrt(),
            beyond,
        }
    }

    /// Both together.
    fn with(&self, other: &Self) -> Self {
        let bounds = self.bounds.union(other.bounds);
        let cone = cone_around((self.axis, self.cos), (other.axis, other.cos));
        Self::new(bounds, self.intensity + other.intensity, cone, self.beyond.max(other.beyond))
    }

    /// Roughly the largest irradiance that a point may get, W/m²; zero only where it gets none.
    #[inline]
    pub(crate) fn importance(&self, from: DVec3) -> f64 {
        let offset = from - self.centre;
        let squared = offset.dot(offset);
        if squared <= self.radius_squared {
            // Within the ball everything is possible. A light of no size gives nothing to itself.
            return if self.radius_squared > 0.0 { self.intensity / self.radius_squared } else { 0.0 };
        }
        let irradiance = (self.intensity / squared).min(BRIGHTEST);
        if self.cos <= -1.0 {
            return irradiance;
        }
        let cos_axis = (offset.dot(self.axis) / squared.sqrt()).clamp(-1.0, 1.0);
        let sin_ball_squared = self.radius_squared / squared;
        let ball = (((1.0 - sin_ball_squared).max(0.0)).sqrt(), sin_ball_squared.sqrt());
        let sin_axis = (1.0 - cos_axis * cos_axis).max(0.0).sqrt();
        let (cos, _) = less(less((cos_axis, sin_axis), (self.cos, self.sin)), ball);
        match self.beyond {
            Beyond::Nothing if cos < 1.0 - SLACK => 0.0,
            Beyond::Nothing => irradiance,
            Beyond::Cosine if cos <= -SLACK => 0.0,
            Beyond::Cosine => irradiance * cos.max(SLACK),
        }
    }

    /// What it costs to choose among these: intensity, times the squared diagonal, times the solid angle into which they shine.
    fn cost(&self) -> f64 {
        let theta = libm::acos(self.cos);
        let beyond = match self.beyond {
            Beyond::Nothing => 0.0,
            Beyond::Cosine => 0.5 * PI,
        };
        let most = (theta + beyond).min(PI);
        let measure = 2.0 * PI * (1.0 - self.cos)
            + 0.5
                * PI
                * (2.0 * most * self.sin - libm::cos(theta - 2.0 * most) - 2.0 * theta * self.sin + self.cos);
        self.intensity * self.radius_squared * measure
    }
}

/// The cosine and sine of the first angle less the second one, of zero where that is more.
#[inline]
fn less((cos_a, sin_a): (f64, f64), (cos_b, sin_b): (f64, f64)) -> (f64, f64) {
    if cos_a >= cos_b {
        (1.0, 0.0)
    } else {
        (cos_a * cos_b + sin_a * sin_b, (sin_a * cos_b - cos_a * sin_b).max(0.0))
    }
}

/// The smallest cone around two: axis and cosine.
fn cone_around(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    let ((axis_a, cos_a), (axis_b, cos_b)) = if a.1 <= b.1 { (a, b) } else { (b, a) };
    if cos_a <= -1.0 {
        return (axis_a, -1.0);
    }
    let (theta_a, theta_b) = (libm::acos(cos_a), libm::acos(cos_b));
    let between = libm::atan2(axis_a.cross(axis_b).length(), axis_a.dot(axis_b));
    if (between + theta_b).min(PI) <= theta_a {
        return (axis_a, cos_a);
    }
    let theta = 0.5 * (theta_a + between + theta_b);
    let across = axis_b - axis_a * axis_a.dot(axis_b);
    if theta >= PI || across.length() < SLACK {
        return (axis_a, -1.0);
    }
    let (sin, cos) = libm::sincos(theta - theta_a);
    (unit(axis_a * cos + unit(across) * sin), libm::cos(theta))
}

/// The tree.
#[derive(Clone, Debug)]
pub(crate) struct LightTree {
    /// A node's first child follows it.
    nodes: Vec<Node>,
    /// For each light the way to it from the top, a bit a step: the second child where it is set.
    trails: Vec<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    reach: Reach,
    to: To,
}

#[derive(Clone, Copy, Debug)]
enum To {
    /// The second child.
    Second(u32),
    /// The only light.
    Light(u32),
}

impl LightTree {
    /// Over lights, at least one; they are known by their places among these.
    pub(crate) fn new(lights: &[Reach]) -> Self {
        let mut tree = Self { nodes: Vec::new(), trails: vec![0; lights.len()] };
        let mut order: Vec<u32> = (0..lights.len() as u32).collect();
        tree.add(lights, &mut order, 0, 0);
        tree
    }

    fn add(&mut self, lights: &[Reach], order: &mut [u32], trail: u64, depth: u32) {
        let of = |&light: &u32| lights[light as usize];
        let reach = order.iter().map(of).reduce(|a, b| a.with(&b)).expect("there is a light");
        let place = self.nodes.len();
        if let [light] = *order {
            self.trails[light as usize] = trail;
            self.nodes.push(Node { reach, to: To::Light(light) });
            return;
        }
        let middle = if depth < HALVED { divide(lights, order) } else { None };
        let middle = middle.unwrap_or(order.len() / 2);
        let (first, second) = order.split_at_mut(middle);
        self.nodes.push(Node { reach, to: To::Second(0) });
        self.add(lights, first, trail, depth + 1);
        self.nodes[place].to = To::Second(self.nodes.len() as u32);
        self.add(lights, second, trail | 1 << depth, depth + 1);
    }

    /// Roughly the irradiance that a point may get from all of them, W/m².
    #[inline]
    pub(crate) fn importance(&self, from: DVec3) -> f64 {
        self.nodes[0].reach.importance(from)
    }

    /// A light for `u` in [0, 1), how probable it is, and where in its part of the interval `u` lies, in [0, 1). Where none reaches,
    /// it is some light.
    #[inline]
    pub(crate) fn choose(&self, from: DVec3, mut u: f64) -> (usize, f64, f64) {
        let (mut place, mut probability) = (0, 1.0);
        loop {
            match self.nodes[place].to {
                To::Light(light) => return (light as usize, probability, u),
                To::Second(second) => {
                    let first = self.share_of_first(place, second as usize, from);
                    if u < first {
                        (place, probability) = (place + 1, probability * first);
                        u /= first;
                    } else {
                        (place, probability) = (second as usize, probability * (1.0 - first));
                        u = (u - first) / (1.0 - first);
                    }
                    u = u.min(1.0 - f64::EPSILON);
                }
            }
        }
    }

    /// How probable [`choose`](Self::choose) makes a light.
    #[inline]
    pub(crate) fn probability(&self, light: usize, from: DVec3) -> f64 {
        let (mut place, mut probability, mut trail) = (0, 1.0, self.trails[light]);
        while let To::Second(second) = self.nodes[place].to {
            let first = self.share_of_first(place, second as usize, from);
            if trail & 1 == 0 {
                (place, probability) = (place + 1, probability * first);
            } else {
                (place, probability) = (second as usize, probability * (1.0 - first));
            }
            trail >>= 1;
        }
        probability
    }

    /// How often the first child of a node is chosen.
    #[inline]
    fn share_of_first(&self, place: usize, second: usize, from: DVec3) -> f64 {
        let (first, second) = (&self.nodes[place + 1].reach, &self.nodes[second].reach);
        let (a, b) = (first.importance(from), second.importance(from));
        // A node may seem to reach the point where none of its lights does: then it does not matter.
        match (a > 0.0, b > 0.0) {
            (true, true) => (a / (a + b)).clamp(RAREST, 1.0 - RAREST),
            (true, false) => 1.0,
            (false, true) => 0.0,
            (false, false) => 0.5,
        }
    }
}

/// Puts lights in the order of the cheapest division, and says where it is; `None` where all of them are at one place.
fn divide(lights: &[Reach], order: &mut [u32]) -> Option<usize> {
    let of = |&light: &u32| &lights[light as usize];
    let centres = Bounds::around(order.iter().map(|light| of(light).centre));
    let extent = centres.extent();
    let bin = |light: &u32, axis: usize| {
        let along = (of(light).centre[axis] - centres.min[axis]) / extent[axis];
        ((along * BINS as f64) as usize).min(BINS - 1)
    };
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in 0..3 {
        if extent[axis] <= 0.0 {
            continue;
        }
        let mut bins: [Option<Reach>; BINS] = [None; BINS];
        for light in order.iter() {
            let bin = &mut bins[bin(light, axis)];
            *bin = together(*bin, Some(*of(light)));
        }
        let mut after = [None; BINS];
        let mut all = None;
        for (bin, after) in bins.iter().zip(&mut after).rev() {
            all = together(all, *bin);
            *after = all;
        }
        let mut before = None;
        for i in 1..BINS {
            before = together(before, bins[i - 1]);
            let (Some(a), Some(b)) = (before, after[i]) else { continue };
            // Long nodes are not cut along their length.
            let cost = (a.cost() + b.cost()) * extent.max_element() / extent[axis];
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    let (_, axis, border) = best?;
    // Stable, so that nothing but the lights decides.
    order.sort_by_key(|light| bin(light, axis) >= border);
    Some(order.partition_point(|light| bin(light, axis) < border))
}

fn together(a: Option<Reach>, b: Option<Reach>) -> Option<Reach> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.with(&b)),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vitrum_testkit::Uniform;

    fn direction(uniform: &mut Uniform) -> DVec3 {
        let [u, v] = uniform.pair();
        let z = 1.0 - 2.0 * u;
        let (sin, cos) = libm::sincos(2.0 * PI * v);
        let r = (1.0 - z * z).max(0.0).sqrt();
        unit(DVec3::new(r * cos, r * sin, z))
    }

    fn position(uniform: &mut Uniform) -> DVec3 {
        let [x, y] = uniform.pair();
        DVec3::new(x, y, uniform.number()) * 10.0 - DVec3::splat(5.0)
    }

    /// A light, and whether it gives anything to a point.
    struct Tried {
        reach: Reach,
        gives: Box<dyn Fn(DVec3) -> bool>,
    }

    fn tried(uniform: &mut Uniform, kind: usize) -> Tried {
        let (at, axis, intensity) = (position(uniform), direction(uniform), uniform.number() + 1e-3);
        match kind {
            0 => Tried { reach: Reach::point(at, intensity), gives: Box::new(move |p| p != at) },
            1 => {
                let cos = 2.0 * uniform.number() - 1.0;
                let gives = move |p: DVec3| p != at && unit(p - at).dot(axis) > cos;
                Tried { reach: Reach::spot(at, intensity, axis, cos), gives: Box::new(gives) }
            }
            _ => {
                // A disk that faces along its axis.
                let (bounds, corner) = (Bounds::around([at]), DVec3::splat(0.3));
                let bounds = Bounds { min: bounds.min - corner, max: bounds.max + corner };
                let reach = Reach::new(bounds, intensity, (axis, 1.0), Beyond::Cosine);
                Tried { reach, gives: Box::new(move |p| (p - at).dot(axis) > 0.0) }
            }
        }
    }

    proptest! {
        /// Probabilities sum to one for any point, agree with how often lights are chosen, and are zero for no light that gives
        /// anything.
        #[test]
        fn probabilities_are_whole_and_leave_nothing_out(
            seed in any::<u64>(), count in 1usize..200, mixed in any::<bool>(), clustered in any::<bool>(),
        ) {
            let mut uniform = Uniform::new(seed);
            let lights: Vec<Tried> =
                (0..count).map(|i| tried(&mut uniform, if mixed { i % 3 } else { 2 })).collect();
            let mut reaches: Vec<Reach> = lights.iter().map(|light| light.reach).collect();
            if clustered {
                // All at one place, which nothing divides.
                let at = reaches[0];
                reaches.iter_mut().for_each(|reach| *reach = at);
            }
            let tree = LightTree::new(&reaches);
            for _ in 0..20 {
                let from = position(&mut uniform);
                let probabilities: Vec<f64> = (0..count).map(|light| tree.probability(light, from)).collect();
                let sum: f64 = probabilities.iter().sum();
                prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}");
                if !clustered {
                    for (light, probability) in lights.iter().zip(&probabilities) {
                        prop_assert!(!(light.gives)(from) || *probability > 0.0);
                        prop_assert!(!(light.gives)(from) || tree.importance(from) > 0.0);
                    }
                }
                for _ in 0..20 {
                    let (light, probability, _) = tree.choose(from, uniform.number());
                    prop_assert_eq!(probability, probabilities[light]);
                }
            }
        }
    }

    /// Evenly spread numbers choose each light as often as its probability says, within one: what is left of a number is as even as
    /// the number was.
    #[test]
    fn one_number_is_enough() {
        let mut uniform = Uniform::new(4);
        let reaches: Vec<Reach> = (0..50).map(|i| tried(&mut uniform, i % 3).reach).collect();
        let tree = LightTree::new(&reaches);
        let from = position(&mut uniform);
        let count = 100_000;
        let mut chosen = vec![0.0; reaches.len()];
        for i in 0..count {
            chosen[tree.choose(from, (f64::from(i) + 0.5) / f64::from(count)).0] += 1.0;
        }
        for (light, found) in chosen.iter().enumerate() {
            let expected = tree.probability(light, from) * f64::from(count);
            assert!((found - expected).abs() <= 1.0, "{light}: {found} {expected}");
        }
    }
}
