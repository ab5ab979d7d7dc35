//! The models under test and the directions that they are looked at from.

use glam::DVec3;
use vitrum_bxdf::{Bxdf, GlossySpecular, Interface, Lambertian, PerfectTransmitter};
use vitrum_testkit::{SphereGrid, Uniform};

/// From the bluntest highlight to one of three degrees.
pub(crate) const EXPONENTS: [f64; 4] = [1.0, 10.0, 200.0, 2000.0];

/// Angles to the normal, in degrees.
pub(crate) const ANGLES: [f64; 4] = [0.0, 30.0, 75.0, 89.9];

/// Reflected shares, or values of the highlight, that differ by channel.
pub(crate) const COLOUR: DVec3 = DVec3::new(0.9, 0.4, 0.05);

pub(crate) fn lambertian() -> Bxdf<f64> {
    Bxdf::Lambertian(Lambertian { reflectance: COLOUR })
}

pub(crate) fn glossy(exponent: f64) -> Bxdf<f64> {
    Bxdf::GlossySpecular(GlossySpecular::unnormalised(COLOUR, exponent))
}

pub(crate) fn glass(kr: DVec3, kt: DVec3, above: f64, below: f64) -> Bxdf<f64> {
    let interface = Interface::new(above, below).expect("both indices are positive");
    Bxdf::PerfectTransmitter(PerfectTransmitter { kr, kt, interface })
}

/// A model with its name.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) model: Bxdf<f64>,
    /// Cells that show the shape of its lobe, for counting in them. For integrals the default ones are fine enough.
    pub(crate) cells: SphereGrid,
}

/// Every model that has a density.
pub(crate) fn subjects() -> Vec<Subject> {
    let subject = |name: String, model, cells| Subject { name, model, cells };
    let diffuse = subject("Lambertian".to_owned(), lambertian(), SphereGrid::default());
    let highlight = |exponent: f64| {
        // A lobe of exponent 2000 is 3 degrees wide at half its height; the finer cells have 1.5 degrees.
        let fine = SphereGrid { theta: 120, phi: 240 };
        let cells = if exponent > 1000.0 { fine } else { SphereGrid::default() };
        subject(format!("exponent {exponent}"), glossy(exponent), cells)
    };
    [diffuse].into_iter().chain(EXPONENTS.map(highlight)).collect()
}

/// A direction at so many degrees from the normal, above or below, away from the axes.
pub(crate) fn at_angle(degrees: f64, above: bool) -> DVec3 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let (sin_phi, cos_phi) = libm::sincos(0.7);
    DVec3::new(sin * cos_phi, sin * sin_phi, if above { cos } else { -cos })
}

/// Every angle on both sides, with its name.
pub(crate) fn outgoing() -> impl Iterator<Item = (String, DVec3)> {
    [true, false].into_iter().flat_map(|above| {
        ANGLES.map(|degrees| {
            let side = if above { "above" } else { "below" };
            (format!("{degrees} degrees {side}"), at_angle(degrees, above))
        })
    })
}

/// A unit vector, uniform over the sphere.
pub(crate) fn direction(uniform: &mut Uniform) -> DVec3 {
    let z = 1.0 - 2.0 * uniform.number();
    let (sin_phi, cos_phi) = libm::sincos(core::f64::consts::TAU * uniform.number());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos_phi, r * sin_phi, z)
}
