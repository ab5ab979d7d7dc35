//! Which light a point asks, and where: for paths, which ask one light at each point that scatters.
//!
//! Lights are points, spots and directions, and objects of an emissive material. A point asks one of them, chosen in proportion
//! to a rough estimate of the irradiance that it gives there, so that the share of a light in the noise is about that in the light:
//! each light is estimated up to [`MOST_ESTIMATED`] of them, and beyond that the way is found in a tree (`light_tree.rs`). Lights
//! whose irradiance is the same everywhere (from infinitely far away, or without falloff) are no part of the tree: they are
//! chosen among by irradiance, and as often as the estimates of both parts say, within bounds.
//!
//! An emissive object whose shape can't be sampled is no light here: paths find it by chance; so they do a background that is no
//! picture.

use crate::background::Background;
use crate::environment_sampler::EnvironmentSampler;
use crate::light::{Falloff, Light};
use crate::light_tree::{LightTree, Reach};
use crate::scene::Scene;
use crate::settings::{Integrator, LightSampling, Settings};
use std::sync::Arc;
use vitrum_geometry::{AreaSampler, SurfaceInteraction};
use vitrum_materials::Material;
use vitrum_math::{DVec3, Rgb};

/// More lights than this are not estimated one by one. With as many, a tree has 0.86 to 0.94 of the efficiency.
const MOST_ESTIMATED: usize = 16;

/// A light that can be asked.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// One that no ray hits: its number among the scene's.
    Delta(usize),
    /// An emissive object.
    Area { object: u32, sampler: Box<AreaSampler> },
    /// A part of the environment.
    Environment(usize),
}

/// A light that was chosen.
pub(crate) struct Chosen<'l> {
    pub(crate) source: &'l Source,
    pub(crate) probability: f64,
    /// Where the number that chose it lies among those that do, in [0, 1): as evenly spread as these numbers, it finds the point
    /// of the light.
    pub(crate) left: f64,
}

/// The lights of a scene.
#[derive(Clone, Debug)]
pub(crate) struct LightSampler {
    sources: Vec<Source>,
    /// What is known of each.
    reaches: Vec<Option<Reach>>,
    /// Where there are too many to estimate.
    many: Option<Many>,
    /// For each object its place among the sources.
    of_object: Vec<Option<u32>>,
    /// The environment, whose parts are the last sources.
    environment: Option<EnvironmentSampler>,
}

/// Many lights.
#[derive(Clone, Debug)]
struct Many {
    /// Those that have a place, and where they stand among all.
    tree: Option<LightTree>,
    of_tree: Vec<u32>,
    /// For each light its place in the tree, or among the others.
    place: Vec<u32>,
    /// The others, and the sum of the irradiances of each and all before it.
    everywhere: Vec<u32>,
    irradiances: Vec<f64>,
}

impl LightSampler {
    /// The lights that are asked by way of this: by paths all, by ray trees none.
    pub(crate) fn of(scene: &Scene, settings: &Settings) -> Self {
        match settings.integrator {
            // What is left to light that is met must be met.
            Integrator::Path => Self::new(scene, settings.light_sampling == LightSampling::Mis),
            Integrator::Whitted => Self {
                sources: Vec::new(),
                reaches: Vec::new(),
                many: None,
                of_object: Vec::new(),
                environment: None,
            },
        }
    }

    fn new(scene: &Scene, compensated: bool) -> Self {
        let mut sources: Vec<Source> = (0..scene.lights.len()).map(Source::Delta).collect();
        let objects = scene.aggregate().objects();
        let mut of_object = vec![None; objects.len()];
        for (id, object) in (0u32..).zip(objects) {
            let shines = |face: u32| brightness(scene.material(id, face));
            if scene.materials_of(id).iter().all(|m| brightness(m) == 0.0) {
                continue;
            }
            if let Some(sampler) = AreaSampler::new(object, &shines) {
                of_object[id as usize] = Some(sources.len() as u32);
                sources.push(Source::Area { object: id, sampler: Box::new(sampler) });
            }
        }
        let environment = match &scene.background {
            Background::Environment(map) => Some(EnvironmentSampler::new(Arc::clone(map), compensated)),
            _ => None,
        };
        let parts = environment.as_ref().map_or(0, EnvironmentSampler::len);
        sources.extend((0..parts).map(Source::Environment));
        let reaches: Vec<_> = sources.iter().map(|source| reach(scene, source)).collect();
        let mut all = Self { sources, reaches, many: None, of_object, environment };
        if all.sources.len() > MOST_ESTIMATED {
            let irradiances: Vec<f64> = all.sources.iter().map(|s| all.irradiance(scene, s)).collect();
            all.many = Some(Many::new(&irradiances, &all.reaches));
        }
        all
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.sources.len()
    }

    /// Emissive objects among them.
    pub(crate) fn areas(&self) -> usize {
        self.sources.iter().filter(|s| matches!(s, Source::Area { .. })).count()
    }

    /// Parts of the environment among them.
    pub(crate) fn parts(&self) -> usize {
        self.environment.as_ref().map_or(0, EnvironmentSampler::len)
    }

    /// What parts of the environment are asked by.
    pub(crate) fn environment(&self) -> Option<&EnvironmentSampler> {
        self.environment.as_ref()
    }

    /// A light for `u` in [0, 1); `None` where no light reaches.
    // Always: there are six walkers, and with so many callers the compiler would not.
    #[inline(always)]
    pub(crate) fn choose(&self, scene: &Scene, from: DVec3, u: f64) -> Option<Chosen<'_>> {
        if let [only] = &self.sources[..] {
            return Some(Chosen { source: only, probability: 1.0, left: u });
        }
        let (index, probability, left) = if let Some(many) = &self.many {
            many.choose(from, u)?
        } else {
            let mut estimated = [0.0; MOST_ESTIMATED];
            pick(self.estimate(scene, from, &mut estimated), u)?
        };
        Some(Chosen { source: &self.sources[index], probability, left })
    }

    /// The density, per steradian, with which a point asks for the point of the object that `hit` is; `None` if that is no light.
    // Always: there are six walkers, and with so many callers the compiler would not.
    #[inline(always)]
    pub(crate) fn pdf(&self, scene: &Scene, from: DVec3, hit: &SurfaceInteraction) -> Option<f64> {
        let index = self.of_object[hit.object as usize]? as usize;
        let Source::Area { sampler, .. } = &self.sources[index] else { return None };
        Some(sampler.pdf(from, hit) * self.probability(scene, from, index))
    }

    /// The density, per steradian, with which a point asks for the background in a cell of its map; `None` if that is no light.
    #[inline]
    pub(crate) fn pdf_of_background(&self, scene: &Scene, from: DVec3, cell: [usize; 2]) -> Option<f64> {
        let environment = self.environment.as_ref()?;
        let (part, density) = environment.pdf(cell)?;
        let index = self.sources.len() - environment.len() + part;
        Some(density * self.probability(scene, from, index))
    }

    /// How probable it is that a point asks a light.
    #[inline]
    fn probability(&self, scene: &Scene, from: DVec3, index: usize) -> f64 {
        if self.sources.len() == 1 {
            return 1.0;
        }
        if let Some(many) = &self.many {
            return many.probability(index, self.reaches[index].is_some(), from);
        }
        let mut estimated = [0.0; MOST_ESTIMATED];
        let up_to = self.estimate(scene, from, &mut estimated);
        let share = share(up_to, index);
        // Where nothing reaches, the sum is zero too.
        if share > 0.0 { share / up_to[up_to.len() - 1] } else { 0.0 }
    }

    /// The sum of the estimates of each light and all before it.
    #[inline]
    fn estimate<'e>(&self, scene: &Scene, from: DVec3, sums: &'e mut [f64; MOST_ESTIMATED]) -> &'e [f64] {
        let mut sum = 0.0;
        for ((source, reach), up_to) in self.sources.iter().zip(&self.reaches).zip(sums.iter_mut()) {
            sum += match (source, reach) {
                (Source::Delta(light), _) => {
                    let arrival = scene.lights[*light].arriving_at(from);
                    arrival.map_or(0.0, |arrival| arrival.irradiance.max_element())
                }
                (Source::Area { .. }, reach) => reach.as_ref().map_or(0.0, |reach| reach.importance(from)),
                (Source::Environment(_), _) => self.irradiance(scene, source),
            };
            *up_to = sum;
        }
        &sums[..self.sources.len()]
    }

    /// The irradiance of a light that gives the same everywhere.
    #[inline]
    fn irradiance(&self, scene: &Scene, source: &Source) -> f64 {
        match source {
            Source::Environment(part) => self.environment.as_ref().map_or(0.0, |all| all.irradiance(*part)),
            Source::Area { .. } => 0.0,
            Source::Delta(light) => match scene.lights[*light] {
                Light::Directional { irradiance: colour, .. } | Light::Point { intensity: colour, .. } => {
                    colour.max_element()
                }
                Light::Spot { .. } => 0.0,
            },
        }
    }
}

/// At least this share of the lights that are asked are of each part, where both give anything.
const LEAST_PART: f64 = 0.1;

impl Many {
    /// Of lights with a place, and others of these irradiances.
    fn new(of_others: &[f64], reaches: &[Option<Reach>]) -> Self {
        let (mut placed, mut of_tree, mut everywhere) = (Vec::new(), Vec::new(), Vec::new());
        let (mut place, mut irradiances, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for (index, (irradiance, reach)) in (0u32..).zip(of_others.iter().zip(reaches)) {
            if let Some(reach) = reach {
                place.push(of_tree.len() as u32);
                of_tree.push(index);
                placed.push(*reach);
            } else {
                place.push(everywhere.len() as u32);
                everywhere.push(index);
                sum += irradiance;
                irradiances.push(sum);
            }
        }
        let tree = (!placed.is_empty()).then(|| LightTree::new(&placed));
        Self { tree, of_tree, place, everywhere, irradiances }
    }

    /// How often a light with a place is asked for.
    #[inline]
    fn share_of_tree(&self, from: DVec3) -> f64 {
        let tree = self.tree.as_ref().map_or(0.0, |tree| tree.importance(from));
        let everywhere = self.irradiances.last().copied().unwrap_or(0.0);
        match (tree > 0.0, everywhere > 0.0) {
            (true, true) => (tree / (tree + everywhere)).clamp(LEAST_PART, 1.0 - LEAST_PART),
            (true, false) => 1.0,
            (false, _) => 0.0,
        }
    }

    #[inline]
    fn choose(&self, from: DVec3, u: f64) -> Option<(usize, f64, f64)> {
        let share_of_tree = self.share_of_tree(from);
        if u < share_of_tree {
            let within = (u / share_of_tree).min(1.0 - f64::EPSILON);
            let (light, probability, left) = self.tree.as_ref()?.choose(from, within);
            return Some((self.of_tree[light] as usize, probability * share_of_tree, left));
        }
        let within = ((u - share_of_tree) / (1.0 - share_of_tree)).min(1.0 - f64::EPSILON);
        let (index, probability, left) = pick(&self.irradiances, within)?;
        Some((self.everywhere[index] as usize, (1.0 - share_of_tree) * probability, left))
    }

    /// How probable a light is, which has a place or has none.
    #[inline]
    fn probability(&self, light: usize, has_place: bool, from: DVec3) -> f64 {
        let (share_of_tree, place) = (self.share_of_tree(from), self.place[light] as usize);
        match (&self.tree, has_place) {
            // Where the tree is not asked, it may not be walked.
            (Some(tree), true) if share_of_tree > 0.0 => share_of_tree * tree.probability(place, from),
            (_, true) => 0.0,
            (_, false) => {
                let total = self.irradiances.last().copied().unwrap_or(0.0);
                if total > 0.0 {
                    (1.0 - share_of_tree) * share(&self.irradiances, place) / total
                } else {
                    0.0
                }
            }
        }
    }
}

/// Where a light is and where it shines to; `None` for one whose irradiance is the same everywhere.
fn reach(scene: &Scene, source: &Source) -> Option<Reach> {
    match source {
        Source::Environment(_) => None,
        Source::Area { sampler, .. } => Some(Reach::surface(sampler)),
        Source::Delta(light) => match scene.lights[*light] {
            Light::Directional { .. } | Light::Point { falloff: Falloff::None, .. } => None,
            Light::Point { position, intensity, .. } => Some(Reach::point(position, intensity.max_element())),
            Light::Spot { position, axis, intensity, cos_outer, .. } => {
                Some(Reach::spot(position, intensity.max_element(), axis, cos_outer))
            }
        },
    }
}

/// One of those whose sums these are, how probable it is, and where in its share `u` lies; `None` where all are zero.
#[inline]
fn pick(up_to: &[f64], u: f64) -> Option<(usize, f64, f64)> {
    let total = *up_to.last()?;
    let at = u * total;
    let index = up_to.partition_point(|sum| *sum <= at).min(up_to.len() - 1);
    let share = share(up_to, index);
    let left = (1.0 - (up_to[index] - at) / share).clamp(0.0, 1.0 - f64::EPSILON);
    (share > 0.0).then_some((index, share / total, left))
}

/// What the light at `index` adds to the sums.
#[inline]
fn share(up_to: &[f64], index: usize) -> f64 {
    up_to[index] - if index == 0 { 0.0 } else { up_to[index - 1] }
}

/// Roughly the radiance that a material sends out; zero only where it sends out none.
fn brightness(material: &Material) -> f64 {
    match material {
        Material::Emissive { radiance } => radiance.brightness(),
        _ => 0.0,
    }
}

/// Radiance that a face of an object sends out at a point.
#[inline]
pub(crate) fn emitted(scene: &Scene, object: u32, face: u32, point: DVec3) -> Rgb {
    match scene.material(object, face) {
        Material::Emissive { radiance } => {
            radiance.at(&mut (point, || scene.aggregate().uv_at(object, face, point)))
        }
        _ => Rgb::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::scene::SceneObject;
    use vitrum_geometry::Object;
    use vitrum_geometry::shape::{Shape, Sphere};
    use vitrum_materials::Texture;
    use vitrum_math::Transform;
    use vitrum_testkit::Uniform;

    /// A scene of so many point lights and balls that shine, with a light from far away and one without falloff.
    fn scene(points: usize, balls: usize) -> Scene {
        let mut uniform = Uniform::new(3);
        let mut somewhere = || {
            let [x, y] = uniform.pair();
            DVec3::new(x, y, uniform.number()) * 8.0
        };
        let emissive = Material::Emissive { radiance: Texture::Constant(Rgb::splat(20.0)) };
        let ball = |number: usize, centre: DVec3| {
            let shape = Shape::Sphere(Sphere::new(centre, 0.1).expect("valid"));
            let object = Object::new(shape, &Transform::IDENTITY, false).expect("valid");
            SceneObject { name: format!("{number:04}"), object, materials: vec![emissive.clone()] }
        };
        let objects = (0..balls).map(|number| ball(number, somewhere())).collect();
        let camera =
            Camera::new(DVec3::Z * 20.0, DVec3::ZERO, DVec3::Y, Projection::Orthographic { height: 5.0 })
                .expect("valid");
        let mut scene = Scene::new(objects, camera).expect("valid");
        let point =
            |position, falloff| Light::Point { position, intensity: Rgb::ONE, falloff, shadows: true };
        scene.lights = (0..points).map(|_| point(somewhere(), Falloff::InverseSquare)).collect();
        scene.lights.push(point(DVec3::ZERO, Falloff::None));
        scene.lights.push(Light::Directional { towards: DVec3::Y, irradiance: Rgb::ONE, shadows: true });
        scene
    }

    /// Each light is chosen as often as it says, and together they are one: few lights, many, and many of each part alone. What is
    /// left of evenly spread numbers is evenly spread for each light.
    #[test]
    fn probabilities_are_whole() {
        for (points, balls) in [(3, 4), (30, 40), (0, 17), (30, 0)] {
            let scene = scene(points, balls);
            let sampler = LightSampler::new(&scene, true);
            assert_eq!(sampler.len(), points + balls + 2);
            let from = DVec3::new(3.0, -1.0, 2.0);
            let count = 200_000;
            let mut found = vec![(0.0, 0.0, Vec::new()); sampler.len()];
            for i in 0..count {
                let u = (f64::from(i) + 0.5) / f64::from(count);
                let Chosen { source, probability, left } =
                    sampler.choose(&scene, from, u).expect("light reaches it");
                let index = match source {
                    Source::Delta(light) => *light,
                    Source::Area { object, .. } => scene.lights.len() + *object as usize,
                    Source::Environment(part) => scene.lights.len() + balls + part,
                };
                found[index].0 += 1.0;
                found[index].1 = probability;
                found[index].2.push(left);
            }
            let sum: f64 = found.iter().map(|(_, probability, _)| probability).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{sum}");
            for (chosen, probability, left) in found {
                let expected: f64 = probability * f64::from(count);
                assert!((chosen - expected).abs() <= 1.5 && probability > 0.0, "{chosen} {expected}");
                for (rank, left) in left.iter().enumerate() {
                    let even = (rank as f64 + 0.5) / chosen;
                    assert!((left - even).abs() < 1.5 / chosen, "{left} instead of {even} of {chosen}");
                }
            }
        }
    }
}
