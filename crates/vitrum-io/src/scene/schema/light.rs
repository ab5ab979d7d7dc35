//! Lights.

use super::{Choice, Key, Kind, Range, Table, Variant};

const SHADOWS: Key = Key::new("shadows", Kind::Boolean, "whether objects stand in its way").default("true");

/// `[[light]]`
pub const LIGHT: Table = Table {
    id: "light",
    header: "[[light]]",
    noun: "a light",
    keys: &[Key::new("name", Kind::Name, "its name in messages").or("none")],
    choice: Some(Choice {
        key: "type",
        variants: &[
            Variant {
                name: "ambient",
                meaning: "The same light on every surface, from everywhere, without shadows.",
                keys: &[Key::light("radiance", "its radiance; a material takes `ka` of it").unit("W/(m² sr)")],
            },
            Variant {
                name: "point",
                meaning: "Light from one point into all directions.",
                keys: &[
                    Key::point("position", "where it is"),
                    Key::light(
                        "intensity",
                        "its radiant intensity; without falloff, the irradiance that it gives",
                    )
                    .unit("W/sr"),
                    Key::new(
                        "falloff",
                        Kind::Choice(&["inverse-square", "none"]),
                        "whether it weakens with the distance, as light does, or not",
                    )
                    .default("\"inverse-square\""),
                    SHADOWS,
                ],
            },
            Variant {
                name: "spot",
                meaning: "Light from one point into a cone.",
                keys: &[
                    Key::point("position", "where it is"),
                    Key::vector("direction", "the axis of the cone, away from the light"),
                    Key::light("intensity", "its radiant intensity along the axis").unit("W/sr"),
                    Key::new(
                        "outer",
                        Kind::Number,
                        "angle between the axis and the edge, where no light is left",
                    )
                    .unit("degrees")
                    .range(Range::Open(0.0, 180.0)),
                    Key::new(
                        "inner",
                        Kind::Number,
                        "angle up to which the light is as strong as along the axis",
                    )
                    .unit("degrees")
                    .range(Range::Closed(0.0, 180.0))
                    .or("four fifths of `outer`"),
                    SHADOWS,
                ],
            },
            Variant {
                name: "directional",
                meaning: "Parallel light from far away.",
                keys: &[
                    Key::vector("direction", "where its light travels to"),
                    Key::light("irradiance", "its irradiance on a surface square to it").unit("W/m²"),
                    SHADOWS,
                ],
            },
        ],
    }),
    hints: &[
        ("color", "the colour is part of `radiance`, `intensity` or `irradiance`, as [red, green, blue]"),
        ("power", "a light is given by `radiance`, `intensity` or `irradiance`, whichever its type has"),
    ],
};
