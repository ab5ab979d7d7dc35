//! Energy compensation of rough dielectrics: what single scattering loses, by table.

pub(crate) mod grid;

use crate::{Ggx, Interface, Real};
use grid::{COSINES, Cosines, LARGEST_Q, RATIOS, ROUGHNESSES, Side};

include!(concat!(env!("OUT_DIR"), "/compensation.rs"));

/// Where in the table the albedos of one interface and roughness stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compensation {
    cosines: Cosines,
    /// The lower nodes of roughness and ratio.
    node: [u8; 2],
    /// How far beyond them, 0 to 1.
    beyond: [f32; 2],
    /// The side above.
    above: Side,
}

impl Compensation {
    /// `None` where the table has nothing: ratios beyond 2.5.
    pub(crate) fn new<R: Real>(interface: &Interface<R>, roughness: &Ggx<R>) -> Option<Self> {
        let (down, up) = (interface.crossing(true), interface.crossing(false));
        let above_is_rarer = down.k > R::zero();
        let (into_denser, into_rarer) = if above_is_rarer { (down, up) } else { (up, down) };
        let alpha = roughness.mean_alpha().to_f64();
        let q = into_denser.k.sqrt().to_f64();
        // A ratio that is 2.5 in single precision is one that is 2.5.
        if q > LARGEST_Q * (1.0 + 1e-6) {
            return None;
        }
        let (i, roughness_beyond) = split(grid::of_roughness(alpha), ROUGHNESSES);
        let (j, ratio_beyond) = split(grid::of_ratio(q, alpha), RATIOS);
        Some(Self {
            cosines: Cosines::new(alpha, into_rarer.critical_hi.to_f64()),
            node: [i as u8, j as u8],
            beyond: [roughness_beyond, ratio_beyond],
            above: if above_is_rarer { Side::Rarer } else { Side::Denser },
        })
    }

    /// What the light scattered between `w` and everywhere is multiplied by, so that none is lost: 1/E. `z` is the z
    /// component of `w`.
    #[inline]
    pub(crate) fn scale<R: Real>(&self, z: R) -> R {
        let is_above = z >= R::zero();
        let side = if is_above == (self.above == Side::Rarer) { Side::Rarer } else { Side::Denser };
        let mu = z.abs().at_most(R::one()).to_f64();
        let (k, beyond) = split(self.cosines.coordinate(mu, side), COSINES);
        let [i, j] = self.node.map(usize::from);
        let along = |roughness: usize, ratio: usize| {
            let row = &ROOTS[grid::row(roughness, ratio, side)..][..COSINES];
            mix(row[k], row[k + 1], beyond)
        };
        let [roughness, ratio] = self.beyond;
        let across = |i: usize| mix(along(i, j), along(i, j + 1), ratio);
        let root = mix(across(i), across(i + 1), roughness);
        R::from_f64(f64::from(1.0 / (root * root)))
    }
}

/// The node below a coordinate in [0, 1] that is not the last of `count`, and how far beyond it.
#[inline]
fn split(coordinate: f64, count: usize) -> (usize, f32) {
    let place = coordinate * (count - 1) as f64;
    let node = (place as usize).min(count - 2);
    (node, (place - node as f64) as f32)
}

#[inline]
fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}
