//! From text to TOML values. The parser goes on after an error, at the cost of follow-on errors. So only the first error
//! of each statement is told; a bracket that is never closed, and would swallow the rest of the file, is told as that,
//! and what follows is read as if the statement were not there.

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::context::shorten;
use super::{Context, Problem};
use crate::diagnostic::{Severity, Span};

/// In texts larger than this only the first syntax error is looked for: what is no scene at all, but a picture or a
/// mesh, has an error in every line.
const RECOVERED_BYTES: usize = 1 << 20;

/// Brackets never closed that are told.
const MOST_UNCLOSED: usize = 16;

/// Parses `text`, tells what is not TOML, and returns what could be read. `mended` is room for a text of which parts
/// are blanked out.
pub(super) fn parse<'t>(cx: &mut Context<'_>, text: &'t str, mended: &'t mut String) -> DeTable<'t> {
    let first = match DeTable::parse(text) {
        Ok(table) => return table.into_inner(),
        Err(error) => error,
    };
    if text.len() > RECOVERED_BYTES {
        tell(cx, &[first], text, &DeTable::new(), &[]);
        return DeTable::new();
    }
    mended.push_str(text);
    blank_unclosed(cx, mended);
    let mended = mended.as_str();
    let (table, mut errors) = DeTable::parse_recoverable(mended);
    let table = table.into_inner();
    errors.sort_by_key(|error| span_of(error).start);
    tell(cx, &errors, mended, &table, &statements(&table, mended));
    cx.broken.sort_unstable();
    table
}

/// Tells the brackets that are never closed, and blanks out their statements, up to what looks like the next one.
fn blank_unclosed(cx: &mut Context<'_>, text: &mut String) {
    for _ in 0..MOST_UNCLOSED {
        let (table, errors) = DeTable::parse_recoverable(text);
        let at_end = errors.iter().find(|error| error.message().starts_with("unclosed array"));
        let unclosed = at_end.and_then(|error| {
            let statements = statements(table.get_ref(), text);
            statement_at(&statements, span_of(error)).map(|statement| (statement.whole, statement.value))
        });
        let Some((whole, value)) = unclosed else { return };
        // At the end of the text there is none: the parser may have come that far for the value.
        let length = text[value.start..].chars().next().map_or(0, char::len_utf8);
        let bracket = Span { start: value.start, end: value.start + length };
        let problem = Problem::error(bracket, "this bracket is never closed", "opened here");
        cx.report_anyway(problem.help("close it where its list ends"));
        let end = next_statement(text, whole.start).unwrap_or(text.len());
        let lost =
            cx.source.whole_lines(Span { start: whole.start, end: end.saturating_sub(1).max(whole.start) });
        cx.broken.push(lost);
        let blanks: String =
            text[lost.start..lost.end].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }).collect();
        text.replace_range(lost.start..lost.end, &blanks);
    }
}

/// The start of the first line after the one at `from` that begins like a statement: `key =`, `[header]`, `[[header]]`.
fn next_statement(text: &str, from: usize) -> Option<usize> {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let begins = |line: &str| {
        let line = line.trim();
        let header = line.trim_start_matches('[').trim_end_matches(']');
        let is_header = line.starts_with('[') && header.starts_with(|c: char| c.is_ascii_alphabetic());
        let key = line.split_once('=').map(|(key, _)| key.trim());
        (is_header && header.chars().all(is_bare))
            || key.is_some_and(|key| !key.is_empty() && key.chars().all(is_bare))
    };
    let mut start = from;
    for line in text[from..].split_inclusive('\n') {
        if start > from && begins(line) {
            return Some(start);
        }
        start += line.len();
    }
    None
}

/// Tells the first of the errors (sorted by place) of each statement.
fn tell(cx: &mut Context<'_>, errors: &[Error], text: &str, table: &DeTable<'_>, statements: &[Statement]) {
    let mut rest = errors;
    while let Some(first) = rest.first() {
        let at = span_of(first);
        let mut extent =
            cx.source.whole_lines(statement_at(statements, at).map_or(at, |statement| statement.whole));
        let header = text[extent.start..].trim_start().starts_with('[');
        if header && first.message() == "duplicate key" {
            // Its keys are read as if they stood under the first header: they are lost, whatever they are.
            let end = text[extent.end..].find("\n[").map_or(text.len(), |length| extent.end + length);
            extent = Span { end, ..extent };
        }
        if cx.diagnostics.is_full(Severity::Error) {
            cx.diagnostics.omit();
        } else {
            cx.report_anyway(explain(first, text, table));
        }
        cx.broken.push(extent);
        let group = rest.iter().take_while(|error| span_of(error).start <= extent.end).count();
        rest = &rest[group.max(1)..];
    }
}

fn span_of(error: &Error) -> Span {
    error.span().unwrap_or_default().into()
}

/// A key and its value outside of brackets.
struct Statement {
    whole: Span,
    value: Span,
}

/// All statements, from top to bottom.
fn statements(table: &DeTable<'_>, text: &str) -> Vec<Statement> {
    let mut statements = Vec::new();
    list_statements(table, text, &mut statements);
    statements.sort_by_key(|statement| statement.whole.start);
    statements
}

fn list_statements(table: &DeTable<'_>, text: &str, statements: &mut Vec<Statement>) {
    // A table under a header of its own has the header's span, one in braces that of the braces.
    let under_header = |value: &Spanned<DeValue<'_>>| !text[value.span().start..].starts_with('{');
    for (key, value) in table {
        let entries: Vec<&DeTable<'_>> = match value.get_ref() {
            DeValue::Table(inner) if under_header(value) => vec![inner],
            DeValue::Array(array) => array
                .iter()
                .filter(|entry| under_header(entry))
                .filter_map(|entry| entry.get_ref().as_table())
                .collect(),
            _ => Vec::new(),
        };
        for inner in &entries {
            list_statements(inner, text, statements);
        }
        if entries.is_empty() {
            let whole = Span { start: key.span().start, end: value.span().end.max(key.span().end) };
            statements.push(Statement { whole, value: value.span().into() });
        }
    }
}

fn statement_at(statements: &[Statement], at: Span) -> Option<&Statement> {
    let after = statements.partition_point(|statement| statement.whole.start <= at.start);
    statements[..after].last().filter(|statement| at.start <= statement.whole.end)
}

/// The parser's message in our form.
fn explain(error: &Error, text: &str, table: &DeTable<'_>) -> Problem {
    let span = span_of(error);
    let marked = text.get(span.start..span.end).unwrap_or("");
    let (what, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    match what {
        "duplicate key" => {
            let first = earlier_key(table, marked, span.start).or_else(|| earlier_header(text, span.start));
            let problem =
                Problem::error(span, format!("`{}` is there already", shorten(marked)), "second time");
            let problem = first.into_iter().fold(problem, |problem, first| problem.also(first, "first time"));
            problem.help("only a list, with double brackets as in [[object]], can stand several times")
        }
        "string values must be quoted" if marked.is_empty() => {
            Problem::error(span, "a value is missing", "expected a value here")
        }
        "string values must be quoted" | "invalid boolean" => Problem::error(
            span,
            "this is not a value",
            "expected a number, true, false, a string, [...] or {...}",
        )
        .help(format!("a string stands in quotes: \"{}\"", shorten(marked))),
        "invalid basic string" | "invalid literal string" if marked.is_empty() => {
            Problem::error(span, "this string is never closed", format!("expected {expected}"))
        }
        "unclosed table" | "unclosed array table" => {
            Problem::error(span, "this header is never closed", format!("expected {expected}"))
        }
        _ if expected.is_empty() => Problem::error(span, format!("not valid TOML: {what}"), "here"),
        _ => Problem::error(span, format!("not valid TOML: {what}"), format!("expected {expected}")),
    }
}

/// The last key `name` that stands before `before`.
fn earlier_key(table: &DeTable<'_>, name: &str, before: usize) -> Option<Span> {
    let name = name.trim_matches(['"', '\'']);
    let mut found: Option<Span> = None;
    for (key, value) in table {
        let here = (key.get_ref() == name).then(|| Span::from(key.span()));
        let inner = match value.get_ref() {
            DeValue::Table(inner) => earlier_key(inner, name, before),
            DeValue::Array(array) => {
                array.iter().filter_map(|entry| earlier_key(entry.get_ref().as_table()?, name, before)).max()
            }
            _ => None,
        };
        found = found.max(here.filter(|span| span.start < before)).max(inner);
    }
    found
}

/// The same header line as the one at `at`, further up.
fn earlier_header(text: &str, at: usize) -> Option<Span> {
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let header = text[start..].lines().next()?.trim_end();
    let above = |first: usize| (first == 0 || text[..first].ends_with('\n')).then_some(first);
    text[..start]
        .match_indices(header)
        .find_map(|(first, _)| above(first))
        .map(|first| Span { start: first, end: first + header.len() })
}
