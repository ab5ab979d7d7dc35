//! What a path does at a hit: it asks one light, and goes on along one direction, or several.
//!
//! Light is found in two ways: by asking for it (surfaces that scatter into a range of directions), and by meeting it. What
//! both can find is weighted by the balance heuristic (E. Veach and L. Guibas, Optimally Combining Sampling Techniques for
//! Monte Carlo Rendering, 1995); what only one can find counts in full: behind smooth glass and mirrors light is only met.
//! Thin sheets of glass change no direction, so both ways lead through them.
//!
//! Every estimate is unbiased: paths end by roulette, in proportion to their weight without the radiance factor, and not at
//! a depth, unless one is set.

use crate::environment_sampler::Asked;
use crate::feature::{Feature, Uses};
use crate::light_sampler::{Chosen, Source, emitted};
use crate::media_list::MediaList;
use crate::overlaps::MOST;
use crate::ray_tree::Node;
use crate::settings::{Branching, LightSampling};
use crate::walker::{ChildrenOf, NodeOf, Policy, Walker, shading_normal, side};
use crate::whereabouts::Whereabouts;
use std::marker::PhantomData;
use vitrum_bxdf::{Bxdf, Density, Sample, TransportMode};
use vitrum_geometry::{Hit, Query, Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{DVec3, Frame, NodeKey, Purpose, Rgb, SampleAddress};

/// Weight below which a path may end: one of less weight goes on with the probability weight/threshold, and then has this
/// weight. Measured with each branching at 0.01, 0.05 and 0.2: less gains nothing, more costs up to 29 % of the efficiency.
const THRESHOLD: f64 = 0.05;

/// Beyond this depth, with so many nodes waiting, and beyond so many nodes of one sample, a node is followed only this often:
/// light that is caught in glass by total reflection would never end. It is less than a third, and a hit has three children at
/// most, so that every tree ends.
const GUARD_DEPTH: u32 = 256;
const GUARD_WAITING: usize = 64;
const GUARD_NODES: u32 = 4096;
const GUARDED_SURVIVAL: f64 = 0.25;

/// What light is asked for ends this share of its distance short of it, so that its own surface is not in the way.
const SHORT: f64 = 1e-9;

/// Random paths, whose rays remember `W` of media.
pub(crate) struct Path<W, const THIN_SHEETS: bool>(PhantomData<W>);

/// Random paths in any scene.
pub(crate) type AnyPath = Path<MediaList<MOST>, true>;

/// What a node of a path remembers.
#[derive(Clone, Copy)]
pub(crate) struct Trace {
    /// Its place in the tree, which its random numbers depend on.
    key: NodeKey,
    /// How its direction was chosen, where light in that direction could have been asked for.
    chance: Option<Chance>,
}

/// A direction that was one of many.
#[derive(Clone, Copy)]
struct Chance {
    /// Its density per steradian.
    pdf: f64,
    /// The point that it was chosen at.
    from: DVec3,
}

impl<W: Whereabouts, const THIN_SHEETS: bool> Policy for Path<W, THIN_SHEETS> {
    type Memory = Trace;

    type Media = W;

    const ROOT: Trace = Trace { key: NodeKey::ROOT, chance: None };

    #[inline(always)]
    fn can(feature: Feature) -> bool {
        match feature {
            Feature::Absorption => W::KNOWS_MEDIUM,
            Feature::NestedMedia => W::KNOWS_SOLIDS,
            Feature::ThinSheets => THIN_SHEETS,
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
        address: &SampleAddress,
        children: &mut ChildrenOf<'_, Self>,
    ) -> Rgb {
        let of_back;
        let scattering = if surface.front {
            scattering
        } else {
            of_back = scattering.of_back();
            &of_back
        };
        let light = walker.light(node, surface, scattering, beyond, address);
        walker.children(node, surface, scattering, beyond, address, children);
        light
    }

    #[inline(always)]
    fn escape(walker: &Walker<'_, Self>, node: &NodeOf<Self>) -> Rgb {
        let direction = node.query.ray.direction;
        match walker.lights.environment() {
            Some(environment) if walker.plan.environment_lights > 0 => {
                let (radiance, cell) = environment.map().radiance_and_cell(direction);
                let asked = |from| walker.lights.pdf_of_background(walker.scene, from, cell);
                radiance * walker.share_met(node, asked)
            }
            _ => walker.scene.background.radiance(direction),
        }
    }
}

type PathNode<W> = Node<Trace, W>;

impl<W: Whereabouts, const THIN_SHEETS: bool> Walker<'_, Path<W, THIN_SHEETS>> {
    /// The radiance that a hit sends towards where the ray came from, apart from what comes along its children.
    #[inline]
    fn light(
        &mut self,
        node: &PathNode<W>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        beyond: &W,
        address: &SampleAddress,
    ) -> Rgb {
        let mut light = Rgb::ZERO;
        if surface.front && scattering.emitted != Rgb::ZERO {
            light +=
                scattering.emitted * self.share_met(node, |from| self.lights.pdf(self.scene, from, surface));
        }
        if self.needs(Feature::Lights) && scattering.answers_lights() {
            light += self.ask_a_light(node, surface, scattering, beyond, address);
        }
        light
    }

    /// The weight of light that a path meets, where from the point at which its direction was chosen it could have been asked
    /// for with a density per steradian.
    #[inline]
    fn share_met(&self, node: &PathNode<W>, asked: impl FnOnce(DVec3) -> Option<f64>) -> f64 {
        let Some(Chance { pdf, from }) = node.memory.chance else { return 1.0 };
        match (asked(from), self.settings.light_sampling) {
            (None, _) | (_, LightSampling::Bsdf) => 1.0,
            // What is asked for so rarely that no number is left is met instead.
            (Some(asked), LightSampling::Lights) => f64::from(u8::from(asked == 0.0)),
            (Some(asked), LightSampling::Mis) => pdf / (pdf + asked),
        }
    }

    /// What one light sends by way of the surface, over the density of asking for it.
    #[inline(never)]
    fn ask_a_light(
        &mut self,
        node: &PathNode<W>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        beyond: &W,
        address: &SampleAddress,
    ) -> Rgb {
        self.stats.uses.count(Feature::Lights);
        // What chooses the light finds the point of it, too: so the points of each light are spread evenly.
        let [u, v] = address.pair(node.memory.key, Purpose::Light);
        let Some(Chosen { source, probability, left: u }) = self.lights.choose(self.scene, surface.point, u)
        else {
            return Rgb::ZERO;
        };
        let left_deeper = self.settings.deepest().saturating_sub(node.depth);
        let (towards, distance, arriving, asked) = match source {
            Source::Delta(light) => {
                let light = &self.scene.lights[*light];
                let Some(arrival) = light.arriving_at(surface.point) else { return Rgb::ZERO };
                let distance = if light.casts_shadows() { arrival.distance } else { 0.0 };
                (arrival.towards, distance, arrival.irradiance / probability, None)
            }
            _ if self.settings.light_sampling == LightSampling::Bsdf => return Rgb::ZERO,
            // What no ray could meet any more is not asked for either: the weights of both ways belong together.
            _ if left_deeper == 0 => return Rgb::ZERO,
            Source::Environment(part) => {
                let asked = self.lights.environment().and_then(|all| all.sample(*part, [u, v]));
                let Some(Asked { towards, radiance, pdf }) = asked else { return Rgb::ZERO };
                (towards, f64::INFINITY, radiance, Some(pdf * probability))
            }
            Source::Area { object, sampler } => {
                let Some(sample) = sampler.sample(surface.point, [u, v]) else { return Rgb::ZERO };
                if sample.towards.dot(sample.ng) >= 0.0 {
                    return Rgb::ZERO;
                }
                let radiance = emitted(self.scene, *object, sample.face, sample.point);
                (sample.towards, sample.distance * (1.0 - SHORT), radiance, Some(sample.pdf * probability))
            }
        };
        let frame = Frame::around(shading_normal(surface));
        let (wo, wi) = (frame.to_local(surface.wo), frame.to_local(towards));
        let side = surface.side_of(towards);
        // An interpolated normal must not let light through the surface.
        if ((wi.z >= 0.0) == (wo.z >= 0.0)) != (side == Side::Incident) {
            return Rgb::ZERO;
        }
        let scattered = scattering.eval(wo, wi, TransportMode::Radiance) * arriving;
        let scattered = match asked {
            None => scattered,
            Some(asked) if self.settings.light_sampling == LightSampling::Lights => scattered / asked,
            Some(asked) => scattered / (asked + scattering.pdf(wo, wi)),
        };
        if scattered.max_element() <= 0.0 {
            return Rgb::ZERO;
        }
        let sheets = if asked.is_some() { left_deeper - 1 } else { u32::MAX };
        scattered * self.unblocked(node, surface, beyond, side, towards, distance, sheets)
    }

    /// The share of the light that comes through from a distance: nothing through objects, but for so many thin sheets; less
    /// through a medium that absorbs.
    #[expect(clippy::too_many_arguments, reason = "a hit, a direction, and what is in between")]
    fn unblocked(
        &mut self,
        node: &PathNode<W>,
        surface: &SurfaceInteraction,
        beyond: &W,
        side: Side,
        towards: DVec3,
        distance: f64,
        mut sheets: u32,
    ) -> Rgb {
        if distance == 0.0 {
            return Rgb::ONE;
        }
        self.stats.shadow_rays += 1;
        let mut query = surface.leave(towards, side);
        let mut media = self.media(node, surface, side, beyond);
        let nested = self.nested();
        let mut share = if self.needs(Feature::Absorption) {
            self.stats.uses.count(Feature::Absorption);
            self.media.absorption_of(media.medium(&nested)).transmittance(distance)
        } else {
            Rgb::ONE
        };
        if !self.needs(Feature::ThinSheets) && !self.knows_solids() {
            let blocked = self.scene.aggregate().occluded(&query, distance, &mut self.stats.geometry);
            return if blocked { Rgb::ZERO } else { share };
        }
        while let Some((hit, sheet)) = self.in_the_way(&mut media, &mut query, distance) {
            let scattering = self.scene.scattering(&hit, sheet.point, &mut self.stats.uses);
            let through = match scattering.specular() {
                Some(thin @ Bxdf::ThinDielectric(_)) => {
                    self.stats.uses.count(Feature::ThinSheets);
                    self.split(&sheet, thin).0.transmitted
                }
                _ => None,
            };
            let (Some(through), true) = (through, sheets > 0) else { return Rgb::ZERO };
            share *= through.weight;
            sheets -= 1;
            query.pass(hit.t, hit.object, hit.face);
        }
        share
    }

    /// The first surface that is there, nearer than a distance.
    fn in_the_way(
        &mut self,
        media: &mut W,
        query: &mut Query,
        distance: f64,
    ) -> Option<(Hit, SurfaceInteraction)> {
        if self.knows_solids() {
            let met = media.meet(&self.nested(), query, distance, &mut self.stats)?;
            return Some((met.hit, met.surface));
        }
        self.stats.uses.count(Feature::ThinSheets);
        let hit = self.scene.aggregate().closest_within(query, distance, &mut self.stats.geometry)?;
        if hit.t >= distance {
            return None;
        }
        Some((hit, self.scene.aggregate().interaction(query, &hit, &mut self.stats.geometry)))
    }

    /// Puts the directions in which a path goes on into the tree.
    #[inline]
    fn children(
        &mut self,
        node: &PathNode<W>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        beyond: &W,
        address: &SampleAddress,
        children: &mut ChildrenOf<'_, Path<W, THIN_SHEETS>>,
    ) {
        let scatters = scattering.answers_lights();
        let choice = || address.first(node.memory.key, Purpose::Choice);
        let Some(body) = scattering.specular() else {
            if scatters
                && let Some(way) =
                    anywhere(&node.memory, surface, scattering, address, choice(), &mut self.stats.uses)
            {
                self.go_on(node, surface, &way, 1.0, beyond, address, children);
            }
            return;
        };
        let (split, frame) = self.split(surface, body);
        let all = match self.branching {
            Branching::One => false,
            Branching::First => node.depth == 0,
            // Which way is best is settled before.
            Branching::Tree | Branching::Auto => true,
        };
        let share = |child: &Option<Sample<f64>>| {
            child.map_or(0.0, |sample| sample.weight.max_element() * (sample.eta * sample.eta))
        };
        let (reflected, transmitted) = (share(&split.reflected), share(&split.transmitted));
        let diffuse = if scatters { scattering.albedo() } else { 0.0 };
        let total = reflected + transmitted + diffuse;
        // Where there is one way, nothing is left to choose.
        let all = all || !scatters && (split.reflected.is_none() || split.transmitted.is_none());
        let at = if all { 0.0 } else { choice() * total };
        // All of them, or one in proportion to its share.
        if let Some(child) = &split.reflected
            && (all || at < reflected)
        {
            let probability = if all { 1.0 } else { reflected / total };
            let way = along(&node.memory, &frame, child, body);
            self.go_on(node, surface, &way, probability, beyond, address, children);
        }
        if let Some(child) = &split.transmitted
            && (all || reflected <= at && at < reflected + transmitted)
        {
            let probability = if all { 1.0 } else { transmitted / total };
            let way = along(&node.memory, &frame, child, body);
            self.go_on(node, surface, &way, probability, beyond, address, children);
        }
        if scatters && (all || reflected + transmitted <= at) {
            let u = if all {
                choice()
            } else {
                ((at - reflected - transmitted) / diffuse).clamp(0.0, 1.0 - f64::EPSILON)
            };
            let probability = if all { 1.0 } else { diffuse / total };
            if let Some(way) = anywhere(&node.memory, surface, scattering, address, u, &mut self.stats.uses) {
                self.go_on(node, surface, &way, probability, beyond, address, children);
            }
        }
    }

    /// On along one way, chosen with a probability, unless roulette or the depth limit ends it.
    #[inline]
    #[expect(clippy::too_many_arguments, reason = "all of them are used once, and none belongs to another")]
    fn go_on(
        &mut self,
        node: &PathNode<W>,
        surface: &SurfaceInteraction,
        way: &Way,
        probability: f64,
        beyond: &W,
        address: &SampleAddress,
        children: &mut ChildrenOf<'_, Path<W, THIN_SHEETS>>,
    ) {
        let mut throughput = node.throughput * way.weight / probability;
        let eta_squared = node.eta_squared * (way.eta * way.eta);
        let depth = node.depth + 1;
        let weight = throughput.max_element() * eta_squared;
        if depth > self.settings.deepest() {
            self.given_up += weight;
            return;
        }
        let mut survival = if weight < THRESHOLD { weight / THRESHOLD } else { 1.0 };
        self.nodes += 1;
        if depth >= GUARD_DEPTH || children.waiting() >= GUARD_WAITING || self.nodes >= GUARD_NODES {
            self.stats.guarded += 1;
            survival *= GUARDED_SURVIVAL;
        }
        if survival < 1.0 {
            // Not less than: what weighs nothing ends.
            if address.second(way.trace.key, Purpose::Choice) >= survival {
                return;
            }
            throughput /= survival;
        }
        match way.side {
            Side::Incident => self.stats.reflected_rays += 1,
            Side::Transmitted => self.stats.transmitted_rays += 1,
        }
        self.dearer += self.scene.ray_cost(surface.object) - 1.0;
        let next = children.push();
        next.query = surface.leave(way.direction, way.side);
        next.throughput = throughput;
        next.eta_squared = eta_squared;
        next.depth = depth;
        next.media = self.media(node, surface, way.side, beyond);
        next.memory = way.trace;
    }
}

/// A way on from a hit.
struct Way {
    /// Unit vector.
    direction: DVec3,
    side: Side,
    weight: Rgb,
    eta: f64,
    trace: Trace,
}

/// Along a specular child.
#[inline]
fn along(trace: &Trace, frame: &Frame, child: &Sample<f64>, body: &Bxdf<f64>) -> Way {
    let side = side(child);
    let key = match side {
        Side::Incident => trace.key.reflected(),
        Side::Transmitted => trace.key.transmitted(),
    };
    // Straight through a sheet, light could still have been asked for.
    let straight = side == Side::Transmitted && matches!(body, Bxdf::ThinDielectric(_));
    let chance = if straight { trace.chance } else { None };
    let trace = Trace { key, chance };
    Way { direction: in_world(frame, child), side, weight: child.weight, eta: child.eta, trace }
}

/// In a direction of the parts that have a density; `None` where they absorb, or an interpolated normal misleads.
#[inline]
fn anywhere(
    trace: &Trace,
    surface: &SurfaceInteraction,
    scattering: &Scattering,
    address: &SampleAddress,
    uc: f64,
    uses: &mut Uses,
) -> Option<Way> {
    if scattering.rough().is_some() {
        uses.count(Feature::Roughness);
    }
    let frame = Frame::around(shading_normal(surface));
    let u = address.pair(trace.key, Purpose::Direction);
    let child = scattering.sample(frame.to_local(surface.wo), uc, u, TransportMode::Radiance)?;
    let (direction, side) = (in_world(&frame, &child), side(&child));
    if surface.side_of(direction) != side {
        return None;
    }
    let Density::SolidAngle(pdf) = child.pdf else { unreachable!("it has a density") };
    let chance = Some(Chance { pdf, from: surface.point });
    let trace = Trace { key: trace.key.scattered(), chance };
    Some(Way { direction, side, weight: child.weight, eta: child.eta, trace })
}

/// The direction of a child.
#[inline]
fn in_world(frame: &Frame, child: &Sample<f64>) -> DVec3 {
    let direction = frame.to_world(child.wi);
    // One Newton step towards unit length: without it errors grow along a long chain.
    direction * (1.5 - 0.5 * direction.dot(direction))
}
