//! Fills the table of energy compensation: the single-scattering albedo E of a rough dielectric at the nodes of
//! `src/compensation/grid.rs`.
//!
//! E(wo) is the mean weight of the model's own sampling, ∫∫ [F G2(wo, wr) + (1 − F) G2(wo, wt)]/G1(wo) du dv over the unit
//! square that chooses the microscopic normal, where a direction on the wrong side counts nothing. The integrand bends
//! where a direction changes sides and where total reflection begins, so intervals are halved towards these places; between
//! them Gauss-Legendre quadrature does. In f64, with libm alone, so that every machine makes the same table.
//!
//! This is the isotropic model written a second time, on purpose: the furnace test of the model tests both.

#[path = "src/compensation/grid.rs"]
mod grid;

use grid::{COSINES, RATIOS, ROUGHNESSES, Side};
use libm::{cos, sin, sqrt};
use std::fmt::Write;
use std::{env, fs, path::Path, thread};

/// Gauss-Legendre quadrature within an interval: abscissae in [0, 1] and weights.
type Rule = [(f64, f64); 3];

/// How often an interval is halved towards a change of kind.
const DEPTH: u32 = 5;

/// The least albedo that is made up for in full (see the manual of `RoughDielectric`).
const LEAST_ALBEDO: f64 = 1.0 / 16.0;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/compensation/grid.rs");

    // One strip of the table per roughness; the threads only share out the work.
    let workers = thread::available_parallelism().map_or(1, usize::from).min(ROUGHNESSES);
    let mut strips: Vec<(usize, Vec<f64>)> = thread::scope(|scope| {
        let work = |first: usize| {
            (first..ROUGHNESSES).step_by(workers).map(|index| (index, strip(index))).collect::<Vec<_>>()
        };
        let handles: Vec<_> = (0..workers).map(|first| scope.spawn(move || work(first))).collect();
        handles.into_iter().flat_map(|handle| handle.join().expect("no worker panics")).collect()
    });
    strips.sort_by_key(|(index, _)| *index);

    let mut source = format!(
        "/// √E by roughness, ratio, side and cosine.\nstatic ROOTS: [f32; {}] = [\n",
        grid::row(ROUGHNESSES, 0, Side::Rarer)
    );
    for albedo in strips.into_iter().flat_map(|(_, strip)| strip) {
        let root = sqrt(albedo.clamp(LEAST_ALBEDO, 1.0)) as f32;
        writeln!(source, "{root:?},").expect("a string takes everything");
    }
    source.push_str("];\n");
    #[expect(clippy::disallowed_methods, reason = "this is how cargo tells a build script")]
    let folder = env::var_os("OUT_DIR").expect("cargo names the folder");
    fs::write(Path::new(&folder).join("compensation.rs"), source).expect("the folder can be written to");
}

/// The albedos of one roughness: by ratio, side and cosine.
fn strip(roughness: usize) -> Vec<f64> {
    let rule: Rule = gauss_legendre();
    let at = |index: usize, count: usize| index as f64 / (count - 1) as f64;
    let alpha = inverse(at(roughness, ROUGHNESSES), grid::LEAST_ALPHA, 1.0, grid::of_roughness);
    let mut albedos = Vec::with_capacity(RATIOS * 2 * COSINES);
    for ratio in 0..RATIOS {
        // Equal indices are a limit: what counts is q/α.
        let q =
            inverse(at(ratio, RATIOS), 0.0, grid::LARGEST_Q, |q| grid::of_ratio(q, alpha)).max(1e-3 * alpha);
        let n = sqrt(1.0 + q * q);
        for side in [Side::Rarer, Side::Denser] {
            let eta = if side == Side::Rarer { n } else { 1.0 / n };
            let cosines = grid::Cosines::new(alpha, q / n);
            for cosine in 0..COSINES {
                let mu = inverse(at(cosine, COSINES), 0.0, 1.0, |mu| cosines.coordinate(mu, side));
                // Along the surface itself the integrand is a limit too.
                albedos.push(View::new(mu.max(1e-6), alpha, eta).albedo(&rule));
            }
        }
    }
    albedos
}

/// A surface as it is seen from one direction.
struct View {
    mu: f64,
    sin: f64,
    alpha: f64,
    /// Index on the far side over that on the near one.
    eta: f64,
    /// √(μ² + α² sin²).
    stretched: f64,
}

/// What may happen at a microscopic normal: the integrand is smooth as long as this stays the same.
#[derive(Clone, Copy, PartialEq)]
struct Fate {
    reflects: bool,
    refracts: bool,
    crosses: bool,
}

impl View {
    fn new(mu: f64, alpha: f64, eta: f64) -> Self {
        let sin = sqrt((1.0 - mu * mu).max(0.0));
        Self { mu, sin, alpha, eta, stretched: sqrt(mu * mu + alpha * alpha * sin * sin) }
    }

    /// The integral over the unit square.
    fn albedo(&self, rule: &Rule) -> f64 {
        // Over the azimuth alone everything is monotonous in its cosine, so the integral over it bends only where the fate
        // changes at one of its ends.
        let ends = |v: f64| [self.weight(0.0, v).0, self.weight(1.0, v).0];
        integrate(&|v| self.over_azimuth(v, rule), &ends, rule)
    }

    fn over_azimuth(&self, v: f64, rule: &Rule) -> f64 {
        integrate(&|u| self.weight(u, v).1, &|u| self.weight(u, v).0, rule)
    }

    /// What the normal at (u, v) does, and the weight of both children together. The azimuth πu covers one half of the
    /// surface; the other one is its mirror image.
    fn weight(&self, u: f64, v: f64) -> (Fate, f64) {
        let Self { mu, sin: sin_o, alpha, eta, stretched } = *self;
        let (out_x, out_z) = (alpha * sin_o / stretched, mu / stretched);
        let down = v * (1.0 + out_z);
        let radius = sqrt((down * (2.0 - down)).max(0.0));
        let phi = core::f64::consts::PI * u;
        let (x, y, z) = (alpha * (radius * cos(phi) + out_x), alpha * radius * sin(phi), 1.0 - down + out_z);
        let length = sqrt(x * x + y * y + z * z);
        let (m_x, m_z) = (x / length, z / length);

        let c = sin_o * m_x + mu * m_z;
        let e_squared = eta * eta - 1.0 + c * c;
        let mut fate = Fate { reflects: false, refracts: e_squared > 0.0, crosses: false };
        let (mut reflectance, mut through_z) = (1.0, 0.0);
        if fate.refracts {
            let e = sqrt(e_squared);
            let s = (c - e) / (c + e);
            let p = (eta * eta * c - e) / (eta * eta * c + e);
            reflectance = 0.5 * (s * s + p * p);
            through_z = (mu - (c - e) * m_z) / eta;
        }
        let seen = |z: f64| {
            let other = sqrt(z * z + alpha * alpha * (1.0 - z * z).max(0.0));
            z * (mu + stretched) / (stretched * z + other * mu)
        };
        let mut weight = 0.0;
        let reflected_z = 2.0 * c * m_z - mu;
        if reflected_z > 0.0 {
            fate.reflects = true;
            weight += reflectance * seen(reflected_z);
        }
        if through_z > 0.0 {
            fate.crosses = true;
            weight += (1.0 - reflectance) * seen(through_z);
        }
        (fate, weight)
    }
}

/// The integral over [0, 1] of a function that is smooth where its kind stays the same.
fn integrate<K: Copy + PartialEq>(f: &dyn Fn(f64) -> f64, kind: &dyn Fn(f64) -> K, rule: &Rule) -> f64 {
    const CELLS: usize = 3;
    let border = |index: usize| {
        let x = index as f64 / CELLS as f64;
        (x, kind(x))
    };
    (0..CELLS).map(|cell| refine(f, kind, rule, border(cell), border(cell + 1), DEPTH)).sum()
}

/// Over an interval, which is halved as long as its ends are of different kinds.
fn refine<K: Copy + PartialEq>(
    f: &dyn Fn(f64) -> f64,
    kind: &dyn Fn(f64) -> K,
    rule: &Rule,
    low: (f64, K),
    high: (f64, K),
    depth: u32,
) -> f64 {
    if depth > 0 && low.1 != high.1 {
        let middle = 0.5 * (low.0 + high.0);
        let middle = (middle, kind(middle));
        return refine(f, kind, rule, low, middle, depth - 1)
            + refine(f, kind, rule, middle, high, depth - 1);
    }
    let width = high.0 - low.0;
    rule.iter().map(|&(x, weight)| weight * width * f(low.0 + x * width)).sum()
}

/// Where an increasing function takes this value, by bisection.
fn inverse(value: f64, mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if f(middle) < value { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Abscissae in [0, 1] and weights of Gauss-Legendre quadrature: the zeros of a Legendre polynomial by Newton's method
/// (Press and others, Numerical Recipes, section 4.6).
fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let n = N as f64;
    std::array::from_fn(|index| {
        let mut x = cos(core::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5));
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=N {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}
