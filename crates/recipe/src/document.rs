//! The recipe as a tree of values with their spans, whichever text they come from.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::span::{Source, Span};
use crate::suggest::is_misspelt;

/// A value in the tree.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A string.
    Text(String),
    /// An integer or a float.
    Number(f64),
    /// A boolean.
    Flag(bool),
    /// A date or a time. No key of a recipe takes one.
    Date,
    /// An array.
    Array(Vec<Node>),
    /// A table.
    Table(Table),
}

/// A value and its span.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// The bytes that hold the value; for a table `[name]` its header.
    pub span: Span,
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// The bytes that hold the key.
    pub span: Span,
    /// The value.
    pub node: Node,
}

/// A table: its entries in the order of the text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    entries: Vec<Entry>,
}

impl Value {
    /// The kind of the value with its article, for messages.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Number(_) => "a bare number",
            Self::Flag(_) => "true or false",
            Self::Date => "a date",
            Self::Array(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

impl Node {
    fn below(&self, key: &str) -> Option<&Self> {
        match (&self.value, index(key)) {
            (Value::Table(table), index) => match table.get(key) {
                None if index == Some(0) => Some(self),
                entry => entry.map(|entry| &entry.node),
            },
            (Value::Array(items), Some(index)) => items.get(index),
            (Value::Array(items), None) => match items.as_slice() {
                [only] => only.below(key),
                _ => None,
            },
            _ => None,
        }
    }
}

/// The index of a list's item that a key stands for.
pub(crate) fn index(key: &str) -> Option<usize> {
    let index: usize = key.parse().ok()?;
    (index.to_string() == key).then_some(index)
}

impl Table {
    /// All entries, in the order of the text.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The entry under a key.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// Whether the table has the key, or a key that looks like a misspelling of it.
    ///
    /// A misspelt key has its own message, so no second message need report the right key as missing.
    pub(crate) fn has_like(&self, key: &str) -> bool {
        self.entries
            .iter()
            .any(|entry| entry.key == key || is_misspelt(&entry.key, key))
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }

    /// Replaces the entry with the same key, or adds the entry at the end.
    pub(crate) fn put(&mut self, entry: Entry) {
        match self.get_mut(&entry.key) {
            Some(old) => *old = entry,
            None => self.entries.push(entry),
        }
    }

    /// Removes an entry.
    pub(crate) fn remove(&mut self, key: &str) {
        self.entries.retain(|entry| entry.key != key);
    }

    /// The node at a path of keys, `["tool", "nose_radius"]`. An index names an item of a list; a
    /// single item needs none, and a table counts as a list of one.
    pub fn find<'k>(&self, path: impl IntoIterator<Item = &'k str>) -> Option<&Node> {
        let mut keys = path.into_iter();
        let first = &self.get(keys.next()?)?.node;
        keys.try_fold(first, Node::below)
    }
}

/// Turns parsed TOML into nodes. The text begins at byte `offset` of the source.
pub(crate) struct Reader {
    pub(crate) source: Arc<Source>,
    pub(crate) offset: usize,
}

impl Reader {
    pub(crate) fn span(&self, range: Range<usize>) -> Span {
        let shifted = range.start + self.offset..range.end + self.offset;
        Span::new(self.source.clone(), shifted)
    }

    pub(crate) fn table(&self, table: &DeTable<'_>) -> Table {
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| self.entry(key, value);
        let mut entries: Vec<Entry> = table.iter().map(entry).collect();
        entries.sort_by_key(|entry| entry.span.range().start);
        Table { entries }
    }

    fn entry(
        &self,
        key: &Spanned<std::borrow::Cow<'_, str>>,
        value: &Spanned<DeValue<'_>>,
    ) -> Entry {
        Entry {
            key: key.get_ref().to_string(),
            span: self.span(key.span()),
            node: self.node(value),
        }
    }

    pub(crate) fn node(&self, value: &Spanned<DeValue<'_>>) -> Node {
        Node {
            value: self.value(value.get_ref()),
            span: self.span(value.span()),
        }
    }

    fn value(&self, value: &DeValue<'_>) -> Value {
        match value {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => Value::Number(integer(number)),
            DeValue::Float(number) => Value::Number(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(flag) => Value::Flag(*flag),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(items) => {
                Value::Array(items.iter().map(|item| self.node(item)).collect())
            }
            DeValue::Table(table) => Value::Table(self.table(table)),
        }
    }
}

fn integer(number: &toml::de::DeInteger<'_>) -> f64 {
    if number.radix() == 10 {
        return number.as_str().parse().unwrap_or(f64::NAN);
    }
    let whole = i64::from_str_radix(number.as_str(), number.radix());
    whole.map_or(f64::NAN, |value| value as f64)
}
