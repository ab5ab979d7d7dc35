//! Where problems are collected, and which are told.
//!
//! After a syntax error part of the file is lost. What that alone would explain is then not told: whatever stands in
//! the same statement, and keys and names that seem to be missing.

use std::collections::BTreeMap;

use super::super::Name;
use super::super::schema::Realm;
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Source, Span};

pub(super) struct Context<'s> {
    pub(super) source: Source<'s>,
    pub(super) diagnostics: Diagnostics,
    /// Whole lines of statements that are not TOML, from top to bottom, apart from each other.
    pub(super) broken: Vec<Span>,
    pub(super) defined: BTreeMap<Realm, BTreeMap<String, Span>>,
    pub(super) used: Vec<(Realm, Name)>,
}

impl<'s> Context<'s> {
    pub(super) fn new(source: Source<'s>) -> Self {
        Self {
            source,
            diagnostics: Diagnostics::default(),
            broken: Vec::new(),
            defined: BTreeMap::new(),
            used: Vec::new(),
        }
    }

    /// Tells a problem, unless a broken statement explains it.
    pub(super) fn report(&mut self, problem: Problem) {
        if !problem.span.is_some_and(|span| self.is_lost(span)) {
            self.report_anyway(problem);
        }
    }

    /// Whether `span` meets a broken statement.
    fn is_lost(&self, span: Span) -> bool {
        let next = self.broken.partition_point(|broken| broken.start <= span.end);
        self.broken[..next].last().is_some_and(|broken| broken.touches(span))
    }

    /// Tells a problem whatever else is wrong.
    pub(super) fn report_anyway(&mut self, problem: Problem) {
        // Finding a place costs time; a file with a million problems is not worth it.
        if self.diagnostics.is_full(problem.severity) {
            self.diagnostics.omit();
        } else {
            self.diagnostics.push(problem.placed(&self.source));
        }
    }

    /// Tells that a key is missing, unless it may have been lost: from the same table, or from the whole file if the
    /// problem has no place.
    pub(super) fn report_missing(&mut self, problem: Problem) {
        let lost = match problem.span {
            Some(span) if !self.broken.is_empty() => self.is_lost(self.source.up_to_next_header(span)),
            _ => !self.broken.is_empty(),
        };
        if !lost {
            self.report_anyway(problem);
        }
    }

    /// The text under `span`, short enough for a message.
    pub(super) fn shown(&self, span: Span) -> String {
        shorten(self.source.slice(span))
    }
}

/// At most 40 characters of `text`, on one line, without control characters.
pub(super) fn shorten(text: &str) -> String {
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let mut short: String = text.chars().take(40).map(clean).collect();
    if text.chars().nth(40).is_some() {
        short.push('…');
    }
    short
}

/// A problem before its place is looked up.
pub(super) struct Problem {
    severity: Severity,
    span: Option<Span>,
    message: String,
    label: String,
    related: Vec<(Span, String)>,
    help: Option<String>,
}

impl Problem {
    pub(super) fn error(span: Span, message: impl Into<String>, label: impl Into<String>) -> Self {
        let (message, label) = (message.into(), label.into());
        Self { severity: Severity::Error, span: Some(span), message, label, related: Vec::new(), help: None }
    }

    pub(super) fn warning(span: Span, message: impl Into<String>, label: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(span, message, label) }
    }

    /// An error of the file as a whole.
    pub(super) fn of_file(message: impl Into<String>) -> Self {
        Self { span: None, ..Self::error(Span::default(), message, "") }
    }

    pub(super) fn also(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, label.into()));
        self
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    fn placed(self, source: &Source<'_>) -> Diagnostic {
        let mut diagnostic = match self.severity {
            Severity::Error => Diagnostic::error(source.name(), self.message),
            Severity::Warning => Diagnostic::warning(source.name(), self.message),
        };
        if let Some(span) = self.span {
            diagnostic = diagnostic.at(source, span, self.label);
        }
        for (span, label) in self.related {
            diagnostic = diagnostic.also(source, span, label);
        }
        diagnostic.help = self.help;
        diagnostic
    }
}
