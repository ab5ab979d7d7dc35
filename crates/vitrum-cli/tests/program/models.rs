//! `vitrum render model.obj`: a scene is built around the model, and options say what it is made of.

use crate::workplace::{CUBE, Workplace, open_cube};

const SMALL: [&str; 5] = ["--size", "32x24", "--spp", "2", "-q"];

/// The linear pixels of a model, as bits.
fn pixels(place: &Workplace, model: &str, options: &[&str]) -> Vec<[u32; 3]> {
    place.succeed(&[&["render", model, "-o", "picture.exr"], &SMALL[..], options].concat());
    let picture = vitrum_io::image::read_exr(&place.path("picture.exr")).expect("an EXR picture");
    assert_eq!((picture.width, picture.height), (32, 24));
    assert!(picture.pixels.iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn what_the_model_is_made_of() {
    let place = Workplace::new();
    place.write("cube.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
    place.write("cube.obj", format!("mtllib cube.mtl\nusemtl red\n{CUBE}"));
    let of = |options: &[&str]| pixels(&place, "cube.obj", options);
    let glass = of(&[]);
    assert!(glass == of(&["--material", "glass"]) && glass == of(&["--ior", "1.5"]), "the defaults");
    let matte = of(&["--material", "matte"]);
    let red = of(&["--material", "file"]);
    let water = of(&["--ior", "1.33"]);
    assert!(glass != matte && glass != red && matte != red && glass != water);
    // The cube is in the middle of the picture: red more than green there, or grey.
    let middle = |pixels: &[[u32; 3]]| pixels[12 * 32 + 16].map(f32::from_bits);
    assert!(middle(&red)[0] > 2.0 * middle(&red)[1], "{:?}", middle(&red));
    assert!(middle(&matte)[0] < 1.1 * middle(&matte)[1], "{:?}", middle(&matte));
}

#[test]
fn how_the_model_is_shaded() {
    let place = Workplace::new();
    place.write("cube.obj", CUBE);
    // Upper case, as some programs write it.
    place.write("NORMALS.OBJ", normals_of_one_direction());
    let matte =
        |model: &str, normals: &str| pixels(&place, model, &["--material", "matte", "--normals", normals]);
    let (flat, smooth) = (matte("cube.obj", "flat"), matte("cube.obj", "smooth"));
    assert!(flat != smooth);
    assert!(smooth == pixels(&place, "cube.obj", &["--material", "matte"]), "smooth where the file has none");
    assert!(flat == matte("cube.obj", "file"), "flat where the file is asked for and has none");
    let own = pixels(&place, "NORMALS.OBJ", &["--material", "matte"]);
    assert!(
        own == matte("NORMALS.OBJ", "file") && own != smooth && own != flat,
        "the file's where it has some"
    );
    assert!(flat == matte("NORMALS.OBJ", "flat") && smooth == matte("NORMALS.OBJ", "smooth"));
}

/// The cube with the same normal everywhere, one that all sides in sight can have.
fn normals_of_one_direction() -> String {
    let faces = |line: &str| match line.strip_prefix("f ") {
        Some(corners) => {
            let corners: Vec<_> = corners.split(' ').map(|corner| format!("{corner}//1")).collect();
            format!("f {}\n", corners.join(" "))
        }
        None => format!("{line}\n"),
    };
    format!("vn 1 1 1\n{}", CUBE.lines().map(faces).collect::<String>())
}

/// A model keeps its look, whatever its unit is and wherever it stands.
#[test]
fn units_do_not_matter() {
    let place = Workplace::new();
    place.write("cube.obj", CUBE);
    let expected = pixels(&place, "cube.obj", &[]);
    for exponent in [-96_i32, -30, 40, 96] {
        let factor = 2_f64.powi(exponent);
        let line = |line: &str| match line.strip_prefix("v ") {
            Some(numbers) => {
                let scaled = numbers.split(' ').map(|n| n.parse::<f64>().expect("a number") * factor);
                format!("v {}\n", scaled.map(|n| format!("{n:e}")).collect::<Vec<_>>().join(" "))
            }
            None => format!("{line}\n"),
        };
        place.write("scaled.obj", CUBE.lines().map(line).collect::<String>());
        assert!(pixels(&place, "scaled.obj", &[]) == expected, "scaled by 2^{exponent}");
    }
}

#[test]
fn inspect_says_what_is_wrong_with_a_model() {
    let place = Workplace::new();
    place.write("cube.obj", CUBE);
    place.write("open.obj", open_cube());
    let closed = place.succeed(&["inspect", "cube.obj"]).stdout;
    assert!(closed.contains("cube.obj: 12 triangles, closed, volume 1.000000"), "{closed}");
    assert!(closed.contains("transparent ior 1.5") && !closed.contains("warning"), "{closed}");
    let open = place.succeed(&["inspect", "open.obj", "--ior", "1.33"]).stdout;
    for phrase in
        ["open.obj: 10 triangles, not closed", "found: 4 open edges (first at (", "ior 1.33", "warning: "]
    {
        assert!(open.contains(phrase), "{phrase}: {open}");
    }
    let matte = place.succeed(&["inspect", "open.obj", "--material", "matte"]).stdout;
    assert!(matte.contains("4 open edges") && !matte.contains("warning"), "matte needs no inside: {matte}");
}

/// An open model is rendered, and the gaps are said once.
#[test]
fn an_open_model_is_rendered_with_a_warning() {
    let place = Workplace::new();
    place.write("open.obj", open_cube());
    let outcome = place.succeed(&["render", "open.obj", "--size", "32x24", "--spp", "1"]);
    assert_eq!(outcome.stderr.matches("warning: ").count(), 1, "{}", outcome.stderr);
    assert!(outcome.stderr.starts_with("warning: open.obj does not enclose a volume"), "{}", outcome.stderr);
    assert_eq!(place.png_size("vitrum.png"), [32, 24]);
}

/// Faces before the first name, and groups of one name in several objects, are parts of their own.
#[test]
fn parts_that_share_a_name() {
    let place = Workplace::new();
    let faces = CUBE.split_once('f').map(|(_, faces)| format!("f{faces}")).expect("the cube has faces");
    place.write("parts.obj", format!("{CUBE}o 1\n{faces}o 2\ng lid\n{faces}o 3\ng lid\n{faces}"));
    let report = place.succeed(&["inspect", "parts.obj"]).stdout;
    assert!(report.contains("5 objects"), "{report}");
    // Which part is open is said.
    place.write("open.obj", format!("o whole\n{CUBE}o broken\n{}", faces.replace("f 4 1 5 8\n", "")));
    let report = place.succeed(&["inspect", "open.obj"]).stdout;
    assert!(report.contains("open.obj, part `broken`, does not enclose a volume"), "{report}");
    assert!(!report.contains("part `whole`"), "{report}");
    place.write("group.toml", crate::workplace::scene_of_mesh("parts.obj") + "group = \"lid\"\n");
    let report = place.succeed(&["inspect", "group.toml"]).stdout;
    assert!(report.contains("2 objects"), "{report}");
}

#[test]
fn explain_tells_the_rays_of_a_pixel() {
    let place = Workplace::new();
    place.write("cube.obj", CUBE);
    let told = place.succeed(&["explain", "cube.obj", "--size", "33x33", "--pixel", "16,16"]).stdout;
    for phrase in [
        "from the camera: weight 1, in air (1)",
        "beyond is index 1.5, eta 1.5: reflects 0.1, transmits 0.9",
        "\n    ",
    ] {
        assert!(told.contains(phrase), "{phrase}: {told}");
    }
    let short = place.succeed(&["explain", "cube.obj", "--pixel", "320,320", "--rays", "2"]).stdout;
    assert!(short.contains("... 2 rays told"), "{short}");
    let beyond = ["explain", "cube.obj", "--size", "33x33", "--pixel", "33,0"];
    place.refuse(&beyond, 2, &["--pixel 33,0 is not in the picture, whose pixels are 0,0 to 32,32"]);
    place.refuse(&["explain", "cube.obj", "--pixel", "5"], 2, &["expected a column and a row"]);
}

/// Walls that are flush, and walls that are not quite.
#[test]
fn inspect_says_how_near_solids_are() {
    let place = Workplace::new();
    let cuboid = |name: &str, low: f64, high: f64| {
        format!(
            "[[object]]\nname = \"{name}\"\nshape = \"box\"\nmin = [{low}, 0, 0]\nmax = [{high}, 1, 1]\n\
             material = {{ type = \"dielectric\", ior = 1.5 }}\n"
        )
    };
    let camera = "[camera]\ntype = \"pinhole\"\nposition = [0.5, 0.5, 0.5]\ntarget = [0, 0, 0]\nfov = 40\n";
    place.write("flush.toml", format!("{camera}{}{}", cuboid("a", 0.0, 1.0), cuboid("b", 1.0, 2.0)));
    let flush = place.succeed(&["inspect", "flush.toml"]).stdout;
    for phrase in ["inside `a`", "1 pair of solids may overlap", "`a` and `b`, flush on 16.7 % of the first"]
    {
        assert!(flush.contains(phrase), "{phrase}: {flush}");
    }
}
