//! The figures of a run that stand in tables: where they are found, and how they are headed.

mod list;

use serde_json::Value;

pub use list::ALL;
use list::DEFAULT;

/// A figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Its name for `--columns`.
    pub name: &'static str,
    /// Its header in the table, the unit last.
    pub head: &'static [&'static str],
    /// Its header in `ablation.csv`.
    pub csv: &'static str,
    /// Where it stands in a run of `ablation.json`, a JSON pointer.
    pub pointer: &'static str,
    /// How it is written.
    pub form: Form,
    /// What tells whether its tolerance holds, if it has one.
    pub within: Option<&'static str>,
    /// Which of its figures is marked.
    pub best: Best,
}

/// Which figure of a column is the best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Best {
    /// The smallest.
    Smallest,
    /// The largest.
    Largest,
    /// None: it differs from call to call.
    None,
}

/// How a figure is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// In full.
    Count,
    /// With four digits.
    Real,
    /// In kB, four digits.
    Bytes,
    /// As a real, in seconds of the processor.
    Clock,
}

const fn column(
    name: &'static str,
    head: &'static [&'static str],
    csv: &'static str,
    pointer: &'static str,
    form: Form,
) -> Column {
    Column {
        name,
        head,
        csv,
        pointer,
        form,
        within: None,
        best: Best::Smallest,
    }
}

const fn real(
    name: &'static str,
    head: &'static [&'static str],
    csv: &'static str,
    pointer: &'static str,
) -> Column {
    column(name, head, csv, pointer, Form::Real)
}

impl Column {
    /// Whether it speaks of the feed strategy's own law alone.
    pub fn is_of_law(&self) -> bool {
        self.pointer.starts_with("/axes_of_law/")
    }

    const fn held(self, within: &'static str) -> Self {
        Self {
            within: Some(within),
            ..self
        }
    }

    const fn best(self, best: Best) -> Self {
        Self { best, ..self }
    }
}

/// The names that can be asked for.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|column| column.name).collect()
}

/// The columns of these names in their order; the usual ones for none.
pub fn chosen(names: &[String]) -> Vec<&'static Column> {
    if names.is_empty() {
        return ALL.iter().take(DEFAULT).collect();
    }
    let of_name = |name: &String| ALL.iter().find(|column| column.name == name);
    names.iter().filter_map(of_name).collect()
}

/// A run's figure, if it has one.
pub fn figure<'a>(entry: &'a Value, column: &Column) -> Option<&'a Value> {
    entry
        .pointer(column.pointer)
        .filter(|value| !value.is_null())
}

/// The same as a number.
pub fn number(entry: &Value, column: &Column) -> Option<f64> {
    figure(entry, column)?.as_f64()
}
