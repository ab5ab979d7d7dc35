//! Reflectances against a table computed by the Python package `tmm` (S. Byrnes, Multilayer Optical Calculations), both
//! polarisations, total reflection included.

use vitrum_bxdf::{Interface, Reflectance};

#[test]
fn every_row_of_the_table_is_reproduced() {
    let Some(assets) = vitrum_testkit::assets() else { return };
    let table =
        std::fs::read_to_string(assets.join("reference/fresnel_interface.csv")).expect("the table is there");
    let mut rows = 0;
    for line in table.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let [n1, n2, degrees, s, p, unpolarised] = numbers[..] else { panic!("six columns: {line}") };
        let found = Interface::new(n1, n2).expect("both are indices").reflectance(degrees.to_radians().cos());
        // The table has nine digits behind the point; along the surface the cosine of 90 degrees is 6e-17.
        let Reflectance { s: found_s, p: found_p, .. } = found;
        for (found, expected) in [(found_s, s), (found_p, p), (found.unpolarised(), unpolarised)] {
            assert!((found - expected).abs() <= 1e-9, "{line}: {found}");
        }
        rows += 1;
    }
    assert!(rows >= 100, "only {rows} rows");
}
