//! A plane-parallel slab keeps the direction of a ray and shifts it sideways by d sin a (1 − cos a / (n cos b)), with
//! sin a = n sin b.

use crate::chain::transmit;
use crate::stage::{camera, clear_glass, object, white};
use vitrum::geometry::shape::{Cuboid, Shape};
use vitrum::math::{DVec3, Ray};
use vitrum::tracer::Projection;

#[test]
fn a_slab_shifts_a_ray_by_the_closed_form() {
    let thickness = 0.3;
    let slab =
        Cuboid::new(DVec3::new(-50.0, -50.0, -thickness), DVec3::new(50.0, 50.0, 0.0)).expect("valid box");
    for n in [0.75, 1.0003, 1.5, 2.42] {
        let glass = object("slab", Shape::Cuboid(slab), clear_glass(0.0, 1.0, 1.0, n));
        let scene = white(vec![glass], camera(Projection::Pinhole { fov: 1.0 }, 5.0));
        for degrees in [0.0f64, 1.0, 20.0, 45.0, 48.0, 80.0] {
            let a = degrees.to_radians();
            let sin_b = a.sin() / n;
            let direction = DVec3::new(a.sin(), 0.0, -a.cos());
            let out = transmit(&scene, Ray::new(-direction * 3.0, direction), 2);
            if sin_b >= 1.0 {
                assert!(out.is_none(), "total reflection at {degrees} degrees into n = {n}");
                continue;
            }
            let out = out.expect("goes through");
            let cos_b = (1.0 - sin_b * sin_b).sqrt();
            let expected = thickness * a.sin() * (1.0 - a.cos() / (n * cos_b));
            // Distance of the outgoing line from the incoming one, which passes through the origin.
            let offset = out.origin - direction * out.origin.dot(direction);
            let shift = -offset.dot(DVec3::new(a.cos(), 0.0, a.sin()));
            assert!(
                (shift - expected).abs() < 1e-13,
                "n = {n}, {degrees} degrees: {shift} instead of {expected}"
            );
            assert!((out.direction - direction).length() < 1e-14, "the direction is kept");
        }
    }
}
