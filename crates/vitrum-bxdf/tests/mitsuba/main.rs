//! The models against an independent implementation: values of Mitsuba 3.9.1 (`references.py` made the files beside it).
//!
//! Mitsuba's published build computes in single precision, so its parameters are singles, read here as such and widened,
//! and its own rounding is part of every difference. What it defines otherwise:
//!
//! - masking is separable, G1(wo) G1(wi), where ours is height-correlated: values are compared after multiplication by the
//!   ratio of both, densities (which know only G1(wo)) as they are;
//! - single scattering only: compared with `single_scattering`;
//! - `alpha_u` is our `alpha_x`.
#![expect(clippy::print_stdout, reason = "the largest difference of each file, for people who ask to see it")]

use glam::{DVec3, Vec3};
use vitrum_bxdf::{
    Bxdf, ComplexIndex, Conductor, Density, FresnelDielectric, Ggx, Interface, Lobe, RoughDielectric, Sample,
    ThinDielectric, TransportMode,
};

/// A file's rows, each number a single.
struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

struct Row<'t> {
    columns: &'t [&'static str],
    fields: &'t [&'static str],
}

impl Table {
    fn read(text: &'static str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let columns = lines.next().expect("a line of names");
        Self { columns, rows: lines.collect() }
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        assert!(!self.rows.is_empty());
        self.rows.iter().map(|fields| Row { columns: &self.columns, fields })
    }
}

impl Row<'_> {
    fn text(&self, name: &str) -> &str {
        let column = self.columns.iter().position(|column| *column == name);
        self.fields[column.unwrap_or_else(|| panic!("no column {name}"))]
    }

    fn number(&self, name: &str) -> f64 {
        f64::from(self.text(name).parse::<f32>().expect("a number"))
    }

    fn direction(&self, name: &str) -> DVec3 {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.number(&format!("{name}_{axis}")));
        DVec3::new(x, y, z)
    }

    fn mode(&self) -> TransportMode {
        match self.text("mode") {
            "radiance" => TransportMode::Radiance,
            "importance" => TransportMode::Importance,
            other => panic!("no mode {other}"),
        }
    }

    fn interface(&self) -> Interface<f64> {
        Interface::new(self.number("ext_ior"), self.number("int_ior")).expect("both are indices")
    }

    fn ggx(&self) -> Ggx<f64> {
        Ggx::new(self.number("alpha_u"), self.number("alpha_v")).expect("both are roughnesses")
    }

    fn index(&self) -> ComplexIndex<f64> {
        let (n, k) = (DVec3::splat(self.number("eta")), DVec3::splat(self.number("k")));
        ComplexIndex::new(n, k, 1.0).expect("it is a metal")
    }
}

/// The largest differences of a file, each with where it is.
#[derive(Default)]
struct Largest {
    difference: f64,
    place: String,
}

impl Largest {
    fn see(&mut self, difference: f64, row: &Row<'_>) {
        assert!(difference.is_finite(), "{:?}", row.fields);
        if difference > self.difference {
            *self = Self { difference, place: row.fields.join(",") };
        }
    }

    fn below(&self, what: &str, tolerance: f64) {
        println!("{what}: {:.1e} of at most {tolerance:e}, at {}", self.difference, self.place);
        assert!(self.difference <= tolerance, "{what}: {} at {}", self.difference, self.place);
    }
}

/// The child of this row's lobe, chosen by the number that must choose it.
fn child(row: &Row<'_>, model: &Bxdf<f64>, mode: TransportMode) -> Sample<f64> {
    let (uc, lobe) = match row.text("lobe") {
        "reflection" => (0.0, Lobe::SpecularReflection),
        "transmission" => (1.0 - f64::EPSILON, Lobe::SpecularTransmission),
        other => panic!("no lobe {other}"),
    };
    let sample = model.sample(row.direction("wo"), uc, [0.5; 2], mode).expect("it scatters");
    assert_eq!(sample.lobe, lobe, "{:?}", row.fields);
    sample
}

fn probability(sample: &Sample<f64>) -> f64 {
    let Density::Discrete(probability) = sample.pdf else { panic!("it is smooth") };
    probability
}

#[test]
fn smooth_glass() {
    let table = Table::read(include_str!("dielectric.csv"));
    let (mut shares, mut nearly_matched, mut weights, mut directions) =
        (Largest::default(), Largest::default(), Largest::default(), Largest::default());
    for row in table.rows() {
        let model = Bxdf::FresnelDielectric(FresnelDielectric { interface: row.interface() });
        let sample = child(&row, &model, row.mode());
        let difference = (probability(&sample) - row.number("probability")).abs();
        let near = row.text("int_ior") == "1.0003";
        if near { &mut nearly_matched } else { &mut shares }.see(difference, &row);
        weights.see((sample.weight.x / row.number("weight") - 1.0).abs(), &row);
        weights.see((sample.eta / row.number("eta") - 1.0).abs(), &row);
        directions.see((sample.wi - row.direction("wi")).length(), &row);
    }
    shares.below("shares", 1e-5);
    // Here Mitsuba's form of the equations loses half of its digits. Ours has fourteen right (`tests/accuracy`).
    nearly_matched.below("shares at index 1.0003", 2e-5);
    weights.below("weights, relative", 1e-6);
    directions.below("directions", 1e-5);
}

#[test]
fn thin_sheets() {
    let table = Table::read(include_str!("thindielectric.csv"));
    let (mut shares, mut directions) = (Largest::default(), Largest::default());
    for row in table.rows() {
        let model = Bxdf::ThinDielectric(ThinDielectric::clear(row.interface()));
        let sample = child(&row, &model, TransportMode::Radiance);
        shares.see((probability(&sample) - row.number("probability")).abs(), &row);
        shares.see((sample.weight.x - row.number("weight")).abs(), &row);
        directions.see((sample.wi - row.direction("wi")).length(), &row);
    }
    shares.below("shares", 1e-5);
    directions.below("directions", 1e-6);
}

#[test]
fn smooth_metal() {
    let table = Table::read(include_str!("conductor.csv"));
    let mut reflectances = Largest::default();
    for row in table.rows() {
        let model = Conductor { index: row.index(), roughness: Ggx::smooth() };
        let sample = model.sample(row.direction("wo"), [0.5; 2]).expect("it reflects");
        reflectances.see((sample.weight.x - row.number("weight")).abs(), &row);
    }
    reflectances.below("reflectances", 1e-5);
}

/// Our masking over Mitsuba's.
fn masking_ratio(ggx: &Ggx<f64>, wo: DVec3, wi: DVec3) -> f64 {
    let [wo, wi] = [wo, wi].map(|w| DVec3::new(w.x, w.y, w.z.abs()));
    ggx.masking_shadowing(wo, wi) / (ggx.masking(wo) * ggx.masking(wi))
}

/// Compares values and densities of a rough model.
fn rough(table: &Table, model: impl Fn(&Row<'_>) -> Bxdf<f64>, mode: impl Fn(&Row<'_>) -> TransportMode) {
    let (mut values, mut densities) = (Largest::default(), Largest::default());
    for row in table.rows() {
        let (wo, wi) = (row.direction("wo").normalize(), row.direction("wi").normalize());
        let model = model(&row);
        let expected = row.number("eval") * masking_ratio(&row.ggx(), wo, wi);
        values.see((model.eval(wo, wi, mode(&row)).x / expected - 1.0).abs(), &row);
        densities.see((model.pdf(wo, wi) / row.number("pdf") - 1.0).abs(), &row);
    }
    values.below("values, relative, after the ratio of the maskings", 1e-3);
    densities.below("densities, relative", 1e-3);
}

#[test]
fn rough_glass() {
    let table = Table::read(include_str!("roughdielectric.csv"));
    let model =
        |row: &Row<'_>| Bxdf::RoughDielectric(RoughDielectric::single_scattering(row.interface(), row.ggx()));
    rough(&table, model, |row| row.mode());
}

#[test]
fn rough_metal() {
    let table = Table::read(include_str!("roughconductor.csv"));
    let model = |row: &Row<'_>| Bxdf::Conductor(Conductor { index: row.index(), roughness: row.ggx() });
    rough(&table, model, |_| TransportMode::Radiance);
}

/// In single precision too, where both round.
#[test]
fn rough_glass_in_single_precision() {
    let table = Table::read(include_str!("roughdielectric.csv"));
    let mut densities = Largest::default();
    for row in table.rows() {
        let single = |name: &str| row.number(name) as f32;
        let interface = Interface::new(single("ext_ior"), single("int_ior")).expect("both are indices");
        let ggx = Ggx::new(single("alpha_u"), single("alpha_v")).expect("both are roughnesses");
        let model = RoughDielectric::single_scattering(interface, ggx);
        let [wo, wi]: [Vec3; 2] = ["wo", "wi"].map(|name| row.direction(name).as_vec3());
        densities.see((f64::from(model.pdf(wo, wi)) / row.number("pdf") - 1.0).abs(), &row);
    }
    densities.below("densities in f32, relative", 1e-3);
}
