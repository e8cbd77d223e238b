//! The recipe as a tree of located values, whichever text they come from.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::place::{Place, Source};
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
    /// A date or a time, which no recipe needs.
    Date,
    /// An array.
    Array(Vec<Node>),
    /// A table.
    Table(Table),
}

/// A value and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Where it stands; for a table `[name]` its header.
    pub place: Place,
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub place: Place,
    /// The value.
    pub node: Node,
}

/// A table: its entries in the order of the text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    entries: Vec<Entry>,
}

impl Value {
    /// What it is, with its article, for messages.
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

impl Table {
    /// All entries, in the order of the text.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The entry under a key.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// Whether the key is there, or one that is not known and nearly the same.
    ///
    /// The unknown key has its own message, so that the right one need not be missed too.
    pub(crate) fn has_like(&self, key: &str) -> bool {
        self.entries
            .iter()
            .any(|entry| entry.key == key || is_misspelt(&entry.key, key))
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }

    /// Puts an entry in the place of the one with its key, or at the end.
    pub(crate) fn put(&mut self, entry: Entry) {
        match self.get_mut(&entry.key) {
            Some(old) => *old = entry,
            None => self.entries.push(entry),
        }
    }

    /// Takes an entry out.
    pub(crate) fn remove(&mut self, key: &str) {
        self.entries.retain(|entry| entry.key != key);
    }

    /// The entry at a path of keys, `["tool", "nose_radius"]`.
    pub fn find<'k>(&self, path: impl IntoIterator<Item = &'k str>) -> Option<&Entry> {
        let mut keys = path.into_iter();
        let mut entry = self.get(keys.next()?)?;
        for key in keys {
            let Value::Table(table) = &entry.node.value else {
                return None;
            };
            entry = table.get(key)?;
        }
        Some(entry)
    }
}

/// A parsed text, with the place of each value counted from `offset`.
pub(crate) struct Reader {
    pub(crate) source: Arc<Source>,
    pub(crate) offset: usize,
}

impl Reader {
    pub(crate) fn place(&self, span: Range<usize>) -> Place {
        let shifted = span.start + self.offset..span.end + self.offset;
        Place::new(self.source.clone(), shifted)
    }

    pub(crate) fn table(&self, table: &DeTable<'_>) -> Table {
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| self.entry(key, value);
        let mut entries: Vec<Entry> = table.iter().map(entry).collect();
        entries.sort_by_key(|entry| entry.place.span().start);
        Table { entries }
    }

    fn entry(
        &self,
        key: &Spanned<std::borrow::Cow<'_, str>>,
        value: &Spanned<DeValue<'_>>,
    ) -> Entry {
        Entry {
            key: key.get_ref().to_string(),
            place: self.place(key.span()),
            node: self.node(value),
        }
    }

    pub(crate) fn node(&self, value: &Spanned<DeValue<'_>>) -> Node {
        Node {
            value: self.value(value.get_ref()),
            place: self.place(value.span()),
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
