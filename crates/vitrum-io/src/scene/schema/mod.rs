//! The scene format, declared: every table and key with its kind, unit, range, default and meaning.
//!
//! The reader takes all of it from here, and so does the format page (`docs/scene-format.md`, by [`markdown`]):
//! neither can know a key that the other does not. A key is read by the name given here; a test fails if one is
//! declared and not read.

mod light;
mod markdown;
mod matter;
mod object;
mod picture;

pub use light::LIGHT;
pub use markdown::markdown;
pub use matter::{INLINE_MATERIAL, MATERIAL, MEDIUM, TEXTURE};
pub use object::{OBJECT, ROTATION, STEP};
pub use picture::{BACKGROUND, CAMERA, OUTPUT, RENDER, ROOT, SURROUNDINGS};

/// Every table of the format page, in its order. [`INLINE_MATERIAL`] is [`MATERIAL`] without its name.
pub const TABLES: &[&Table] = &[
    &ROOT,
    &RENDER,
    &OUTPUT,
    &CAMERA,
    &SURROUNDINGS,
    &BACKGROUND,
    &MEDIUM,
    &LIGHT,
    &TEXTURE,
    &MATERIAL,
    &OBJECT,
    &STEP,
    &ROTATION,
];

/// Largest magnitude of a coordinate and largest length, metres: beyond it, products of four of them leave f64's
/// accuracy no room, and no glass is as large as the orbit of Mars.
pub const FARTHEST: f64 = 1e12;

/// Smallest length that is not degenerate, metres (and smallest size of a scale factor).
pub const SMALLEST: f64 = 1e-12;

/// A table of the format.
#[derive(Debug)]
pub struct Table {
    /// Short name, which marks its place on the format page: `camera`.
    pub id: &'static str,
    /// How it is written: `[camera]`, `[[light]]`.
    pub header: &'static str,
    /// How one such table is called in a sentence: `a camera`.
    pub noun: &'static str,
    /// Keys that it has in any case.
    pub keys: &'static [Key],
    /// The key that chooses among further sets of keys.
    pub choice: Option<Choice>,
    /// Names that are often tried here, and what to write instead.
    pub hints: &'static [(&'static str, &'static str)],
}

/// The key that says which variant of a table is meant.
#[derive(Debug)]
pub struct Choice {
    /// `type` or `shape`.
    pub key: &'static str,
    /// What can be chosen.
    pub variants: &'static [Variant],
}

/// One variant of a table.
#[derive(Debug)]
pub struct Variant {
    /// The value of the choosing key.
    pub name: &'static str,
    /// One sentence.
    pub meaning: &'static str,
    /// Its keys beside the table's own.
    pub keys: &'static [Key],
}

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As it is written.
    pub name: &'static str,
    /// What can be written.
    pub kind: Kind,
    /// Unit of its numbers; empty if they have none.
    pub unit: &'static str,
    /// Bounds of each of its numbers.
    pub range: Range,
    /// What holds if it is left out.
    pub default: Default,
    /// One sentence.
    pub meaning: &'static str,
}

/// What kind of value a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A finite number.
    Number,
    /// An integer, not negative.
    Integer,
    /// `true` or `false`.
    Boolean,
    /// One of some strings.
    Choice(&'static [&'static str]),
    /// A string that names the table it stands in.
    Name,
    /// The name of something of this realm.
    Reference(Realm),
    /// Any other string that is not empty.
    Text,
    /// The path of a file, relative to the scene file.
    File,
    /// Two integers, width and height.
    Size,
    /// Two numbers.
    Pair,
    /// Two numbers, or one that stands for both, none of them zero.
    Repeats,
    /// Three numbers.
    Point,
    /// Three numbers, not all zero.
    Vector,
    /// Three numbers, or one that stands for all, none of them zero.
    Scale,
    /// One number, or red, green and blue.
    Colour,
    /// A colour, or the name of a texture.
    ColourOrTexture,
    /// The name of a material, or a material in place.
    Material,
    /// One table.
    Table(&'static Table),
    /// A list of tables.
    Tables(&'static Table),
}

/// A kind of thing that has a name. Names are unique within one realm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Realm {
    /// `[[medium]]`
    Medium,
    /// `[[light]]`
    Light,
    /// `[[texture]]`
    Texture,
    /// `[[material]]`
    Material,
    /// `[[object]]`
    Object,
}

impl Realm {
    /// The word for one of its things, which is also the key of its list.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Medium => "medium",
            Self::Light => "light",
            Self::Texture => "texture",
            Self::Material => "material",
            Self::Object => "object",
        }
    }

    /// The word for several.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Medium => "media",
            Self::Light => "lights",
            Self::Texture => "textures",
            Self::Material => "materials",
            Self::Object => "objects",
        }
    }
}

/// Bounds of a number.
#[derive(Clone, Copy, Debug)]
pub enum Range {
    /// Any finite number.
    Finite,
    /// From the first to the second, both included.
    Closed(f64, f64),
    /// Between the two, neither included.
    Open(f64, f64),
    /// Not below.
    AtLeast(f64),
    /// Integers from the first to the second, both included.
    Whole(u64, u64),
}

/// What holds if a key is left out.
#[derive(Clone, Copy, Debug)]
pub enum Default {
    /// It can't be.
    Required,
    /// The value that this TOML text stands for.
    Toml(&'static str),
    /// What these words say.
    Words(&'static str),
}

impl Key {
    /// A required key without unit and bounds.
    const fn new(name: &'static str, kind: Kind, meaning: &'static str) -> Self {
        Self { name, kind, unit: "", range: Range::Finite, default: Default::Required, meaning }
    }

    /// A position, metres.
    const fn point(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, Kind::Point, meaning).unit("m").range(Range::Closed(-FARTHEST, FARTHEST))
    }

    /// A direction of any length.
    const fn vector(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, Kind::Vector, meaning).range(Range::Closed(-FARTHEST, FARTHEST))
    }

    /// A length, metres.
    const fn length(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, Kind::Number, meaning).unit("m").range(Range::Closed(SMALLEST, FARTHEST))
    }

    /// A number from 0 to 1.
    const fn share(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, Kind::Number, meaning).range(Range::Closed(0.0, 1.0))
    }

    /// A colour of light, not negative.
    const fn light(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, Kind::Colour, meaning).range(Range::AtLeast(0.0))
    }

    const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    const fn range(mut self, range: Range) -> Self {
        self.range = range;
        self
    }

    const fn default(mut self, toml: &'static str) -> Self {
        self.default = Default::Toml(toml);
        self
    }

    const fn or(mut self, words: &'static str) -> Self {
        self.default = Default::Words(words);
        self
    }
}

impl Table {
    /// The keys of the table with this variant: its own and the variant's.
    pub fn keys_with(&self, variant: Option<&'static Variant>) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().chain(variant.map_or(&[][..], |v| v.keys))
    }

    /// Whether it has a key of this name, in any variant.
    pub fn has(&self, name: &str) -> bool {
        let of_variants = self.variants().iter().flat_map(|variant| variant.keys);
        self.keys.iter().chain(of_variants).any(|key| key.name == name)
    }

    /// The variants, none for a table without choice.
    pub fn variants(&self) -> &'static [Variant] {
        self.choice.as_ref().map_or(&[], |choice| choice.variants)
    }
}

impl Range {
    /// Whether `x` lies within; false for what is not finite.
    pub fn contains(self, x: f64) -> bool {
        match self {
            Self::Finite | Self::Whole(..) => x.is_finite(),
            Self::Closed(low, high) => low <= x && x <= high,
            Self::Open(low, high) => low < x && x < high,
            Self::AtLeast(low) => low <= x && x.is_finite(),
        }
    }

    /// Whether zero and what is below are out of bounds.
    pub fn is_positive(self) -> bool {
        match self {
            Self::Finite => false,
            Self::Closed(low, _) | Self::AtLeast(low) => low > 0.0,
            Self::Open(low, _) => low >= 0.0,
            Self::Whole(low, _) => low > 0,
        }
    }

    /// The bounds in words; `None` if there are none.
    pub fn words(self) -> Option<String> {
        match self {
            Self::Finite => None,
            Self::Closed(low, high) => Some(format!("from {} to {}", number(low), number(high))),
            Self::Open(low, high) => {
                Some(format!("more than {} and less than {}", number(low), number(high)))
            }
            Self::AtLeast(low) => Some(format!("{} or more", number(low))),
            Self::Whole(low, high) if low == high => Some(format!("{low}")),
            Self::Whole(low, high) => Some(format!("from {low} to {high}")),
        }
    }
}

/// A number as a person writes it: with an exponent only if it is long.
fn number(x: f64) -> String {
    let plain = format!("{x}");
    if plain.len() > "1000000".len() { format!("{x:e}") } else { plain }
}

impl Kind {
    /// What can be written, in words that fit after "must be".
    pub fn words(self) -> String {
        match self {
            Self::Number => "a number".into(),
            Self::Integer => "an integer".into(),
            Self::Boolean => "true or false".into(),
            Self::Choice(options) => one_of(options),
            Self::Name => "a name (a string)".into(),
            Self::Reference(realm) => format!("the name of a {} (a string)", realm.noun()),
            Self::Text => "a string".into(),
            Self::File => "the path of a file (a string)".into(),
            Self::Size => "[width, height], two integers".into(),
            Self::Pair => "[u, v], two numbers".into(),
            Self::Repeats => "a number or [u, v], none of them zero".into(),
            Self::Point => "[x, y, z], three numbers".into(),
            Self::Vector => "[x, y, z], three numbers, not all zero".into(),
            Self::Scale => "a number or [x, y, z], none of them zero".into(),
            Self::Colour => "a colour: a number or [red, green, blue]".into(),
            Self::ColourOrTexture => {
                "a colour (a number or [red, green, blue]) or the name of a texture (a string)".into()
            }
            Self::Material => "the name of a material (a string) or a material { type = ... }".into(),
            Self::Table(table) => format!("a table {}", table.header),
            Self::Tables(table) => format!("a list of tables {}", table.header),
        }
    }
}

/// `"a", "b" or "c"`.
pub(super) fn one_of(options: &[&str]) -> String {
    let quoted: Vec<String> = options.iter().map(|option| format!("\"{option}\"")).collect();
    match quoted.as_slice() {
        [] => "nothing".into(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_print_as_people_write_them() {
        let shown = [1e12, 1e-12, 0.001, 65536.0, -1e12, 0.0, 1e6].map(number);
        assert_eq!(shown, ["1e12", "1e-12", "0.001", "65536", "-1e12", "0", "1000000"]);
    }

    #[test]
    fn no_name_stands_twice_in_a_table() {
        for table in TABLES {
            for variant in table.variants().iter().map(Some).chain([None]) {
                let mut names: Vec<&str> = table.keys_with(variant).map(|key| key.name).collect();
                names.extend(table.choice.as_ref().map(|choice| choice.key));
                names.sort_unstable();
                let count = names.len();
                names.dedup();
                assert_eq!(names.len(), count, "{} {variant:?}", table.header);
                assert!(table.hints.iter().all(|(hint, _)| !names.contains(hint)), "{}", table.header);
            }
        }
    }
}
