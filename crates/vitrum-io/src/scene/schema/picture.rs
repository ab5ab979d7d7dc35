//! The scene as a whole, and what concerns the picture: settings, output, camera, surroundings, background.

use super::{
    Choice, FARTHEST, Key, Kind, LIGHT, MATERIAL, MEDIUM, OBJECT, Range, Realm, TEXTURE, Table, Variant,
};

/// The file itself.
pub const ROOT: Table = Table {
    id: "scene-file",
    header: "the top of the file",
    noun: "the scene",
    keys: &[
        Key::new("version", Kind::Integer, "version of this format").range(Range::Whole(1, 1)).default("1"),
        Key::new("render", Kind::Table(&RENDER), "how the picture is computed")
            .or("every default of `[render]`"),
        Key::new("output", Kind::Table(&OUTPUT), "how it is written").or("every default of `[output]`"),
        Key::new("camera", Kind::Table(&CAMERA), "where it is seen from"),
        Key::new("surroundings", Kind::Table(&SURROUNDINGS), "what lies around all objects")
            .or("every default of `[surroundings]`"),
        Key::new("background", Kind::Table(&BACKGROUND), "what a ray sees that meets nothing").or("black"),
        Key::new("medium", Kind::Tables(&MEDIUM), "media that objects can lie in").or("none"),
        Key::new("light", Kind::Tables(&LIGHT), "lights").or("none"),
        Key::new("texture", Kind::Tables(&TEXTURE), "colours that vary in space").or("none"),
        Key::new("material", Kind::Tables(&MATERIAL), "materials with a name").or("none"),
        Key::new("object", Kind::Tables(&OBJECT), "what stands in the scene").or("none"),
    ],
    choice: None,
    hints: &[
        ("include", "a scene is one file; meshes are named by `file` in an [[object]]"),
        ("environment", "what a ray sees that meets nothing is the [background]"),
        ("sphere", "write [[object]] with shape = \"sphere\""),
        ("mesh", "write [[object]] with shape = \"mesh\""),
    ],
};

/// `[render]`
pub const RENDER: Table = Table {
    id: "render",
    header: "[render]",
    noun: "[render]",
    keys: &[
        Key::new("size", Kind::Size, "width and height of the picture; together at most 2^28 pixels")
            .unit("pixels")
            .range(Range::Whole(1, 65_536))
            .default("[640, 480]"),
        Key::new("spp", Kind::Integer, "samples per pixel").range(Range::Whole(1, 1_000_000)).default("16"),
        Key::new("max_depth", Kind::Integer, "a ray deeper than this is not traced; the camera ray has depth 0")
            .range(Range::Whole(0, 1000))
            .or("10 for `whitted`; none for `path`"),
        Key::share(
            "cutoff",
            "of `whitted`: a ray that weighs less is not traced; what is given up so is summed and reported, and 0 gives up nothing",
        )
        .default("0.001"),
        Key::new("seed", Kind::Integer, "start of the random numbers; equal seeds give equal pictures")
            .range(Range::Whole(0, u64::MAX))
            .default("0"),
        Key::new(
            "filter",
            Kind::Choice(&["box", "tent", "blackman-harris"]),
            "which points of the film a pixel is the mean of: those of its square, or also of its neighbours with less weight, which \
             is softer and shows less aliasing",
        )
        .default("\"box\""),
        Key::new(
            "integrator",
            Kind::Choice(&["whitted", "path"]),
            "how light is followed: `whitted` traces the ray tree of mirrors and glass, `path` follows light on all its ways",
        )
        .or("`whitted` with an ambient light or straight shadows, else `path`"),
        Key::new(
            "branching",
            Kind::Choice(&["auto", "one", "first", "tree"]),
            "of `path`: whether one of the rays that glass divides is followed, all at the first hit and then one, or all while \
             they weigh enough; `auto` finds out which of these is best, part by part of the picture; no picture depends on it but \
             in its noise",
        )
        .default("\"auto\""),
        Key::new(
            "shadow",
            Kind::Choice(&["opaque", "straight"]),
            "of `whitted`: whether glass casts a full shadow, or lets light through along a straight line, unbent",
        )
        .default("\"opaque\""),
    ],
    choice: None,
    hints: &[
        ("width", "write size = [width, height]"),
        ("height", "write size = [width, height]"),
        ("samples", "samples per pixel are `spp`"),
        ("depth", "the deepest ray traced is `max_depth`"),
        ("threads", "threads are an option of the program, because they never change the picture"),
    ],
};

/// `[output]`
pub const OUTPUT: Table = Table {
    id: "output",
    header: "[output]",
    noun: "[output]",
    keys: &[
        Key::new("exposure", Kind::Number, "brightness of a PNG: each step doubles it; EXR stays as it is")
            .unit("stops")
            .range(Range::Closed(-32.0, 32.0))
            .default("0.0"),
        Key::new(
            "tone",
            Kind::Choice(&["clip", "neutral"]),
            "what a PNG does with more than it can show: cut it, or roll it off; EXR stays as it is",
        )
        .default("\"clip\""),
    ],
    choice: None,
    hints: &[("file", "the output file is an option of the program")],
};

const FOV: Key = Key::new("fov", Kind::Number, "angle between the bottom and the top of the picture")
    .unit("degrees")
    .range(Range::Open(0.0, 180.0));

/// `[camera]`
pub const CAMERA: Table = Table {
    id: "camera",
    header: "[camera]",
    noun: "a camera",
    keys: &[
        Key::point("position", "where the camera stands"),
        Key::point("target", "the point in the middle of the picture; not where the camera stands"),
        Key::vector("up", "a direction that is up in the picture; not along the line of sight")
            .default("[0, 1, 0]"),
        Key::new("medium", Kind::Reference(Realm::Medium), "the medium that the camera stands in")
            .or("what is found there"),
    ],
    choice: Some(Choice {
        key: "type",
        variants: &[
            Variant { name: "pinhole", meaning: "Everything is sharp.", keys: &[FOV] },
            Variant {
                name: "thin-lens",
                meaning: "Sharp at one distance, blurred before and behind it.",
                keys: &[
                    FOV,
                    Key::new(
                        "lens_radius",
                        Kind::Number,
                        "radius of the aperture; the larger, the more blur",
                    )
                    .unit("m")
                    .range(Range::Closed(0.0, FARTHEST)),
                    Key::length("focus_distance", "distance of the sharp plane, along the line of sight")
                        .or("the distance to `target`"),
                ],
            },
            Variant {
                name: "orthographic",
                meaning: "Parallel rays: size does not depend on distance.",
                keys: &[Key::length("height", "from the bottom to the top of the picture")],
            },
        ],
    }),
    hints: &[
        ("look_at", "the point looked at is `target`"),
        ("aperture", "the size of the aperture is `lens_radius`, in metres"),
        ("focal_length", "the angle of view is `fov`, in degrees"),
    ],
};

/// `[surroundings]`
pub const SURROUNDINGS: Table = Table {
    id: "surroundings",
    header: "[surroundings]",
    noun: "[surroundings]",
    keys: &[Key::new(
        "medium",
        Kind::Reference(Realm::Medium),
        "the scene's medium: what surrounds everything",
    )
    .default("\"air\"")],
    choice: None,
    hints: &[],
};

/// `[background]`
pub const BACKGROUND: Table = Table {
    id: "background",
    header: "[background]",
    noun: "a background",
    keys: &[],
    choice: Some(Choice {
        key: "type",
        variants: &[
            Variant {
                name: "constant",
                meaning: "The same in every direction.",
                keys: &[Key::light("color", "its radiance").unit("W/(m² sr)")],
            },
            Variant {
                name: "gradient",
                meaning: "Linear in the direction's y, which goes from -1 (straight down) to 1 (straight up).",
                keys: &[
                    Key::light("bottom", "radiance straight down").unit("W/(m² sr)"),
                    Key::light("top", "radiance straight up").unit("W/(m² sr)"),
                ],
            },
            Variant {
                name: "image",
                meaning: "A picture of all directions by latitude and longitude: its upper edge is straight up, its middle in the \
                          direction -Z, and what is right of that towards +X.",
                keys: &[
                    Key::new(
                        "file",
                        Kind::File,
                        "a Radiance (.hdr) or OpenEXR (.exr) file, its path relative to the scene file",
                    ),
                    Key::new("rotation", Kind::Number, "about the axis +Y, counterclockwise seen from above")
                        .unit("degrees")
                        .default("0.0"),
                    Key::new("scale", Kind::Number, "factor of its radiance")
                        .range(Range::AtLeast(0.0))
                        .default("1.0"),
                ],
            },
        ],
    }),
    hints: &[
        ("exposure", "the factor of all radiance is `scale`"),
        ("strength", "the factor of all radiance is `scale`"),
    ],
};
