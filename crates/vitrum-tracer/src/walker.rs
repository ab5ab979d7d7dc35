//! The ray tree: the hot loop.
//!
//! A node is a ray with the weight that its radiance has in the sample. Nodes wait in a tree (`ray_tree.rs`) and are taken depth
//! first. Two ways of following light share all that, and differ in what they do at a hit: see the [`Policy`] of
//! [`Whitted`](crate::whitted::Whitted) and of [`Path`](crate::path::Path).

use crate::crossing::Nested;
use crate::feature::Feature;
use crate::filter::FilterSampler;
use crate::light_sampler::LightSampler;
use crate::media::MediaTable;
use crate::overlaps::MOST;
use crate::plan::Plan;
use crate::ray_tree::{Children, Node, RayTree};
use crate::render::Setup;
use crate::scene::Scene;
use crate::settings::{Branching, Settings};
use crate::stats::Stats;
use crate::whereabouts::Whereabouts;
use vitrum_bxdf::{Bxdf, Sample, Split, TransportMode};
use vitrum_geometry::{Query, Side, SurfaceInteraction};
use vitrum_materials::{Absorption, Scattering};
use vitrum_math::{DVec3, Frame, NodeKey, Purpose, Ray, Rgb, SampleAddress};

/// A way of following light.
pub(crate) trait Policy: Sized {
    /// What a node has to remember beside its ray and its weight.
    type Memory: Copy;

    /// What a ray remembers of the media that it goes through.
    type Media: Whereabouts;

    /// That of the camera ray.
    const ROOT: Self::Memory;

    /// Whether a walker of this policy can do it: what it can't leaves no instruction, not even a question.
    fn can(feature: Feature) -> bool;

    /// What a hit does: returns the radiance that it sends to where the ray came from, apart from what comes along its
    /// children, and puts these into the tree. `beyond` is what a ray is in that crosses the surface, where solids are known.
    fn hit(
        walker: &mut Walker<'_, Self>,
        node: &NodeOf<Self>,
        surface: &SurfaceInteraction,
        scattering: &Scattering,
        beyond: &Self::Media,
        address: &SampleAddress,
        children: &mut ChildrenOf<'_, Self>,
    ) -> Rgb;

    /// What a ray that escapes brings.
    // Always: called from two places, it would no longer be inlined into the loop, which costs up to half a per cent.
    #[inline(always)]
    fn escape(walker: &Walker<'_, Self>, node: &NodeOf<Self>) -> Rgb {
        walker.scene.background.radiance(node.query.ray.direction)
    }
}

/// A node, and its children, as a policy has them.
pub(crate) type NodeOf<P> = Node<<P as Policy>::Memory, <P as Policy>::Media>;
pub(crate) type ChildrenOf<'t, P> = Children<'t, <P as Policy>::Memory, <P as Policy>::Media>;

/// One worker's ray trees, the room for one reused from sample to sample.
pub(crate) struct Walker<'s, P: Policy> {
    pub(crate) scene: &'s Scene,
    pub(crate) lights: &'s LightSampler,
    pub(crate) settings: &'s Settings,
    pub(crate) plan: &'s Plan,
    pub(crate) media: &'s MediaTable,
    /// Which of the rays that glass divides a path follows.
    pub(crate) branching: Branching,
    /// False where camera rays can't meet any object.
    pub(crate) sees_objects: bool,
    tree: RayTree<P::Memory, P::Media>,
    /// Where a camera ray started last, and what that lies in.
    start: Option<(DVec3, P::Media)>,
    pub(crate) stats: Stats,
    /// Nodes of the present sample so far, where paths count them, and what their rays cost beyond one each (see
    /// [`Scene::ray_cost`]).
    pub(crate) nodes: u32,
    pub(crate) dearer: f64,
    /// Weight of the subtrees of the present sample that were not followed.
    pub(crate) given_up: f64,
}

impl<'s, P: Policy> Walker<'s, P> {
    pub(crate) fn new(Setup { scene, lights, settings, plan, media }: Setup<'s>) -> Self {
        let is_enough = Feature::ALL.into_iter().all(|feature| P::can(feature) || !plan.needs(feature));
        assert!(is_enough, "a walker was chosen that cannot do what the scene needs");
        let (tree, start, stats) = (RayTree::default(), None, Stats::default());
        let (branching, sees_objects) = (settings.branching, true);
        let (nodes, dearer, given_up) = (0, 0.0, 0.0);
        Self {
            scene,
            lights,
            settings,
            plan,
            media,
            branching,
            sees_objects,
            tree,
            start,
            stats,
            nodes,
            dearer,
            given_up,
        }
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
        tree.plant(Query::new(ray), self.around(ray.origin), P::ROOT);
        let mut radiance = if self.sees_objects { Rgb::ZERO } else { self.unsearched(&mut tree) };
        while let Some((node, mut children)) = tree.next() {
            self.stats.deepest = self.stats.deepest.max(node.depth);

            // The ray escapes, or finds a surface, which may be one between solids that reach into each other; the medium takes its
            // share of what it brings. (Written out, because what a function returns would be copied.)
            let (hit, surface, body, beyond);
            if self.knows_solids() {
                let nested = self.nested();
                let met = node.media.meet(&nested, &mut node.query, f64::INFINITY, &mut self.stats);
                let Some(met) = met else {
                    radiance += self.escaping(node);
                    continue;
                };
                (hit, surface, body, beyond) = (met.hit, met.surface, met.body, met.beyond);
            } else {
                let Some(found) = self.scene.aggregate().closest(&node.query, &mut self.stats.geometry)
                else {
                    radiance += self.escaping(node);
                    continue;
                };
                (hit, body, beyond) = (found, None, P::Media::START);
                surface = self.scene.aggregate().interaction(&node.query, &hit, &mut self.stats.geometry);
            }
            // Where the camera stands, an interface that it sees knows.
            if node.depth == 0
                && self.follows_media()
                && let Some(here) = self.nested().said_to_camera(&surface)
            {
                node.media.is_told(&self.nested(), here);
            }
            if self.needs(Feature::Absorption) {
                self.stats.uses.count(Feature::Absorption);
                let medium = self.media.absorption_of(node.media.medium(&self.nested()));
                node.throughput *= medium.transmittance(hit.t);
            }
            let mut scattering = self.scene.scattering(&hit, surface.point, &mut self.stats.uses);
            if P::Media::KNOWS_SOLIDS
                && let Some(body) = body
            {
                scattering = scattering.with_body(body);
            }

            // The surface sends out light of its own, and returns what the lights send to it; light from other surfaces
            // arrives along the children.
            let light = P::hit(self, node, &surface, &scattering, &beyond, address, &mut children);
            radiance += node.throughput * light;
        }
        self.tree = tree;
        radiance
    }

    /// What a camera ray is in that starts at a point.
    #[inline]
    fn around(&mut self, point: DVec3) -> P::Media {
        if !self.follows_media() {
            return P::Media::START;
        }
        match self.start {
            Some((known, media)) if known == point || !self.media.is_at_camera() => media,
            _ => {
                let media = self.found_at(point);
                self.start = Some((point, media));
                media
            }
        }
    }

    /// The same, looked for.
    #[inline(never)]
    fn found_at(&mut self, point: DVec3) -> P::Media {
        if self.knows_solids() {
            P::Media::around(&self.nested(), point, &mut self.stats)
        } else {
            let list = self.nested().around_camera::<MOST>(point, &mut self.stats);
            P::Media::saying(self.nested().medium(&list))
        }
    }

    /// Whether rays know the medium that they are in.
    #[inline(always)]
    fn follows_media(&self) -> bool {
        P::Media::KNOWS_MEDIUM && (self.needs(Feature::Absorption) || self.knows_solids())
    }

    /// Whether rays count the solids that they are in.
    #[inline(always)]
    pub(crate) fn knows_solids(&self) -> bool {
        P::Media::KNOWS_SOLIDS && self.needs(Feature::NestedMedia)
    }

    /// The scene as its media have it.
    #[inline(always)]
    pub(crate) fn nested(&self) -> Nested<'s> {
        Nested { scene: self.scene, table: self.media }
    }

    /// What the first ray of a tree brings, which can't meet anything.
    #[inline(never)]
    fn unsearched(&mut self, tree: &mut RayTree<P::Memory, P::Media>) -> Rgb {
        self.stats.unsearched_rays += 1;
        tree.next().map_or(Rgb::ZERO, |(node, _)| self.escaping(node))
    }

    /// What a ray brings that meets nothing.
    // Always, because it is half of the loop above.
    #[inline(always)]
    fn escaping(&mut self, node: &NodeOf<P>) -> Rgb {
        let mut throughput = node.throughput;
        if self.needs(Feature::Absorption) {
            self.stats.uses.count(Feature::Absorption);
            let medium = self.media.absorption_of(node.media.medium(&self.nested()));
            throughput *= medium.transmittance(f64::INFINITY);
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
        let (split, frame, fell_back) = split(body, surface);
        self.stats.normal_fallbacks += u64::from(fell_back);
        (split, frame)
    }

    /// What a ray goes through that leaves the surface to a side: what it came through, or what is `beyond`; where solids are not
    /// known, what the surface says.
    #[inline]
    pub(crate) fn media(
        &self,
        node: &NodeOf<P>,
        surface: &SurfaceInteraction,
        side: Side,
        beyond: &P::Media,
    ) -> P::Media {
        if self.knows_solids() {
            return if side == Side::Incident { node.media } else { *beyond };
        }
        if !self.needs(Feature::Absorption) {
            return node.media;
        }
        let inside = surface.front == (side == Side::Transmitted);
        self.media.beside(self.scene, surface, inside).map_or(node.media, P::Media::saying)
    }

    /// What is absorbed on the way from a surface to a side.
    #[inline]
    pub(crate) fn absorption(
        &self,
        node: &NodeOf<P>,
        surface: &SurfaceInteraction,
        side: Side,
        beyond: &P::Media,
    ) -> &'s Absorption {
        self.media.absorption_of(self.media(node, surface, side, beyond).medium(&self.nested()))
    }
}

/// The specular children of a hit, the frame of their directions, and whether that is around the geometric normal because the shading
/// normal puts one of them on the wrong side.
// Always, because what it returns is large and would be copied.
#[inline(always)]
pub(crate) fn split(body: &Bxdf<f64>, surface: &SurfaceInteraction) -> (Split<f64>, Frame, bool) {
    let normal = shading_normal(surface);
    let frame = Frame::around(normal);
    let split = body.split(frame.to_local(surface.wo), TransportMode::Radiance);
    let agrees = |child: &Sample<f64>| surface.side_of(frame.to_world(child.wi)) == side(child);
    let children = || [&split.reflected, &split.transmitted].into_iter().flatten();
    if surface.ns == surface.ng || normal == surface.ns && children().all(agrees) {
        return (split, frame, false);
    }
    let frame = Frame::around(surface.ng);
    (body.split(frame.to_local(surface.wo), TransportMode::Radiance), frame, true)
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
