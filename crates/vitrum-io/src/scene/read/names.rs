//! Names are unique within their realm, and what is referred to exists.

use super::super::Name;
use super::super::schema::Realm;
use super::context::shorten;
use super::{Context, Fields, Problem, suggest};
use vitrum_materials::NamedMedium;

/// Names listed in a help line.
const LISTED: usize = 8;

impl Fields<'_, '_> {
    /// The `name` of this table, noted as one of `realm`.
    pub(super) fn name(&mut self, realm: Realm) -> Option<Name> {
        let name = self.text("name")?;
        define(self.cx, realm, &name);
        Some(name)
    }
}

fn define(cx: &mut Context<'_>, realm: Realm, name: &Name) {
    let quoted = shorten(&name.text);
    // What is there in every scene may be taken to be something else, but not nothing.
    if realm == Realm::Medium && ["air", "vacuum"].contains(&name.text.as_str()) {
        let problem =
            Problem::error(name.span, format!("the medium \"{quoted}\" is there already"), "predefined");
        cx.report(problem.help("leave this table out, or take another name"));
        return;
    }
    let first = *cx.defined.entry(realm).or_default().entry(name.text.clone()).or_insert(name.span);
    if first != name.span {
        let message = format!("the name \"{quoted}\" is given to two {}", realm.plural());
        let problem = Problem::error(name.span, message, "second time").also(first, "first time");
        cx.report(problem.help("rename one of them"));
    }
}

/// Tells the references to what does not exist.
pub(super) fn resolve(cx: &mut Context<'_>) {
    if !cx.broken.is_empty() {
        // The name may stand in what could not be read.
        return;
    }
    for (realm, name) in std::mem::take(&mut cx.used) {
        let predefined = NamedMedium::ALL.iter().map(|medium| medium.name).filter(|_| realm == Realm::Medium);
        let defined = cx.defined.get(&realm);
        let all = || {
            predefined.clone().chain(defined.into_iter().flat_map(|names| names.keys().map(String::as_str)))
        };
        if predefined.clone().any(|known| known == name.text)
            || defined.is_some_and(|d| d.contains_key(&name.text))
        {
            continue;
        }
        let noun = realm.noun();
        let message = format!("unknown {noun} \"{}\"", shorten(&name.text));
        let label = match suggest::nearest(&name.text, all()) {
            Some(near) => format!("did you mean \"{}\"?", shorten(near)),
            None => format!("no [[{noun}]] has this name"),
        };
        let known: Vec<String> = all().take(LISTED).map(|name| format!("\"{}\"", shorten(name))).collect();
        let more = if all().nth(LISTED).is_some() { ", ..." } else { "" };
        let help = match known.as_slice() {
            [] => format!("give a [[{noun}]] this name"),
            _ => format!("known names: {}{more}", known.join(", ")),
        };
        cx.report(Problem::error(name.span, message, label).help(help));
    }
}
