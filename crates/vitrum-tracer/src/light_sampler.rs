//! Which light a point asks, and where: for paths, which ask one light at each point that scatters.
//!
//! Lights are points, spots and directions, and objects of an emissive material. A point asks one of them, chosen in proportion
//! to a rough estimate of the irradiance that it gives there (up to [`MOST_ESTIMATED`] lights; by power beyond), so that the
//! share of a light in the noise is about that in the light. An emissive object whose shape can't be sampled is no light here:
//! paths find it by chance; so they do a background that is no picture.

use crate::background::Background;
use crate::environment_sampler::EnvironmentSampler;
use crate::light::Light;
use crate::scene::Scene;
use crate::settings::{Integrator, LightSampling, Settings};
use std::f64::consts::PI;
use std::sync::Arc;
use vitrum_geometry::{AreaSampler, SurfaceInteraction};
use vitrum_materials::Material;
use vitrum_math::{DVec3, Rgb};

/// More lights than this are not estimated one by one.
const MOST_ESTIMATED: usize = 16;

/// A light that can be asked.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// One that no ray hits: its number among the scene's.
    Delta(usize),
    /// An emissive object.
    Area { object: u32, sampler: AreaSampler },
    /// A part of the environment.
    Environment(usize),
}

/// The lights of a scene.
#[derive(Clone, Debug)]
pub(crate) struct LightSampler {
    sources: Vec<Source>,
    /// The sum of the powers of each light and all before it, where there are too many to estimate.
    powers: Option<Vec<f64>>,
    /// For each object its place among the sources.
    of_object: Vec<Option<u32>>,
    /// The environment, whose parts are the last sources.
    environment: Option<EnvironmentSampler>,
    /// Centre and radius of everything, for lights that are infinitely far away.
    scene: (DVec3, f64),
}

impl LightSampler {
    /// The lights that are asked by way of this: by paths all, by ray trees none.
    pub(crate) fn of(scene: &Scene, settings: &Settings) -> Self {
        match settings.integrator {
            // What is left to light that is met must be met.
            Integrator::Path => Self::new(scene, settings.light_sampling == LightSampling::Mis),
            Integrator::Whitted => Self {
                sources: Vec::new(),
                powers: None,
                of_object: Vec::new(),
                environment: None,
                scene: (DVec3::ZERO, 1.0),
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
                sources.push(Source::Area { object: id, sampler });
            }
        }
        let environment = match &scene.background {
            Background::Environment(map) => Some(EnvironmentSampler::new(Arc::clone(map), compensated)),
            _ => None,
        };
        let parts = environment.as_ref().map_or(0, EnvironmentSampler::len);
        sources.extend((0..parts).map(Source::Environment));
        let bounds = scene.aggregate().bounds();
        let whole = if bounds.is_empty() {
            (DVec3::ZERO, 1.0)
        } else {
            (bounds.centre(), bounds.extent().length() * 0.5)
        };
        let mut all = Self { sources, powers: None, of_object, environment, scene: whole };
        if all.sources.len() > MOST_ESTIMATED {
            let mut sum = 0.0;
            let up_to = |source: &Source| {
                sum += all.power(scene, source);
                sum
            };
            all.powers = Some(all.sources.iter().map(up_to).collect());
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

    /// A light for `u` in [0, 1), and how probable it is; `None` where no light reaches.
    #[inline]
    pub(crate) fn choose(&self, scene: &Scene, from: DVec3, u: f64) -> Option<(&Source, f64)> {
        if let [only] = &self.sources[..] {
            return Some((only, 1.0));
        }
        let mut estimated = [0.0; MOST_ESTIMATED];
        let up_to = match &self.powers {
            Some(powers) => &powers[..],
            None => self.estimate(scene, from, &mut estimated),
        };
        let total = *up_to.last()?;
        let at = u * total;
        let index = up_to.partition_point(|sum| *sum <= at).min(up_to.len() - 1);
        let share = share(up_to, index);
        (share > 0.0).then(|| (&self.sources[index], share / total))
    }

    /// The density, per steradian, with which a point asks for the point of the object that `hit` is; `None` if that is no light.
    #[inline]
    pub(crate) fn pdf(&self, scene: &Scene, from: DVec3, hit: &SurfaceInteraction) -> Option<f64> {
        let index = self.of_object[hit.object as usize]? as usize;
        let Source::Area { sampler, .. } = &self.sources[index] else { return None };
        Some(sampler.pdf(from, hit) * self.probability(scene, from, index))
    }

    /// The density, per steradian, with which a point asks for the background in a direction; `None` if that is no light.
    #[inline]
    pub(crate) fn pdf_of_background(&self, scene: &Scene, from: DVec3, direction: DVec3) -> Option<f64> {
        let environment = self.environment.as_ref()?;
        let (part, density) = environment.pdf(direction)?;
        let index = self.sources.len() - environment.len() + part;
        Some(density * self.probability(scene, from, index))
    }

    /// How probable it is that a point asks a light.
    #[inline]
    fn probability(&self, scene: &Scene, from: DVec3, index: usize) -> f64 {
        if self.sources.len() == 1 {
            return 1.0;
        }
        let mut estimated = [0.0; MOST_ESTIMATED];
        let up_to = match &self.powers {
            Some(powers) => &powers[..],
            None => self.estimate(scene, from, &mut estimated),
        };
        up_to.last().map_or(0.0, |total| share(up_to, index) / total)
    }

    /// The sum of the estimates of each light and all before it.
    #[inline]
    fn estimate<'e>(&self, scene: &Scene, from: DVec3, sums: &'e mut [f64; MOST_ESTIMATED]) -> &'e [f64] {
        let mut sum = 0.0;
        for (source, up_to) in self.sources.iter().zip(sums.iter_mut()) {
            sum += match source {
                Source::Delta(light) => {
                    let arrival = scene.lights[*light].arriving_at(from);
                    arrival.map_or(0.0, |arrival| arrival.irradiance.max_element())
                }
                Source::Area { sampler, .. } => {
                    let (centre, radius) = sampler.ball();
                    let offset = centre - from;
                    sampler.weight() / offset.dot(offset).max(radius * radius)
                }
                Source::Environment(part) => self.irradiance(*part),
            };
            *up_to = sum;
        }
        &sums[..self.sources.len()]
    }

    /// Roughly the irradiance that a part of the environment gives.
    #[inline]
    fn irradiance(&self, part: usize) -> f64 {
        self.environment.as_ref().map_or(0.0, |environment| environment.irradiance(part))
    }

    /// Roughly the power that reaches the scene, watts.
    fn power(&self, scene: &Scene, source: &Source) -> f64 {
        match source {
            Source::Area { sampler, .. } => PI * sampler.weight(),
            Source::Environment(part) => PI * self.scene.1 * self.scene.1 * self.irradiance(*part),
            Source::Delta(light) => match &scene.lights[*light] {
                Light::Directional { irradiance, .. } => {
                    PI * self.scene.1 * self.scene.1 * irradiance.max_element()
                }
                Light::Point { intensity, .. } => 4.0 * PI * intensity.max_element(),
                Light::Spot { intensity, cos_outer, .. } => {
                    2.0 * PI * (1.0 - cos_outer) * intensity.max_element()
                }
            },
        }
    }
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
            radiance.at(point, || scene.aggregate().uv_at(object, face, point))
        }
        _ => Rgb::ZERO,
    }
}
