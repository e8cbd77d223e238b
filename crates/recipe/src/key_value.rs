//! The value that a recipe has under a declared key, or the key's default.

use turnpath_core::{ParamDefault, ParamInfo, ParamKind, ParamValue};

use crate::coefficients;
use crate::constants;
use crate::declared::{example, range, shown, usual_text};
use crate::diagnostic::Diagnostic;
use crate::document::{Node, Value};
use crate::span::Spanned;
use crate::value;

/// What a recipe has under a declared key.
pub(crate) enum KeyValue {
    /// A value.
    Value(ParamValue),
    /// The path of a file, which is not read here.
    File(Spanned<String>),
}

/// The value of a declared key, of its kind and in its range.
pub(crate) fn key_value(param: &ParamInfo, node: &Node) -> Result<KeyValue, Diagnostic> {
    let key = param.name;
    let value = match param.kind {
        ParamKind::File => return value::file(key, node).map(KeyValue::File),
        ParamKind::Flag => ParamValue::Flag(value::flag(key, node)?),
        ParamKind::Text => ParamValue::Text(value::text(key, node)?.to_owned()),
        ParamKind::Choice(words) => ParamValue::Text(value::word(key, node, words)?.to_owned()),
        ParamKind::ChoiceOr(words, _) if is_word(node) => {
            ParamValue::Text(value::word(key, node, words)?.to_owned())
        }
        ParamKind::List(words) => ParamValue::List(list(key, node, words)?),
        ParamKind::Rows(columns) => ParamValue::Rows(some(param, node, rows(key, node, columns)?)?),
        ParamKind::Coefficients(indices, quantity) => {
            let read = coefficients::read(param, node, indices, quantity)?;
            ParamValue::Rows(some(param, node, read)?)
        }
        ParamKind::Constants => ParamValue::Constants(constants::read(param, node)?),
        ParamKind::Quantity(_) | ParamKind::ChoiceOr(..) | ParamKind::Number | ParamKind::Count => {
            ParamValue::Number(number(param, node)?)
        }
    };
    Ok(KeyValue::Value(value))
}

/// The value of a key that the recipe leaves out; `None` if there is none.
pub(crate) fn default_of(param: &ParamInfo) -> Option<ParamValue> {
    match param.default {
        ParamDefault::Required | ParamDefault::Absent => None,
        ParamDefault::Number(number) => Some(ParamValue::Number(number)),
        ParamDefault::Flag(flag) => Some(ParamValue::Flag(flag)),
        ParamDefault::Text(word) => Some(ParamValue::Text(word.to_owned())),
        ParamDefault::List(words) => {
            let texts = words.iter().map(|word| (*word).to_owned());
            Some(ParamValue::List(texts.collect()))
        }
    }
}

fn is_word(node: &Node) -> bool {
    let starts_as_word = |text: &str| text.starts_with(|c: char| c.is_ascii_alphabetic());
    matches!(&node.value, Value::Text(text) if starts_as_word(text))
}

fn number(param: &ParamInfo, node: &Node) -> Result<f64, Diagnostic> {
    let number = match param.kind.quantity() {
        Some(quantity) => value::quantity(param.name, node, quantity, usual_text(param))?,
        None => value::number(param.name, node)?,
    };
    whole_if_count(param, node, number)?;
    in_range(param, node, number)?;
    Ok(number)
}

fn whole_if_count(param: &ParamInfo, node: &Node, number: f64) -> Result<(), Diagnostic> {
    /// Above this, doubles skip whole numbers.
    const LARGEST_COUNT: f64 = 9_007_199_254_740_992.0;
    if param.kind != ParamKind::Count || (number.floor() == number && number <= LARGEST_COUNT) {
        return Ok(());
    }
    let title = format!("`{}` must be a whole number", param.name);
    Err(Diagnostic::new(node.span.clone(), title)
        .with_label("a count belongs here")
        .with_help(format!("for example: {} = {}", param.name, example(param))))
}

fn in_range(param: &ParamInfo, node: &Node, number: f64) -> Result<(), Diagnostic> {
    if param.admits(number) {
        return Ok(());
    }
    let title = format!("`{}` must be {}", param.name, range(param));
    Err(Diagnostic::new(node.span.clone(), title)
        .with_label(format!("this is {}", shown(param.kind, number)))
        .with_help(format!("`{}`: {}", param.name, param.help)))
}

fn list(key: &str, node: &Node, words: &[&str]) -> Result<Vec<String>, Diagnostic> {
    let item = |item: &Node| match words {
        [] => value::text(key, item).map(str::to_owned),
        words => value::word(key, item, words).map(str::to_owned),
    };
    value::items(key, node)?.iter().map(item).collect()
}

fn rows(key: &str, node: &Node, columns: usize) -> Result<Vec<Vec<f64>>, Diagnostic> {
    value::items(key, node)?
        .iter()
        .map(|item| row(key, item, columns))
        .collect()
}

/// Rows as they are. A key without any says nothing, and is refused: without the key it is said.
fn some(param: &ParamInfo, node: &Node, rows: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, Diagnostic> {
    if !rows.is_empty() {
        return Ok(rows);
    }
    let (key, for_example) = (param.name, example(param));
    let left_out = match param.default {
        ParamDefault::Absent => format!("leave `{key}` out, or give some"),
        _ => "give some".to_owned(),
    };
    Err(
        Diagnostic::new(node.span.clone(), format!("`{key}` is empty"))
            .with_label("at least one belongs here")
            .with_help(format!("{left_out}; for example: {key} = {for_example}")),
    )
}

fn row(key: &str, node: &Node, columns: usize) -> Result<Vec<f64>, Diagnostic> {
    let expected = format!("a list of rows of {columns} numbers");
    let items = value::items(key, node).map_err(|_| value::wrong_type(key, node, &expected))?;
    if items.len() != columns {
        let title = format!("a row of `{key}` must have {columns} numbers");
        return Err(Diagnostic::new(node.span.clone(), title)
            .with_label(format!("this has {}", items.len())));
    }
    items.iter().map(|item| value::number(key, item)).collect()
}
