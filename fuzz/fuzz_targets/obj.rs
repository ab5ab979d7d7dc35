//! Any bytes as an OBJ file and, at the same time, as the material library that it names.
#![no_main]

use libfuzzer_sys::fuzz_target;
use vitrum_io::obj::{self, MtlMaterial};

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = obj::parse("fuzz.obj", bytes, |_| Ok(bytes.to_vec())) else { return };
    for part in &file.parts {
        let mesh = &part.mesh;
        assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < mesh.positions.len()));
        assert!(mesh.positions.iter().all(|position| position.is_finite()));
    }
    let _ = file.materials.iter().map(MtlMaterial::meaning).count();
});
