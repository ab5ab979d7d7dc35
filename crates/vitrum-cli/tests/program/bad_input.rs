//! What can't be rendered is refused with exit code 2, by its name and place, with what was found and what to do; and the
//! picture that was there before stays as it was.

use crate::workplace::{CUBE, SCENE, Workplace, open_cube, scene_of_mesh, scene_with};

/// A folder with an older picture, which every refusal must leave alone.
fn place() -> Workplace {
    let place = Workplace::with_scene();
    place.write("picture.png", "the old picture");
    place
}

fn refuse(place: &Workplace, input: &str, phrases: &[&str]) -> String {
    place.refuse(&["inspect", input], 2, phrases);
    place.refuse(&["render", input, "-o", "picture.png"], 2, phrases)
}

#[test]
fn what_is_not_there() {
    let place = place();
    refuse(&place, "no.toml", &["no.toml: there is no such scene file; check the path"]);
    refuse(&place, "no/scene.toml", &["no/scene.toml: there is no such scene file"]);
    refuse(&place, "no.obj", &["no.obj: there is no such file; check the path"]);
    refuse(&place, "scene.toml/scene.toml", &["scene.toml/scene.toml: cannot be read"]);
}

#[test]
fn what_is_a_folder() {
    let place = place();
    for name in ["folder.toml", "folder.obj", "folder"] {
        std::fs::create_dir(place.path(name)).expect("a new name");
        refuse(&place, name, &[name, "a folder, expected", ".obj"]);
    }
}

#[cfg(unix)]
#[test]
fn what_cannot_be_read() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = place();
    for name in ["loop.toml", "loop.obj"] {
        symlink(name, place.path(name)).expect("a new name");
        refuse(&place, name, &[&format!("{name}: "), "cannot be read"]);
    }
    for (name, content) in [("locked.toml", SCENE), ("locked.obj", CUBE)] {
        place.write(name, content);
        std::fs::set_permissions(place.path(name), std::fs::Permissions::from_mode(0o000)).expect("own file");
        if std::fs::read(place.path(name)).is_err() {
            refuse(&place, name, &[name, "cannot be read", "check its permissions"]);
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn what_never_ends() {
    refuse(&place(), "/dev/zero", &["/dev/zero: a scene file may have 16777216 bytes, this one has more"]);
}

#[test]
fn what_is_of_another_kind() {
    let place = place();
    place.write("model.stl", "solid cube\n");
    refuse(&place, "model.stl", &["model.stl: found the extension .stl, expected .toml", "or .obj", "OBJ"]);
    place.write("model.toml", CUBE);
    refuse(&place, "model.toml", &["error: not valid TOML", "--> model.toml:1:3"]);
    place.write("scene.obj", SCENE);
    refuse(&place, "scene.obj", &["scene.obj: there are no faces to render"]);
    for command in ["render", "inspect"] {
        let message = place.refuse(&[command, "scene.toml", "--ior", "1.3"], 2, &["--ior", "models (.obj)"]);
        assert!(message.contains("a scene says so itself"), "{message}");
    }
}

#[test]
fn text_that_is_not_utf8() {
    let place = place();
    place.write("latin.toml", b"[camera]\n# caf\xe9\n");
    refuse(
        &place,
        "latin.toml",
        &[
            "latin.toml: line 2, column 6: found the byte 0xe9, expected text in UTF-8; save the file as UTF-8",
        ],
    );
    place.write("utf16.toml", b"\xff\xfe[\0c\0a\0m\0e\0r\0a\0]\0");
    refuse(&place, "utf16.toml", &["line 1, column 1: found the byte 0xff"]);
}

#[test]
fn what_is_empty() {
    let place = place();
    place.write("empty.toml", "");
    refuse(&place, "empty.toml", &["`camera` is missing", "--> empty.toml", "add a table [camera]"]);
    place.write("empty.obj", "");
    refuse(&place, "empty.obj", &["empty.obj: the file is empty, expected vertices and faces"]);
    place.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    refuse(&place, "points.obj", &["points.obj: there are no faces to render (vertices: 3,", "export"]);
    place.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    refuse(&place, "flat.obj", &["flat.obj: the mesh has no triangle with an area"]);
    place.write("dot.obj", "v 1 1 1\nf 1 1 1\n");
    refuse(&place, "dot.obj", &["dot.obj: the mesh has no triangle with an area"]);
    for name in ["empty.obj", "points.obj", "flat.obj"] {
        place.write("mesh.toml", scene_of_mesh(name));
        refuse(&place, "mesh.toml", &[name, "--> mesh.toml:18:8", "^ this file"]);
    }
}

#[test]
fn numbers_of_a_mesh_that_are_none() {
    let place = place();
    for (number, said) in [("nan", "nan"), ("inf", "inf"), ("1e999", "1e999")] {
        place.write("model.obj", CUBE.replace("v 1 0 0", &format!("v {number} 0 0")));
        refuse(
            &place,
            "model.obj",
            &["model.obj:2: vertices that are not finite: 1", said, "repair the model"],
        );
        place.write("mesh.toml", scene_of_mesh("model.obj"));
        refuse(&place, "mesh.toml", &["model.obj:2:", "--> mesh.toml:18:8", said]);
    }
    place.write("model.obj", CUBE.replace("v 1 0 0", "v one 0 0"));
    refuse(&place, "model.obj", &["model.obj:2: found `one`, expected"]);
    place.write("model.obj", CUBE.replace("f 4 3 2 1", "f 4 3 2 9"));
    refuse(&place, "model.obj", &["model.obj:9: a face names vertex 9, but the vertices end at 8"]);
}

/// A scene is built around a model of any size that can be squared and cubed.
#[test]
fn models_beyond_all_measure() {
    let place = place();
    let scaled = |factor: &str| format!("v 0 0 0\nv {factor} 0 0\nv 0 {factor} 0\nf 1 2 3\n");
    place.write("huge.obj", scaled("1e200"));
    refuse(&place, "huge.obj", &["huge.obj: a vertex has the coordinate 1e200", "scale the model down"]);
    place.write("tiny.obj", scaled("1e-200"));
    refuse(&place, "tiny.obj", &["tiny.obj: the model is 1e-200 across", "scale the model up"]);
}

#[test]
fn a_missing_mesh_is_shown_in_the_scene() {
    let place = place();
    place.write("mesh.toml", scene_of_mesh("meshes/no.obj"));
    let message = refuse(&place, "mesh.toml", &[]);
    let expected = r#"error: meshes/no.obj: there is no such file
  --> mesh.toml:18:8
   |
18 | file = "meshes/no.obj"
   |        ^^^^^^^^^^^^^^^ this file
   |
   = help: paths are relative to the folder of the scene file
"#;
    assert_eq!(message, expected);
    // From the folder of the scene, not from where the program is.
    std::fs::create_dir(place.path("scenes")).expect("a new name");
    place.write("cube.obj", CUBE);
    place.write("scenes/mesh.toml", scene_of_mesh("../cube.obj"));
    place.succeed(&["inspect", "scenes/mesh.toml"]);
    place.write("scenes/mesh.toml", scene_of_mesh("cube.obj"));
    refuse(&place, "scenes/mesh.toml", &["scenes/cube.obj: there is no such file"]);
}

#[test]
fn glass_without_an_inside() {
    let place = place();
    place.write("open.obj", open_cube());
    place.write("mesh.toml", scene_of_mesh("open.obj"));
    let phrases = ["open.obj does not enclose a volume", "4 open edges", "mesh.toml:18:8", "`force = true`"];
    refuse(&place, "mesh.toml", &phrases);
}

/// One wrong line each: the line that takes the place of a right one, and what is said about it.
#[test]
fn one_wrong_line() {
    let place = place();
    let cases: [(&str, &str, &[&str]); 15] = [
        ("size = [16, 12]", "size = [0, 12]", &["`size`", ":3:9", "found 0"]),
        ("size = [16, 12]", "size = [16, 99999]", &["`size`", ":3:13", "65536"]),
        ("size = [16, 12]", "size = [20000, 20000]", &["the picture is too large", ":3:8", "2^28"]),
        ("spp = 2", "spp = 0", &["`spp`", ":4:7", "found 0", "samples per pixel"]),
        ("spp = 2", "spp = 2.5", &["`spp`", ":4:7", "integer"]),
        ("spp = 2", "ssp = 2", &["unknown key `ssp`", ":4:1", "did you mean `spp`?"]),
        ("radius = 1", "radius = -1", &["`radius`", ":19:10", "found -1", "1e-12 to 1e12 m"]),
        ("radius = 1", "radius = 0", &["`radius`", ":19:10", "found 0"]),
        ("radius = 1", "radius = \"1\"", &["`radius`", ":19:10", "number"]),
        ("radius = 1", "radius = nan", &["`radius`", ":19:10", "nan"]),
        ("radius = 1", "", &["`radius` is missing", "expected `radius`"]),
        (
            "target = [0, 0, 0]",
            "target = [0, 0, 5]",
            &["the camera stands at its target", ":9:10", "move either"],
        ),
        ("fov = 40", "fov = 180", &["`fov`", ":10:7", "less than 180"]),
        (
            "radius = 1",
            "radius = 1\ntransform = [{ scale = [1, 0, 1] }]",
            &["`scale` is singular", ":20:24", "found [1, 0, 1]"],
        ),
        (
            "shape = \"sphere\"",
            "shape = \"spere\"",
            &["unknown `shape`", ":17:9", "did you mean \"sphere\"?"],
        ),
    ];
    for (right, wrong, phrases) in cases {
        place.write("wrong.toml", scene_with(right, wrong));
        refuse(&place, "wrong.toml", &[&["wrong.toml"], phrases].concat());
    }
}

/// Each step can be undone, all together can't: their product leaves the numbers.
#[test]
fn steps_that_are_singular_together() {
    let place = place();
    let steps = vec!["{ scale = 1e-12 }"; 30].join(", ");
    place.write("flat.toml", scene_with("radius = 1", &format!("radius = 1\ntransform = [{steps}]")));
    refuse(&place, "flat.toml", &["the transform is singular", "flat.toml:20:13", "these steps together"]);
}

/// All problems are told at once, whether reading the file finds them or building the scene.
#[test]
fn several_problems_in_one_go() {
    let place = place();
    let wrong = scene_with("spp = 2", "ssp = 2")
        .replace("fov = 40", "fov = 0")
        .replace("radius = 1", "radius = -1")
        .replace("ior = 1.5", "ior = \"glass\"");
    place.write("wrong.toml", wrong);
    let message = refuse(&place, "wrong.toml", &["`ssp`", "`fov`", "`radius`", "`ior`"]);
    assert_eq!(message.matches("error: ").count(), 4, "{message}");

    place.write("open.obj", open_cube());
    let (scene, object) = SCENE.split_once("[[object]]").expect("the scene has an object");
    let mesh = |file: &str| {
        format!(
            "[[object]]\nshape = \"mesh\"\nfile = \"{file}\"\nmaterial = {{ type = \"transparent\", ior = 1.5 }}\n"
        )
    };
    let steps = vec!["{ scale = 1e-12 }"; 30].join(", ");
    let wrong =
        [scene, &mesh("no.obj"), &mesh("open.obj"), "[[object]]", object, "transform = [", &steps, "]\n"];
    place.write("wrong.toml", wrong.concat());
    let message = refuse(&place, "wrong.toml", &["no such file", "not enclose a volume", "singular"]);
    assert_eq!(message.matches("error: ").count(), 3, "{message}");
}

#[test]
fn options_out_of_range() {
    let place = place();
    let cases: [(&[&str], &str); 15] = [
        (&["--size", "0x12"], "expected width and height in pixels, 1 to 65536 each"),
        (&["--size", "16"], "such as 640x480"),
        (&["--size", "65536x65536"], "2^28"),
        (&["--spp", "0"], "expected a whole number from 1 to 1000000"),
        (&["--spp", "-1"], "invalid value '-1' for '--spp <N>'"),
        (&["--spp", "1.5"], "invalid value '1.5' for '--spp <N>'"),
        (&["--max-depth", "1001"], "expected a whole number from 0 to 1000"),
        (&["--cutoff", "nan"], "expected a number from 0 to 1"),
        (&["--cutoff", "-0.1"], "expected a number from 0 to 1"),
        (&["--seed", "-1"], "expected a whole number from 0 to 18446744073709551615"),
        (&["--threads", "100000"], "expected a whole number from 0 to 1024"),
        (&["--tile", "0"], "expected a whole number from 1 to 4096"),
        (&["--crop", "0,0,0,1"], "expected four whole numbers, left,top,width,height"),
        (&["--crop", "10,10,10,10"], "--crop 10,10,10,10 reaches beyond the picture of 16 x 12 pixels"),
        (&["--crop", "4294967295,0,4294967295,1"], "reaches beyond the picture"),
    ];
    for (options, phrase) in cases {
        place.refuse(&[&["render", "scene.toml", "-o", "picture.png"], options].concat(), 2, &[phrase]);
    }
    place.write("cube.obj", CUBE);
    let model = ["render", "cube.obj", "-o", "picture.png"];
    let cases: [(&[&str], &str); 5] = [
        (&["--ior", "0"], "expected a number from 0.001 to 1000"),
        (&["--ior", "-1.5"], "expected a number from 0.001 to 1000"),
        (&["--ior", "2", "--material", "matte"], "--ior is the index of refraction of --material glass"),
        (&["--material", "wood"], "glass, matte, file"),
        (&["--normals", "round"], "smooth, flat, file"),
    ];
    for (options, phrase) in cases {
        place.refuse(&[&model, options].concat(), 2, &[phrase]);
    }
}

#[test]
fn commands_that_there_are_not() {
    let place = place();
    place.refuse(&["rendr", "scene.toml"], 2, &["unrecognized subcommand 'rendr'", "'render'"]);
    place.refuse(&["scene.toml"], 2, &["tip: to render it: vitrum render scene.toml"]);
    place.refuse(&["render", "scene.toml", "--sise", "8x8"], 2, &["'--sise'", "'--size'"]);
    place.refuse(&["render", "scene.toml", "scene.toml"], 2, &["unexpected argument"]);
    let nothing = place.run(&[]);
    assert_eq!((nothing.code, nothing.stdout.as_str()), (Some(2), ""));
    assert!(nothing.stderr.contains("Usage: vitrum <COMMAND>"), "{}", nothing.stderr);
}
