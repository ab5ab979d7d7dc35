//! One table: its unknown, missing, defaulted and unread keys.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::super::schema::{Default, Key, Kind, TABLES, Table, Variant, one_of};
use super::context::shorten;
use super::{Context, Problem, suggest, value};
use crate::diagnostic::{Severity, Span};

/// A table being read: opened against its schema, asked for every key of it by name, then closed.
pub(super) struct Fields<'f, 's> {
    pub(super) cx: &'f mut Context<'s>,
    schema: &'static Table,
    variant: Option<&'static Variant>,
    table: &'f DeTable<'f>,
    span: Span,
    unread: Vec<&'static str>,
    /// Keys that an unknown one was taken for: they are not missing as well.
    misspelt: Vec<&'static str>,
}

impl<'f, 's> Fields<'f, 's> {
    /// Starts on `table`, whose header stands at `span` (0..0 for the file itself): finds out which variant it is, and
    /// tells the keys that do not belong.
    pub(super) fn open(
        cx: &'f mut Context<'s>,
        schema: &'static Table,
        table: &'f DeTable<'f>,
        span: Span,
    ) -> Self {
        let mut fields =
            Self { cx, schema, variant: None, table, span, unread: Vec::new(), misspelt: Vec::new() };
        fields.variant = fields.choose();
        fields.unread = schema.keys_with(fields.variant).map(|key| key.name).collect();
        fields.refuse_unknown();
        fields
    }

    /// The name of the variant; `None` if it is not known.
    pub(super) fn variant(&self) -> Option<&'static str> {
        self.variant.map(|variant| variant.name)
    }

    /// Ends the table.
    ///
    /// # Panics
    /// If a key of the schema was not asked for: schema and reader have drifted apart.
    pub(super) fn close(self) {
        let (header, variant) = (self.schema.header, self.variant());
        // Without a variant the reader can't know what to ask for.
        if self.schema.choice.is_none() || variant.is_some() {
            assert!(
                self.unread.is_empty(),
                "{header} {variant:?}: declared, but not read: {:?}",
                self.unread
            );
        }
    }

    /// Where the value of `key` stands; the table's header if it is left out.
    pub(super) fn span_of(&self, key: &str) -> Span {
        self.table.get(key).map_or(self.span, |value| value.span().into())
    }

    /// Whether `key` is written out.
    pub(super) fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// Asks for a key: its value or default through `convert`. `None` if it is absent, or wrong, which has been told.
    pub(super) fn read<T>(
        &mut self,
        name: &'static str,
        convert: impl FnOnce(&mut Context<'s>, &Key, &Spanned<DeValue<'_>>) -> Option<T>,
    ) -> Option<T> {
        self.unread.retain(|unread| *unread != name);
        let key = self.schema.keys_with(self.variant).find(|key| key.name == name).unwrap_or_else(|| {
            panic!("`{name}` is not declared for {} {:?}", self.schema.header, self.variant())
        });
        if let Some(value) = self.table.get(name) {
            return convert(self.cx, key, value);
        }
        match key.default {
            Default::Toml(text) => {
                let value = DeValue::parse(text).expect("defaults are valid TOML");
                convert(self.cx, key, &value)
            }
            Default::Words(_) => None,
            Default::Required => {
                self.tell_missing(key);
                None
            }
        }
    }

    /// The table under `name`.
    pub(super) fn table<T>(
        &mut self,
        name: &'static str,
        read: impl FnOnce(&mut Context<'s>, &DeTable<'_>, Span) -> Option<T>,
    ) -> Option<T> {
        self.read(name, |cx, key, value| {
            let table = value::table(cx, key, value)?;
            read(cx, table, value.span().into())
        })
    }

    /// The table under `name`, or an empty one.
    pub(super) fn table_or_default<T>(
        &mut self,
        name: &'static str,
        read: impl Fn(&mut Context<'s>, &DeTable<'_>, Span) -> Option<T>,
    ) -> Option<T> {
        let written = self.table(name, &read);
        if self.has(name) { written } else { read(self.cx, &DeTable::new(), self.span) }
    }

    /// The tables of the list under `name` that could be read.
    pub(super) fn tables<T>(
        &mut self,
        name: &'static str,
        mut read: impl FnMut(&mut Context<'s>, &DeTable<'_>, Span) -> Option<T>,
    ) -> Vec<T> {
        let list = self.read(name, |cx, key, value| {
            let entries = value::tables(cx, key, value)?;
            Some(entries.into_iter().filter_map(|(table, span)| read(cx, table, span)).collect())
        });
        list.unwrap_or_default()
    }

    /// Such a table in words: `an object with shape = "box"`.
    fn words(&self) -> String {
        let noun = self.schema.noun;
        match (&self.schema.choice, self.variant) {
            (Some(choice), Some(variant)) => format!("{noun} with {} = \"{}\"", choice.key, variant.name),
            _ => noun.to_string(),
        }
    }

    fn choose(&mut self) -> Option<&'static Variant> {
        let choice = self.schema.choice.as_ref()?;
        let names: Vec<&str> = choice.variants.iter().map(|variant| variant.name).collect();
        let Some(value) = self.table.get(choice.key) else {
            let label = format!("expected {} = {}", choice.key, one_of(&names));
            let message = format!("`{}` is missing in {}", choice.key, self.schema.noun);
            self.cx.report_missing(Problem::error(self.span, message, label));
            return None;
        };
        let name = value::one_of_names(self.cx, choice.key, &names, value)?;
        choice.variants.iter().find(|variant| variant.name == name)
    }

    fn tell_missing(&mut self, key: &Key) {
        if self.misspelt.contains(&key.name) {
            return;
        }
        let message = format!("`{}` is missing in {}", key.name, self.words());
        let problem = if self.span == Span::default() {
            Problem::of_file(message).help(format!("add {}: {}", key.kind.words(), key.meaning))
        } else {
            let label = format!("expected `{}`, {}", key.name, key.kind.words());
            Problem::error(self.span, message, label).help(value::meaning(key))
        };
        self.cx.report_missing(problem);
    }

    fn refuse_unknown(&mut self) {
        let known = |name: &str| {
            let is_choice = self.schema.choice.as_ref().is_some_and(|choice| choice.key == name);
            // Of an unknown variant any key may be meant.
            let any = self.variant.is_none() && !self.homes(name).is_empty();
            is_choice || any || self.schema.keys_with(self.variant).any(|key| key.name == name)
        };
        let unknown: Vec<_> = self.table.keys().filter(|key| !known(key.get_ref())).collect();
        for key in unknown {
            // Suggestions take time, and nobody would read them.
            if self.cx.diagnostics.is_full(Severity::Error) {
                self.cx.diagnostics.omit();
                continue;
            }
            let (problem, near) = self.unknown(key.get_ref(), key.span().into());
            self.cx.report(problem);
            self.misspelt.extend(near);
        }
    }

    /// The variants that have a key of this name.
    fn homes(&self, name: &str) -> Vec<&'static str> {
        let has = |variant: &&Variant| variant.keys.iter().any(|key| key.name == name);
        self.schema.variants().iter().filter(has).map(|variant| variant.name).collect()
    }

    /// The problem of an unknown key, and the key that was perhaps meant.
    fn unknown(&self, name: &str, span: Span) -> (Problem, Option<&'static str>) {
        let quoted = shorten(name);
        let choice_key = self.schema.choice.as_ref().map(|choice| choice.key);
        let mut allowed: Vec<&'static str> = choice_key.into_iter().collect();
        allowed.extend(self.schema.keys_with(self.variant).map(|key| key.name));
        if self.variant.is_none() {
            allowed
                .extend(self.schema.variants().iter().flat_map(|variant| variant.keys).map(|key| key.name));
            allowed.sort_unstable();
            allowed.dedup();
        }
        let list = allowed.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
        let list = format!("keys here: {list}");

        let homes = self.homes(name);
        if !homes.is_empty() {
            let message = format!("`{quoted}` does not belong to {}", self.words());
            let label = format!("goes with {} = {}", choice_key.unwrap_or_default(), one_of(&homes));
            return (Problem::error(span, message, label).help(list), None);
        }
        let problem =
            |label: &str| Problem::error(span, format!("unknown key `{quoted}` in {}", self.words()), label);
        if let Some((_, advice)) = self.schema.hints.iter().find(|(hint, _)| *hint == name) {
            return (problem("not a key here").help(*advice), None);
        }
        let near = suggest::nearest(name, allowed.iter().copied());
        let elsewhere: Vec<&str> =
            TABLES.iter().filter(|table| table.has(name)).map(|table| table.header).collect();
        if near.is_none() && !elsewhere.is_empty() {
            let help = format!(
                "`{quoted}` is a key of {}; a key belongs to the header above it",
                elsewhere.join(", ")
            );
            return (problem("not a key here").help(help), None);
        }
        let label = near.map_or("not a key here".to_string(), |near| format!("did you mean `{near}`?"));
        (problem(&label).help(list), near)
    }
}

/// Asking by kind. Each tells what is wrong with the value, and is `None` then or if the key is absent.
impl Fields<'_, '_> {
    pub(super) fn number(&mut self, name: &'static str) -> Option<f64> {
        self.read(name, value::number)
    }

    pub(super) fn integer(&mut self, name: &'static str) -> Option<u64> {
        self.read(name, value::integer)
    }

    /// An integer whose declared range lies within `u32`.
    pub(super) fn small_integer(&mut self, name: &'static str) -> Option<u32> {
        self.integer(name).map(|n| u32::try_from(n).expect("the declared range lies within u32"))
    }

    pub(super) fn boolean(&mut self, name: &'static str) -> Option<bool> {
        self.read(name, value::boolean)
    }

    /// One of `options`, which are those of the schema in its order.
    pub(super) fn choice<T: Copy>(&mut self, name: &'static str, options: &[(&str, T)]) -> Option<T> {
        self.read(name, |cx, key, value| {
            let names: Vec<&str> = options.iter().map(|(name, _)| *name).collect();
            assert!(
                matches!(key.kind, Kind::Choice(declared) if declared == names),
                "`{name}` has other options"
            );
            let chosen = value::one_of_names(cx, key.name, &names, value)?;
            options.iter().find(|(name, _)| *name == chosen).map(|(_, option)| *option)
        })
    }
}
