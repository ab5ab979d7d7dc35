//! The reader: from TOML values with spans to the description, guided by the schema.
//!
//! | file | what it does |
//! |---|---|
//! | `syntax` | what is not TOML, told once per statement |
//! | `context` | collects problems |
//! | `fields` | one table: unknown, missing, defaulted and unread keys |
//! | `value` | one value: kind, range, degenerate cases |
//! | `names` | names are unique and known |
//! | `picture`, `light`, `matter`, `object` | the tables of the format |

mod context;
mod fields;
mod light;
mod matter;
mod names;
mod object;
mod picture;
mod suggest;
mod syntax;
mod value;

use toml::de::DeTable;

use self::context::{Context, Problem};
use self::fields::Fields;
use super::{MAX_BYTES, SceneDesc, schema};
use crate::diagnostic::{Diagnostic, Diagnostics, Source, Span};

pub(super) fn parse(name: &str, text: &str) -> (Option<SceneDesc>, Diagnostics) {
    if text.len() > MAX_BYTES {
        let mut diagnostics = Diagnostics::default();
        let message =
            format!("the scene file is too large: {} bytes, at most {MAX_BYTES} are read", text.len());
        diagnostics.push(Diagnostic::error(name, message).help("put geometry into mesh files"));
        return (None, diagnostics);
    }
    let mut cx = Context::new(Source::new(name, text));
    let mut mended = String::new();
    let table = syntax::parse(&mut cx, text, &mut mended);
    let scene = scene(&mut cx, &table);
    names::resolve(&mut cx);
    let mut diagnostics = cx.diagnostics;
    diagnostics.sort();
    if diagnostics.has_errors() {
        return (None, diagnostics);
    }
    (Some(scene.expect("a scene without errors is complete")), diagnostics)
}

fn scene(cx: &mut Context<'_>, table: &DeTable<'_>) -> Option<SceneDesc> {
    let mut top = Fields::open(cx, &schema::ROOT, table, Span::default());
    top.integer("version");
    let render = top.table_or_default("render", picture::render);
    let output = top.table_or_default("output", picture::output);
    let camera = top.table("camera", picture::camera);
    let surroundings = top.table_or_default("surroundings", picture::surroundings);
    let background = top.table("background", picture::background);
    let media = top.tables("medium", matter::medium);
    let lights = top.tables("light", light::light);
    let textures = top.tables("texture", matter::texture);
    let materials =
        top.tables("material", |cx, table, span| matter::material(cx, &schema::MATERIAL, table, span));
    let objects = top.tables("object", object::object);
    top.close();

    if let Some(render) = &render {
        light::check_ambient(cx, render, &lights);
    }
    matter::check_reflectances(cx, &textures, &materials, &objects);
    object::check_instances(cx, &objects);
    Some(SceneDesc {
        render: render?,
        output: output?,
        camera: camera?,
        surroundings: surroundings?,
        background: background.unwrap_or_default(),
        media,
        lights,
        textures,
        materials,
        objects,
    })
}

#[cfg(test)]
mod tests {
    use super::super::schema::{Kind, TABLES, Table};
    use super::*;

    /// `Fields::close` panics if a declared key was not read, and a reader panics on a variant that it does not know.
    /// So it is enough to bring up every table with every variant, empty: the readers go on past missing keys.
    #[test]
    fn every_key_of_the_schema_is_read() {
        let mut seen = Vec::new();
        let mut bring_up = |table: &Table, write: &dyn Fn(&str) -> String| {
            seen.push(table.id);
            if table.choice.is_none() {
                parse("scene.toml", &write(""));
            }
            for variant in table.variants() {
                let choice = table.choice.as_ref().expect("variants are chosen by a key");
                parse("scene.toml", &write(&format!("{} = \"{}\"", choice.key, variant.name)));
            }
        };
        bring_up(&schema::ROOT, &|_| String::new());
        for key in schema::ROOT.keys {
            match key.kind {
                Kind::Table(table) => bring_up(table, &|choice| format!("{} = {{ {choice} }}", key.name)),
                Kind::Tables(table) => bring_up(table, &|choice| format!("{} = [{{ {choice} }}]", key.name)),
                _ => {}
            }
        }
        bring_up(&schema::INLINE_MATERIAL, &|choice| {
            format!("object = [{{ shape = \"sphere\", material = {{ {choice} }} }}]")
        });
        bring_up(&schema::STEP, &|_| "object = [{ shape = \"sphere\", transform = [{}] }]".into());
        bring_up(&schema::ROTATION, &|_| {
            "object = [{ shape = \"sphere\", transform = [{ rotate = {} }] }]".into()
        });
        let missed: Vec<&str> = TABLES.iter().map(|table| table.id).filter(|id| !seen.contains(id)).collect();
        assert!(missed.is_empty(), "tables that this test does not reach: {missed:?}");
    }

    #[test]
    fn a_file_over_the_limit_is_refused_unread() {
        let (scene, problems) = parse("big.toml", &"#\n".repeat(MAX_BYTES / 2 + 1));
        assert!(scene.is_none());
        assert!(problems.to_string().starts_with("error: the scene file is too large: 16777218 bytes"));
    }

    #[test]
    fn a_list_over_the_limit_is_refused() {
        let text = format!("object = [{}]", "{},".repeat(super::super::MAX_ENTRIES + 1));
        let (scene, problems) = parse("big.toml", &text);
        assert!(scene.is_none());
        assert!(problems.to_string().contains("`object` has 1000001 entries"), "{problems}");
    }
}
