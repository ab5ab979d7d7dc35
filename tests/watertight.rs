//! Nothing slips through the edges of a closed mesh. `cargo run --release --example watertight -- 1e8` does the same with
//! more rays.

#[path = "../examples/watertight/rays.rs"]
mod rays;

use std::path::Path;

#[test]
fn a_million_rays_find_no_gap() {
    let cases = rays::cases(Path::new(env!("CARGO_MANIFEST_DIR")));
    let each = 1_000_000u64.div_ceil(cases.len() as u64);
    for case in &cases {
        let rays::Case { name, scale, offset, is_instance, .. } = case;
        let leaks = case.leaks(each, 1);
        assert!(
            leaks.is_empty(),
            "{name}, scale {scale}, offset {offset}, instance: {is_instance}: {leaks:?}"
        );
    }
}
