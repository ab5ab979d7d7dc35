//! The ray tree: the hot loop.
//!
//! A node is a ray with the weight that its radiance has in the sample. Nodes wait on an explicit stack and are taken depth
//! first. Both children of a dielectric are followed, each with the material's own coefficient; the tree ends where a
//! coefficient is zero, at the depth limit, and where weights fall below the cut-off. What ends early is counted.

use crate::direct::direct;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::stats::Stats;
use vitrum_bxdf::{Lobe, Sample, Split, TransportMode};
use vitrum_geometry::{Query, Side, SurfaceInteraction};
use vitrum_materials::Scattering;
use vitrum_math::{DVec3, Frame, Ray, Rgb};

/// A ray, and what its radiance counts for.
struct Node {
    query: Query,
    throughput: Rgb,
    /// Product of eta² over the crossings so far: throughput times this is the weight without the radiance factor, by which
    /// subtrees are judged.
    eta_squared: f64,
    depth: u32,
}

/// One worker's ray trees, its stack reused from sample to sample.
pub(crate) struct Walker<'s> {
    scene: &'s Scene,
    settings: &'s Settings,
    plan: &'s Plan,
    stack: Vec<Node>,
    pub(crate) stats: Stats,
    /// Weight of the subtrees of the present sample that were not followed.
    pub(crate) given_up: f64,
}

impl<'s> Walker<'s> {
    pub(crate) fn new(scene: &'s Scene, settings: &'s Settings, plan: &'s Plan) -> Self {
        Self { scene, settings, plan, stack: Vec::new(), stats: Stats::default(), given_up: 0.0 }
    }

    /// The radiance that arrives along a camera ray.
    pub(crate) fn radiance(&mut self, ray: Ray) -> Rgb {
        self.given_up = 0.0;
        self.stats.camera_rays += 1;
        let root = Node { query: Query::new(ray), throughput: Rgb::ONE, eta_squared: 1.0, depth: 0 };
        self.stack.push(root);
        let mut radiance = Rgb::ZERO;
        while let Some(node) = self.stack.pop() {
            self.stats.deepest = self.stats.deepest.max(node.depth);

            // The ray escapes, or finds a surface.
            let Some(hit) = self.scene.aggregate().closest(&node.query, &mut self.stats.geometry) else {
                radiance += node.throughput * self.scene.background.radiance(node.query.ray.direction);
                continue;
            };
            let surface = self.scene.aggregate().interaction(&node.query, &hit);
            let scattering = self.scene.material(hit.object, hit.face).scattering(surface.point);

            // The surface sends out light of its own, and returns what the lights send to it.
            let local = self.local_light(&surface, &scattering);
            radiance += node.throughput * local;

            // Light from other surfaces arrives along the children.
            if scattering.specular.is_some() {
                let (split, frame) = self.split(&surface, &scattering);
                if let Some(child) = &split.reflected {
                    self.follow(&node, &surface, &frame, child);
                }
                if let Some(child) = &split.transmitted {
                    self.follow(&node, &surface, &frame, child);
                }
            }
        }
        radiance
    }

    /// Emission, ambient light, and light from the lights.
    #[inline]
    fn local_light(&mut self, surface: &SurfaceInteraction, scattering: &Scattering) -> Rgb {
        let mut local = Rgb::ZERO;
        if surface.front {
            local += scattering.emitted;
        }
        if self.plan.ambient {
            local += scattering.ambient * self.scene.ambient;
        }
        if self.plan.lights > 0 && scattering.answers_lights() {
            let normal = shading_normal(surface);
            local += direct(self.scene, self.settings.shadow, surface, normal, scattering, &mut self.stats);
        }
        local
    }

    /// The children of a hit, with the frame that their directions are in: around the shading normal, unless that puts a
    /// direction on the wrong side of the surface.
    #[inline]
    fn split(&mut self, surface: &SurfaceInteraction, scattering: &Scattering) -> (Split<f64>, Frame) {
        let around = |normal: DVec3| {
            let frame = Frame::around(normal);
            (scattering.split(frame.to_local(surface.wo), TransportMode::Radiance), frame)
        };
        if surface.ns == surface.ng {
            return around(surface.ng);
        }
        if shading_normal(surface) == surface.ns {
            let (split, frame) = around(surface.ns);
            let agrees = |child: &Sample<f64>| surface.side_of(frame.to_world(child.wi)) == side(child);
            if [&split.reflected, &split.transmitted].into_iter().flatten().all(agrees) {
                return (split, frame);
            }
        }
        self.stats.normal_fallbacks += 1;
        around(surface.ng)
    }

    /// Puts a child on the stack, unless it is too deep or too faint.
    #[inline]
    fn follow(&mut self, parent: &Node, surface: &SurfaceInteraction, frame: &Frame, child: &Sample<f64>) {
        let throughput = parent.throughput * child.weight;
        let eta_squared = parent.eta_squared * (child.eta * child.eta);
        let weight = throughput.max_element() * eta_squared;
        let depth = parent.depth + 1;
        if depth > self.settings.max_depth || weight < self.settings.cutoff {
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
        self.stack.push(Node { query: surface.leave(direction, side), throughput, eta_squared, depth });
    }
}

/// The side of the surface that a child goes to.
#[inline]
fn side(child: &Sample<f64>) -> Side {
    if child.lobe == Lobe::SpecularTransmission { Side::Transmitted } else { Side::Incident }
}

/// The interpolated normal, unless the viewer is behind it.
#[inline]
fn shading_normal(surface: &SurfaceInteraction) -> DVec3 {
    if (surface.wo.dot(surface.ns) >= 0.0) == surface.front { surface.ns } else { surface.ng }
}
