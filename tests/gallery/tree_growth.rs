//! 6: the growth of the ray tree.

use crate::stage::gallery;
use crate::table::{growth, markdown};
use std::fs;
use vitrum_testkit::blessing;

const BEGIN: &str = "<!-- tree growth: begin -->\n";
const END: &str = "<!-- tree growth: end -->";

#[test]
fn the_page_has_the_table_that_the_program_prints() {
    let path = gallery().join("README.md");
    let page = fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once(BEGIN).expect("the README marks where the table begins");
    let (table, after) = rest.split_once(END).expect("the README marks where the table ends");
    let fresh = markdown(&gallery()).unwrap();
    if blessing() {
        fs::write(&path, format!("{before}{BEGIN}{fresh}{END}{after}")).unwrap();
    } else {
        assert_eq!(table, fresh, "run the tests with VITRUM_BLESS=1 to write the new table");
    }
}

/// Inside a sphere of n > 1 each hit sends one ray out, which is gone, and one on: 1 + 2 D nodes. What the limit cuts
/// is what is still inside, kt kr^(D-1).
#[test]
fn the_tree_of_one_ball_grows_by_two_at_each_depth() {
    let scene = gallery().join("06_sphere.toml");
    for depth in 0..=12u32 {
        let found = growth(&scene, depth, 0.0).unwrap();
        assert_eq!(found.nodes, f64::from(1 + 2 * depth));
        let inside = if depth == 0 { 1.0 } else { 0.9 * 0.1f64.powi(depth.cast_signed() - 1) };
        // A mean over 1024 equal values, each the product of up to twelve rounded factors.
        assert!((found.given_up / inside - 1.0).abs() < 1e-12, "{found:?}, expected {inside}");
    }
    // With the default cut-off of 1e-3 the ray inside ends at its fourth hit, where 0.9 x 0.1^3 would go on: 8 nodes.
    for depth in 4..=12 {
        assert_eq!(growth(&scene, depth, 1e-3).unwrap().nodes, 8.0);
    }
}
