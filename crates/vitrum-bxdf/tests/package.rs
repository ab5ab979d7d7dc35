//! The crate as a user gets it: packaged, unpacked away from this workspace, built as a dependency and for targets without
//! a standard library. Needs `cargo` and `tar`, and no network: what it depends on has been built already.

use std::fs;
use std::path::Path;
use std::process::Command;

/// A program of somebody else's, which prints what Fresnel says of glass along the normal.
const MAIN: &str = r#"use vitrum_bxdf::Interface;

fn main() {
    let glass = Interface::new(1.0_f64, 1.5).expect("both are indices");
    println!("{:.6}", glass.reflectance(1.0).unpolarised());
}
"#;

/// Runs a command and returns what it printed.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

/// Cargo in this folder, offline, with its output in `target`.
fn cargo(folder: &Path, target: &Path) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(folder).env("CARGO_TARGET_DIR", target).env("CARGO_NET_OFFLINE", "true");
    command
}

#[test]
fn the_packaged_crate_builds_outside_the_workspace() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let target = folder.path().join("target");
    let source = Path::new(env!("CARGO_MANIFEST_DIR"));
    run(cargo(source, &target).args(["package", "--quiet", "--allow-dirty", "--no-verify"]));
    let package = format!("vitrum-bxdf-{}", env!("CARGO_PKG_VERSION"));
    run(Command::new("tar")
        .current_dir(folder.path())
        .arg("-xzf")
        .arg(target.join("package").join(format!("{package}.crate"))));
    let unpacked = folder.path().join(&package);

    // Nothing of ours but itself, and what a stranger reads first is there.
    let manifest = fs::read_to_string(unpacked.join("Cargo.toml")).expect("it is packaged");
    assert!(!manifest.contains("vitrum-testkit") && !manifest.contains("path = \"../"), "{manifest}");
    for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "examples/glass_sphere.rs"] {
        assert!(unpacked.join(file).is_file(), "{file} is missing from the package");
    }

    // As a dependency of another program.
    let consumer = folder.path().join("consumer");
    fs::create_dir_all(consumer.join("src")).expect("the folder is ours");
    let manifest = format!(
        "[package]\nname = \"consumer\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[dependencies]\nvitrum-bxdf = {{ path = \"../{package}\" }}\n"
    );
    fs::write(consumer.join("Cargo.toml"), manifest).expect("the folder is ours");
    fs::write(consumer.join("src/main.rs"), MAIN).expect("the folder is ours");
    fs::copy(unpacked.join("Cargo.lock"), consumer.join("Cargo.lock")).expect("the package has a lock file");
    assert_eq!(run(cargo(&consumer, &target).args(["run", "--quiet"])), "0.040000\n");

    // Without the standard library.
    run(cargo(&unpacked, &target).args([
        "check",
        "--quiet",
        "--lib",
        "--no-default-features",
        "--features",
        "libm",
    ]));
}
