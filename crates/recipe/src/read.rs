//! Reads the keys of one table, and collects what is wrong with them.

use turnpath_core::Quantity;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Table, Value};
use crate::place::{Located, Place};
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::SCHEMA;
use crate::value;

/// One table of the recipe, there or not, and the messages so far.
pub(crate) struct Section<'a> {
    /// `tool`; empty for the keys above the first table.
    pub(crate) name: &'static str,
    /// Its keys; none if the recipe has no such table.
    pub(crate) table: Option<&'a Table>,
    /// Its header; the recipe as a whole if there is none.
    pub(crate) place: Place,
    /// Whether there is no such table, but an unknown one of nearly its name.
    pub(crate) misspelt: bool,
    /// What was found wrong.
    pub(crate) found: &'a mut Vec<Diagnostic>,
}

/// A recipe whose tables are read one after the other.
pub(crate) struct Sections<'a> {
    pub(crate) root: &'a Table,
    /// The recipe as a whole.
    pub(crate) whole: &'a Place,
    /// What was found wrong.
    pub(crate) found: &'a mut Vec<Diagnostic>,
}

impl Sections<'_> {
    /// The keys above the first table.
    pub(crate) fn top(&mut self) -> Section<'_> {
        let place = self.whole.clone();
        Section {
            name: "",
            table: Some(self.root),
            place,
            misspelt: false,
            found: self.found,
        }
    }

    /// A table by its name, `output` or `output.pmac-pvt`; it may be missing.
    pub(crate) fn open(&mut self, name: &'static str) -> Section<'_> {
        let entry = self.root.find(name.split('.'));
        let place = entry.map_or(self.whole, |entry| &entry.node.place).clone();
        let table = match entry.map(|entry| &entry.node.value) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        };
        let misspelt = entry.is_none() && self.root.has_like(name);
        Section {
            name,
            table,
            place,
            misspelt,
            found: self.found,
        }
    }
}

/// A condition on a number.
#[derive(Clone, Copy)]
pub(crate) struct Bound {
    /// Whether it holds.
    pub(crate) holds: fn(f64) -> bool,
    /// "above zero".
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
    /// The value under a key, if it is there.
    pub(crate) fn node(&self, key: &str) -> Option<&'a Node> {
        self.table?.get(key).map(|entry| &entry.node)
    }

    /// Whether the name stands for a value that is no table, which was complained about.
    pub(crate) fn is_something_else(&self) -> bool {
        self.table.is_none() && !self.place.is_whole()
    }

    /// Complains if the name of a table within a table stands for something else.
    pub(crate) fn is_table(&mut self) {
        if self.is_something_else() {
            let title = format!("`{}` must be a table", self.name);
            let diagnostic = Diagnostic::new(self.place.clone(), title).help(format!(
                "write the line [{}], and its keys below it",
                self.name
            ));
            self.complain(diagnostic);
        }
    }

    /// Takes a complaint.
    pub(crate) fn complain(&mut self, diagnostic: Diagnostic) {
        self.found.push(diagnostic);
    }

    fn keep<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.complain(diagnostic)).ok()
    }

    fn at<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&'a Node) -> Result<T, Diagnostic>,
    ) -> Option<Located<T>> {
        let node = self.node(key)?;
        let value = self.keep(read(node))?;
        Some(Located {
            value,
            place: node.place.clone(),
        })
    }

    /// A quantity within a bound, if the key is there and right.
    pub(crate) fn quantity(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
    ) -> Option<Located<f64>> {
        self.quantity_like(key, kind, bound, kind.example())
    }

    fn quantity_like(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
        example: &str,
    ) -> Option<Located<f64>> {
        let read = self.at(key, |node| value::quantity(key, node, kind, example))?;
        if (bound.holds)(read.value) {
            return Some(read);
        }
        let title = format!("`{key}` must be {}", bound.words);
        let label = format!("not {}", bound.words);
        self.complain(Diagnostic::new(read.place, title).label(label));
        None
    }

    /// A quantity that the recipe must give; `example` is a value that would do.
    pub(crate) fn required_quantity(
        &mut self,
        key: &str,
        kind: Quantity,
        bound: Bound,
        example: &str,
    ) -> Option<Located<f64>> {
        let there = self.table.is_none_or(|table| table.has_like(key));
        if !there {
            self.missing(key, &format!("\"{example}\""));
        }
        self.quantity_like(key, kind, bound, example)
    }

    /// A pure number, if the key is there and right.
    pub(crate) fn number(&mut self, key: &str) -> Option<Located<f64>> {
        self.at(key, |node| value::number(key, node))
    }

    /// A flag, if the key is there and right.
    pub(crate) fn flag(&mut self, key: &str) -> Option<Located<bool>> {
        self.at(key, |node| value::flag(key, node))
    }

    /// A string, if the key is there and right.
    pub(crate) fn text(&mut self, key: &str) -> Option<Located<String>> {
        self.at(key, |node| value::text(key, node).map(str::to_owned))
    }

    /// One of some words, if the key is there and right.
    pub(crate) fn word<'w>(&mut self, key: &str, words: &[&'w str]) -> Option<Located<&'w str>> {
        self.at(key, |node| value::word(key, node, words))
    }

    /// The items of a list of strings, those that are right.
    pub(crate) fn texts(&mut self, key: &str) -> Option<Vec<Located<String>>> {
        let nodes = self.at(key, |node| value::items(key, node))?.value;
        let item = |node: &Node| {
            let value = self.keep(value::text(key, node))?.to_owned();
            Some(Located {
                value,
                place: node.place.clone(),
            })
        };
        Some(nodes.iter().filter_map(item).collect())
    }

    /// Complains that a key is missing; `example` is its value as it would be written.
    pub(crate) fn missing(&mut self, key: &str, example: &str) {
        let (title, to) = if self.name.is_empty() {
            (format!("the recipe lacks `{key}`"), String::new())
        } else {
            (
                format!("[{}] lacks `{key}`", self.name),
                format!(" to [{}]", self.name),
            )
        };
        let mut diagnostic = Diagnostic::new(self.place.clone(), title)
            .help(format!("add{to} a line such as: {key} = {example}"));
        if !self.name.is_empty() {
            diagnostic = diagnostic.label(format!("`{key}` must be given"));
        }
        self.complain(diagnostic);
    }

    /// Complains that the whole table is missing; `example` is a line that it would hold.
    pub(crate) fn missing_table(&mut self, example: &str) {
        if self.is_something_else() || self.misspelt {
            return;
        }
        let title = format!("the recipe lacks the table [{}]", self.name);
        let help = format!(
            "add the line [{}] and below it, for example: {example}",
            self.name
        );
        let diagnostic = Diagnostic::new(self.place.clone(), title).help(help);
        self.complain(diagnostic);
    }

    /// Complains about each key that is not among the known ones.
    pub(crate) fn only(&mut self, known: &[&str]) {
        let entries = self.table.map_or(&[][..], Table::entries);
        let strange = entries
            .iter()
            .filter(|entry| !known.contains(&entry.key.as_str()));
        for entry in strange {
            let diagnostic = self.unknown_key(entry, known);
            self.complain(diagnostic);
        }
    }

    fn unknown_key(&self, entry: &Entry, known: &[&str]) -> Diagnostic {
        let key = entry.key.as_str();
        let title = format!("[{}] has no key {}", self.name, quoted(key));
        let elsewhere = || tables_with(key).map(|tables| format!("`{key}` belongs to {tables}"));
        Diagnostic::new(entry.place.clone(), title)
            .label("unknown key")
            .helps(did_you_mean(key, known).or_else(elsewhere))
            .help(format!("keys of [{}]: {}", self.name, listed(known)))
    }
}

/// The tables that have such a key, "[part]".
pub(crate) fn tables_with(key: &str) -> Option<String> {
    let with_key = SCHEMA.iter().filter(|(_, keys)| keys.contains(&key));
    let names: Vec<String> = with_key.map(|(table, _)| format!("[{table}]")).collect();
    (!names.is_empty()).then(|| names.join(" or "))
}
