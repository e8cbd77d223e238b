//! Single values: turns a node of the tree into a number, a flag or a word, or into a message.

use turnpath_core::{Quantity, QuantityError};

use crate::diagnostic::Diagnostic;
use crate::document::{Node, Value};
use crate::span::Spanned;
use crate::suggest::{did_you_mean, listed, quoted};

/// A quantity in the units used inside (mm, rad, s); `example` is a value that would be right.
pub(crate) fn quantity(
    key: &str,
    node: &Node,
    expected: Quantity,
    example: &str,
) -> Result<f64, Diagnostic> {
    let with_unit = || format!("write it with its unit: {key} = \"{example}\"");
    match &node.value {
        Value::Text(text) => expected
            .parse(text)
            .map_err(|error| unit_error(key, node, error, example)),
        Value::Number(number) if number.is_finite() => {
            Err(bare_number(key, node, *number, expected))
        }
        Value::Number(_) => Err(not_finite(key, node).with_help(with_unit())),
        _ => Err(wrong_type(key, node, expected.noun()).with_help(with_unit())),
    }
}

fn not_finite(key: &str, node: &Node) -> Diagnostic {
    let title = format!("`{key}` is not a finite number");
    Diagnostic::new(node.span.clone(), title).with_label("must be finite")
}

/// Help that shows the number with each of the usual units.
fn with_units(number: &str, expected: Quantity) -> String {
    let choices: Vec<String> = expected
        .units()
        .take(3)
        .map(|unit| format!("\"{number} {unit}\""))
        .collect();
    format!(
        "write the number with its unit, in quotes: {}",
        choices.join(" or ")
    )
}

fn bare_number(key: &str, node: &Node, number: f64, expected: Quantity) -> Diagnostic {
    let title = format!("`{key}` has no unit");
    let label = format!("{} needs one", expected.noun());
    Diagnostic::new(node.span.clone(), title)
        .with_label(label)
        .with_help(with_units(&number.to_string(), expected))
}

fn unit_error(key: &str, node: &Node, error: QuantityError, example: &str) -> Diagnostic {
    let message = |title: String| Diagnostic::new(node.span.clone(), title);
    match error {
        QuantityError::NoUnit { text, wanted } => message(format!("`{key}` has no unit"))
            .with_label(format!("{} needs one", wanted.noun()))
            .with_help(with_units(&text, wanted)),
        QuantityError::OtherKind {
            text,
            found,
            wanted,
        } => message(format!("`{key}`: {} is {}", quoted(&text), found.noun()))
            .with_label(format!("{} belongs here", wanted.noun()))
            .with_help(format!("for example: {key} = \"{example}\"")),
        QuantityError::UnknownUnit {
            unit,
            wanted,
            meant,
        } => {
            let units: Vec<&str> = wanted.units().collect();
            message(format!("`{key}`: unknown unit {}", quoted(&unit)))
                .with_label(format!("{} belongs here", wanted.noun()))
                .with_helps(meant.map(|meant| format!("did you mean `{meant}`?")))
                .with_help(format!("units of {}: {}", wanted.noun(), listed(&units)))
        }
        QuantityError::NotANumber { text } => {
            let comma = text
                .contains(',')
                .then(|| "write the decimal separator as a point".to_owned());
            message(format!(
                "`{key}`: {} is not a number with a unit",
                quoted(&text)
            ))
            .with_label("a number and a unit belong here")
            .with_helps(comma)
        }
        QuantityError::NotFinite { text } => {
            message(format!("`{key}`: {} is not a finite number", quoted(&text)))
                .with_label("must be finite")
        }
    }
}

/// A finite number without a unit.
pub(crate) fn number(key: &str, node: &Node) -> Result<f64, Diagnostic> {
    match &node.value {
        Value::Number(number) if number.is_finite() => Ok(*number),
        Value::Number(_) => Err(not_finite(key, node)),
        Value::Text(text) if text.trim().parse::<f64>().is_ok() => {
            let fixed = format!("write it without quotes: {key} = {}", text.trim());
            Err(wrong_type(key, node, "a pure number").with_help(fixed))
        }
        Value::Text(text) if text.trim_start().starts_with(|c: char| c.is_ascii_digit()) => {
            Err(wrong_type(key, node, "a pure number")
                .with_help("write it without a unit and without quotes"))
        }
        _ => Err(wrong_type(key, node, "a pure number")),
    }
}

/// True or false.
pub(crate) fn flag(key: &str, node: &Node) -> Result<bool, Diagnostic> {
    match &node.value {
        Value::Flag(flag) => Ok(*flag),
        _ => Err(wrong_type(key, node, "true or false").with_help(format!(
            "write {key} = true or {key} = false, without quotes"
        ))),
    }
}

/// Any string.
pub(crate) fn text<'a>(key: &str, node: &'a Node) -> Result<&'a str, Diagnostic> {
    match &node.value {
        Value::Text(text) => Ok(text),
        _ => Err(wrong_type(key, node, "a string").with_help("write it in double quotes")),
    }
}

/// The path of a file.
pub(crate) fn file(key: &str, node: &Node) -> Result<Spanned<String>, Diagnostic> {
    match &node.value {
        Value::Text(text) if !text.trim().is_empty() => Ok(Spanned {
            value: text.clone(),
            span: node.span.clone(),
        }),
        Value::Text(_) => Err(
            Diagnostic::new(node.span.clone(), format!("`{key}` names no file"))
                .with_label("the path of a file belongs here"),
        ),
        _ => Err(wrong_type(key, node, "the path of a file")
            .with_help("write it in double quotes; it is relative to the recipe")),
    }
}

/// One of the allowed words.
pub(crate) fn word<'w>(key: &str, node: &Node, words: &[&'w str]) -> Result<&'w str, Diagnostic> {
    let written = text(key, node)?;
    let word = words.iter().find(|word| **word == written);
    word.copied().ok_or_else(|| {
        Diagnostic::new(
            node.span.clone(),
            format!("`{key}` cannot be {}", quoted(written)),
        )
        .with_label("not an allowed word")
        .with_helps(did_you_mean(written, words))
        .with_help(format!("`{key}` is one of {}", listed(words)))
    })
}

/// The items of a list.
pub(crate) fn items<'a>(key: &str, node: &'a Node) -> Result<&'a [Node], Diagnostic> {
    match &node.value {
        Value::Array(items) => Ok(items),
        _ => Err(wrong_type(key, node, "a list").with_help("write a list in brackets: [ … ]")),
    }
}

/// The message that a value has the wrong kind: "`key` must be a list", "this is a string".
pub(crate) fn wrong_type(key: &str, node: &Node, expected: &str) -> Diagnostic {
    let title = format!("`{key}` must be {expected}");
    Diagnostic::new(node.span.clone(), title).with_label(format!("this is {}", node.value.noun()))
}
