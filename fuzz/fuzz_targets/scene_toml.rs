//! Any text as a scene file: a scene or diagnostics that can be printed, and never neither.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (scene, diagnostics) = vitrum_io::scene::parse("fuzz.toml", text);
    assert!(scene.is_some() || diagnostics.has_errors());
    let _ = diagnostics.to_string();
});
