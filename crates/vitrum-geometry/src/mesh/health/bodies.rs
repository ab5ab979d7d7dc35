//! Bodies: the faces connected through edges, and how their windings relate.
//!
//! One union-find over faces answers both. Each face remembers whether its winding agrees with that of its
//! parent, so that along any path of edges the agreement of two faces is known; a cycle that contradicts
//! itself is a surface without two sides.

use glam::DVec3;

use super::{Component, nesting, surface::Surface};

/// The bodies of a surface.
pub(super) struct Bodies {
    /// The body of each face; `None` for a face without edges.
    pub(super) of_face: Vec<Option<usize>>,
    /// Whether a face's winding contradicts that of its body's lowest face; for closed, orientable bodies.
    pub(super) turned: Vec<bool>,
    pub(super) components: Vec<Component>,
    /// For each body the closed bodies that it lies inside, ascending.
    pub(super) containers: Vec<Vec<usize>>,
}

impl Bodies {
    pub(super) fn new(surface: &Surface<'_>) -> Self {
        let mut union = Windings::new(surface.kinds.len());
        for edge in surface.edges() {
            for pair in edge.windows(2) {
                // Only an edge of two faces says how they should run.
                let turned = edge.len() == 2 && pair[0].forward == pair[1].forward;
                union.join(pair[0].face, pair[1].face, turned, edge.len() == 2);
            }
        }

        let count = surface.kinds.len();
        let mut bodies = Self {
            of_face: vec![None; count],
            turned: vec![false; count],
            components: Vec::new(),
            containers: Vec::new(),
        };
        for (face, kind) in (0..).zip(&surface.kinds) {
            if !kind.has_edges() {
                continue;
            }
            // The root of a set is its lowest face, so it is met first and has its body by now.
            let (root, turned) = union.find(face);
            let (face, root) = (face as usize, root as usize);
            if root == face {
                bodies.of_face[face] = Some(bodies.components.len());
                bodies.components.push(Component {
                    triangles: 0,
                    first: surface.place(face),
                    bounds: (DVec3::INFINITY, DVec3::NEG_INFINITY),
                    closed: true,
                    oriented: true,
                    orientable: !union.contradicts[root],
                    volume: 0.0,
                    depth: 0,
                });
            }
            bodies.of_face[face] = bodies.of_face[root];
            bodies.turned[face] = turned;
            let body = bodies.body_mut(face);
            body.triangles += 1;
            for point in surface.points(face) {
                body.bounds = (body.bounds.0.min(point), body.bounds.1.max(point));
            }
        }
        for edge in surface.edges() {
            let body = bodies.body_mut(edge[0].face as usize);
            body.closed &= edge.len() == 2;
            body.oriented &= edge.len() != 2 || edge[0].forward != edge[1].forward;
        }
        for face in 0..count {
            if let Some(index) = bodies.of_face[face] {
                let volume = signed_volume(surface.points(face), bodies.components[index].centre());
                bodies.components[index].volume += volume;
            }
        }
        for body in &mut bodies.components {
            // What the sum can have lost: a product of three lengths for each face. A sheet's two sides
            // cancel to that.
            let (low, high) = body.bounds;
            let size = (high - low).length();
            let rounding = body.triangles as f64 * f64::EPSILON * (size * size * size);
            if body.volume.abs() <= rounding {
                body.volume = 0.0;
            }
        }
        bodies.containers = nesting::containers(surface, &bodies);
        for (body, containers) in bodies.components.iter_mut().zip(&bodies.containers) {
            body.depth = containers.len();
        }
        bodies
    }

    /// The faces of every body, ascending.
    pub(super) fn faces(&self) -> Vec<Vec<usize>> {
        let mut faces = vec![Vec::new(); self.components.len()];
        for (face, body) in self.of_face.iter().enumerate() {
            if let Some(body) = *body {
                faces[body].push(face);
            }
        }
        faces
    }

    fn body_mut(&mut self, face: usize) -> &mut Component {
        let body = self.of_face[face].expect("a face with edges has a body");
        &mut self.components[body]
    }
}

impl Component {
    pub(super) fn centre(&self) -> DVec3 {
        self.bounds.0 * 0.5 + self.bounds.1 * 0.5
    }
}

/// Volume of the tetrahedron between a face and a point: positive where the face turns its back to it.
pub(super) fn signed_volume([a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    (a - point).dot((b - point).cross(c - point)) / 6.0
}

/// Union-find with a bit of relation (Tarjan 1975, path halving); the root of a set is its lowest face.
struct Windings {
    parent: Vec<u32>,
    /// Whether the winding contradicts the parent's.
    turned: Vec<bool>,
    /// At a root: some cycle of the set turns a face against itself.
    contradicts: Vec<bool>,
}

impl Windings {
    fn new(count: usize) -> Self {
        let parent = (0..).take(count).collect();
        Self { parent, turned: vec![false; count], contradicts: vec![false; count] }
    }

    /// The root of a face's set, and whether the face's winding contradicts the root's.
    fn find(&mut self, face: u32) -> (u32, bool) {
        let mut at = face as usize;
        let mut turned = false;
        while self.parent[at] as usize != at {
            let parent = self.parent[at] as usize;
            self.turned[at] ^= self.turned[parent];
            self.parent[at] = self.parent[parent];
            turned ^= self.turned[at];
            at = self.parent[at] as usize;
        }
        (self.parent[at], turned)
    }

    /// Joins the sets of two faces. `binding`: `turned` is a fact about the two; if not, it is only a
    /// default.
    fn join(&mut self, a: u32, b: u32, turned: bool, binding: bool) {
        let ((root_a, turned_a), (root_b, turned_b)) = (self.find(a), self.find(b));
        let relation = turned ^ turned_a ^ turned_b;
        let (low, high) = (root_a.min(root_b) as usize, root_a.max(root_b) as usize);
        if low == high {
            self.contradicts[low] |= binding && relation;
        } else {
            self.parent[high] = root_a.min(root_b);
            self.turned[high] = relation;
            self.contradicts[low] |= self.contradicts[high];
        }
    }
}
