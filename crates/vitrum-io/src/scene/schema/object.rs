//! Objects and where they stand.

use super::{Choice, FARTHEST, Key, Kind, Range, Realm, Table, Variant};

/// One step of a transform.
pub const STEP: Table = Table {
    id: "transform",
    header: "{ translate | rotate | scale = ... }",
    noun: "a step of a transform",
    keys: &[
        Key::point("translate", "moves by this much").or("none"),
        Key::new("rotate", Kind::Table(&ROTATION), "turns about an axis through the origin").or("none"),
        Key::new("scale", Kind::Scale, "stretches away from the origin; a negative factor mirrors")
            .range(Range::Closed(-FARTHEST, FARTHEST))
            .or("none"),
    ],
    choice: None,
    hints: &[
        ("axis", "write { rotate = { axis = [...], angle = ... } }"),
        ("angle", "write { rotate = { axis = [...], angle = ... } }"),
        ("move", "a step that moves is `translate`"),
    ],
};

/// The turn of a `rotate` step.
pub const ROTATION: Table = Table {
    id: "rotation",
    header: "{ axis = ..., angle = ... }",
    noun: "a rotation",
    keys: &[
        Key::vector("axis", "the axis of the turn"),
        Key::new("angle", Kind::Number, "how far; counterclockwise seen from where the axis points to")
            .unit("degrees")
            .range(Range::Closed(-1e5, 1e5)),
    ],
    choice: None,
    hints: &[],
};

const CENTER: Key = Key::point("center", "its centre");
const MATERIAL: Key = Key::new("material", Kind::Material, "what it is made of");

/// `[[object]]`
pub const OBJECT: Table = Table {
    id: "object",
    header: "[[object]]",
    noun: "an object",
    keys: &[
        Key::new("name", Kind::Name, "its name in messages, and what an instance refers to").or("none"),
        Key::new(
            "transform",
            Kind::Tables(&STEP),
            "where it is put, step by step: the first written acts first",
        )
        .or("none"),
        Key::new("flip", Kind::Boolean, "turns its outside in, for parts that bound a body together")
            .default("false"),
    ],
    choice: Some(Choice {
        key: "shape",
        variants: &[
            Variant {
                name: "sphere",
                meaning: "A ball.",
                keys: &[CENTER, Key::length("radius", "its radius"), MATERIAL],
            },
            Variant {
                name: "plane",
                meaning: "A plane without end.",
                keys: &[
                    Key::point("point", "any point on it"),
                    Key::vector("normal", "direction of its outer side"),
                    MATERIAL,
                ],
            },
            Variant {
                name: "disk",
                meaning: "A flat disk without thickness.",
                keys: &[
                    CENTER,
                    Key::vector("normal", "direction of its outer side"),
                    Key::length("radius", "its radius"),
                    MATERIAL,
                ],
            },
            Variant {
                name: "rectangle",
                meaning: "A flat rectangle or parallelogram without thickness; its outer side is that of `edge_u` \
                          × `edge_v`.",
                keys: &[
                    Key::point("corner", "one corner"),
                    Key::vector("edge_u", "from there to the next corner").unit("m"),
                    Key::vector("edge_v", "from there to the other neighbour; not parallel to `edge_u`")
                        .unit("m"),
                    MATERIAL,
                ],
            },
            Variant {
                name: "box",
                meaning: "A box along the axes.",
                keys: &[
                    Key::point("min", "the corner with the least x, y and z"),
                    Key::point("max", "the corner with the greatest x, y and z"),
                    MATERIAL,
                ],
            },
            Variant {
                name: "cylinder",
                meaning: "A round cylinder.",
                keys: &[
                    Key::point("bottom", "one end of its axis"),
                    Key::point("top", "the other end"),
                    Key::length("radius", "its radius"),
                    Key::new("capped", Kind::Boolean, "whether disks close its ends").default("true"),
                    MATERIAL,
                ],
            },
            Variant {
                name: "mesh",
                meaning: "Triangles from a file.",
                keys: &[
                    Key::new("file", Kind::File, "an OBJ file, its path relative to the scene file"),
                    Key::new(
                        "normals",
                        Kind::Choice(&["smooth", "flat", "file"]),
                        "shading: rounded, faceted, or as the file says (faceted where it says nothing)",
                    )
                    .default("\"file\""),
                    Key::new(
                        "build",
                        Kind::Choice(&["fast", "medium", "best"]),
                        "how much time goes into the tree that finds its triangles; the picture is the same",
                    )
                    .default("\"medium\""),
                    Key::new("group", Kind::Text, "the one object or group of the file to take")
                        .or("all of them"),
                    Key::new(
                        "force",
                        Kind::Boolean,
                        "take a mesh as solid glass although it is open or damaged",
                    )
                    .default("false"),
                    MATERIAL.or("the materials that the file names"),
                ],
            },
            Variant {
                name: "instance",
                meaning: "The shape of another object once more, without that object's own transform and `flip`; it costs no \
                          memory.",
                keys: &[
                    Key::new("of", Kind::Reference(Realm::Object), "that object; not itself an instance"),
                    MATERIAL.or("that object's material"),
                ],
            },
        ],
    }),
    hints: &[
        ("type", "the kind of an object is its `shape`"),
        ("translate", "write transform = [{ translate = [x, y, z] }]"),
        ("rotate", "write transform = [{ rotate = { axis = [x, y, z], angle = degrees } }]"),
        ("scale", "write transform = [{ scale = 2 }]"),
        ("color", "a colour belongs to the material: material = { type = \"matte\", color = ... }"),
        (
            "ior",
            "the index of refraction belongs to the material: material = { type = \"transparent\", ior = ... }",
        ),
    ],
};
