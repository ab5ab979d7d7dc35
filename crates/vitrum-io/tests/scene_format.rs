//! The scene format: what a file says arrives in the description, the page tells the truth, and no text breaks the
//! reader.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use vitrum_io::diagnostic::{Diagnostics, Severity, Span};
use vitrum_io::scene::schema::{self, Default as KeyDefault, Kind, TABLES};
use vitrum_io::scene::{self, *};
use vitrum_materials::NamedMedium;
use vitrum_math::{DVec3, Rgb};

const CAMERA: &str = "[camera]\ntype = \"pinhole\"\nposition = [0, 1, 5]\ntarget = [0, 0, 0]\nfov = 40\n";

fn page_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-format.md")
}

fn page() -> String {
    fs::read_to_string(page_path()).expect("the format page can be read")
}

/// The scene of a text without problems.
fn scene_of(text: &str) -> SceneDesc {
    let (scene, problems) = scene::parse("test.toml", text);
    assert!(problems.is_empty(), "{problems}");
    scene.expect("no problems, so a scene")
}

/// The only object of a text that has a camera beside it.
fn object_of(text: &str) -> Object {
    scene_of(&format!("{CAMERA}[[object]]\n{text}")).objects.remove(0)
}

#[test]
fn the_tables_of_the_page_are_those_of_the_schema() {
    const START: &str = "<!-- schema: ";
    const END: &str = "<!-- end of schema -->";
    let page = page();
    let mut parts = page.split(START);
    let mut fresh = parts.next().expect("split has a first part").to_string();
    let mut found = Vec::new();
    for part in parts {
        let (id, rest) = part.split_once(" -->").expect("a marker is closed");
        let (_, after) = rest.split_once(END).expect("a block is ended");
        let table = TABLES.iter().find(|table| table.id == id);
        let table = table.unwrap_or_else(|| panic!("the page shows `{id}`, which the schema does not have"));
        fresh += &format!("{START}{id} -->\n{}{END}{after}", schema::markdown(table));
        found.push(id);
    }
    let all: Vec<&str> = TABLES.iter().map(|table| table.id).collect();
    assert_eq!(found, all, "the page shows each table once, in the order of the schema");
    if vitrum_testkit::blessing() {
        fs::write(page_path(), &fresh).expect("the format page can be written");
    }
    assert!(
        vitrum_testkit::blessing() || page == fresh,
        "docs/scene-format.md is behind: VITRUM_BLESS=1 rewrites it"
    );
}

#[test]
fn every_link_of_the_page_has_its_heading() {
    let page = page();
    let headings: BTreeSet<String> = page
        .lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| {
            line.trim_start_matches('#').trim().to_lowercase().replace(['`', '[', ']'], "").replace(' ', "-")
        })
        .collect();
    for link in page.split("](#").skip(1) {
        let anchor = link.split(')').next().unwrap_or_default();
        assert!(headings.contains(anchor), "no heading for #{anchor} among {headings:?}");
    }
}

#[test]
fn every_example_of_the_page_is_a_scene() {
    let page = page();
    let examples: Vec<&str> =
        page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect();
    assert!(examples.len() >= 4, "only {} examples found", examples.len());
    examples.into_iter().for_each(|example| drop(scene_of(example)));
}

#[test]
fn a_default_is_what_its_text_says_when_written_out() {
    // Each table by its required keys alone, and again with every default written: the same description.
    let sample = |key: &schema::Key| match (key.name, key.kind) {
        ("position" | "bottom" | "min", Kind::Point) => "[1, 2, 3]",
        ("name", _) => "\"it\"",
        ("of", _) => "\"ball\"",
        (_, Kind::Number) => "0.5",
        (_, Kind::Point) => "[4, 5, 7]",
        ("edge_v", _) => "[3, 2, 1]",
        (_, Kind::Vector) => "[1, 2, 3]",
        (_, Kind::Colour | Kind::ColourOrTexture) => "[0.1, 0.2, 0.3]",
        (_, Kind::File) => "\"a.obj\"",
        (_, Kind::Material) => "{ type = \"matte\" }",
        (name, kind) => panic!("no sample for {name}: {kind:?}"),
    };
    for top in schema::ROOT.keys {
        let (Kind::Table(table) | Kind::Tables(table)) = top.kind else { continue };
        let variants: Vec<Option<&'static schema::Variant>> =
            if table.choice.is_none() { vec![None] } else { table.variants().iter().map(Some).collect() };
        for variant in variants {
            let camera = if table.id == "camera" { "" } else { CAMERA };
            let ball = "[[object]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = 0\nradius = 1\n"
                .replace("center = 0", "center = [0, 0, 0]\nmaterial = { type = \"matte\" }");
            let mut short = format!("{ball}{camera}{}\n", table.header);
            if let (Some(choice), Some(variant)) = (&table.choice, variant) {
                short += &format!("{} = \"{}\"\n", choice.key, variant.name);
            }
            for key in table.keys_with(variant).filter(|key| matches!(key.default, KeyDefault::Required)) {
                short += &format!("{} = {}\n", key.name, sample(key));
            }
            if variant.is_some_and(|variant| variant.name == "dielectric") {
                // One of three keys is required.
                short += "ior = 1.5\n";
            }
            if variant.is_some_and(|variant| variant.name == "conductor") {
                // Either this, or two others.
                short += "metal = \"gold\"\n";
            }
            let mut long = short.clone();
            for key in table.keys_with(variant) {
                if let KeyDefault::Toml(text) = key.default {
                    long += &format!("{} = {text}\n", key.name);
                }
            }
            let mut written = scene_of(&long);
            if table.id == "surroundings" {
                assert_eq!(written.surroundings.text, "air");
                written.surroundings.span = Span::default();
            }
            assert_eq!(scene_of(&short), written, "{long}");
        }
    }
}

#[test]
fn settings_arrive() {
    let scene = scene_of(&format!(
        "version = 1\n[render]\nsize = [0x10, 1_000]\nspp = 4\nmax_depth = 0\ncutoff = 0\n\
         seed = 18446744073709551615\nintegrator = \"whitted\"\nshadow = \"straight\"\n[output]\nexposure = -1\ntone = \"neutral\"\n{CAMERA}"
    ));
    let render = Render {
        size: [16, 1000],
        spp: 4,
        max_depth: Some(0),
        cutoff: 0.0,
        filter: Filter::Box,
        seed: u64::MAX,
        integrator: Some(Integrator::Whitted),
        branching: Branching::Auto,
        shadow: Shadow::Straight,
    };
    assert_eq!(scene.render, render);
    assert_eq!(scene.output, Output { exposure: -1.0, tone: Tone::Neutral });
}

#[test]
fn defaults_in_code_are_those_of_a_file_that_says_nothing() {
    let scene = scene_of(CAMERA);
    assert_eq!(scene, SceneDesc::new(scene.camera.clone()));
    assert_eq!((scene.render.size, scene.render.spp, scene.render.max_depth), ([640, 480], 16, None));
}

#[test]
fn a_camera_focuses_on_its_target_unless_told_otherwise() {
    let lens = |more: &str| {
        let camera = CAMERA.replace("pinhole", "thin-lens");
        scene_of(&format!("{camera}lens_radius = 0.1\n{more}")).camera.lens
    };
    let distance = 26f64.sqrt();
    assert_eq!(lens(""), Lens::Thin { fov: 40.0, radius: 0.1, focus_distance: distance });
    assert_eq!(lens("focus_distance = 3"), Lens::Thin { fov: 40.0, radius: 0.1, focus_distance: 3.0 });
}

#[test]
fn matter_and_light_arrive() {
    let scene = scene_of(&format!(
        "{CAMERA}\
         [surroundings]\nmedium = \"water\"\n\
         [background]\ntype = \"gradient\"\nbottom = 0\ntop = [0.1, 0.2, 0.3]\n\
         [[medium]]\nname = \"water\"\nior = 1.33\n\
         [[light]]\nname = \"sun\"\ntype = \"directional\"\ndirection = [0, -2, 0]\nirradiance = 3\nshadows = false\n\
         [[light]]\ntype = \"point\"\nposition = [1, 2, 3]\nintensity = [1, 2, 3]\nfalloff = \"none\"\n\
         [[texture]]\nname = \"t\"\ntype = \"checker\"\neven = 1\nodd = 0\nsize = 0.5\naxes = \"xyz\"\n\
         [[material]]\nname = \"m\"\ntype = \"transparent\"\nior = 0.75\noutside = \"water\"\ncolor = \"t\"\n"
    ));
    assert_eq!(scene.surroundings.text, "water");
    assert_eq!(scene.background, Background::Gradient { bottom: Rgb::ZERO, top: Rgb::new(0.1, 0.2, 0.3) });
    assert_eq!((scene.media[0].name.text.as_str(), scene.media[0].ior), ("water", 1.33));
    let sun = LightKind::Directional {
        direction: DVec3::new(0.0, -2.0, 0.0),
        irradiance: Rgb::splat(3.0),
        shadows: false,
    };
    assert_eq!(scene.lights[0].kind, sun);
    assert_eq!(scene.lights[0].name.as_ref().map(|name| name.text.as_str()), Some("sun"));
    let lamp = LightKind::Point {
        position: DVec3::new(1.0, 2.0, 3.0),
        intensity: Rgb::new(1.0, 2.0, 3.0),
        falloff: Falloff::None,
        shadows: true,
    };
    assert_eq!(scene.lights[1].kind, lamp);
    let Pattern::Checker { axes, size, .. } = scene.textures[0].pattern else { panic!("not a checker") };
    assert_eq!((axes, size), ([true; 3], 0.5));
    let Model::Transparent { phong, kr, kt, ior, around } = &scene.materials[0].model else {
        panic!("{:?}", scene.materials[0])
    };
    assert_eq!((*kr, *kt, *ior), (Rgb::splat(0.1), Rgb::splat(0.9), 0.75));
    assert_eq!((phong.ka, phong.kd, phong.ks, phong.exponent), (0.0, 0.0, 0.0, 2000.0));
    assert!(matches!(&phong.color, ColourOrTexture::Texture(name) if name.text == "t"));
    assert!(matches!(around, Around::Medium(name) if name.text == "water"));
}

#[test]
fn objects_arrive() {
    let steps = object_of(
        "shape = \"mesh\"\nfile = \"knot.obj\"\ngroup = \"g\"\nnormals = \"smooth\"\nforce = true\nflip = true\n\
         transform = [{ scale = 2 }, { rotate = { axis = [0, 0, 3], angle = 90 } }, { translate = [1, 2, 3] }]\n",
    );
    assert_eq!(
        steps.transform.steps,
        [
            Step::Scale(DVec3::splat(2.0)),
            Step::Rotate { axis: DVec3::new(0.0, 0.0, 3.0), angle: 90.0 },
            Step::Translate(DVec3::new(1.0, 2.0, 3.0)),
        ]
    );
    assert!(steps.flip && steps.material.is_none());
    let Shape::Mesh { file, normals, group, force, .. } = steps.shape else { panic!("{:?}", steps.shape) };
    assert_eq!((file.as_path(), normals, force), (Path::new("knot.obj"), Normals::Smooth, true));
    assert_eq!(group.map(|name| name.text).as_deref(), Some("g"));

    let cylinder = object_of(
        "shape = \"cylinder\"\nbottom = [0, 0, 0]\ntop = [0, 1, 0]\nradius = 0.5\ncapped = false\n\
         material = { type = \"reflective\", kr = [0.1, 0.2, 0.3] }\n",
    );
    let expected = Shape::Cylinder { bottom: DVec3::ZERO, top: DVec3::Y, radius: 0.5, capped: false };
    assert_eq!(cylinder.shape, expected);
    let Some(MaterialChoice::Inline(material)) = cylinder.material else { panic!("{:?}", cylinder.material) };
    assert!(material.name.is_none());
    assert!(matches!(material.model, Model::Reflective { kr, .. } if kr == Rgb::new(0.1, 0.2, 0.3)));
}

#[test]
fn steps_can_be_written_as_tables_of_their_own() {
    let object = object_of(
        "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = { type = \"matte\" }\n\
         [[object.transform]]\nscale = 2\n[[object.transform]]\ntranslate = [1, 0, 0]\n",
    );
    assert_eq!(object.transform.steps, [Step::Scale(DVec3::splat(2.0)), Step::Translate(DVec3::X)]);
}

#[test]
fn spans_point_at_what_they_say() {
    let text = format!(
        "{CAMERA}[[object]]\nname = \"o\"\nshape = \"mesh\"\nfile = \"a.obj\"\ntransform = [{{ scale = 3 }}]\n\
         material = {{ type = \"matte\" }}\n"
    );
    let scene = scene_of(&text);
    let object = &scene.objects[0];
    let under = |span: Span| &text[span.start..span.end];
    let Shape::Mesh { file_span, .. } = object.shape else { panic!("{:?}", object.shape) };
    let Some(MaterialChoice::Inline(material)) = &object.material else { panic!("{:?}", object.material) };
    assert_eq!(under(scene.camera.span), "[camera]");
    assert_eq!(under(scene.camera.target_span), "[0, 0, 0]");
    assert_eq!(under(object.span), "[[object]]");
    assert_eq!(under(file_span), "\"a.obj\"");
    assert_eq!(under(object.transform.span), "[{ scale = 3 }]");
    assert_eq!(under(material.span), "{ type = \"matte\" }");
    assert_eq!(object.name.as_ref().map(|name| under(name.span)), Some("\"o\""));
}

#[test]
fn a_warning_comes_with_a_scene() {
    let text = format!("{CAMERA}[[material]]\nname = \"m\"\ntype = \"transparent\"\nior = 1\nkr = 0.5\n");
    let (scene, problems) = scene::parse("test.toml", &text);
    assert!(scene.is_some());
    assert_eq!(problems.iter().map(|problem| problem.severity).collect::<Vec<_>>(), [Severity::Warning]);
}

#[test]
fn a_file_full_of_problems_is_told_in_bounds() {
    // One line of 800 kilobytes, with several errors every eight bytes.
    let text = format!("object = [{}]\n{CAMERA}", "{x = 1},".repeat(100_000));
    let (scene, problems) = scene::parse("test.toml", &text);
    assert!(scene.is_none());
    assert_eq!(problems.iter().count(), Diagnostics::LIMIT);
    assert_eq!(problems.omitted(), 2 * 100_000 - Diagnostics::LIMIT);
    assert!(problems.to_string().len() < 100_000);
}

#[test]
fn what_is_no_scene_at_all_is_refused() {
    for text in [
        "",
        "\0",
        "\u{feff}",
        "v 1 2 3\nf 1 2 3\n",
        "[[[[",
        "]]",
        "a.b.c = 1",
        "\"\"\"",
        "= 1",
        "[camera]\n[camera]",
    ] {
        let (scene, problems) = scene::parse("test.toml", text);
        assert!(scene.is_none() && problems.has_errors(), "{text:?}");
    }
    let mesh = "v 1 2 3\n".repeat(1_000_000);
    assert!(scene::parse("mesh.obj", &mesh).1.has_errors());
}

/// Something to cut up.
fn long_scene() -> String {
    let page = page();
    page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or_default().to_string()
}

proptest! {
    /// Whatever is cut out of a scene and put in: no panic, spans within the text, and a scene exactly if no error.
    #[test]
    fn no_text_breaks_the_reader(
        at in 0usize..900,
        length in 0usize..40,
        inserted in "[\\[\\]{}=\"'#,.\\n\\\\a-z0-9é \t-]{0,12}",
        again in 0usize..900,
    ) {
        let characters: Vec<char> = long_scene().chars().collect();
        let cut = |from: usize, to: usize| characters[from.min(characters.len())..to.min(characters.len())].iter();
        let text: String = cut(0, at)
            .chain(inserted.chars().collect::<Vec<_>>().iter())
            .chain(cut(at + length, again.max(at + length)))
            .chain(cut(again, usize::MAX))
            .collect();
        let (scene, problems) = scene::parse("test.toml", &text);
        prop_assert_eq!(scene.is_none(), problems.has_errors());
        for problem in &problems {
            if let Some(place) = &problem.place {
                prop_assert!(place.span.end <= text.len());
                prop_assert!(place.line <= text.lines().count().max(1) + 1);
            }
        }
        prop_assert!(!problems.to_string().contains('\t'));
    }
}

/// Found by the test above: the value of a statement that ends with the text.
#[test]
fn an_open_bracket_at_the_end_is_told_within_the_text() {
    for text in ["a = 1\n''==[{\u{e9}", "a = [", "a = [\u{e9}"] {
        let (scene, problems) = scene::parse("test.toml", text);
        assert!(scene.is_none() && problems.has_errors());
        for place in (&problems).into_iter().filter_map(|problem| problem.place.as_ref()) {
            assert!(place.span.end <= text.len(), "{text:?}: {:?}", place.span);
        }
    }
}

#[test]
fn the_page_lists_the_media_that_have_names() {
    let page = fs::read_to_string(page_path()).expect("the page is there");
    let (_, list) = page.split_once("Media that can be named without a table:").expect("the page lists them");
    let (list, _) = list.split_once("<!-- schema").expect("the table follows");
    for NamedMedium { name, medium } in NamedMedium::ALL {
        let (_, after) =
            list.split_once(&format!("`{name}`")).unwrap_or_else(|| panic!("{name} is not listed"));
        let index = medium.index.value().to_string();
        assert!(
            after.split('(').nth(1).is_some_and(|index_after| index_after.starts_with(&index)),
            "{name}: {index}"
        );
        let sigma_a = medium.absorption.sigma_a().to_array();
        let told = sigma_a.iter().all(|s| *s == 0.0 || list.contains(&s.to_string()));
        assert!(told, "{name}: {sigma_a:?}");
    }
}

#[test]
fn media_with_names_are_there_and_can_be_replaced() {
    let media = |text: &str| scene_of(&format!("{CAMERA}{text}"));
    let of = |name: &str| {
        format!(
            "[[object]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {{ type = \"dielectric\", inside = \"{name}\" }}\n"
        )
    };
    for medium in NamedMedium::ALL {
        media(&of(medium.name));
    }
    assert_eq!(
        media(&format!("[[medium]]\nname = \"water\"\nior = 1.34\n{}", of("water"))).media[0].ior,
        1.34
    );
}
