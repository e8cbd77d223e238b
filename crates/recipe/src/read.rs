//! Reads the keys of one table and collects the messages about them.

use turnpath_core::Quantity;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Table, Value};
use crate::span::{Span, Spanned};
use crate::suggest::{did_you_mean, is_misspelt, listed, quoted};
use crate::value;

/// Tables and their fixed keys.
pub(crate) type Schema = &'static [(&'static str, &'static [&'static str])];

/// One table of the recipe, which may be missing, and the messages so far.
pub(crate) struct Section<'a> {
    /// `tool`; empty for the keys above the first table.
    pub(crate) name: &'static str,
    /// The keys of the table; `None` if the recipe has no such table.
    pub(crate) table: Option<&'a Table>,
    /// The header of the table; the recipe as a whole if there is no header.
    pub(crate) span: Span,
    /// Whether the recipe has an unknown table with nearly this name instead.
    pub(crate) misspelt: bool,
    /// The tables with fixed keys.
    pub(crate) schema: Schema,
    /// The messages so far.
    pub(crate) diagnostics: &'a mut Vec<Diagnostic>,
}

/// A recipe whose tables are read one after the other.
pub(crate) struct Sections<'a> {
    pub(crate) root: &'a Table,
    /// The recipe as a whole.
    pub(crate) whole: &'a Span,
    /// The tables with fixed keys.
    pub(crate) schema: Schema,
    /// The messages so far.
    pub(crate) diagnostics: &'a mut Vec<Diagnostic>,
}

impl Sections<'_> {
    /// The keys above the first table.
    pub(crate) fn top(&mut self) -> Section<'_> {
        let span = self.whole.clone();
        Section {
            name: "",
            table: Some(self.root),
            span,
            misspelt: false,
            schema: self.schema,
            diagnostics: self.diagnostics,
        }
    }

    /// A table by its name, `output` or `output.pmac-pvt`. The recipe need not have it.
    pub(crate) fn open(&mut self, name: &'static str) -> Section<'_> {
        let entry = self.root.find(name.split('.'));
        let span = entry.map_or(self.whole, |entry| &entry.node.span).clone();
        let table = match entry.map(|entry| &entry.node.value) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        };
        let misspelt = entry.is_none() && self.root.has_like(name);
        Section {
            name,
            table,
            span,
            misspelt,
            schema: self.schema,
            diagnostics: self.diagnostics,
        }
    }
}

/// A condition on a number.
#[derive(Clone, Copy)]
pub(crate) struct Bound {
    /// Whether it holds.
    pub(crate) holds: fn(f64) -> bool,
    /// The condition in words: "above zero".
    pub(crate) words: &'static str,
}

/// Only values above zero.
pub(crate) const POSITIVE: Bound = Bound {
    holds: |value| value > 0.0,
    words: "above zero",
};
/// No value below zero.
pub(crate) const NOT_NEGATIVE: Bound = Bound {
    holds: |value| value >= 0.0,
    words: "zero or above",
};

impl<'a> Section<'a> {
    /// The value under a key, if the recipe has the key.
    pub(crate) fn node(&self, key: &str) -> Option<&'a Node> {
        self.table?.get(key).map(|entry| &entry.node)
    }

    /// Whether the recipe has a value of another kind under the table's name. Another message
    /// reports that value.
    pub(crate) fn is_something_else(&self) -> bool {
        self.table.is_none() && !self.span.is_whole()
    }

    /// Reports a value of another kind under the name of a table within a table.
    pub(crate) fn report_unless_table(&mut self) {
        if self.is_something_else() {
            let title = format!("`{}` must be a table", self.name);
            let diagnostic = Diagnostic::new(self.span.clone(), title).with_help(format!(
                "write the line [{}], and its keys below it",
                self.name
            ));
            self.report(diagnostic);
        }
    }

    /// Adds a message.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    fn ok_or_report<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.report(diagnostic)).ok()
    }

    fn at<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&'a Node) -> Result<T, Diagnostic>,
    ) -> Option<Spanned<T>> {
        let node = self.node(key)?;
        let value = self.ok_or_report(read(node))?;
        Some(Spanned {
            value,
            span: node.span.clone(),
        })
    }

    /// A quantity within a bound; `None` if the key is missing or its value is wrong.
    pub(crate) fn quantity(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
    ) -> Option<Spanned<f64>> {
        self.quantity_with_example(key, kind, bound, kind.example())
    }

    fn quantity_with_example(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
        example: &str,
    ) -> Option<Spanned<f64>> {
        let read = self.at(key, |node| value::quantity(key, node, kind, example))?;
        if (bound.holds)(read.value) {
            return Some(read);
        }
        let title = format!("`{key}` must be {}", bound.words);
        let label = format!("not {}", bound.words);
        self.report(Diagnostic::new(read.span, title).with_label(label));
        None
    }

    /// A quantity that the recipe must give; `example` is a value that would be right.
    pub(crate) fn required_quantity(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
        example: &str,
    ) -> Option<Spanned<f64>> {
        let there = self.table.is_none_or(|table| table.has_like(key));
        if !there {
            self.missing(key, &format!("\"{example}\""));
        }
        self.quantity_with_example(key, kind, bound, example)
    }

    /// A pure number; `None` if the key is missing or its value is wrong.
    pub(crate) fn number(&mut self, key: &str) -> Option<Spanned<f64>> {
        self.at(key, |node| value::number(key, node))
    }

    /// A flag; `None` if the key is missing or its value is wrong.
    pub(crate) fn flag(&mut self, key: &str) -> Option<Spanned<bool>> {
        self.at(key, |node| value::flag(key, node))
    }

    /// A string; `None` if the key is missing or its value is wrong.
    pub(crate) fn text(&mut self, key: &str) -> Option<Spanned<String>> {
        self.at(key, |node| value::text(key, node).map(str::to_owned))
    }

    /// One of the allowed words; `None` if the key is missing or its value is wrong.
    pub(crate) fn word<'w>(&mut self, key: &str, words: &[&'w str]) -> Option<Spanned<&'w str>> {
        self.at(key, |node| value::word(key, node, words))
    }

    /// The items of a list that are strings. Each other item is reported.
    pub(crate) fn texts(&mut self, key: &str) -> Option<Vec<Spanned<String>>> {
        let nodes = self.at(key, |node| value::items(key, node))?.value;
        let item = |node: &Node| {
            let value = self.ok_or_report(value::text(key, node))?.to_owned();
            Some(Spanned {
                value,
                span: node.span.clone(),
            })
        };
        Some(nodes.iter().filter_map(item).collect())
    }

    /// Reports a missing key; `example` is a value as the recipe would have it.
    pub(crate) fn missing(&mut self, key: &str, example: &str) {
        let (title, to) = if self.name.is_empty() {
            (format!("the recipe lacks `{key}`"), String::new())
        } else {
            (
                format!("[{}] lacks `{key}`", self.name),
                format!(" to [{}]", self.name),
            )
        };
        let mut diagnostic = Diagnostic::new(self.span.clone(), title)
            .with_help(format!("add{to} a line such as: {key} = {example}"));
        if !self.name.is_empty() {
            diagnostic = diagnostic.with_label(format!("`{key}` must be given"));
        }
        self.report(diagnostic);
    }

    /// Reports a missing table; `example` is a line that the table could have.
    pub(crate) fn missing_table(&mut self, example: &str) {
        if self.is_something_else() || self.misspelt {
            return;
        }
        let title = format!("the recipe lacks the table [{}]", self.name);
        let help = format!(
            "add the line [{}] and below it, for example: {example}",
            self.name
        );
        let diagnostic = Diagnostic::new(self.span.clone(), title).with_help(help);
        self.report(diagnostic);
    }

    /// Reports each key that is not a known one.
    pub(crate) fn report_unknown_keys(&mut self, known: &[&str]) {
        let entries = self.table.map_or(&[][..], Table::entries);
        let unknown = entries
            .iter()
            .filter(|entry| !known.contains(&entry.key.as_str()));
        for entry in unknown {
            let diagnostic = self.unknown_key(entry, known);
            self.report(diagnostic);
        }
    }

    /// Reports each key that looks like a misspelling of `key`, if the table lacks `key` itself.
    pub(crate) fn report_misspelling(&mut self, key: &str, known: &[&str]) {
        let entries = match self.table {
            Some(table) if table.get(key).is_none() => table.entries(),
            _ => &[],
        };
        for entry in entries.iter().filter(|entry| is_misspelt(&entry.key, key)) {
            let diagnostic = self.unknown_key(entry, known);
            self.report(diagnostic);
        }
    }

    fn unknown_key(&self, entry: &Entry, known: &[&str]) -> Diagnostic {
        let key = entry.key.as_str();
        let title = format!("[{}] has no key {}", self.name, quoted(key));
        let elsewhere = || {
            self.tables_with(key)
                .map(|tables| format!("`{key}` belongs to {tables}"))
        };
        Diagnostic::new(entry.span.clone(), title)
            .with_label("unknown key")
            .with_helps(did_you_mean(key, known).or_else(elsewhere))
            .with_help(format!("keys of [{}]: {}", self.name, listed(known)))
    }

    /// The tables that have such a key: "[part]", or "[part] or [path]".
    pub(crate) fn tables_with(&self, key: &str) -> Option<String> {
        let with_key = self.schema.iter().filter(|(_, keys)| keys.contains(&key));
        let names: Vec<String> = with_key.map(|(table, _)| format!("[{table}]")).collect();
        (!names.is_empty()).then(|| names.join(" or "))
    }
}
