//! What a scene does not need is not done: every feature of the plan, counted. And doing it all the same changes no bit.
//!
//! To a new feature belong a line of [`showing`], which the compiler asks for, and nothing else here.

use std::path::{Path, PathBuf};
use vitrum::io::load::{Loaded, scene_text};
use vitrum::tracer::{Feature, Integrator, NoSkip, Rendering, Settings, Uses, render};

/// A matte ball before a sky: needs nothing.
const BARE: &str = r#"
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
material = { type = "matte", color = 0.5 }
"#;

const POINT: &str = "[[light]]\ntype = \"point\"\nposition = [3, 4, 5]\nintensity = 50\n";
const FLAT_CUBE: &str = "[[object]]\nname = \"cube\"\nshape = \"mesh\"\nfile = \"cube.obj\"\nnormals = \"flat\"\n\
                         material = { type = \"matte\" }\ntransform = [{ translate = [-0.5, -1, 1] }]\n";

/// A ball of this material, in front of the other.
fn ball(material: &str) -> String {
    format!(
        "[[object]]\nname = \"ball in front\"\nshape = \"sphere\"\ncenter = [0.5, 0, 2]\nradius = 0.6\nmaterial = {{ {material} }}\n"
    )
}

/// A scene that needs a feature, and how it is followed.
fn showing(feature: Feature) -> (String, Integrator) {
    use Integrator::{Path, Whitted};
    let with = |more: &str| format!("{BARE}{more}");
    let textured = |texture: &str| {
        with(&format!(
            "{}[[texture]]\nname = \"pattern\"\n{texture}\n",
            ball("type = \"matte\", color = \"pattern\"")
        ))
    };
    match feature {
        Feature::Lights | Feature::ShadowRays => (with(POINT), Path),
        Feature::AmbientLight => (with("[[light]]\ntype = \"ambient\"\nradiance = 0.5\n"), Whitted),
        Feature::Refraction => (with(&ball("type = \"dielectric\", ior = 1.5")), Path),
        Feature::Absorption => (with(&ball("type = \"dielectric\", ior = 1.5, sigma_a = 2")), Path),
        Feature::NestedMedia => {
            let water = ball("type = \"dielectric\", inside = \"water\"").replace("ball in front", "drop");
            let drop = water.replace("radius = 0.6", "radius = 0.4").replace("[0.5, 0, 2]", "[0.8, 0.2, 2]");
            (with(&format!("{}{drop}", ball("type = \"dielectric\", ior = 1.5"))), Path)
        }
        Feature::ThinSheets => (with(&format!("{POINT}{}", ball("type = \"thin\", ior = 1.5"))), Path),
        Feature::Roughness => (with(&ball("type = \"dielectric\", ior = 1.5, roughness = 0.3")), Path),
        Feature::Mirrors => (with(&ball("type = \"conductor\", metal = \"gold\"")), Path),
        Feature::Textures => (textured("type = \"checker\"\neven = 0.2\nodd = 0.8\nsize = 0.1"), Path),
        Feature::Images => (textured("type = \"image\"\nfile = \"pattern.png\""), Path),
        Feature::Meshes => (with(FLAT_CUBE), Path),
        Feature::SmoothNormals => (with(&FLAT_CUBE.replace("flat", "smooth")), Path),
        Feature::ObjectTree => {
            let boxes = (-3..3).map(|i| {
                let (min, max) = (f64::from(i), f64::from(i) + 0.5);
                format!(
                    "[[object]]\nshape = \"box\"\nmin = [{min}, -1, 0]\nmax = [{max}, 1, 1]\nmaterial = {{ type = \"matte\" }}\n"
                )
            });
            (with(&boxes.collect::<String>()), Path)
        }
        Feature::Lens => (BARE.replace("\"pinhole\"", "\"thin-lens\"\nlens_radius = 0.1"), Path),
        Feature::StraightShadows => {
            let text = with(&format!("{POINT}{}", ball("type = \"dielectric\", ior = 1.5")));
            (format!("[render]\nintegrator = \"whitted\"\nshadow = \"straight\"\n{text}"), Whitted)
        }
    }
}

/// A folder with the files that these scenes name.
fn files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    std::fs::write(folder.path().join("cube.obj"), cube).expect("the folder is writable");
    let white = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/invalid/white.png");
    std::fs::copy(white, folder.path().join("pattern.png")).expect("the folder is writable");
    folder
}

fn load(text: &str, folder: &Path) -> Loaded {
    scene_text("a scene of this test", text, folder).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn rendered(loaded: &Loaded, integrator: Integrator, no_skip: NoSkip) -> Rendering {
    let settings = Settings { size: [32, 24], spp: 4, integrator, no_skip, threads: 1, ..loaded.settings };
    render(&loaded.scene, &settings, &()).expect("the settings are valid")
}

// Builds without debug assertions count nothing.
#[cfg(debug_assertions)]
#[test]
fn what_a_scene_does_not_need_runs_zero_times() {
    let folder = files();
    let bare = load(BARE, folder.path());
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let bare = rendered(&bare, integrator, NoSkip::default());
        for feature in Feature::ALL {
            assert!(!bare.plan.needs(feature), "{}", feature.name());
            assert_eq!(bare.stats.uses_of(feature), 0, "{} in a bare scene", feature.name());
        }
    }
    for feature in Feature::ALL {
        let (text, integrator) = showing(feature);
        let with = rendered(&load(&text, folder.path()), integrator, NoSkip::default());
        assert!(with.plan.needs(feature), "{}", feature.name());
        assert!(with.stats.uses_of(feature) > 0, "{} in a scene that shows it", feature.name());
        for other in Feature::ALL.into_iter().filter(|other| !with.plan.needs(*other)) {
            let uses = with.stats.uses_of(other);
            assert_eq!(uses, 0, "{} in the scene of {}", other.name(), feature.name());
        }
    }
}

/// What can be done without being needed: then it runs, and the picture is the same.
#[test]
fn doing_all_the_same_changes_no_bit() {
    let folder = files();
    for feature in Feature::ALL {
        let (text, integrator) = showing(feature);
        let loaded = load(&text, folder.path());
        let [skipping, doing] =
            [NoSkip::default(), NoSkip::ALL].map(|no_skip| rendered(&loaded, integrator, no_skip));
        assert_eq!(skipping.film.image(), doing.film.image(), "{}", feature.name());
        for done in [Feature::Absorption, Feature::NestedMedia, Feature::ObjectTree]
            .into_iter()
            .filter(|_| Uses::ARE_COUNTED)
        {
            assert!(doing.stats.uses_of(done) > 0, "{} in the scene of {}", done.name(), feature.name());
        }
    }
}

/// Each by itself, in a scene that does not need it.
#[cfg(debug_assertions)]
#[test]
fn each_can_be_made_to_run() {
    let folder = files();
    let none = NoSkip::default();
    let (point, _) = showing(Feature::Lights);
    let (glass, _) = showing(Feature::Refraction);
    let uses = |text: &str, integrator, no_skip, feature| {
        let rendering = rendered(&load(text, folder.path()), integrator, no_skip);
        let others =
            Feature::ALL.into_iter().filter(|other| *other != feature && !rendering.plan.needs(*other));
        for other in others {
            assert_eq!(rendering.stats.uses_of(other), 0, "{} with {no_skip:?}", other.name());
        }
        rendering.stats.uses_of(feature)
    };
    for (text, integrator, feature, no_skip) in [
        (BARE, Integrator::Path, Feature::Lights, NoSkip { lights: true, ..none }),
        (BARE, Integrator::Whitted, Feature::AmbientLight, NoSkip { ambient: true, ..none }),
        (BARE, Integrator::Path, Feature::Absorption, NoSkip { absorption: true, ..none }),
        (BARE, Integrator::Path, Feature::NestedMedia, NoSkip { nested_media: true, ..none }),
        (BARE, Integrator::Whitted, Feature::NestedMedia, NoSkip { nested_media: true, ..none }),
        (&point, Integrator::Path, Feature::ThinSheets, NoSkip { thin_sheets: true, ..none }),
        (BARE, Integrator::Path, Feature::ObjectTree, NoSkip { object_tree: true, ..none }),
    ] {
        assert_eq!(uses(text, integrator, none, feature), 0, "{}", feature.name());
        assert!(uses(text, integrator, no_skip, feature) > 0, "{}", feature.name());
    }
    // Camera rays of pixels that no object reaches are searched for, or not.
    let unsearched =
        |no_skip| rendered(&load(BARE, folder.path()), Integrator::Path, no_skip).stats.unsearched_rays;
    assert!(unsearched(none) > 0);
    assert_eq!(unsearched(NoSkip { outlines: true, ..none }), 0);
    // Rays inside a solid are asked of it first, or not.
    let inner = |no_skip| {
        rendered(&load(&glass, folder.path()), Integrator::Path, no_skip).stats.geometry.inner_searches
    };
    assert!(inner(none) > 0);
    assert_eq!(inner(NoSkip { solids: true, ..none }), 0);
}

/// Rays that are not followed because nothing would come of them: counted in builds of all kinds.
#[test]
fn single_rays_skip_what_they_can() {
    let folder = files();
    let stats = |material: &str, integrator| {
        let (sky, _) = BARE.split_once("[[object]]").expect("it has one object");
        rendered(&load(&format!("{sky}{}", ball(material)), folder.path()), integrator, NoSkip::default())
            .stats
    };
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let glass = stats("type = \"transparent\", ior = 1.5, kr = 0.1, kt = 0.9", integrator);
        assert!(glass.reflected_rays > 0 && glass.transmitted_rays > 0);
        // No ray follows a coefficient of zero. (Total reflection has one all the same, but not in a ball.)
        let clear = stats("type = \"transparent\", ior = 1.5, kr = 0.0, kt = 1.0", integrator);
        assert!(clear.transmitted_rays > 0);
        assert_eq!(clear.reflected_rays, 0, "kr = 0");
        let opaque = stats("type = \"transparent\", ior = 1.5, kr = 0.5, kt = 0.0", integrator);
        assert!(opaque.reflected_rays > 0);
        assert_eq!(opaque.transmitted_rays, 0, "kt = 0");
        // Where indices match nothing is reflected.
        let matched = stats("type = \"dielectric\", ior = 1.0, sigma_a = 1", integrator);
        assert!(matched.transmitted_rays > 0);
        assert_eq!(matched.reflected_rays, 0, "indices that match");
    }
}

/// A camera that looks past everything asks no tree of objects, however many there are.
#[test]
fn pixels_of_the_background_search_nothing() {
    let folder = files();
    let (text, integrator) = showing(Feature::ObjectTree);
    let away = text.replace("target = [0, 0, 0]", "target = [0, 0, 10]");
    let [seeing, past] =
        [&text, &away].map(|text| rendered(&load(text, folder.path()), integrator, NoSkip::default()).stats);
    assert!(seeing.unsearched_rays > 0 && seeing.unsearched_rays < seeing.camera_rays);
    assert_eq!((past.geometry.tree_searches, past.unsearched_rays), (0, past.camera_rays));
    if Uses::ARE_COUNTED {
        assert!(seeing.geometry.tree_searches > 0);
    }
    assert!(past.camera_rays > 0);
}
