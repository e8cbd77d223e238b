//! Values as text, for the rows of the comparison.

use crate::document::{Entry, Node, Table, Value};

use super::lists::List;

/// A value of a list as a person reads it.
pub(super) fn of_choice(list: &List, index: usize) -> String {
    let Some(Some(node)) = list.choices.get(index) else {
        return "(default)".to_owned();
    };
    match &node.value {
        Value::Table(table) if list.is_slot() => of_strategy(list, table),
        Value::Text(text) => text.clone(),
        value => toml_of(value),
    }
}

/// A strategy's name, with its parameters if the list has several strategies of that name.
fn of_strategy(list: &List, table: &Table) -> String {
    let name = name(table).unwrap_or_default();
    let of_name = |choice: &&Option<Node>| match choice.as_ref().map(|node| &node.value) {
        Some(Value::Table(table)) => self::name(table) == Some(name),
        _ => false,
    };
    let params: Vec<String> = table
        .entries()
        .iter()
        .filter(|entry| entry.key != "use")
        .map(setting)
        .collect();
    if params.is_empty() || list.choices.iter().filter(of_name).count() < 2 {
        return name.to_owned();
    }
    format!("{name} ({})", params.join(", "))
}

fn name(table: &Table) -> Option<&str> {
    match &table.get("use")?.node.value {
        Value::Text(name) => Some(name),
        _ => None,
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
