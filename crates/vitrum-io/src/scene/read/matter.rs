//! Media, textures and materials.

use std::collections::BTreeMap;

use toml::de::DeTable;
use vitrum_materials::{Encoding, Filter, Metal, Wrap};
use vitrum_math::Rgb;

use super::super::schema::{self, Realm, Table};
use super::super::{
    Absorption, Around, ColourOrTexture, Index, Material, MaterialChoice, Medium, MetalIndex, Model, Object,
    Pattern, Phong, Texture,
};
use super::context::shorten;
use super::{Context, Fields, Problem, Span, value};

/// By how much `kr + kt` may exceed 1 without a warning: what is left of decimal fractions in f64.
const SUM_TOLERANCE: f64 = 1e-12;

pub(super) fn medium(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Medium> {
    let mut fields = Fields::open(cx, &schema::MEDIUM, table, span);
    let name = fields.name(Realm::Medium);
    let ior = fields.number("ior");
    let absorption = absorption(&mut fields);
    fields.close();
    Some(Medium { name: name?, ior: ior?, absorption })
}

/// What is absorbed: by `transmittance` and `distance`, or by `sigma_a`, or nothing.
fn absorption(fields: &mut Fields<'_, '_>) -> Absorption {
    let (share, distance) = (fields.colour("transmittance"), fields.number("distance"));
    let sigma_a = fields.colour("sigma_a");
    let [has_share, has_distance, has_sigma] =
        ["transmittance", "distance", "sigma_a"].map(|key| fields.has(key));
    if has_share != has_distance {
        let (there, missing) =
            if has_share { ("transmittance", "distance") } else { ("distance", "transmittance") };
        let message = format!("`{there}` says nothing without `{missing}`");
        let problem =
            Problem::error(fields.span_of(there), message, format!("expected `{missing}` beside it"));
        fields.cx.report(
            problem.help("`transmittance` is the share of light that is left after `distance` metres"),
        );
    }
    if has_sigma && (has_share || has_distance) {
        let problem = Problem::error(
            fields.span_of("sigma_a"),
            "absorption is given twice",
            "expected either this or `transmittance` with `distance`",
        );
        fields.cx.report(problem.help("leave out one of them"));
    }
    match (share, distance, sigma_a) {
        (Some(share), Some(distance), _) => Absorption::Transmittance { share, distance },
        (_, _, Some(sigma_a)) => Absorption::PerMetre(sigma_a),
        _ => Absorption::Clear,
    }
}

pub(super) fn texture(cx: &mut Context<'_>, table: &DeTable<'_>, span: Span) -> Option<Texture> {
    let mut fields = Fields::open(cx, &schema::TEXTURE, table, span);
    let name = fields.name(Realm::Texture);
    let pattern = match fields.variant() {
        Some("checker") => checker(&mut fields),
        Some("image") => image(&mut fields),
        Some(other) => panic!("no reader for a {other} texture"),
        None => None,
    };
    fields.close();
    Some(Texture { span, name: name?, pattern: pattern? })
}

fn checker(fields: &mut Fields<'_, '_>) -> Option<Pattern> {
    const AXES: [(&str, [bool; 3]); 7] = [
        ("x", [true, false, false]),
        ("y", [false, true, false]),
        ("z", [false, false, true]),
        ("xy", [true, true, false]),
        ("xz", [true, false, true]),
        ("yz", [false, true, true]),
        ("xyz", [true, true, true]),
    ];
    let even = fields.colour("even");
    let odd = fields.colour("odd");
    let size = fields.number("size");
    let origin = fields.point("origin");
    let axes = fields.choice("axes", &AXES);
    Some(Pattern::Checker { even: even?, odd: odd?, size: size?, origin: origin?, axes: axes? })
}

fn image(fields: &mut Fields<'_, '_>) -> Option<Pattern> {
    let file = fields.text("file");
    let scale = fields.read("scale", value::repeats);
    let offset = fields.read("offset", value::pair);
    let wraps = [("repeat", Wrap::Repeat), ("clamp", Wrap::Clamp), ("mirror", Wrap::Mirror)];
    let wrap = fields.choice("wrap", &wraps);
    let filter = fields.choice("filter", &[("bilinear", Filter::Bilinear), ("nearest", Filter::Nearest)]);
    let encoding = fields.choice("encoding", &[("srgb", Encoding::Srgb), ("linear", Encoding::Linear)]);
    let factor = fields.colour("factor");
    let file = file?;
    Some(Pattern::Image {
        file: file.text.into(),
        file_span: file.span,
        scale: scale?,
        offset: offset?,
        wrap: wrap?,
        filter: filter?,
        encoding,
        factor: factor?,
    })
}

/// A material of either schema: with a name, or at its object without one.
pub(super) fn material(
    cx: &mut Context<'_>,
    schema: &'static Table,
    table: &DeTable<'_>,
    span: Span,
) -> Option<Material> {
    let named = schema.keys.iter().any(|key| key.name == "name");
    let mut fields = Fields::open(cx, schema, table, span);
    let name = if named { fields.name(Realm::Material) } else { None };
    let model = match fields.variant() {
        Some("matte") => matte(&mut fields),
        Some("phong") => phong(&mut fields).map(Model::Phong),
        Some("reflective") => {
            let (phong, kr) = (phong(&mut fields), fields.colour("kr"));
            phong.zip(kr).map(|(phong, kr)| Model::Reflective { phong, kr })
        }
        Some("transparent") => transparent(&mut fields),
        Some("dielectric") => dielectric(&mut fields),
        Some("thin") => {
            let (ior, outside) = (fields.number("ior"), fields.reference("outside"));
            let transmittance = fields.colour("transmittance");
            ior.zip(transmittance).map(|(ior, transmittance)| Model::Thin { ior, outside, transmittance })
        }
        Some("conductor") => conductor(&mut fields),
        Some("emissive") => fields.colour_or_texture("radiance").map(|radiance| Model::Emissive { radiance }),
        Some(other) => panic!("no reader for a {other} material"),
        None => None,
    };
    fields.close();
    if named && name.is_none() {
        return None;
    }
    Some(Material { span, name, model: model? })
}

fn matte(fields: &mut Fields<'_, '_>) -> Option<Model> {
    let (color, ka, kd) = (fields.colour_or_texture("color"), fields.number("ka"), fields.number("kd"));
    Some(Model::Matte { color: color?, ka: ka?, kd: kd? })
}

fn phong(fields: &mut Fields<'_, '_>) -> Option<Phong> {
    let color = fields.colour_or_texture("color");
    let (ka, kd, ks) = (fields.number("ka"), fields.number("kd"), fields.number("ks"));
    let exponent = fields.number("exponent");
    Some(Phong { color: color?, ka: ka?, kd: kd?, ks: ks?, exponent: exponent? })
}

fn transparent(fields: &mut Fields<'_, '_>) -> Option<Model> {
    let phong = phong(fields);
    let (kr, kt) = (fields.colour("kr"), fields.colour("kt"));
    let ior = fields.number("ior");
    let around = around(fields);
    if let (Some(kr), Some(kt)) = (kr, kt) {
        warn_of_gain(fields, kr, kt);
    }
    Some(Model::Transparent { phong: phong?, kr: kr?, kt: kt?, ior: ior?, around: around? })
}

/// What is around glass: `outside`, or whatever is there, by `priority`.
fn around(fields: &mut Fields<'_, '_>) -> Option<Around> {
    let (outside, priority) = (fields.reference("outside"), fields.small_integer("priority"));
    if fields.has("outside") && fields.has("priority") {
        let message = "`priority` says nothing beside `outside`";
        let problem = Problem::error(fields.span_of("priority"), message, "this has no effect");
        let problem = problem.also(fields.span_of("outside"), "this says what is outside, whatever overlaps");
        fields.cx.report(problem.help(
            "leave out `outside` for a solid that may overlap others, or `priority` for an interface between two media",
        ));
    }
    match outside {
        Some(outside) => Some(Around::Medium(outside)),
        None => priority.map(|priority| Around::Anything {
            priority: i16::try_from(priority).expect("the declared range lies within i16"),
        }),
    }
}

fn dielectric(fields: &mut Fields<'_, '_>) -> Option<Model> {
    let absolute = fields.number("ior").map(Index::Absolute);
    let relative = fields.number("relative_ior").map(Index::Relative);
    let medium = fields.reference("inside").map(Index::Medium);
    let around = around(fields);
    let roughness = fields.number("roughness");
    let compensation = fields.boolean("compensation");
    let absorption = absorption(fields);
    let written: Vec<&str> =
        ["ior", "relative_ior", "inside"].into_iter().filter(|key| fields.has(key)).collect();
    let help =
        "one of `ior` (against vacuum), `relative_ior` (against `outside`) and `inside` (a [[medium]])";
    match written[..] {
        [] => {
            let message = "nothing says what is inside";
            let problem = Problem::error(fields.span_of("ior"), message, "expected an index of refraction");
            fields.cx.report(problem.help(help));
        }
        [first, second, ..] => {
            let message = "the index of refraction is given twice";
            let problem = Problem::error(fields.span_of(second), message, "this one, too");
            let problem = problem.also(fields.span_of(first), "it is given here");
            fields.cx.report(problem.help(help));
        }
        ["inside"] if absorption != Absorption::Clear => {
            let message = "what is absorbed inside is given twice";
            let key = if fields.has("sigma_a") { "sigma_a" } else { "transmittance" };
            let problem = Problem::error(fields.span_of(key), message, "the medium inside has its own");
            fields
                .cx
                .report(problem.help("write it at the [[medium]], or write `ior` in the place of `inside`"));
        }
        _ => {}
    }
    let inside = absolute.or(relative).or(medium);
    Some(Model::Dielectric {
        inside: inside?,
        around: around?,
        roughness: roughness?,
        compensation: compensation?,
        absorption,
    })
}

fn conductor(fields: &mut Fields<'_, '_>) -> Option<Model> {
    let metals: Vec<(&str, Metal)> = Metal::all().map(|metal| (metal.name(), metal)).collect();
    let named = fields.choice("metal", &metals).map(MetalIndex::Named);
    let (n, k) = (fields.colour("n"), fields.colour("k"));
    let given = n.zip(k).map(|(n, k)| MetalIndex::Given { n, k });
    let outside = fields.reference("outside");
    let roughness = fields.number("roughness");
    let help = "`metal` names one whose index is known; `n` and `k` give the index of any";
    match ["metal", "n", "k"].map(|key| fields.has(key)) {
        [false, false, false] => {
            let message = "nothing says which metal this is";
            let label = "expected `metal`, or `n` and `k`";
            fields.cx.report(Problem::error(fields.span_of("metal"), message, label).help(help));
        }
        [true, has_n, has_k] if has_n || has_k => {
            let second = fields.span_of(if has_n { "n" } else { "k" });
            let problem = Problem::error(second, "the index of this metal is given twice", "this one, too");
            let problem = problem.also(fields.span_of("metal"), "it is given here");
            fields.cx.report(problem.help(help));
        }
        [false, has_n, has_k] if has_n != has_k => {
            let (there, missing) = if has_n { ("n", "k") } else { ("k", "n") };
            let message = format!("`{there}` is half of an index without `{missing}`");
            let label = format!("expected `{missing}` beside it");
            fields.cx.report(Problem::error(fields.span_of(there), message, label).help(help));
        }
        _ => {}
    }
    Some(Model::Conductor { index: named.or(given)?, outside, roughness: roughness? })
}

/// Warns of a surface that gives back more light than it gets.
fn warn_of_gain(fields: &mut Fields<'_, '_>, kr: Rgb, kt: Rgb) {
    let most = (kr + kt).max_element();
    if most <= 1.0 + SUM_TOLERANCE {
        return;
    }
    // The key that is written out is the one to change.
    let key = if fields.has("kt") { "kt" } else { "kr" };
    let left_out = match (fields.has("kr"), fields.has("kt")) {
        (true, true) => "",
        (true, false) => " (`kt` is 0.9 unless it is given)",
        _ => " (`kr` is 0.1 unless it is given)",
    };
    let message = "this surface gives back more light than it gets";
    let label = format!("`kr` + `kt` = {most}, expected at most 1{left_out}");
    let problem = Problem::warning(fields.span_of(key), message, label);
    fields.cx.report(problem.help("lower `kr` or `kt` until they add up to 1 or less in every channel"));
}

/// Tells textures brighter than 1 where a surface colour is wanted.
pub(super) fn check_reflectances(
    cx: &mut Context<'_>,
    textures: &[Texture],
    materials: &[Material],
    objects: &[Object],
) {
    let bright: BTreeMap<&str, &Texture> = textures
        .iter()
        .filter(|texture| match texture.pattern {
            Pattern::Checker { even, odd, .. } => even.max(odd).max_element() > 1.0,
            // Known when the file is read.
            Pattern::Image { .. } => false,
        })
        .map(|texture| (texture.name.text.as_str(), texture))
        .collect();
    let inline = objects.iter().filter_map(|object| match &object.material {
        Some(MaterialChoice::Inline(material)) => Some(material.as_ref()),
        _ => None,
    });
    for material in materials.iter().chain(inline) {
        let color = match &material.model {
            Model::Matte { color, .. } => color,
            Model::Phong(phong) | Model::Reflective { phong, .. } | Model::Transparent { phong, .. } => {
                &phong.color
            }
            Model::Dielectric { .. }
            | Model::Thin { .. }
            | Model::Conductor { .. }
            | Model::Emissive { .. } => continue,
        };
        let ColourOrTexture::Texture(name) = color else { continue };
        if let Some(texture) = bright.get(name.text.as_str()) {
            let message = format!("the texture \"{}\" is too bright for a surface", shorten(&name.text));
            let problem = Problem::error(name.span, message, "expected colours from 0 to 1")
                .also(texture.span, "it has a colour above 1")
                .help("only `radiance` of an emissive material can exceed 1");
            cx.report(problem);
        }
    }
}
