//! Every scene that comes with the program loads; and what only building a scene can find wrong is told, never passed over.

use std::fs;
use std::path::{Path, PathBuf};
use vitrum_io::diagnostic::Span;
use vitrum_io::load::{self, Loaded};
use vitrum_io::scene::{self, ColourOrTexture, Material, MaterialChoice, Model, Name, SceneDesc, Shape};
use vitrum_materials::Metal;

/// All scenes of a folder of the repository, sorted.
fn scenes(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(folder);
    let entries = fs::read_dir(&folder).expect("the repository has this folder");
    let paths = entries.map(|entry| entry.expect("readable").path());
    let mut scenes: Vec<_> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    scenes.sort();
    scenes
}

#[test]
fn every_scene_of_ours_loads() {
    let mut problems = Vec::new();
    for folder in [".", "gallery"] {
        let scenes = scenes(folder);
        assert!(!scenes.is_empty(), "scenes/{folder} has no scenes");
        for path in scenes {
            match load::scene_file(&path, load::SceneOptions::default()) {
                Ok(Loaded { scene, .. }) if scene.names().is_empty() => {
                    problems.push(format!("{}: there is nothing to see", path.display()));
                }
                Ok(_) => {}
                Err(error) => problems.push(error.to_string()),
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

const TWO_BALLS: &str = r#"
[camera]
type = "pinhole"
position = [0, 0, 5]
target = [0, 0, 0]
fov = 40

[[material]]
name = "glass"
type = "transparent"
ior = 1.5

[[object]]
name = "ball"
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "glass"

[[object]]
name = "other ball"
shape = "instance"
of = "ball"
transform = [{ translate = [3, 0, 0] }]
"#;

/// A description built in code can say what no file can.
#[test]
fn descriptions_that_refer_to_nothing_are_refused() {
    let desc = || scene::parse("balls.toml", TWO_BALLS).0.expect("a good scene");
    let said = |change: fn(&mut SceneDesc)| {
        let mut desc = desc();
        change(&mut desc);
        load::description(&desc, Path::new("")).expect_err("refused").to_string()
    };
    let loaded = load::description(&desc(), Path::new("")).expect("unchanged, it is good");
    assert_eq!(loaded.scene.names(), ["ball", "other ball"]);

    let unknown = said(|desc| desc.objects[1].shape = Shape::Instance { of: Name::new("bell") });
    assert!(unknown.contains("there is no object `bell` with a shape of its own"), "{unknown}");
    let itself = said(|desc| desc.objects[0].shape = Shape::Instance { of: Name::new("ball") });
    assert!(itself.contains("there is no object `ball` with a shape of its own"), "{itself}");
    let material = said(|desc| desc.objects[0].material = Some(MaterialChoice::Named(Name::new("gloss"))));
    assert!(material.contains("there is no material `gloss`"), "{material}");
    let none = said(|desc| desc.objects[0].material = None);
    assert!(none.contains("the object has no material"), "{none}");
    let surroundings = said(|desc| desc.surroundings = Name::new("wine"));
    assert!(surroundings.contains("there is no medium `wine`"), "{surroundings}");
    let texture = said(|desc| {
        let color = ColourOrTexture::Texture(Name::new("tiles"));
        let model = Model::Matte { color, ka: 1.0, kd: 1.0 };
        let material = Material { span: Span::default(), name: None, model };
        desc.objects[0].material = Some(MaterialChoice::Inline(Box::new(material)));
    });
    assert!(texture.contains("there is no texture `tiles`"), "{texture}");
    let twice = said(|desc| desc.objects[1].name = Some(Name::new("ball")));
    assert!(twice.contains("two objects are named `ball`"), "{twice}");
}

#[test]
fn scenes_named_by_a_missing_file_or_folder_say_so() {
    let said = |path: &Path| {
        load::scene_file(path, load::SceneOptions::default()).expect_err("there is no scene").to_string()
    };
    assert!(said(Path::new("no/such.toml")).contains("no/such.toml: there is no such scene file"));
    assert!(said(Path::new(env!("CARGO_MANIFEST_DIR"))).contains("is a folder, expected a scene file"));
}

/// Lights of no power are left out, and that is said with their place.
#[test]
fn lights_without_power_are_said() {
    let dark = r#"
[[light]]
type = "point"
position = [0, 5, 0]
intensity = 0

[[object]]
shape = "sphere"
center = [0, 3, 0]
radius = 0.5
material = { type = "emissive", radiance = 0 }
"#;
    let text = format!("{TWO_BALLS}{dark}");
    let loaded = load::scene_text("dark.toml", &text, Path::new("")).expect("only warnings");
    assert!(loaded.scene.lights.is_empty());
    let said = loaded.warnings.to_string();
    for part in
        ["a light without power is left out", "an emissive object without power lights nothing", "dark.toml:"]
    {
        assert!(said.contains(part), "{said}");
    }
}

/// A point light in glass is said, and only where glass is all around it and keeps its light in.
#[test]
fn lights_inside_glass_are_said() {
    let with = |light: &str, glass: &str| {
        let text = format!(
            "[render]\nintegrator = \"path\"\n\
             [camera]\ntype = \"pinhole\"\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\nfov = 40\n\
             [[object]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n\
             material = {{ type = \"dielectric\", ior = 1.5{glass} }}\n\
             [[light]]\ntype = \"point\"\nintensity = 1\n{light}\n"
        );
        load::scene_text("lamp.toml", &text, Path::new("")).expect("only warnings").warnings.to_string()
    };
    let said = with("position = [0.3, 0.2, 0]", "");
    assert!(said.contains("a light inside the glass of `ball` lights nothing outside of it"), "{said}");
    assert!(said.contains("lamp.toml:") && said.contains("emissive"), "{said}");
    for (light, glass) in [
        ("position = [0, 1.1, 0]", ""),
        ("position = [0.3, 0.2, 0]\nshadows = false", ""),
        ("position = [0.3, 0.2, 0]", ", roughness = 0.2"),
    ] {
        assert_eq!(with(light, glass), "", "{light}{glass}");
    }
}

/// A metal's name stands for its n and k.
#[test]
fn a_named_metal_is_its_index() {
    let of = |index: &str| {
        let text = format!(
            "[camera]\ntype = \"pinhole\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40\n\
             [[object]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\n\
             material = {{ type = \"conductor\", {index}, roughness = 0.2 }}\n"
        );
        let loaded = load::scene_text("metal.toml", &text, Path::new(".")).expect("a valid scene");
        loaded.scene.materials()[0].clone()
    };
    for metal in Metal::all() {
        let index = format!("n = {:?}, k = {:?}", metal.n().to_array(), metal.k().to_array());
        assert_eq!(of(&format!("metal = \"{}\"", metal.name())), of(&index));
    }
}
