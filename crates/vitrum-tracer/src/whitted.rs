//! The ray tree as T. Whitted described it (An Improved Illumination Model for Shaded Display, 1980): every light is asked, and
//! both children of a dielectric are followed, each with the material's own coefficient. The tree ends where a coefficient is
//! zero, at the depth limit, and where weights fall below the cut-off. What ends early is counted.

use crate::direct::{Way, direct};
use crate::feature::Feature;
use crate::walker::{ChildrenOf, NodeOf, Policy, Walker, shading_normal, side};
use crate::whereabouts::Whereabouts;
use std::marker::PhantomData;
use vitrum_bxdf::Sample;
use vitrum_geometry::{Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{Frame, Rgb, SampleAddress};

/// The whole ray tree, whose rays remember `W` of media.
pub(crate) struct Whitted<W>(PhantomData<W>);

impl<W: Whereabouts> Policy for Whitted<W> {
    type Memory = ();

    type Media = W;

    const ROOT: () = ();

    #[inline(always)]
    fn can(feature: Feature) -> bool {
        match feature {
            Feature::Absorption => W::KNOWS_MEDIUM,
            Feature::NestedMedia => W::KNOWS_SOLIDS,
            _ => true,
        }
    }

    #[inline]
    fn hit(
        walker: &mut Walker<'_, Self>,
        node: &NodeOf<Self>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        beyond: &W,
        _: &SampleAddress,
        children: &mut ChildrenOf<'_, Self>,
    ) -> Rgb {
        let local = walker.local_light(node, surface, scattering);
        if let Some(body) = scattering.specular() {
            let (split, frame) = walker.split(surface, body);
            if let Some(child) = &split.reflected {
                walker.follow(node, surface, &frame, child, beyond, children);
            }
            if let Some(child) = &split.transmitted {
                walker.follow(node, surface, &frame, child, beyond, children);
            }
        }
        local
    }
}

impl<W: Whereabouts> Walker<'_, Whitted<W>> {
    /// Emission, ambient light, and light from the lights.
    #[inline]
    fn local_light(
        &mut self,
        node: &NodeOf<Whitted<W>>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
    ) -> Rgb {
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
            let absorbs = self.needs(Feature::Absorption);
            let medium = absorbs.then(|| *self.absorption(node, surface, Side::Incident, &W::START));
            let from = self.knows_solids().then_some(&node.media);
            let way = Way { nested: self.nested(), shadow: self.settings.shadow, from, medium };
            local += direct(&way, surface, normal, scattering, &mut self.stats);
        }
        local
    }

    /// Puts a child into the tree, unless it is too deep or too faint.
    #[inline]
    fn follow(
        &mut self,
        parent: &NodeOf<Whitted<W>>,
        surface: &SurfaceInteraction,
        frame: &Frame,
        child: &Sample<f64>,
        beyond: &W,
        children: &mut ChildrenOf<'_, Whitted<W>>,
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
        next.media = self.media(parent, surface, side, beyond);
    }
}
