//! Problems in an input file, told so that the reader can mend them: what was found, what was expected, where, and
//! how to fix it.
//!
//! ```text
//! error: `radius` is out of range
//!   --> scene.toml:12:10
//!    |
//! 12 | radius = -1
//!    |          ^^ found -1, expected from 1e-12 to 1e12 m
//!    |
//!    = help: `radius` is the sphere's radius
//! ```
//!
//! Spans are byte ranges of the text. Lines and columns count from 1; a column is a character, whatever its width on a
//! screen. The text is plain: no colours, and control characters of the file never reach the terminal.

use std::fmt;

/// A byte range of a source text, end excluded. The default, 0..0, stands for "built in code, no text".
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// Whether the two ranges share a byte or touch.
    pub fn touches(self, other: Self) -> bool {
        self.start <= other.end && other.start <= self.end
    }
}

impl From<std::ops::Range<usize>> for Span {
    fn from(range: std::ops::Range<usize>) -> Self {
        Self { start: range.start, end: range.end }
    }
}

/// A named text that spans point into.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    name: &'a str,
    text: &'a str,
    line_starts: Vec<usize>,
}

impl<'a> Source<'a> {
    /// A source called `name` in messages. With an empty `text` (a scene built in code), places show the name alone.
    pub fn new(name: &'a str, text: &'a str) -> Self {
        let after_newlines = text.bytes().enumerate().filter(|&(_, b)| b == b'\n').map(|(i, _)| i + 1);
        Self { name, text, line_starts: std::iter::once(0).chain(after_newlines).collect() }
    }

    /// The name in messages, as a rule the path that the user gave.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// The text under `span`, cut to what exists.
    pub fn slice(&self, span: Span) -> &'a str {
        self.text.get(span.start..span.end).unwrap_or("")
    }

    /// `span` grown to whole lines, without the last line's end.
    pub fn whole_lines(&self, span: Span) -> Span {
        let (start, _) = self.line(self.line_index(span.start));
        let last = self.line_index(span.end.max(span.start));
        let (end_start, end_line) = self.line(last);
        Span { start, end: end_start + end_line.len() }
    }

    /// `span` grown to before the next line that begins with a bracket, as the headers of a TOML file do.
    pub(crate) fn up_to_next_header(&self, span: Span) -> Span {
        let after = self.text.get(span.end..).unwrap_or("");
        Span { end: after.find("\n[").map_or(self.text.len(), |length| span.end + length), ..span }
    }

    fn line_index(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset) - 1
    }

    /// Start and text of a line, without its end.
    fn line(&self, index: usize) -> (usize, &'a str) {
        let start = self.line_starts[index];
        let end = self.line_starts.get(index + 1).map_or(self.text.len(), |next| next - 1);
        let line = &self.text[start..end];
        (start, line.strip_suffix('\r').unwrap_or(line))
    }

    /// The place of `span`, with its line's text. Only the first line of a longer span is shown.
    fn place(&self, span: Span, label: String) -> Place {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let index = self.line_index(start);
        let (line_start, line) = self.line(index);
        let before = &line[..(start - line_start).min(line.len())];
        // A byte order mark has no column.
        let column = before.trim_start_matches('\u{feff}').chars().count();
        let end = span.end.max(start).min(line_start + line.len()).max(line_start + before.len());
        let marked = line.get(before.len()..end - line_start).unwrap_or("");
        let mut excerpt = Excerpt::default();
        excerpt.fill(before, marked, &line[before.len() + marked.len()..]);
        Place { line: index + 1, column: column + 1, span, label, excerpt }
    }
}

/// Where a problem is: a position, its line, and what to say there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The bytes in question.
    pub span: Span,
    /// What was found there and what was expected.
    pub label: String,
    excerpt: Excerpt,
}

/// A line ready to print, and the part of it to underline, both in characters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Excerpt {
    text: String,
    indent: usize,
    width: usize,
}

impl Excerpt {
    /// Characters shown before and after the place where the mark starts; longer lines are cut with an ellipsis.
    const BEFORE: usize = 60;
    const AFTER: usize = 60;

    fn fill(&mut self, before: &str, marked: &str, after: &str) {
        let before = before.trim_start_matches('\u{feff}');
        let (skip, _) = before.char_indices().rev().nth(Self::BEFORE - 1).unwrap_or((0, ' '));
        if skip > 0 {
            self.text.push('…');
        }
        before[skip..].chars().for_each(|c| self.push(c));
        self.indent = self.text.chars().count();
        marked.chars().take(Self::AFTER).for_each(|c| self.push(c));
        self.width = (self.text.chars().count() - self.indent).max(1);
        let room = Self::AFTER.saturating_sub(self.width);
        after.chars().take(room).for_each(|c| self.push(c));
        if marked.chars().nth(Self::AFTER).is_some() || after.chars().nth(room).is_some() {
            self.text.push('…');
        }
    }

    fn push(&mut self, c: char) {
        match c {
            '\t' => self.text.push_str("    "),
            c if c.is_control() => self.text.push('\u{fffd}'),
            c => self.text.push(c),
        }
    }
}

/// How bad a problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input is refused.
    Error,
    /// The input is taken, but is perhaps not what was meant.
    Warning,
}

/// One problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, in one line.
    pub message: String,
    /// The file it is in.
    pub file: String,
    /// The place in that file; none if it concerns the file as a whole.
    pub place: Option<Place>,
    /// Other places in the same file that belong to it, such as the first of two equal names.
    pub related: Vec<Place>,
    /// How to mend it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error that concerns the file called `file` as a whole, until [`at`](Self::at) gives it a place.
    pub fn error(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, file.into(), message.into())
    }

    /// A warning, as [`error`](Self::error).
    pub fn warning(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, file.into(), message.into())
    }

    fn new(severity: Severity, file: String, message: String) -> Self {
        Self { severity, message, file, place: None, related: Vec::new(), help: None }
    }

    /// Puts the problem at `span` of `source`.
    #[must_use]
    pub fn at(mut self, source: &Source<'_>, span: Span, label: impl Into<String>) -> Self {
        if !source.text.is_empty() {
            self.place = Some(source.place(span, label.into()));
        }
        self
    }

    /// Adds another place of the same source.
    #[must_use]
    pub fn also(mut self, source: &Source<'_>, span: Span, label: impl Into<String>) -> Self {
        if !source.text.is_empty() {
            self.related.push(source.place(span, label.into()));
        }
        self
    }

    /// Says how to mend it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    fn write_place(
        &self,
        f: &mut fmt::Formatter<'_>,
        place: &Place,
        gutter: usize,
        main: bool,
    ) -> fmt::Result {
        let (arrow, mark) = if main { ("-->", "^") } else { (":::", "-") };
        let Excerpt { text, indent, width } = &place.excerpt;
        writeln!(f, "{:gutter$}{arrow} {}:{}:{}", "", self.file, place.line, place.column)?;
        writeln!(f, "{:gutter$} |", "")?;
        writeln!(f, "{:>gutter$} | {text}", place.line)?;
        let underline = format!("{:indent$}{} {}", "", mark.repeat(*width), place.label);
        writeln!(f, "{:gutter$} | {}", "", underline.trim_end())
    }
}

impl fmt::Display for Diagnostic {
    /// The caret form, several lines, each ended by a newline.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        writeln!(f, "{severity}: {}", self.message)?;
        let places = self.place.iter().chain(&self.related);
        let gutter = places.map(|place| place.line.to_string().len()).max().unwrap_or(1).max(2);
        match &self.place {
            Some(place) => self.write_place(f, place, gutter, true)?,
            None => writeln!(f, "{:gutter$}--> {}", "", self.file)?,
        }
        for place in &self.related {
            self.write_place(f, place, gutter, false)?;
        }
        if let Some(help) = &self.help {
            writeln!(f, "{:gutter$} |", "")?;
            writeln!(f, "{:gutter$} = help: {help}", "")?;
        }
        Ok(())
    }
}

/// The problems of one input, each once. Beyond [`Diagnostics::LIMIT`] they are only counted; an error then takes the
/// place of a warning, so that a refusal never stands without a reason.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    omitted: usize,
}

impl Diagnostics {
    /// Problems kept and printed.
    pub const LIMIT: usize = 100;

    /// Adds a problem, unless the very same is there.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.list.contains(&diagnostic) {
            return;
        }
        if self.list.len() >= Self::LIMIT {
            self.omitted += 1;
            if diagnostic.severity == Severity::Warning {
                return;
            }
            let Some(warning) = self.list.iter().rposition(|d| d.severity == Severity::Warning) else {
                return;
            };
            self.list.remove(warning);
        }
        self.list.push(diagnostic);
    }

    /// Whether another problem of this severity would only be counted.
    pub fn is_full(&self, severity: Severity) -> bool {
        self.list.len() >= Self::LIMIT
            && (severity == Severity::Warning || self.list.iter().all(|d| d.severity == Severity::Error))
    }

    /// Counts a problem without keeping it.
    pub fn omit(&mut self) {
        self.omitted += 1;
    }

    /// Sorts by file and place; problems of a whole file stand first.
    pub fn sort(&mut self) {
        let start = |d: &Diagnostic| d.place.as_ref().map(|p| (p.span.start, p.span.end));
        self.list.sort_by(|a, b| a.file.cmp(&b.file).then_with(|| start(a).cmp(&start(b))));
    }

    /// Whether the input is refused.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The problems kept, in the order they print in.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// Problems counted but not kept.
    pub fn omitted(&self) -> usize {
        self.omitted
    }
}

impl Extend<Diagnostic> for Diagnostics {
    fn extend<I: IntoIterator<Item = Diagnostic>>(&mut self, more: I) {
        more.into_iter().for_each(|d| self.push(d));
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl fmt::Display for Diagnostics {
    /// All of them, with an empty line between two.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.list.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{diagnostic}")?;
        }
        match self.omitted {
            0 => Ok(()),
            1 => writeln!(f, "\n1 more problem is not shown"),
            n => writeln!(f, "\n{n} more problems are not shown"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn render(text: &str, span: std::ops::Range<usize>) -> String {
        let source = Source::new("a.toml", text);
        Diagnostic::error("a.toml", "bad").at(&source, span.into(), "here").to_string()
    }

    #[test]
    fn marks_the_span_under_its_line() {
        let expected = "error: bad\n  --> a.toml:2:5\n   |\n 2 | b = xyz\n   |     ^^^ here\n";
        assert_eq!(render("a = 1\r\nb = xyz\r\n", 11..14), expected);
    }

    #[test]
    fn columns_are_characters_and_a_byte_order_mark_has_none() {
        let text = "\u{feff}é = 1";
        assert!(render(text, 8..9).contains("a.toml:1:5"), "{}", render(text, 8..9));
        assert!(render(text, 8..9).contains("\n 1 | é = 1\n   |     ^ here"));
    }

    #[test]
    fn control_characters_are_not_printed() {
        let shown = render("a\t= \u{1b}[31m", 4..5);
        assert!(shown.contains("a    = \u{fffd}[31m\n   |        ^ here"), "{shown}");
    }

    #[test]
    fn long_lines_are_cut_around_the_mark() {
        let text = format!("{}X{}", "a".repeat(500), "b".repeat(500));
        let shown = render(&text, 500..501);
        assert!(shown.contains("a.toml:1:501"));
        assert!(shown.contains(&format!("…{}X{}…", "a".repeat(60), "b".repeat(59))), "{shown}");
    }

    #[test]
    fn any_span_is_survived() {
        let text = "aé\n\nb";
        for start in 0..12 {
            for end in 0..12 {
                render(text, start..end);
            }
        }
    }

    #[test]
    fn an_empty_source_shows_only_the_file() {
        let source = Source::new("built in", "");
        let shown = Diagnostic::error("built in", "bad").at(&source, Span::default(), "here").to_string();
        assert_eq!(shown, "error: bad\n  --> built in\n");
    }

    #[test]
    fn each_problem_once_and_errors_push_warnings_out() {
        let mut all = Diagnostics::default();
        for i in 0..Diagnostics::LIMIT + 5 {
            all.push(Diagnostic::warning("a", format!("w{i}")));
            all.push(Diagnostic::warning("a", "w0"));
        }
        assert!(!all.has_errors());
        all.push(Diagnostic::error("a", "e"));
        assert!(all.has_errors());
        assert_eq!(all.iter().count(), Diagnostics::LIMIT);
        assert_eq!(all.omitted(), 6);
        assert!(all.to_string().ends_with("\n6 more problems are not shown\n"));
    }
}
