//! 4: a prism, and the line that parts reflection from transmission on its back.

use crate::stage::{described, keep, loaded, picture, set_glass, unanimous};
use vitrum::io::scene::Background;
use vitrum::math::{DVec3, Ray, Rgb};

const INDEX: f64 = 1.5;

/// Where a ray that enters the front of the prism gets to at its first meeting with the inside.
#[derive(Debug, PartialEq)]
enum Back {
    Mirrors,
    LetsThrough,
}

/// Snell's law at the front, z = 0.5, and the angle at the back, y = z + 0.6; `None` for rays that meet something else.
fn back(ray: Ray) -> Option<Back> {
    let to_front = (0.5 - ray.origin.z) / ray.direction.z;
    let on_front = ray.at(to_front);
    let tangential = DVec3::new(ray.direction.x, ray.direction.y, 0.0) / INDEX;
    let inside = tangential - DVec3::Z * (1.0 - tangential.dot(tangential)).sqrt();
    let to_back = (on_front.z + 0.6 - on_front.y) / (inside.y - inside.z);
    let on_back = on_front + to_back * inside;
    // Away from the edges by a margin, so that a pixel beside an edge is not asked.
    let on_faces = [on_front, on_back].iter().all(|p| p.x.abs() < 0.58 && (0.12..1.08).contains(&p.y));
    if !on_faces {
        return None;
    }
    let cosine = (inside.y - inside.z) * std::f64::consts::FRAC_1_SQRT_2;
    let critical = (1.0 - 1.0 / (INDEX * INDEX)).sqrt();
    Some(if cosine < critical { Back::Mirrors } else { Back::LetsThrough })
}

/// Under a sky whose radiance tells how steeply a direction goes down, and with nothing reflected but in total reflection:
/// what the back mirrors leaves by the bottom, within 30 degrees of straight down (a level ray exactly there); what gets
/// through leaves along the back, 45 degrees down, or higher.
#[test]
fn the_line_is_where_the_critical_angle_is() {
    let mut desc = described("04_total_reflection");
    keep(&mut desc, &["prism"]);
    set_glass(&mut desc, 0.0, 1.0);
    desc.lights.clear();
    desc.background = Background::Gradient { bottom: Rgb::ONE, top: Rgb::ZERO };

    let size = [160, 160];
    let camera = loaded(&desc).scene.camera;
    let at = |x: f64, y: f64| back(camera.ray(x, y, size, || unreachable!("no lens")));
    let (mut mirrors, mut through) = (0, 0);
    for (i, pixel) in (0u32..).zip(picture(&desc, size, 2)) {
        let (x, y) = (i % size[0], i / size[0]);
        // Radiance is (1 - y)/2 of the direction: 0.933 for 30 degrees off straight down, 0.854 for 45.
        match unanimous(x, y, at).flatten() {
            Some(Back::Mirrors) => {
                mirrors += 1;
                assert!(pixel[0] > 0.93, "({x}, {y}): {pixel:?} is not mirrored");
            }
            Some(Back::LetsThrough) => {
                through += 1;
                assert!(pixel[0] < 0.86, "({x}, {y}): {pixel:?} has not got through");
            }
            None => {}
        }
    }
    assert!(mirrors > 1000 && through > 1000, "{mirrors}, {through}");
}
