//! Values as text, for the rows of the comparison.

use crate::document::{Entry, Table, Value};

use super::lists::List;
use super::sums::{name, of_table, tables};

/// A value of a list as a person reads it.
pub(super) fn of_choice(list: &List, index: usize) -> String {
    let Some(Some(node)) = list.choices.get(index) else {
        return "(default)".to_owned();
    };
    match &node.value {
        value if list.is_slot() => of_strategy(list, value),
        Value::Text(text) => text.clone(),
        value => toml_of(value),
    }
}

/// The name of a strategy or of a sum, with the parameters if the list has several of that name.
fn of_strategy(list: &List, value: &Value) -> String {
    let own = name(value);
    let choices = list.choices.iter().flatten();
    if choices.filter(|choice| name(&choice.value) == own).count() < 2 {
        return own;
    }
    let parts: Vec<String> = tables(value).into_iter().map(with_params).collect();
    parts.join(" + ")
}

fn with_params(table: &Table) -> String {
    let entries = table.entries().iter();
    let params: Vec<String> = entries
        .filter(|entry| entry.key != "use")
        .map(setting)
        .collect();
    let name = of_table(table);
    match params.is_empty() {
        true => name,
        false => format!("{name} ({})", params.join(", ")),
    }
}

fn setting(entry: &Entry) -> String {
    match &entry.node.value {
        Value::Text(text) => format!("{} = {text}", entry.key),
        value => format!("{} = {}", entry.key, toml_of(value)),
    }
}

/// The value as a recipe would write it.
fn toml_of(value: &Value) -> String {
    match value {
        Value::Text(text) => format!("{text:?}"),
        Value::Number(number) => number.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::Date => "a date".to_owned(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| toml_of(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entries = table.entries().iter();
            let entries =
                entries.map(|entry| format!("{} = {}", entry.key, toml_of(&entry.node.value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
