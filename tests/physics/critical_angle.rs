//! Total reflection against a table of Fresnel reflectances (computed by the Python package `tmm`).

use crate::reference::{column, table};
use vitrum::bxdf::{Interface, Refraction};
use vitrum::math::DVec3;

#[test]
fn total_reflection_is_where_the_table_reflects_everything() {
    let Some(rows) = table("fresnel_interface.csv") else { return };
    let mut total = 0;
    for row in &rows[1..] {
        let number = |name| column(&rows[0], row, name).expect("a number");
        let (n1, n2, degrees) = (number("n1"), number("n2"), number("angle_deg"));
        let (sin, cos) = degrees.to_radians().sin_cos();
        let interface = Interface::new(n1, n2).expect("valid indices");
        let is_total =
            interface.refract(DVec3::new(sin, 0.0, cos)) == Refraction::<f64>::TotalInternalReflection;
        // Along the surface everything is reflected too, but by an angle at which glass refracts.
        let table_says = number("R_unpolarised") >= 1.0 - 1e-9 && degrees < 90.0;
        assert_eq!(is_total && degrees < 90.0, table_says, "{row:?}");
        total += u32::from(table_says);
    }
    assert!(total >= 5, "the table has angles beyond critical");
}

/// The sine of the critical angle is `n_t / n_i`, to the last bits on both sides.
#[test]
fn the_critical_angle_is_where_the_closed_form_puts_it() {
    for (n_i, n_t) in [(1.5, 1.0), (1.333, 1.0), (2.42, 1.0), (1.5, 1.333), (1.0003, 1.0)] {
        let interface = Interface::new(n_i, n_t).expect("valid indices");
        let critical = f64::asin(n_t / n_i);
        for (turned, expected) in [(1e-10, true), (-1e-10, false)] {
            let (sin, cos) = (critical + turned).sin_cos();
            let is_total =
                interface.refract(DVec3::new(0.0, sin, cos)) == Refraction::<f64>::TotalInternalReflection;
            assert_eq!(is_total, expected, "{n_i} to {n_t}");
        }
    }
}
