//! A folder of its own for each test, and the program run in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A scene that renders at once: a glass ball before a white sky, 16 x 12 pixels.
pub(crate) const SCENE: &str = r#"
[render]
size = [16, 12]
spp = 2

[camera]
type = "pinhole"
position = [0, 0, 5]
target = [0, 0, 0]
fov = 40

[background]
type = "constant"
color = 1

[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = { type = "transparent", ior = 1.5 }
"#;

/// [`SCENE`] with one of its lines changed.
pub(crate) fn scene_with(line: &str, instead: &str) -> String {
    assert!(SCENE.contains(line), "the scene has no `{line}`");
    SCENE.replace(line, instead)
}

/// [`SCENE`] with a mesh instead of the ball.
pub(crate) fn scene_of_mesh(file: &str) -> String {
    let (before, _) = SCENE.split_once("shape = ").expect("the scene has an object");
    format!(
        "{before}shape = \"mesh\"\nfile = \"{file}\"\nmaterial = {{ type = \"transparent\", ior = 1.5 }}\n"
    )
}

/// A cube, its faces outwards.
pub(crate) const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// [`CUBE`] without its last face.
pub(crate) fn open_cube() -> String {
    CUBE.replace("f 4 1 5 8\n", "")
}

/// How a run of the program ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// The exit code; none when a signal ended it.
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// A folder that goes away with this value.
pub(crate) struct Workplace {
    folder: TempDir,
}

impl Workplace {
    /// An empty one.
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    /// One with [`SCENE`] as `scene.toml`.
    pub(crate) fn with_scene() -> Self {
        let place = Self::new();
        place.write("scene.toml", SCENE);
        place
    }

    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("the folder is writable");
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of all that is in the folder, hidden files too, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder is there");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// The program, about to be run in the folder, without a terminal.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vitrum"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    /// Runs the program to its end.
    pub(crate) fn run(&self, arguments: &[&str]) -> Outcome {
        outcome(self.command(arguments))
    }

    /// Runs the program to its end, which must be a good one.
    pub(crate) fn succeed(&self, arguments: &[&str]) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
        outcome
    }

    /// Runs the program where it must fail with `code`, saying all `phrases` and nothing else than an error; the folder
    /// stays as it was. Gives back what it said.
    pub(crate) fn refuse(&self, arguments: &[&str], code: i32, phrases: &[&str]) -> String {
        let before = self.contents();
        let Outcome { code: found, stdout, stderr } = self.run(arguments);
        assert_eq!(found, Some(code), "{arguments:?}: {stderr}");
        assert_eq!(stdout, "", "{arguments:?}");
        assert!(stderr.starts_with("error: ") && stderr.ends_with('\n'), "{arguments:?}: {stderr}");
        for phrase in phrases {
            assert!(stderr.contains(phrase), "{arguments:?} does not say `{phrase}`:\n{stderr}");
        }
        assert!(self.contents() == before, "{arguments:?} changed the folder: {:?}", self.names());
        stderr
    }

    /// Every name, with the bytes where it is a file that can be read.
    fn contents(&self) -> Vec<(String, Option<Vec<u8>>)> {
        let bytes = |name: &String| {
            let path = self.path(name);
            fs::metadata(&path).is_ok_and(|m| m.is_file()).then(|| fs::read(path).ok()).flatten()
        };
        self.names().into_iter().map(|name| (name.clone(), bytes(&name))).collect()
    }

    /// Width and height of a PNG, which must be complete.
    pub(crate) fn png_size(&self, name: &str) -> [u32; 2] {
        let picture = image::load_from_memory(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        [picture.width(), picture.height()]
    }
}

/// Runs a command to its end.
pub(crate) fn outcome(mut command: Command) -> Outcome {
    let output = command.output().expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program speaks UTF-8");
    Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}
