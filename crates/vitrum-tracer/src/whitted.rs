//! The ray tree as T. Whitted described it (An Improved Illumination Model for Shaded Display, 1980): every light is asked, and
//! both children of a dielectric are followed, each with the material's own coefficient. The tree ends where a coefficient is
//! zero, at the depth limit, and where weights fall below the cut-off. What ends early is counted.

use crate::direct::direct;
use crate::feature::Feature;
use crate::ray_tree::{Children, Node};
use crate::walker::{Policy, Walker, shading_normal, side};
use vitrum_bxdf::Sample;
use vitrum_geometry::{Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{Frame, Rgb, SampleAddress};

/// The whole ray tree.
pub(crate) struct Whitted<const ABSORPTION: bool>;

impl<const ABSORPTION: bool> Policy for Whitted<ABSORPTION> {
    type Memory = ();

    const ROOT: () = ();

    #[inline(always)]
    fn can(feature: Feature) -> bool {
        match feature {
            Feature::Absorption => ABSORPTION,
            _ => true,
        }
    }

    #[inline]
    fn hit(
        walker: &mut Walker<'_, Self>,
        node: &Node<()>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        _: &SampleAddress,
        children: &mut Children<'_, ()>,
    ) -> Rgb {
        let local = walker.local_light(node, surface, scattering);
        if let Some(body) = scattering.specular() {
            let (split, frame) = walker.split(surface, body);
            if let Some(child) = &split.reflected {
                walker.follow(node, surface, &frame, child, children);
            }
            if let Some(child) = &split.transmitted {
                walker.follow(node, surface, &frame, child, children);
            }
        }
        local
    }
}

impl<const ABSORPTION: bool> Walker<'_, Whitted<ABSORPTION>> {
    /// Emission, ambient light, and light from the lights.
    #[inline]
    fn local_light(&mut self, node: &Node<()>, surface: &SurfaceInteraction, scattering: &Scattering) -> Rgb {
        let mut local = Rgb::ZERO;
        if surface.front {
            local += scattering.emitted;
        }
        if self.needs(Feature::AmbientLight) {
            self.stats.uses.count(Feature::AmbientLight);
            local += scattering.ambient * self.scene.ambient;
        }
        if self.needs(Feature::Lights) && scattering.answers_lights() {
            self.stats.uses.count(Feature::Lights);
            let normal = shading_normal(surface);
            let medium = self.needs(Feature::Absorption).then(|| self.medium(node, surface, Side::Incident));
            let medium = medium.map(|medium| *self.scene.absorption_of(medium));
            let (scene, shadow) = (self.scene, self.settings.shadow);
            local += direct(scene, shadow, medium, surface, normal, scattering, &mut self.stats);
        }
        local
    }

    /// Puts a child into the tree, unless it is too deep or too faint.
    #[inline]
    fn follow(
        &mut self,
        parent: &Node<()>,
        surface: &SurfaceInteraction,
        frame: &Frame,
        child: &Sample<f64>,
        children: &mut Children<'_, ()>,
    ) {
        let throughput = parent.throughput * child.weight;
        let eta_squared = parent.eta_squared * (child.eta * child.eta);
        let weight = throughput.max_element() * eta_squared;
        let depth = parent.depth + 1;
        if depth > self.settings.deepest() || weight < self.settings.cutoff {
            self.given_up += weight;
            return;
        }
        let side = side(child);
        match side {
            Side::Incident => self.stats.reflected_rays += 1,
            Side::Transmitted => self.stats.transmitted_rays += 1,
        }
        let direction = frame.to_world(child.wi);
        // One Newton step towards unit length: without it errors grow along a long chain.
        let direction = direction * (1.5 - 0.5 * direction.dot(direction));
        let next = children.push();
        next.query = surface.leave(direction, side);
        next.throughput = throughput;
        next.eta_squared = eta_squared;
        next.depth = depth;
        next.medium = self.medium(parent, surface, side);
    }
}
