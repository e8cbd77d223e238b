//! Single values: from a node of the tree to a number, a flag or a word, or a message why not.

use turnpath_core::{Quantity, QuantityError};

use crate::diagnostic::Diagnostic;
use crate::document::{Node, Value};
use crate::suggest::{did_you_mean, listed, quoted};

/// A quantity with its unit, in inner units; `example` is a value that would do.
pub(crate) fn quantity(
    key: &str,
    node: &Node,
    wanted: Quantity,
    example: &str,
) -> Result<f64, Diagnostic> {
    let with_unit = || format!("write it with its unit: {key} = \"{example}\"");
    match &node.value {
        Value::Text(text) => wanted
            .parse(text)
            .map_err(|error| unit_error(key, node, error, example)),
        Value::Number(number) if number.is_finite() => Err(bare_number(key, node, *number, wanted)),
        Value::Number(_) => Err(not_finite(key, node).help(with_unit())),
        _ => Err(wrong_type(key, node, wanted.noun()).help(with_unit())),
    }
}

fn not_finite(key: &str, node: &Node) -> Diagnostic {
    let title = format!("`{key}` is not a finite number");
    Diagnostic::new(node.place.clone(), title).label("must be finite")
}

/// The number with each of the usual units.
fn with_units(number: &str, wanted: Quantity) -> String {
    let choices: Vec<String> = wanted
        .units()
        .take(3)
        .map(|unit| format!("\"{number} {unit}\""))
        .collect();
    format!(
        "write the number with its unit, in quotes: {}",
        choices.join(" or ")
    )
}

fn bare_number(key: &str, node: &Node, number: f64, wanted: Quantity) -> Diagnostic {
    let title = format!("`{key}` has no unit");
    let label = format!("{} needs one", wanted.noun());
    Diagnostic::new(node.place.clone(), title)
        .label(label)
        .help(with_units(&number.to_string(), wanted))
}

fn unit_error(key: &str, node: &Node, error: QuantityError, example: &str) -> Diagnostic {
    let message = |title: String| Diagnostic::new(node.place.clone(), title);
    match error {
        QuantityError::NoUnit { text, wanted } => message(format!("`{key}` has no unit"))
            .label(format!("{} needs one", wanted.noun()))
            .help(with_units(&text, wanted)),
        QuantityError::OtherKind {
            text,
            found,
            wanted,
        } => message(format!("`{key}`: {} is {}", quoted(&text), found.noun()))
            .label(format!("{} belongs here", wanted.noun()))
            .help(format!("for example: {key} = \"{example}\"")),
        QuantityError::UnknownUnit {
            unit,
            wanted,
            meant,
        } => {
            let units: Vec<&str> = wanted.units().collect();
            message(format!("`{key}`: unknown unit {}", quoted(&unit)))
                .label(format!("{} belongs here", wanted.noun()))
                .helps(meant.map(|meant| format!("did you mean `{meant}`?")))
                .help(format!("units of {}: {}", wanted.noun(), listed(&units)))
        }
        QuantityError::NotANumber { text } => {
            let comma = text
                .contains(',')
                .then(|| "the decimal sign is a point".to_owned());
            message(format!(
                "`{key}`: {} is not a number with a unit",
                quoted(&text)
            ))
            .label("a number and a unit belong here")
            .helps(comma)
        }
        QuantityError::NotFinite { text } => {
            message(format!("`{key}`: {} is not a finite number", quoted(&text)))
                .label("must be finite")
        }
    }
}

/// A pure number; finite.
pub(crate) fn number(key: &str, node: &Node) -> Result<f64, Diagnostic> {
    match &node.value {
        Value::Number(number) if number.is_finite() => Ok(*number),
        Value::Number(_) => Err(not_finite(key, node)),
        Value::Text(text) if text.trim().parse::<f64>().is_ok() => {
            let fixed = format!("write it without quotes: {key} = {}", text.trim());
            Err(wrong_type(key, node, "a pure number").help(fixed))
        }
        Value::Text(text) if text.trim_start().starts_with(|c: char| c.is_ascii_digit()) => {
            Err(wrong_type(key, node, "a pure number").help("it has no unit, and needs no quotes"))
        }
        _ => Err(wrong_type(key, node, "a pure number")),
    }
}

/// True or false.
pub(crate) fn flag(key: &str, node: &Node) -> Result<bool, Diagnostic> {
    match &node.value {
        Value::Flag(flag) => Ok(*flag),
        _ => Err(wrong_type(key, node, "true or false").help(format!(
            "write {key} = true or {key} = false, without quotes"
        ))),
    }
}

/// Any string.
pub(crate) fn text<'a>(key: &str, node: &'a Node) -> Result<&'a str, Diagnostic> {
    match &node.value {
        Value::Text(text) => Ok(text),
        _ => Err(wrong_type(key, node, "a string").help("write it in double quotes")),
    }
}

/// One of some words.
pub(crate) fn word<'w>(key: &str, node: &Node, words: &[&'w str]) -> Result<&'w str, Diagnostic> {
    let written = text(key, node)?;
    let found = words.iter().find(|word| **word == written);
    found.copied().ok_or_else(|| {
        Diagnostic::new(
            node.place.clone(),
            format!("`{key}` cannot be {}", quoted(written)),
        )
        .label("not one of its words")
        .helps(did_you_mean(written, words))
        .help(format!("`{key}` is one of {}", listed(words)))
    })
}

/// The items of a list.
pub(crate) fn items<'a>(key: &str, node: &'a Node) -> Result<&'a [Node], Diagnostic> {
    match &node.value {
        Value::Array(items) => Ok(items),
        _ => Err(wrong_type(key, node, "a list").help("write a list in brackets: [ … ]")),
    }
}

/// "`key` must be a list, and is a string".
pub(crate) fn wrong_type(key: &str, node: &Node, wanted: &str) -> Diagnostic {
    let title = format!("`{key}` must be {wanted}");
    Diagnostic::new(node.place.clone(), title).label(format!("this is {}", node.value.noun()))
}
