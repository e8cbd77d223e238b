//! Tables of coefficients: each has one or several whole numbers as its key.

use turnpath_core::{ParamInfo, Quantity};

use crate::declared::example;
use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Value};
use crate::suggest::quoted;
use crate::value;

/// Largest whole number of a key. No formula has so many terms.
const LARGEST_INDEX: i32 = 1_000_000;

/// The coefficients of a table, in the order of the text. Each is a row of its whole numbers and its
/// value, in inner units.
pub(crate) fn read(
    param: &ParamInfo,
    node: &Node,
    indices: usize,
    quantity: Option<Quantity>,
) -> Result<Vec<Vec<f64>>, Diagnostic> {
    let for_example = || format!("for example: {} = {}", param.name, example(param));
    let Value::Table(table) = &node.value else {
        return Err(
            value::wrong_type(param.name, node, "a table of coefficients").with_help(for_example()),
        );
    };
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for entry in table.entries() {
        let mut row = numbers(&entry.key, indices)
            .ok_or_else(|| wrong_key(param.name, entry, indices).with_help(for_example()))?;
        if rows.iter().any(|other| other[..indices] == row) {
            let title = format!("`{}` has two values for {}", param.name, quoted(&entry.key));
            return Err(Diagnostic::new(entry.span.clone(), title).with_label("the second one"));
        }
        row.push(coefficient(param.name, entry, quantity)?);
        rows.push(row);
    }
    Ok(rows)
}

/// The whole numbers of a key such as `4` or `2,-1`.
fn numbers(key: &str, indices: usize) -> Option<Vec<f64>> {
    let number = |part: &str| {
        let number: i32 = part.trim().parse().ok()?;
        (-LARGEST_INDEX..=LARGEST_INDEX)
            .contains(&number)
            .then_some(f64::from(number))
    };
    let numbers: Option<Vec<f64>> = key.split(',').map(number).collect();
    numbers.filter(|numbers| numbers.len() == indices)
}

fn wrong_key(name: &str, entry: &Entry, indices: usize) -> Diagnostic {
    // A key that is whole is too large then.
    let is_digits = |part: &str| {
        let part = part.trim();
        let digits = part.strip_prefix(['-', '+']).unwrap_or(part);
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    let parts = entry.key.split(',');
    let is_whole = parts.clone().count() == indices && parts.clone().all(is_digits);
    let (title, label) = match indices {
        _ if is_whole => (
            "is too large",
            format!("a number up to {LARGEST_INDEX} belongs here"),
        ),
        1 => (
            "is not a whole number",
            "a whole number belongs here".to_owned(),
        ),
        several => (
            "is not a list of whole numbers",
            format!("{several} whole numbers with commas between them belong here, in quotes"),
        ),
    };
    let title = format!("`{name}`: the key {} {title}", quoted(&entry.key));
    Diagnostic::new(entry.span.clone(), title).with_label(label)
}

fn coefficient(name: &str, entry: &Entry, quantity: Option<Quantity>) -> Result<f64, Diagnostic> {
    let key = format!("{name}.{}", entry.key);
    if let Value::Table(table) = &entry.node.value
        && let Some(inner) = table.entries().first()
    {
        let (number, decimals) = (&entry.key, &inner.key);
        let title = format!(
            "`{name}`: the key {} is not a whole number",
            quoted(&format!("{number}.{decimals}"))
        );
        return Err(Diagnostic::new(entry.span.clone(), title)
            .with_label("TOML reads a point in a key as a table within a table"));
    }
    match quantity {
        Some(quantity) => value::quantity(&key, &entry.node, quantity, quantity.example()),
        None => value::number(&key, &entry.node),
    }
}
