//! Fresnel's reflectance of an interface against the angle, from both sides, as CSV:
//!
//! ```text
//! cargo run --example fresnel_curve > curve.csv
//! ```
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use vitrum_bxdf::{IndexError, Interface};

fn main() -> Result<(), IndexError> {
    let glass = Interface::new(1.0_f64, 1.5)?;
    println!("degrees,from_air_s,from_air_p,from_air,from_glass_s,from_glass_p,from_glass");
    for degrees in 0..=90 {
        let cos = f64::from(degrees).to_radians().cos();
        let [air, inside] = [cos, -cos].map(|cos| glass.reflectance(cos));
        println!(
            "{degrees},{},{},{},{},{},{}",
            air.s,
            air.p,
            air.unpolarised(),
            inside.s,
            inside.p,
            inside.unpolarised()
        );
    }
    Ok(())
}
