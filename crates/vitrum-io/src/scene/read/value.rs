//! One value: is it of the declared kind, finite, in range, and not degenerate?

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vitrum_math::{DVec2, DVec3, Rgb};

use super::super::schema::{Key, Kind, Range, Realm, SMALLEST, Table};
use super::super::{ColourOrTexture, MAX_ENTRIES, Name};
use super::context::shorten;
use super::{Context, Fields, Problem, suggest};
use crate::diagnostic::Span;

type Value<'v> = Spanned<DeValue<'v>>;

/// `` `fov` (degrees): the vertical angle ``.
pub(super) fn meaning(key: &Key) -> String {
    let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
    format!("`{}`{unit}: {}", key.name, key.meaning)
}

/// A value in words, for "found ...".
fn words(cx: &Context<'_>, value: &Value<'_>) -> String {
    let shown = cx.shown(value.span().into());
    match value.get_ref() {
        DeValue::String(text) => format!("the string \"{}\"", shorten(text)),
        DeValue::Integer(_) => format!("the integer {shown}"),
        DeValue::Float(_) => format!("the number {shown}"),
        DeValue::Boolean(truth) => format!("{truth}"),
        DeValue::Datetime(_) => format!("the date {shown}"),
        DeValue::Array(array) => match array.len() {
            0 => "an empty list".into(),
            1 => "a list of one".into(),
            n => format!("a list of {n}"),
        },
        DeValue::Table(_) => "a table".into(),
    }
}

/// Tells that a value is not of the key's kind.
fn wrong_kind(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) {
    let message = format!("`{}` must be {}", key.name, key.kind.words());
    let found = format!("found {}", words(cx, value));
    cx.report(Problem::error(value.span().into(), message, found).help(meaning(key)));
}

fn out_of_range(cx: &mut Context<'_>, key: &Key, span: Span, not_positive: bool) {
    let bounds = key.range.words().unwrap_or_else(|| "a finite number".into());
    let unit = if key.unit.is_empty() { String::new() } else { format!(" {}", key.unit) };
    let label = format!("found {}, expected {bounds}{unit}", cx.shown(span));
    let message = if not_positive && key.range.is_positive() {
        format!("`{}` must be greater than 0", key.name)
    } else {
        format!("`{}` is out of range", key.name)
    };
    cx.report(Problem::error(span, message, label).help(meaning(key)));
}

/// A number within the key's range: the whole value, or a component of it.
fn component(cx: &mut Context<'_>, key: &Key, whole: &Value<'_>, value: &Value<'_>) -> Option<f64> {
    let number = match value.get_ref() {
        // Every integer of i128 has a nearest f64; longer ones go through the decimal text.
        DeValue::Integer(n) => i128::from_str_radix(n.as_str(), n.radix()).map_or_else(
            |_| if n.radix() == 10 { n.as_str().parse().ok() } else { Some(f64::INFINITY) },
            |n| Some(n as f64),
        ),
        DeValue::Float(x) => x.as_str().parse().ok(),
        _ if std::ptr::eq(whole, value) => {
            wrong_kind(cx, key, whole);
            return None;
        }
        _ => {
            let message = format!("`{}` must be {}", key.name, key.kind.words());
            let found = format!("found {}, expected a number", words(cx, value));
            cx.report(Problem::error(value.span().into(), message, found).help(meaning(key)));
            return None;
        }
    };
    let number: f64 = number?;
    if !number.is_finite() {
        let label = format!("found {}", cx.shown(value.span().into()));
        let message = format!("`{}` must be finite", key.name);
        cx.report(Problem::error(value.span().into(), message, label).help(meaning(key)));
        return None;
    }
    if !key.range.contains(number) {
        out_of_range(cx, key, value.span().into(), number <= 0.0);
        return None;
    }
    Some(number)
}

pub(super) fn number(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<f64> {
    component(cx, key, value, value)
}

pub(super) fn integer(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<u64> {
    let DeValue::Integer(digits) = value.get_ref() else {
        wrong_kind(cx, key, value);
        return None;
    };
    let Range::Whole(low, high) = key.range else { panic!("integer `{}` without bounds", key.name) };
    let number = i128::from_str_radix(digits.as_str(), digits.radix()).ok();
    let within = number.and_then(|n| u64::try_from(n).ok()).filter(|n| (low..=high).contains(n));
    if within.is_none() {
        out_of_range(cx, key, value.span().into(), number.is_some_and(|n| n <= 0));
    }
    within
}

pub(super) fn boolean(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<bool> {
    let truth = value.get_ref().as_bool();
    if truth.is_none() {
        wrong_kind(cx, key, value);
    }
    truth
}

/// The one of `names` that the string is.
pub(super) fn one_of_names<'n>(
    cx: &mut Context<'_>,
    key: &str,
    names: &[&'n str],
    value: &Value<'_>,
) -> Option<&'n str> {
    let expected = super::super::schema::one_of(names);
    let span = value.span().into();
    let Some(text) = value.get_ref().as_str() else {
        let label = format!("found {}", words(cx, value));
        cx.report(Problem::error(span, format!("`{key}` must be {expected}"), label));
        return None;
    };
    let found = names.iter().copied().find(|name| *name == text);
    if found.is_none() {
        let message = format!("unknown `{key}`: \"{}\"", shorten(text));
        let problem = match suggest::nearest(text, names.iter().copied()) {
            Some(near) => Problem::error(span, message, format!("did you mean \"{near}\"?")),
            None => Problem::error(span, message, "not one of its values"),
        };
        let only = if names.len() == 1 { "only " } else { "" };
        cx.report(problem.help(format!("`{key}` can {only}be {expected}")));
    }
    found
}

/// The numbers of an array, which must be `N`.
fn numbers<const N: usize>(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<[f64; N]> {
    let Some(array) = value.get_ref().as_array().filter(|array| array.len() == N) else {
        wrong_kind(cx, key, value);
        return None;
    };
    let mut numbers = [0.0; N];
    let mut complete = true;
    for (number, entry) in numbers.iter_mut().zip(array) {
        match component(cx, key, value, entry) {
            Some(found) => *number = found,
            // On to the next: it may be wrong as well.
            None => complete = false,
        }
    }
    complete.then_some(numbers)
}

pub(super) fn pair(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec2> {
    numbers(cx, key, value).map(DVec2::from_array)
}

/// One number for both, or two; none of them zero.
pub(super) fn repeats(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec2> {
    let factors = match value.get_ref() {
        DeValue::Integer(_) | DeValue::Float(_) => number(cx, key, value).map(DVec2::splat),
        _ => pair(cx, key, value),
    }?;
    if factors.abs().min_element() < SMALLEST {
        let label =
            format!("found {}, expected factors of at least {SMALLEST:e}", cx.shown(value.span().into()));
        let message = format!("`{}` is singular: all of the surface shows one line of the image", key.name);
        cx.report(Problem::error(value.span().into(), message, label).help(meaning(key)));
        return None;
    }
    Some(factors)
}

pub(super) fn point(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec3> {
    numbers(cx, key, value).map(DVec3::from_array)
}

pub(super) fn vector(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec3> {
    let vector = point(cx, key, value)?;
    if vector.length() < SMALLEST {
        let what = if vector == DVec3::ZERO { "zero" } else { "too short" };
        let message = format!("`{}` is {what}: it has no direction", key.name);
        let label = format!("length {}, expected at least {SMALLEST:e}", vector.length());
        cx.report(Problem::error(value.span().into(), message, label).help(meaning(key)));
        return None;
    }
    Some(vector)
}

pub(super) fn scale(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec3> {
    let factors = number_or_three(cx, key, value)?;
    if factors.abs().min_element() < SMALLEST {
        let label =
            format!("found {}, expected factors of at least {SMALLEST:e}", cx.shown(value.span().into()));
        let message = format!("`{}` is singular: it flattens the object", key.name);
        cx.report(Problem::error(value.span().into(), message, label).help(meaning(key)));
        return None;
    }
    Some(factors)
}

/// One number for all three, or three.
fn number_or_three(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<DVec3> {
    match value.get_ref() {
        DeValue::Integer(_) | DeValue::Float(_) => number(cx, key, value).map(DVec3::splat),
        _ => point(cx, key, value),
    }
}

pub(super) fn colour(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<Rgb> {
    number_or_three(cx, key, value)
}

pub(super) fn colour_or_texture(
    cx: &mut Context<'_>,
    key: &Key,
    value: &Value<'_>,
) -> Option<ColourOrTexture> {
    if value.get_ref().is_str() {
        used_name(cx, key, Realm::Texture, value).map(ColourOrTexture::Texture)
    } else {
        colour(cx, key, value).map(ColourOrTexture::Colour)
    }
}

/// Width and height; their product is checked by whoever asks.
pub(super) fn size(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<[u32; 2]> {
    let Some(array) = value.get_ref().as_array().filter(|array| array.len() == 2) else {
        wrong_kind(cx, key, value);
        return None;
    };
    let sides: Vec<Option<u64>> = array.iter().map(|side| integer(cx, key, side)).collect();
    let side = |i: usize| sides[i].map(|n| u32::try_from(n).expect("the declared range lies within u32"));
    Some([side(0)?, side(1)?])
}

/// A string that is not empty and has no control characters.
pub(super) fn text(cx: &mut Context<'_>, key: &Key, value: &Value<'_>) -> Option<Name> {
    let Some(text) = value.get_ref().as_str() else {
        wrong_kind(cx, key, value);
        return None;
    };
    let wrong = match text {
        "" => Some("is empty"),
        _ if text.contains(char::is_control) => Some("contains a control character"),
        _ => None,
    };
    if let Some(wrong) = wrong {
        let message = format!("`{}` {wrong}", key.name);
        cx.report(Problem::error(value.span().into(), message, "expected readable text").help(meaning(key)));
        return None;
    }
    Some(Name { text: text.to_string(), span: value.span().into() })
}

/// A name that is used here and given elsewhere.
pub(super) fn used_name(cx: &mut Context<'_>, key: &Key, realm: Realm, value: &Value<'_>) -> Option<Name> {
    let name = text(cx, key, value)?;
    cx.used.push((realm, name.clone()));
    Some(name)
}

pub(super) fn table<'v>(cx: &mut Context<'_>, key: &Key, value: &'v Value<'_>) -> Option<&'v DeTable<'v>> {
    let table = value.get_ref().as_table();
    if table.is_none() {
        let doubled = value.get_ref().as_array().and_then(|array| array.iter().next()?.get_ref().as_table());
        match (doubled, key.kind) {
            (Some(_), Kind::Table(Table { header, .. })) => {
                let message = format!("`{}` is one table, not a list", key.name);
                cx.report(
                    Problem::error(value.span().into(), message, "found a list")
                        .help(format!("write {header} with single brackets, once")),
                );
            }
            _ => wrong_kind(cx, key, value),
        }
    }
    table
}

pub(super) fn tables<'v>(
    cx: &mut Context<'_>,
    key: &Key,
    value: &'v Value<'_>,
) -> Option<Vec<(&'v DeTable<'v>, Span)>> {
    let Kind::Tables(Table { header, .. }) = key.kind else {
        panic!("`{}` is not a list of tables", key.name)
    };
    let span: Span = value.span().into();
    let Some(array) = value.get_ref().as_array() else {
        let message = format!("`{}` is a list of tables", key.name);
        let label = format!("found {}", words(cx, value));
        let help = match value.get_ref() {
            DeValue::String(_) if key.name == "medium" => {
                "the medium around everything is `medium` of [surroundings]".to_string()
            }
            DeValue::Table(_) if header.starts_with('{') => {
                format!("put brackets around it: {} = [{{ ... }}]", key.name)
            }
            _ if header.starts_with('{') => format!("write {} = [{header}]", key.name),
            _ => format!("write {header} with double brackets, once for each"),
        };
        cx.report(Problem::error(span, message, label).help(help));
        return None;
    };
    if array.len() > MAX_ENTRIES {
        let message = format!("`{}` has {} entries", key.name, array.len());
        cx.report(Problem::error(span, message, format!("at most {MAX_ENTRIES} are read")));
        return None;
    }
    let mut entries = Vec::with_capacity(array.len());
    for entry in array {
        match entry.get_ref().as_table() {
            Some(table) => entries.push((table, entry.span().into())),
            None => {
                let message = format!("`{}` is a list of tables", key.name);
                let label = format!("found {}, expected {header}", words(cx, entry));
                cx.report(Problem::error(entry.span().into(), message, label));
            }
        }
    }
    Some(entries)
}

/// Asking a table for values of these kinds.
impl Fields<'_, '_> {
    pub(super) fn point(&mut self, name: &'static str) -> Option<DVec3> {
        self.read(name, point)
    }

    pub(super) fn vector(&mut self, name: &'static str) -> Option<DVec3> {
        self.read(name, vector)
    }

    pub(super) fn colour(&mut self, name: &'static str) -> Option<Rgb> {
        self.read(name, colour)
    }

    pub(super) fn colour_or_texture(&mut self, name: &'static str) -> Option<ColourOrTexture> {
        self.read(name, colour_or_texture)
    }

    pub(super) fn text(&mut self, name: &'static str) -> Option<Name> {
        self.read(name, text)
    }

    /// The name of something else; a default stands nowhere in the file.
    pub(super) fn reference(&mut self, name: &'static str) -> Option<Name> {
        let found = self.read(name, |cx, key, value| {
            let Kind::Reference(realm) = key.kind else { panic!("`{name}` is not a reference") };
            used_name(cx, key, realm, value)
        });
        found.map(|found| if self.has(name) { found } else { Name::new(found.text) })
    }
}
