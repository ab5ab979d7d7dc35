//! What a scene needs, and what it can skip.
//!
//! Decided once, before the first ray. It chooses the walker, and the walker asks it; the rest is decided where it is built
//! (trees, isolated solids, lens, normals) and told here.

use crate::feature::Feature;
use crate::light_sampler::LightSampler;
use crate::overlaps::MOST;
use crate::scene::Scene;
use crate::settings::{Integrator, Settings, ShadowMode};
use vitrum_geometry::Shape;
use vitrum_materials::{Material, Medium, Texture};
use vitrum_math::Rgb;

/// What a scene needs; `false` and zero mean that nothing of the kind runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Lights that are asked at each point that can answer them: all of them by ray trees, one of them by paths, which ask
    /// objects that shine too. Without any: no light loop and no shadow rays.
    pub lights: usize,
    /// Objects that shine, among them.
    pub area_lights: usize,
    /// Parts of the environment, among them: its suns, and the rest where it varies.
    pub environment_lights: usize,
    /// Lights that objects block.
    pub shadow_lights: usize,
    /// Ambient light.
    pub ambient: bool,
    /// Glass: refraction, and trees of rays.
    pub dielectrics: bool,
    /// Mirrors.
    pub mirrors: bool,
    /// Something divides light or mirrors it: a path may follow several rays from one hit.
    pub divides: bool,
    /// Media that absorb: a factor for each segment of a ray.
    pub absorption: bool,
    /// How many solids a ray may be in at a time, where some reach into each other: 2 or 8, as there is room for; 0 where every
    /// surface knows what is on both sides of it.
    pub nested_media: usize,
    /// Sheets of glass, which light that is asked for goes through.
    pub thin_sheets: bool,
    /// Glass and metal that scatters into a range of directions.
    pub rough: bool,
    /// Textures that vary.
    pub textures: bool,
    /// Images among them: texture coordinates at hits, and in meshes.
    pub images: bool,
    /// Meshes with interpolated normals.
    pub smooth_normals: bool,
    /// Meshes, each with its own tree.
    pub meshes: usize,
    /// A tree over the objects; without it they are tried one by one.
    pub object_tree: bool,
    /// Random points on a lens.
    pub lens: bool,
    /// Shadow rays go through glass.
    pub straight_shadows: bool,
    /// Objects that were left out because nothing can see them.
    pub invisible: usize,
    /// The largest radiance that can arrive at a point from anywhere, where the scene bounds it: no lights of zero size,
    /// and no surface that returns more than it receives.
    pub radiance_bound: Option<f64>,
}

impl Plan {
    /// Looks at the scene.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        Self::with_lights(scene, settings, &LightSampler::of(scene, settings))
    }

    /// Whether rendering uses a feature: what the hot loop asks.
    // Always, because the feature is a constant wherever it is asked.
    #[inline(always)]
    pub fn needs(&self, feature: Feature) -> bool {
        feature.is_built() && self.wants(feature)
    }

    #[inline(always)]
    fn wants(&self, feature: Feature) -> bool {
        match feature {
            Feature::Lights => self.lights > 0,
            Feature::ShadowRays => self.shadow_lights > 0,
            Feature::AmbientLight => self.ambient,
            Feature::Refraction => self.dielectrics,
            Feature::Absorption => self.absorption,
            Feature::NestedMedia => self.nested_media > 0,
            Feature::ThinSheets => self.thin_sheets,
            Feature::Roughness => self.rough,
            Feature::Mirrors => self.mirrors,
            Feature::Textures => self.textures,
            Feature::Images => self.images,
            Feature::Meshes => self.meshes > 0,
            Feature::SmoothNormals => self.smooth_normals,
            Feature::ObjectTree => self.object_tree,
            Feature::Lens => self.lens,
            Feature::StraightShadows => self.straight_shadows,
        }
    }

    pub(crate) fn with_lights(scene: &Scene, settings: &Settings, sampler: &LightSampler) -> Self {
        let materials = scene.materials();
        let objects = scene.aggregate().objects();
        let rough = materials.iter().any(Material::is_rough);
        let answers =
            rough || materials.iter().filter_map(Material::phong).any(|p| p.kd > 0.0 || p.ks != Rgb::ZERO);
        let is_path = settings.integrator == Integrator::Path;
        let all_lights = if is_path { sampler.len() } else { scene.lights.len() };
        let lights = if answers { all_lights } else { 0 };
        let area_lights = if answers { sampler.areas() } else { 0 };
        let environment_lights = if answers { sampler.parts() } else { 0 };
        let shadow_lights = area_lights
            + environment_lights
            + scene.lights.iter().take(lights).filter(|l| l.casts_shadows()).count();
        let dielectrics = materials.iter().any(Material::is_dielectric);
        let textures = materials.iter().filter_map(Material::texture).any(Texture::varies);
        let meshes = objects.iter().filter_map(|o| match o.shape() {
            Shape::Mesh(mesh) => Some(mesh),
            _ => None,
        });
        let ambient = !is_path
            && scene.ambient != Rgb::ZERO
            && materials.iter().filter_map(Material::phong).any(|p| p.ka > 0.0);
        let absorbs = |medium: Medium| !medium.absorption.is_none();
        let nested_media = match scene.overlaps().depth {
            0 => 0,
            1 | 2 => 2,
            _ => MOST,
        };
        let absorption = absorbs(scene.medium)
            || scene.camera_medium.is_some_and(absorbs)
            || materials.iter().filter_map(Material::media).any(|m| absorbs(m.inside) || absorbs(m.outside));
        let mirrors =
            materials.iter().any(|m| matches!(m, Material::Reflective { .. } | Material::Conductor(_)));
        let thin = materials.iter().any(|m| matches!(m, Material::Thin(_)));
        let needed = Self {
            lights,
            area_lights,
            environment_lights,
            absorption,
            nested_media,
            thin_sheets: is_path && thin,
            rough,
            shadow_lights,
            ambient,
            dielectrics,
            divides: dielectrics || mirrors || thin,
            mirrors,
            textures,
            images: materials.iter().any(|m| m.image().is_some()),
            smooth_normals: meshes.clone().any(|m| m.is_smooth()),
            meshes: meshes.count(),
            object_tree: scene.aggregate().uses_tree(),
            lens: scene.camera.has_lens(),
            straight_shadows: !is_path
                && settings.shadow == ShadowMode::Straight
                && shadow_lights > 0
                && dielectrics,
            invisible: scene.invisible().len(),
            radiance_bound: (lights == 0 && !ambient && !is_path).then(|| radiance_bound(scene)).flatten(),
        };
        let left_out = Feature::ALL.into_iter().find(|feature| needed.wants(*feature) && !feature.is_built());
        assert!(left_out.is_none(), "this build was made without what the scene needs: {left_out:?}");
        // What is made to run: it changes nothing.
        let no_skip = settings.no_skip;
        Self {
            lights: needed.lights.max(usize::from(no_skip.lights)),
            ambient: needed.ambient || no_skip.ambient && !is_path,
            absorption: needed.absorption || no_skip.absorption,
            nested_media: needed.nested_media.max(if no_skip.nested_media { MOST } else { 0 }),
            thin_sheets: needed.thin_sheets || no_skip.thin_sheets && is_path,
            ..needed
        }
    }
}

/// The brightest background or emission, if no surface amplifies. Weights are free of the radiance factor: they bound the
/// missing radiance only where a ray that was cut off is in no thinner medium than the camera. That is certain for solids
/// that are denser than what surrounds them.
fn radiance_bound(scene: &Scene) -> Option<f64> {
    for (id, object) in (0u32..).zip(scene.aggregate().objects()) {
        for material in scene.materials_of(id) {
            if let Some(interface) = material.interface()
                && (interface.eta() < 1.0 || !object.is_convex_solid() || object.is_flipped())
            {
                return None;
            }
        }
    }
    let mut bound = scene.background.brightest();
    for material in scene.materials() {
        match material {
            Material::Emissive { radiance } => bound = bound.max(radiance.brightest()),
            Material::Transparent(t) if (t.kr + t.kt).max_element() > 1.0 => return None,
            _ => {}
        }
    }
    Some(bound)
}
