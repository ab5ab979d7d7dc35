//! What the program says, where, and when it keeps quiet.

use crate::workplace::{SCENE, Workplace, scene_with};
use std::process::Stdio;

#[test]
fn without_arguments_it_renders_its_own_scene() {
    let place = Workplace::new();
    let inspected = place.succeed(&["inspect"]).stdout;
    let first = inspected.lines().next().expect("a report");
    let outcome = place.succeed(&["render"]);
    assert_eq!(place.names(), ["vitrum.png"]);
    let [width, height] = place.png_size("vitrum.png");
    assert!(first.starts_with(&format!("picture    {width} x {height}, ")), "{first}");
    assert_eq!(outcome.stdout, "");
    assert!(outcome.stderr.starts_with("wrote      vitrum.png ("), "{}", outcome.stderr);
    for row in ["time  ", "rays  ", "tree  ", "given up "] {
        assert!(outcome.stderr.lines().any(|line| line.starts_with(row)), "{row}: {}", outcome.stderr);
    }
}

/// Nobody looks at a progress line in a log file.
#[test]
fn there_is_no_progress_without_a_terminal() {
    let place = Workplace::with_scene();
    let outcome = place.succeed(&["render", "scene.toml", "--size", "256x256"]);
    assert!(!outcome.stderr.contains(['\r', '\u{1b}', '%']), "{:?}", outcome.stderr);
    assert!(outcome.stderr.starts_with("wrote"), "{}", outcome.stderr);
}

#[test]
fn quiet_is_quiet() {
    let place = Workplace::new();
    place.write("bright.toml", scene_with("ior = 1.5", "ior = 1.5, kr = 0.1, kt = 1"));
    let loud = place.succeed(&["render", "bright.toml"]);
    assert!(loud.stderr.starts_with("warning: this surface gives back more light"), "{}", loud.stderr);
    for quiet in ["-q", "--quiet"] {
        let outcome = place.succeed(&["render", "bright.toml", quiet]);
        assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""));
    }
    // Errors are said all the same.
    place.refuse(&["render", "no.toml", "-q"], 2, &["no such scene file"]);
}

#[test]
fn inspect_answers_and_writes_nothing() {
    let place = Workplace::with_scene();
    let names = place.names();
    let outcome = place.succeed(&["inspect", "scene.toml"]);
    assert_eq!(outcome.stderr, "");
    for phrase in
        ["picture    16 x 12, 2 samples per pixel", "1 object\n", "sphere, transparent ior 1.5", "\nplan\n"]
    {
        assert!(outcome.stdout.contains(phrase), "{phrase}: {}", outcome.stdout);
    }
    assert_eq!(place.names(), names);
}

#[test]
fn help_and_version() {
    let place = Workplace::new();
    let version = place.succeed(&["--version"]);
    assert_eq!(version.stdout, format!("vitrum {}\n", env!("CARGO_PKG_VERSION")));
    for arguments in [&["--help"][..], &["-h"], &["help"], &["render", "--help"], &["help", "inspect"]] {
        let outcome = place.succeed(arguments);
        assert!(outcome.stdout.contains("Usage: vitrum"), "{arguments:?}");
        assert_eq!(outcome.stderr, "");
    }
    assert!(place.names().is_empty());
}

/// Options of the command line take the place of the scene's; a crop has the bytes of the whole picture.
#[test]
fn options_take_the_place_of_the_scenes() {
    let place = Workplace::with_scene();
    let picture = |name: &str, options: &[&str]| {
        place.succeed(&[&["render", "scene.toml", "-q", "-o", name], options].concat());
        vitrum_io::image::read_exr(&place.path(name)).expect("an EXR picture")
    };
    let whole = picture("whole.exr", &["--size", "20x10", "--spp", "3", "--seed", "7", "--max-depth", "3"]);
    assert_eq!((whole.width, whole.height), (20, 10));
    for (key, value) in [("size", "20x10"), ("spp", "3"), ("seed", "7"), ("max_depth", "3")] {
        let pair = (format!("vitrum:{key}"), value.to_owned());
        assert!(whole.metadata.contains(&pair), "{pair:?}: {:?}", whole.metadata);
    }
    let options = ["--size", "20x10", "--spp", "3", "--seed", "7", "--max-depth", "3", "--crop", "5,2,9,6"];
    let part = picture("part.exr", &options);
    assert_eq!((part.width, part.height), (9, 6));
    for (y, row) in part.pixels.chunks(9).enumerate() {
        let start = (y + 2) * 20 + 5;
        let bits = |pixels: &[[f32; 3]]| pixels.iter().map(|p| p.map(f32::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(row), bits(&whole.pixels[start..start + 9]), "row {y}");
    }
}

/// The file as a whole, not only its pixels.
#[test]
fn files_are_the_same_whatever_renders_them() {
    let place = Workplace::with_scene();
    for name in ["picture.png", "picture.exr"] {
        let file = |options: &[&str]| {
            place.succeed(&[&["render", "scene.toml", "-q", "-o", name], options].concat());
            place.read(name)
        };
        let first = file(&["--threads", "1"]);
        for options in [&["--threads", "2"][..], &["--threads", "7", "--tile", "3"], &["--tile", "4096"], &[]]
        {
            assert!(file(options) == first, "{name} {options:?}");
        }
        assert!(file(&["--seed", "1"]) != first, "another seed is another picture");
    }
}

/// A picture is worth more than a message that nobody can read.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_takes_nothing_ends_nothing() {
    let place = Workplace::with_scene();
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("Linux has this device");
    let code = |arguments: &[&str], stdout: Stdio, stderr: Stdio| {
        place.command(arguments).stdout(stdout).stderr(stderr).status().expect("the program starts").code()
    };
    assert_eq!(code(&["render", "scene.toml"], full().into(), full().into()), Some(0));
    assert_eq!(place.png_size("vitrum.png"), [16, 12]);
    assert_eq!(code(&["render", "no.toml"], Stdio::null(), full().into()), Some(2));
    // An answer that can't be given is a failure; unless the one who asked has turned away, as `head` does.
    assert_eq!(code(&["inspect", "scene.toml"], full().into(), Stdio::null()), Some(1));
    let mut asked = place.command(&["inspect", "scene.toml"]);
    let mut child = asked.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

/// A scene may come through a pipe.
#[cfg(unix)]
#[test]
fn a_scene_through_a_pipe() {
    use std::io::Write;
    let place = Workplace::new();
    let mut command = place.command(&["render", "/dev/stdin", "-q"]);
    let mut child = command.stdin(Stdio::piped()).spawn().expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(SCENE.as_bytes()).expect("the program reads");
    assert!(child.wait().expect("the program ends").success());
    assert_eq!(place.png_size("vitrum.png"), [16, 12]);
}
