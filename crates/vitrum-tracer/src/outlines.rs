//! Where on the film objects may be seen: a pixel outside all outlines shows the background alone, and searches nothing.
//!
//! The outline of an object is the rectangle around the image of its bounds, that of a plane everything on its side of the
//! horizon. Both are asked pixel by pixel, with all that the filter reaches. In doubt an object is everywhere: a lens blurs outlines,
//! so there they have none.

use crate::camera::Projection;
use crate::scene::Scene;
use crate::settings::Settings;
use vitrum_geometry::{Object, Shape};
use vitrum_math::{Bounds, DVec3};

/// So many objects have outlines of their own; of more, those with bounds have one together.
const MOST: usize = 16;

/// Bounds are widened by this share of their extent, and of how far they and the camera are from the origin: more than the
/// roundings of what is traced, which is single precision in the frame of a mesh. (A shape that lies 1e9 times its own size from the
/// origin of its own frame has larger ones, and no reliable picture anyway.)
const WIDENED: (f64, f64) = (1e-6, 1e-13);

/// The outlines of a scene.
pub(crate) struct Outlines {
    /// How far the filter reaches from the middle of a pixel, pixels.
    reach: f64,
    outlines: Vec<Outline>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Outline {
    /// From and to, in pixels.
    Rectangle { x: [f64; 2], y: [f64; 2] },
    /// Where a + b x + c y is at most 0.
    Side { a: f64, b: f64, c: f64 },
}

impl Outline {
    const EVERYWHERE: Self =
        Self::Rectangle { x: [f64::NEG_INFINITY, f64::INFINITY], y: [f64::NEG_INFINITY, f64::INFINITY] };
}

impl Outlines {
    pub(crate) fn new(scene: &Scene, settings: &Settings) -> Self {
        let is_blurred = scene.camera.has_lens() || !scene.camera.is_square();
        let outlines = if is_blurred || settings.no_skip.outlines {
            vec![Outline::EVERYWHERE]
        } else {
            outlines(scene, settings.size)
        };
        Self { reach: settings.filter.reach(), outlines }
    }

    /// False where a pixel certainly shows the background alone.
    pub(crate) fn may_reach(&self, [x, y]: [u32; 2]) -> bool {
        let [x, y] = [x, y].map(|at| f64::from(at) + 0.5);
        let overlaps = |[from, to]: [f64; 2], at: f64| from <= at + self.reach && at - self.reach <= to;
        self.outlines.iter().any(|outline| match outline {
            Outline::Rectangle { x: xs, y: ys } => overlaps(*xs, x) && overlaps(*ys, y),
            Outline::Side { a, b, c } => a + b * x + c * y <= (b.abs() + c.abs()) * self.reach,
        })
    }
}

/// How many pixels of the image show the background alone, and are not searched.
pub fn background_pixels(scene: &Scene, settings: &Settings) -> u64 {
    let (outlines, [width, height]) = (Outlines::new(scene, settings), settings.size);
    let row = |y| (0..width).filter(|x| !outlines.may_reach([*x, y])).count() as u64;
    (0..height).map(row).sum()
}

fn outlines(scene: &Scene, size: [u32; 2]) -> Vec<Outline> {
    let objects = scene.aggregate().objects();
    let infinite = objects.iter().filter(|object| object.bounds().is_none());
    let sides = infinite.map(|object| match object.shape() {
        Shape::Plane(plane) => side(scene, size, plane.point(), plane.normal()),
        _ => Outline::EVERYWHERE,
    });
    let bounds = if objects.len() <= MOST {
        objects.iter().filter_map(Object::bounds).collect()
    } else {
        vec![scene.aggregate().bounds()]
    };
    let bounded = bounds.iter().filter(|bounds| !bounds.is_empty());
    sides.chain(bounded.filter_map(|bounds| rectangle(scene, size, bounds))).collect()
}

/// The rectangle around the image of a box; none where it is behind the camera.
fn rectangle(scene: &Scene, size: [u32; 2], bounds: &Bounds) -> Option<Outline> {
    let eye = scene.camera.position();
    let farthest = bounds.min.abs().max(bounds.max.abs()).max(eye.abs()).max_element();
    let bounds = bounds.padded(WIDENED.0 * bounds.extent().max_element() + WIDENED.1 * farthest);
    let corners = bounds.corners().map(|corner| scene.camera.on_film(corner - eye, size));
    if !corners.as_flattened().iter().all(|number| number.is_finite()) {
        return Some(Outline::EVERYWHERE);
    }
    let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut widen = |axis: usize, at: f64| {
        let [from, to] = &mut found[axis];
        (*from, *to) = (from.min(at), to.max(at));
    };
    for (place, [x, y, depth]) in corners.iter().enumerate() {
        if *depth <= 0.0 {
            continue;
        }
        widen(0, x / depth);
        widen(1, y / depth);
        // Along edges that go on behind the camera the image runs to infinity, to one side of the film or the other.
        for [x_behind, y_behind, behind] in [1, 2, 4].map(|bit| corners[place ^ bit]) {
            if behind > 0.0 {
                continue;
            }
            let share = depth / (depth - behind);
            for (axis, at, then) in [(0, x, x_behind), (1, y, y_behind)] {
                let crossing = at + (then - at) * share;
                let doubt = 1e-9 * (at.abs() + then.abs());
                if crossing >= -doubt {
                    widen(axis, f64::INFINITY);
                }
                if crossing <= doubt {
                    widen(axis, f64::NEG_INFINITY);
                }
            }
        }
    }
    let [x, y] = found;
    (x[0] <= x[1]).then_some(Outline::Rectangle { x, y })
}

/// The side of the horizon on which a plane is seen.
fn side(scene: &Scene, size: [u32; 2], point: DVec3, normal: DVec3) -> Outline {
    let (eye, towards) = (scene.camera.position(), |x, y| scene.camera.towards(x, y, size));
    let height = normal.dot(eye - point);
    let is_apart = height.abs() > WIDENED.1 * (eye.abs().max_element() + point.abs().max_element());
    if !is_apart || !matches!(scene.camera.projection(), Projection::Pinhole { .. }) {
        return Outline::EVERYWHERE;
    }
    // Rays come nearer where their direction has a part against the height; it is linear over the film.
    let normal = normal * height.signum();
    let [a, right, below] = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| normal.dot(towards(x, y)));
    // These numbers are of order 1 and rounded; over the film, what they differ by is multiplied.
    let [width, height] = size.map(f64::from);
    let roundings = 1e-14 * (1.0 + a.abs()) * (1.0 + width + height);
    Outline::Side { a: a - roundings, b: right - a, c: below - a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::filter::Filter;
    use crate::scene::SceneObject;
    use crate::settings::NoSkip;
    use vitrum_geometry::shape::{Cuboid, Cylinder, Disk, Plane, Rectangle, Sphere};
    use vitrum_geometry::{Counters, Object, Query};
    use vitrum_materials::{Material, Texture};
    use vitrum_math::{Rgb, Transform, unit};

    const SIZE: [u32; 2] = [40, 30];

    fn scene(shapes: Vec<Shape>, camera: Camera) -> Scene {
        placed(shapes, &Transform::IDENTITY, camera)
    }

    /// With the same transform for every shape.
    fn placed(shapes: Vec<Shape>, transform: &Transform, camera: Camera) -> Scene {
        let object = |(place, shape): (usize, Shape)| SceneObject {
            name: place.to_string(),
            object: Object::new(shape, transform, false).expect("valid"),
            materials: vec![Material::Emissive { radiance: Texture::Constant(Rgb::ONE) }],
        };
        Scene::new(shapes.into_iter().enumerate().map(object).collect(), camera).expect("valid")
    }

    fn looking(from: DVec3, to: DVec3, projection: Projection) -> Camera {
        Camera::new(from, to, DVec3::Y, projection).expect("valid")
    }

    fn settings(filter: Filter) -> Settings {
        Settings { size: SIZE, filter, ..Settings::default() }
    }

    /// Numbers from 0 to 1, the same each time.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    /// The image of a box before the camera, by similar triangles: 90 degrees over 30 pixels of height, and its nearer face at a distance
    /// of 2 is from -1 to 1.
    #[test]
    fn a_box_has_the_outline_of_its_nearer_face() {
        let shape = Cuboid::new(DVec3::new(-1.0, -1.0, -3.0), DVec3::new(1.0, 1.0, -2.0)).expect("valid");
        let pinhole = Projection::Pinhole { fov: std::f64::consts::FRAC_PI_2 };
        let scene = scene(vec![Shape::Cuboid(shape)], looking(DVec3::ZERO, -DVec3::Z, pinhole));
        let bounds = scene.aggregate().bounds();
        let Some(Outline::Rectangle { x, y }) = rectangle(&scene, SIZE, &bounds) else {
            panic!("it is seen")
        };
        for (found, expected) in [(x[0], 12.5), (x[1], 27.5), (y[0], 7.5), (y[1], 22.5)] {
            assert!((found - expected).abs() < 1e-4, "{found} in the place of {expected}");
        }
        assert_eq!(background_pixels(&scene, &settings(Filter::Box)), 40 * 30 - 16 * 16);
        assert_eq!(background_pixels(&scene, &settings(Filter::BlackmanHarris)), 40 * 30 - 18 * 18);
        let searched = Settings { no_skip: NoSkip::ALL, ..settings(Filter::Box) };
        assert_eq!(background_pixels(&scene, &searched), 0);
    }

    /// A floor fills the picture up to the horizon, seen from above or from below.
    #[test]
    fn a_floor_ends_at_the_horizon() {
        for height in [1.0, -1.0] {
            let floor = Plane::new(DVec3::ZERO, DVec3::Y).expect("valid");
            let eye = DVec3::Y * height;
            let camera = looking(eye, eye - DVec3::Z, Projection::Pinhole { fov: 1.0 });
            let scene = scene(vec![Shape::Plane(floor)], camera);
            let outlines = Outlines::new(&scene, &settings(Filter::Box));
            let rows: Vec<bool> = (0..30).map(|y| outlines.may_reach([7, y])).collect();
            // The row whose edge is the horizon counts, for rounding may lead across it.
            let expected: Vec<bool> = (0..30).map(|y| if height > 0.0 { y >= 14 } else { y <= 15 }).collect();
            assert_eq!(rows, expected, "from {height}");
        }
    }

    /// No ray of any pixel that is left out meets anything, wherever camera and objects are; and much is left out.
    #[test]
    fn nothing_is_seen_outside_outlines() {
        let mut random = numbers();
        let mut left_out = 0;
        for turn in 0..400 {
            let mut point = || DVec3::new(random(), random(), random()) * 6.0 - DVec3::splat(3.0);
            let (eye, target, a, b, c, d, e) =
                (point(), point(), point(), point(), point(), point(), point());
            let mut shapes = vec![
                Shape::Sphere(Sphere::new(a, 0.3 + 0.4 * random()).expect("valid")),
                Shape::Cuboid(Cuboid::new(b.min(c), b.min(c) + (b - c).abs() * 0.2).expect("valid")),
                Shape::Rectangle(Rectangle::new(d, DVec3::X, DVec3::new(0.0, 0.3, 1.0)).expect("valid")),
                Shape::Disk(Disk::new(e, d - e, 0.4).expect("valid")),
                Shape::Cylinder(Cylinder::new(c, b, 0.1, turn % 2 == 0).expect("valid")),
            ];
            if turn % 3 == 0 {
                shapes.push(Shape::Plane(Plane::new(e, (a - e) + DVec3::splat(0.1)).expect("valid")));
            }
            if turn % 7 == 0 {
                // Too many for an outline each.
                let small = |i: usize| Sphere::new(a + DVec3::X * (0.1 * i as f64), 0.05).expect("valid");
                shapes.extend((0..20).map(|i| Shape::Sphere(small(i))));
            }
            let projection = match turn % 5 {
                0 => Projection::Orthographic { height: 1.0 + 4.0 * random() },
                1 => Projection::Pinhole { fov: 0.001 + 0.1 * random() },
                _ => Projection::Pinhole { fov: 0.1 + 2.9 * random() },
            };
            let stretched = Transform::scale(DVec3::new(0.5, 1.5, 1.0)).expect("valid");
            let turned = stretched.then(&Transform::rotate(unit(b), 1.0)).expect("valid");
            let transform = if turn % 2 == 0 { Transform::IDENTITY } else { turned };
            let scene = placed(shapes, &transform, looking(eye, target, projection));
            let filter = [Filter::Box, Filter::Tent, Filter::BlackmanHarris][turn / 3 % 3];
            let outlines = Outlines::new(&scene, &settings(filter));
            for pixel in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])) {
                if outlines.may_reach(pixel) {
                    continue;
                }
                left_out += 1;
                // The corners of what the filter reaches, and a point of it.
                let within = [random(), random()];
                for share in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], within] {
                    let at = |axis: usize| {
                        f64::from(pixel[axis]) + 0.5 + (2.0 * share[axis] - 1.0) * filter.reach()
                    };
                    let ray = scene.camera.ray(at(0), at(1), SIZE, || unreachable!("no lens"));
                    let hit = scene.aggregate().closest(&Query::new(ray), &mut Counters::default());
                    assert_eq!(hit, None, "turn {turn}, pixel {pixel:?}");
                }
            }
        }
        assert!(left_out > 400 * 40 * 30 / 4, "{left_out} pixels");
    }

    /// Planes alone have no bounds together; what is too large for numbers is everywhere.
    #[test]
    fn in_doubt_objects_are_everywhere() {
        let pinhole = Projection::Pinhole { fov: 1.0 };
        let plane = |i: i32| Plane::new(DVec3::Y * -f64::from(i), DVec3::Y).expect("valid");
        let planes = (1..=20).map(|i| Shape::Plane(plane(i))).collect();
        let level = looking(DVec3::ZERO, -DVec3::Z, pinhole);
        assert_eq!(background_pixels(&scene(planes, level), &settings(Filter::Box)), 40 * 14);
        let huge = Cuboid::new(DVec3::splat(-1e308), DVec3::splat(1e308)).expect("valid");
        assert_eq!(background_pixels(&scene(vec![Shape::Cuboid(huge)], level), &settings(Filter::Box)), 0);
        // The picture's upright is noise along the view.
        let up = DVec3::new(0.0, 1e-9, -1.0);
        let skewed = Camera::new(DVec3::ZERO, -DVec3::Z, up, pinhole).expect("still has an upright");
        let ball = Shape::Sphere(Sphere::new(DVec3::Z * -5.0, 0.1).expect("valid"));
        let some = background_pixels(&scene(vec![ball.clone()], level), &settings(Filter::Box));
        let none = background_pixels(&scene(vec![ball], skewed), &settings(Filter::Box));
        assert!(some > 0 && (none == 0) != skewed.is_square());
    }

    #[test]
    fn a_lens_leaves_nothing_out() {
        let shape = Shape::Sphere(Sphere::new(DVec3::ZERO, 0.1).expect("valid"));
        let lens = |lens_radius| Projection::ThinLens { fov: 1.0, lens_radius, focus_distance: 3.0 };
        for (radius, some) in [(0.0, true), (0.01, false)] {
            let scene = scene(vec![shape.clone()], looking(DVec3::Z * 3.0, DVec3::ZERO, lens(radius)));
            assert_eq!(background_pixels(&scene, &settings(Filter::Box)) > 0, some);
        }
    }
}
