//! Media, textures and materials.

use super::{Choice, FARTHEST, Key, Kind, Range, Realm, Table, Variant};
use vitrum_materials::Metal;

/// `[[medium]]`
pub const MEDIUM: Table = Table {
    id: "medium",
    header: "[[medium]]",
    noun: "a medium",
    keys: &[
        Key::new("name", Kind::Name, "what refers to it; those above are there already"),
        Key::new("ior", Kind::Number, "its index of refraction against vacuum")
            .range(Range::Closed(0.1, 10.0)),
        TRANSMITTANCE,
        DISTANCE,
        SIGMA_A,
    ],
    choice: None,
    hints: ABSORPTION_HINTS,
};

const TRANSMITTANCE: Key =
    Key::new("transmittance", Kind::Colour, "share of light left after `distance` in the medium")
        .range(Range::Closed(1e-30, 1.0))
        .or("clear");

const DISTANCE: Key = Key::length("distance", "the distance that `transmittance` belongs to").or("none");

const SIGMA_A: Key = Key::new(
    "sigma_a",
    Kind::Colour,
    "absorption, in the place of `transmittance`: exp(-sigma_a d) is left after d",
)
.unit("1/m")
.range(Range::Closed(0.0, 1e12))
.or("clear");

const ABSORPTION_HINTS: &[(&str, &str)] = &[
    ("absorption", "absorption is given by `transmittance` and `distance`, or by `sigma_a` per metre"),
    ("attenuation", "absorption is given by `transmittance` and `distance`, or by `sigma_a` per metre"),
];

const ROUGHNESS: Key = Key::new(
    "roughness",
    Kind::Number,
    "alpha of the GGX distribution of microscopic normals; below 0.0001 it is smooth; what is rough needs `path`",
)
.range(Range::Closed(0.0, 1.0))
.default("0.0");

const PRIORITY: Key = Key::new(
    "priority",
    Kind::Integer,
    "where solids overlap, the highest fills the space; of equal ones, that whose name comes first",
)
.range(Range::Whole(0, 1000))
.default("0");

/// `[[texture]]`
pub const TEXTURE: Table = Table {
    id: "texture",
    header: "[[texture]]",
    noun: "a texture",
    keys: &[Key::new("name", Kind::Name, "what a material's `color` or `radiance` refers to")],
    choice: Some(Choice {
        key: "type",
        variants: &[
            Variant {
                name: "checker",
                meaning: "Cells of two colours in turn, fixed in the scene.",
                keys: &[
                Key::light("even", "colour of the cell that starts at the origin"),
                Key::light("odd", "colour of its neighbours"),
                Key::length("size", "edge of a cell"),
                Key::point("origin", "a corner of a cell").default("[0, 0, 0]"),
                Key::new(
                    "axes",
                    Kind::Choice(&["x", "y", "z", "xy", "xz", "yz", "xyz"]),
                    "along which axes cells alternate; leave out the one square to a flat floor",
                )
                .default("\"xz\""),
                ],
            },
            Variant {
                name: "image",
                meaning: "An image on the surface, placed by texture coordinates (below).",
                keys: &[
                    Key::new("file", Kind::File, "PNG, JPEG, Radiance HDR or OpenEXR, by what is in it; relative to the scene file"),
                    Key::new("scale", Kind::Repeats, "how often the image repeats from 0 to 1 of u and of v; negative mirrors it")
                        .range(Range::Closed(-FARTHEST, FARTHEST))
                        .default("1"),
                    Key::new("offset", Kind::Pair, "the place in the image of u = v = 0: uv times `scale` is added to it")
                        .range(Range::Closed(-FARTHEST, FARTHEST))
                        .default("[0, 0]"),
                    Key::new("wrap", Kind::Choice(&["repeat", "clamp", "mirror"]), "what lies beyond the image: the image again, the colours of its edge, or its mirror image")
                        .default("\"repeat\""),
                    Key::new("filter", Kind::Choice(&["bilinear", "nearest"]), "what lies between the middles of pixels: a mixture of four, or the nearest")
                        .default("\"bilinear\""),
                    Key::new("encoding", Kind::Choice(&["srgb", "linear"]), "of PNG and JPEG: colours for a display, or numbers in proportion to light")
                        .or("`\"srgb\"`; HDR and EXR are linear"),
                    Key::light("factor", "what its colours are multiplied by: the tint of a surface, the strength of a `radiance`")
                        .default("1"),
                ],
            },
        ],
    }),
    hints: &[
        ("path", "the name of the image stands in `file`"),
        ("repeat", "how often the image repeats is `scale`"),
        ("gamma", "what the numbers of an image mean is `encoding`: \"srgb\" or \"linear\""),
        ("brightness", "what the colours of an image are multiplied by is `factor`"),
    ],
};

/// A surface colour.
const COLOR: Key = Key::new("color", Kind::ColourOrTexture, "colour of the ambient and diffuse parts")
    .range(Range::Closed(0.0, 1.0));

const KA: Key = Key::share("ka", "share of ambient light given back");
const KD: Key = Key::share("kd", "share of light given back evenly to all sides");
const KS: Key = Key::share("ks", "strength of the highlight");
const EXPONENT: Key =
    Key::new("exponent", Kind::Number, "sharpness of the highlight").range(Range::Closed(1.0, 1e6));

const fn coefficient(name: &'static str, meaning: &'static str) -> Key {
    Key::new(name, Kind::Colour, meaning).range(Range::Closed(0.0, 1.0))
}

const MODELS: Choice = Choice {
    key: "type",
    variants: &[
        Variant {
            name: "matte",
            meaning: "Paper, plaster: light leaves evenly to all sides.",
            keys: &[COLOR.default("1"), KA.default("1"), KD.default("1")],
        },
        Variant {
            name: "phong",
            meaning: "Matte with a highlight of each light.",
            keys: &[
                COLOR.default("1"),
                KA.default("1"),
                KD.default("1"),
                KS.default("0.2"),
                EXPONENT.default("100"),
            ],
        },
        Variant {
            name: "reflective",
            meaning: "Phong that also mirrors its surroundings.",
            keys: &[
                COLOR.default("1"),
                KA.default("1"),
                KD.default("1"),
                KS.default("0.2"),
                EXPONENT.default("100"),
                coefficient("kr", "share of light mirrored"),
            ],
        },
        Variant {
            name: "transparent",
            meaning: "Clear with fixed shares mirrored and let through; in total reflection all is mirrored.",
            keys: &[
                COLOR.default("1"),
                KA.default("0"),
                KD.default("0"),
                KS.default("0"),
                EXPONENT.default("2000"),
                coefficient("kr", "share of light mirrored").default("0.1"),
                coefficient("kt", "share of light let through; `kr` and `kt` should not exceed 1 together")
                    .default("0.9"),
                Key::new(
                    "ior",
                    Kind::Number,
                    "index of refraction, inside over outside: 0.75 is air in water",
                )
                .range(Range::Closed(0.001, 1000.0)),
                Key::new("outside", Kind::Reference(Realm::Medium), "the medium outside, which `ior` is relative to: makes the surface an interface")
                    .or("`medium` of `[surroundings]`, and whatever overlaps"),
                PRIORITY,
            ],
        },
        Variant {
            name: "dielectric",
            meaning: "Glass, water, diamond: reflects and refracts by Fresnel's equations. One of `ior`, `relative_ior` and `inside` says what is inside.",
            keys: &[
                Key::new("ior", Kind::Number, "index of refraction inside, against vacuum")
                    .range(Range::Closed(0.001, 1000.0))
                    .or("none"),
                Key::new("relative_ior", Kind::Number, "index inside over that of `outside`")
                    .range(Range::Closed(0.001, 1000.0))
                    .or("none"),
                Key::new("inside", Kind::Reference(Realm::Medium), "the medium inside, with what it absorbs")
                    .or("none"),
                Key::new("outside", Kind::Reference(Realm::Medium), "the medium outside: makes the surface an interface")
                    .or("`medium` of `[surroundings]`, and whatever overlaps"),
                PRIORITY,
                ROUGHNESS,
                Key::new(
                    "compensation",
                    Kind::Boolean,
                    "of rough glass: whether light that is scattered more than once in the roughness is made up for",
                )
                .default("true"),
                TRANSMITTANCE,
                DISTANCE,
                SIGMA_A,
            ],
        },
        Variant {
            name: "thin",
            meaning: "A sheet of glass as one surface without thickness: reflects, and lets the rest go straight on.",
            keys: &[
                Key::new("ior", Kind::Number, "index of refraction of the sheet, against vacuum")
                    .range(Range::Closed(0.001, 1000.0)),
                Key::new("outside", Kind::Reference(Realm::Medium), "the medium on both sides")
                    .or("`medium` of `[surroundings]`"),
                coefficient(
                    "transmittance",
                    "share that the glass leaves of light that crosses it at a right angle",
                )
                .default("1"),
            ],
        },
        Variant {
            name: "conductor",
            meaning: "Metal: reflects by Fresnel's equations for a complex index, and absorbs the rest. The index is that of a `metal`, or `n` and `k`.",
            keys: &[
                Key::new("metal", Kind::Choice(Metal::NAMES), "the metal whose measured index this is")
                    .or("none"),
                Key::new("n", Kind::Colour, "real part of the index, against vacuum")
                    .range(Range::Closed(0.001, 100.0))
                    .or("none"),
                Key::new("k", Kind::Colour, "imaginary part of the index")
                    .range(Range::Closed(0.0, 100.0))
                    .or("none"),
                Key::new("outside", Kind::Reference(Realm::Medium), "the medium outside")
                    .or("`medium` of `[surroundings]`"),
                ROUGHNESS,
            ],
        },
        Variant {
            name: "emissive",
            meaning: "Shines by itself, on its outer side. It lights other objects where light is followed by `path`, and only there.",
            keys: &[Key::new("radiance", Kind::ColourOrTexture, "its radiance")
                .unit("W/(m² sr)")
                .range(Range::AtLeast(0.0))],
        },
    ],
};

const MATERIAL_HINTS: &[(&str, &str)] = &[
    ("index", "the index of refraction is `ior`"),
    ("shininess", "the sharpness of the highlight is `exponent`"),
    ("diffuse", "the colour is `color`, the diffuse share `kd`"),
];

/// `[[material]]`
pub const MATERIAL: Table = Table {
    id: "material",
    header: "[[material]]",
    noun: "a material",
    keys: &[Key::new("name", Kind::Name, "what an object's `material` refers to")],
    choice: Some(MODELS),
    hints: MATERIAL_HINTS,
};

/// A material written at its object, without a name.
pub const INLINE_MATERIAL: Table = Table {
    id: "inline-material",
    header: "{ type = ... }",
    noun: "a material",
    keys: &[],
    choice: Some(MODELS),
    hints: &[
        ("name", "a material written at its object has no name; one with a name is a [[material]]"),
        MATERIAL_HINTS[0],
        MATERIAL_HINTS[1],
        MATERIAL_HINTS[2],
    ],
};
