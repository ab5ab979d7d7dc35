//! A density of directions integrates to one, less the probability that nothing is returned.

use crate::stage::{at_angle, glossy, lambertian, outgoing, subjects};
use glam::DVec3;
use vitrum_bxdf::Bxdf;
use vitrum_testkit::{SphereGrid, integrate_sphere};

/// The quadrature's own error where a density jumps or bends inside a cell (see `vitrum_testkit::sphere`).
const QUADRATURE: f64 = 1e-5;

fn integral(model: &Bxdf<f64>, wo: DVec3) -> f64 {
    integrate_sphere(|wi| model.pdf(wo, wi), SphereGrid::default())
}

#[test]
fn no_density_integrates_to_more_than_one() {
    for subject in subjects() {
        for (place, wo) in outgoing() {
            let found = integral(&subject.model, wo);
            assert!(
                (0.0..=1.0 + QUADRATURE).contains(&found),
                "{}, {place}: integrates to {found}",
                subject.name
            );
        }
    }
}

#[test]
fn where_nothing_falls_below_the_surface_it_is_one() {
    let is_one = |name: &str, found: f64| {
        assert!((found - 1.0).abs() < QUADRATURE, "{name}: integrates to {found}");
    };
    for (place, wo) in outgoing() {
        is_one(&place, integral(&lambertian(), wo));
    }
    for subject in subjects() {
        // Along the normal the lobe just fills the hemisphere.
        for above in [true, false] {
            let wo = at_angle(0.0, above);
            is_one(&subject.name, integral(&subject.model, wo));
        }
    }
    // At 30 degrees the surface cuts a lobe of exponent n where its cosine is a half: less than 2⁻ⁿ of it is below.
    let wo = at_angle(30.0, true);
    is_one("exponent 200", integral(&glossy(200.0), wo));
}

/// Along the surface the mirror direction is in it, and half of every lobe lies below.
#[test]
fn at_grazing_incidence_it_is_a_half() {
    for subject in subjects().iter().skip(1) {
        let wo = at_angle(90.0 - 1e-7, true);
        let found = integral(&subject.model, wo);
        assert!((found - 0.5).abs() < QUADRATURE, "{}: integrates to {found}", subject.name);
    }
}
