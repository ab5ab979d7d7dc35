//! The ray tree: the hot loop.
//!
//! A node is a ray with the weight that its radiance has in the sample. Nodes wait in a tree (`ray_tree.rs`) and are taken depth
//! first. Two ways of following light share all that, and differ in what they do at a hit: see the [`Policy`] of
//! [`Whitted`](crate::whitted::Whitted) and of [`Path`](crate::path::Path).

use crate::feature::Feature;
use crate::filter::FilterSampler;
use crate::light_sampler::LightSampler;
use crate::plan::Plan;
use crate::ray_tree::{Children, Node, RayTree};
use crate::scene::{Medium, Scene};
use crate::settings::{Branching, Settings};
use crate::stats::Stats;
use vitrum_bxdf::{Bxdf, Sample, Split, TransportMode};
use vitrum_geometry::{Query, Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{DVec3, Frame, NodeKey, Purpose, Ray, Rgb, SampleAddress};

/// A way of following light.
pub(crate) trait Policy: Sized {
    /// What a node has to remember beside its ray and its weight.
    type Memory: Copy;

    /// That of the camera ray.
    const ROOT: Self::Memory;

    /// Whether a walker of this policy can do it: what it can't leaves no instruction, not even a question.
    fn can(feature: Feature) -> bool;

    /// What a hit does: returns the radiance that it sends to where the ray came from, apart from what comes along its
    /// children, and puts these into the tree.
    fn hit(
        walker: &mut Walker<'_, Self>,
        node: &Node<Self::Memory>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        address: &SampleAddress,
        children: &mut Children<'_, Self::Memory>,
    ) -> Rgb;

    /// What a ray that escapes brings.
    // Always: called from two places, it would no longer be inlined into the loop, which costs up to half a per cent.
    #[inline(always)]
    fn escape(walker: &Walker<'_, Self>, node: &Node<Self::Memory>) -> Rgb {
        walker.scene.background.radiance(node.query.ray.direction)
    }
}

/// One worker's ray trees, the room for one reused from sample to sample.
pub(crate) struct Walker<'s, P: Policy> {
    pub(crate) scene: &'s Scene,
    pub(crate) lights: &'s LightSampler,
    pub(crate) settings: &'s Settings,
    pub(crate) plan: &'s Plan,
    /// Which of the rays that glass divides a path follows.
    pub(crate) branching: Branching,
    /// False where camera rays can't meet any object.
    pub(crate) sees_objects: bool,
    tree: RayTree<P::Memory>,
    pub(crate) stats: Stats,
    /// Nodes of the present sample so far, where paths count them, and what their rays cost beyond one each (see
    /// [`Scene::ray_cost`]).
    pub(crate) nodes: u32,
    pub(crate) dearer: f64,
    /// Weight of the subtrees of the present sample that were not followed.
    pub(crate) given_up: f64,
}

impl<'s, P: Policy> Walker<'s, P> {
    pub(crate) fn new(
        scene: &'s Scene,
        lights: &'s LightSampler,
        settings: &'s Settings,
        plan: &'s Plan,
    ) -> Self {
        let is_enough = Feature::ALL.into_iter().all(|feature| P::can(feature) || !plan.needs(feature));
        assert!(is_enough, "a walker was chosen that cannot do what the scene needs");
        let (tree, stats) = (RayTree::default(), Stats::default());
        let (branching, sees_objects) = (settings.branching, true);
        let (nodes, dearer, given_up) = (0, 0.0, 0.0);
        Self { scene, lights, settings, plan, branching, sees_objects, tree, stats, nodes, dearer, given_up }
    }

    /// Whether rendering uses a feature.
    // Always, because the feature is a constant wherever it is asked.
    #[inline(always)]
    pub(crate) fn needs(&self, feature: Feature) -> bool {
        P::can(feature) && self.plan.needs(feature)
    }

    /// A sample of a pixel as the film takes it, rounded once; `None` when it is not finite or negative.
    pub(crate) fn sample(
        &mut self,
        filter: &FilterSampler,
        [x, y]: [u32; 2],
        address: &SampleAddress,
    ) -> Option<[f32; 3]> {
        let [dx, dy] = filter.sample(address.pair(NodeKey::ROOT, Purpose::Film));
        let lens = || {
            self.stats.uses.count(Feature::Lens);
            address.pair(NodeKey::ROOT, Purpose::Lens)
        };
        let ray = self.scene.camera.ray(f64::from(x) + dx, f64::from(y) + dy, self.settings.size, lens);
        let radiance = self.radiance(ray, address).to_array();
        // No channel above the largest value that counts; what is not finite stays so.
        let most = self.settings.clamp.unwrap_or(f64::INFINITY);
        let rounded = radiance.map(|c| if c > most && c.is_finite() { most as f32 } else { c as f32 });
        rounded.iter().all(|c| c.is_finite() && *c >= 0.0).then_some(rounded)
    }

    /// The radiance that arrives along a camera ray.
    pub(crate) fn radiance(&mut self, ray: Ray, address: &SampleAddress) -> Rgb {
        (self.nodes, self.dearer, self.given_up) = (0, 0.0, 0.0);
        self.stats.camera_rays += 1;
        let mut tree = std::mem::take(&mut self.tree);
        tree.plant(Query::new(ray), P::ROOT);
        let mut radiance = if self.sees_objects { Rgb::ZERO } else { self.unsearched(&mut tree) };
        while let Some((node, mut children)) = tree.next() {
            self.stats.deepest = self.stats.deepest.max(node.depth);

            // The ray escapes, or finds a surface; the medium takes its share of what it brings.
            let Some(hit) = self.scene.aggregate().closest(&node.query, &mut self.stats.geometry) else {
                radiance += self.escaping(node);
                continue;
            };
            let surface = self.scene.aggregate().interaction(&node.query, &hit, &mut self.stats.geometry);
            if self.needs(Feature::Absorption) {
                self.stats.uses.count(Feature::Absorption);
                if node.depth == 0 {
                    // Where the camera stands, the first surface knows.
                    node.medium = self.medium(node, &surface, Side::Incident);
                }
                node.throughput *= self.scene.absorption_of(node.medium).transmittance(hit.t);
            }
            let scattering = self.scene.scattering(&hit, surface.point, &mut self.stats.uses);

            // The surface sends out light of its own, and returns what the lights send to it; light from other surfaces
            // arrives along the children.
            radiance += node.throughput * P::hit(self, node, &surface, &scattering, address, &mut children);
        }
        self.tree = tree;
        radiance
    }

    /// What the first ray of a tree brings, which can't meet anything.
    #[inline(never)]
    fn unsearched(&mut self, tree: &mut RayTree<P::Memory>) -> Rgb {
        self.stats.unsearched_rays += 1;
        tree.next().map_or(Rgb::ZERO, |(node, _)| self.escaping(node))
    }

    /// What a ray brings that meets nothing.
    // Always, because it is half of the loop above.
    #[inline(always)]
    fn escaping(&mut self, node: &Node<P::Memory>) -> Rgb {
        let mut throughput = node.throughput;
        if self.needs(Feature::Absorption) {
            self.stats.uses.count(Feature::Absorption);
            throughput *= self.scene.absorption_of(node.medium).transmittance(f64::INFINITY);
        }
        throughput * P::escape(self, node)
    }

    /// The specular children of a hit, with the frame that their directions are in: around the shading normal, unless that puts
    /// a direction on the wrong side of the surface.
    // Always, because what it returns is large and would be copied.
    #[inline(always)]
    pub(crate) fn split(&mut self, surface: &SurfaceInteraction, body: &Bxdf<f64>) -> (Split<f64>, Frame) {
        match body {
            Bxdf::PerfectSpecular(_) | Bxdf::Conductor(_) => self.stats.uses.count(Feature::Mirrors),
            Bxdf::ThinDielectric(_) => {}
            _ => self.stats.uses.count(Feature::Refraction),
        }
        let normal = shading_normal(surface);
        let frame = Frame::around(normal);
        let split = body.split(frame.to_local(surface.wo), TransportMode::Radiance);
        let agrees = |child: &Sample<f64>| surface.side_of(frame.to_world(child.wi)) == side(child);
        let children = || [&split.reflected, &split.transmitted].into_iter().flatten();
        if surface.ns == surface.ng || normal == surface.ns && children().all(agrees) {
            return (split, frame);
        }
        self.stats.normal_fallbacks += 1;
        let frame = Frame::around(surface.ng);
        (body.split(frame.to_local(surface.wo), TransportMode::Radiance), frame)
    }

    /// What a ray goes through that leaves the surface to a side: what the surface says, or what the ray came through.
    #[inline]
    pub(crate) fn medium(&self, node: &Node<P::Memory>, surface: &SurfaceInteraction, side: Side) -> Medium {
        if !self.needs(Feature::Absorption) {
            return node.medium;
        }
        let inside = surface.front == (side == Side::Transmitted);
        self.scene.medium_beside(surface.object, surface.face, inside).unwrap_or(node.medium)
    }
}

/// The side of the surface that a child goes to.
#[inline]
pub(crate) fn side(child: &Sample<f64>) -> Side {
    if child.lobe.is_transmission() { Side::Transmitted } else { Side::Incident }
}

/// The interpolated normal, unless the viewer is behind it.
#[inline]
pub(crate) fn shading_normal(surface: &SurfaceInteraction) -> DVec3 {
    if (surface.wo.dot(surface.ns) >= 0.0) == surface.front { surface.ns } else { surface.ng }
}
