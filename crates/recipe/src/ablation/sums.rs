//! Sums of surfaces among the values of a list: `surface = [[{ … }, { … }], { … }]`.

use turnpath_core::Slot;

use crate::document::{Node, Table, Value, index};

/// Whether the values under a path of keys are strategies, each a whole table: those of a slot, or
/// of one surface of a sum.
pub(super) fn are_strategies(path: &[&str]) -> bool {
    match path {
        [key] => Slot::ALL.iter().any(|slot| slot.key() == *key),
        [key, at] => *key == Slot::Surface.key() && index(at).is_some(),
        _ => false,
    }
}

/// Whether a value may stand in a list of strategies: a table, or a sum of surfaces.
pub(super) fn is_strategy_or_sum(path: &[&str], value: &Value) -> bool {
    let is_table = |item: &Node| matches!(item.value, Value::Table(_));
    match value {
        Value::Table(_) => true,
        Value::Array(items) => {
            path == [Slot::Surface.key()] && !items.is_empty() && items.iter().all(is_table)
        }
        _ => false,
    }
}

/// The keys of a path. A single surface needs no number, so its number is left out.
pub(super) fn without_number<'p>(mut path: Vec<&'p str>, base: &Table) -> Vec<&'p str> {
    let surface = Slot::Surface.key();
    let surfaces = base
        .get(surface)
        .map_or(0, |entry| tables(&entry.node.value).len());
    if surfaces == 1 && path.starts_with(&[surface, "0"]) {
        path.remove(1);
    }
    path
}

/// A sum of one surface as that surface; any other value as it is.
pub(super) fn without_single_sum(path: &[&str], node: Node) -> Node {
    match &node.value {
        Value::Array(items) if path == [Slot::Surface.key()] => match items.as_slice() {
            [only] => only.clone(),
            _ => node,
        },
        _ => node,
    }
}

/// The tables of a strategy or of a sum.
pub(super) fn tables(value: &Value) -> Vec<&Table> {
    match value {
        Value::Table(table) => vec![table],
        Value::Array(items) => items.iter().flat_map(|item| tables(&item.value)).collect(),
        _ => Vec::new(),
    }
}

/// The name of the strategy that a table chooses.
pub(super) fn of_table(table: &Table) -> String {
    match table.get("use").map(|entry| &entry.node.value) {
        Some(Value::Text(name)) => name.clone(),
        _ => String::new(),
    }
}

/// The name of a strategy; of a sum "conic + zernike".
pub(super) fn name(value: &Value) -> String {
    let names: Vec<String> = tables(value).into_iter().map(of_table).collect();
    names.join(" + ")
}
