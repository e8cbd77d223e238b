//! Tables of named constants: numbers, angles, and powers of lengths.

use turnpath_core::{LengthPower, NamedConstant, ParamInfo, QuantityError};

use crate::declared::example;
use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Value};
use crate::suggest::quoted;
use crate::value;

/// The constants of a table, in the order of the text.
pub(crate) fn read(param: &ParamInfo, node: &Node) -> Result<Vec<NamedConstant>, Diagnostic> {
    let for_example = || format!("for example: {} = {}", param.name, example(param));
    let Value::Table(table) = &node.value else {
        return Err(
            value::wrong_type(param.name, node, "a table of constants").with_help(for_example())
        );
    };
    let constant = |entry: &Entry| {
        if !is_name(&entry.key) {
            let title = format!("`{}`: {} is not a name", param.name, quoted(&entry.key));
            return Err(Diagnostic::new(entry.span.clone(), title)
                .with_label("letters, digits and `_` belong here, and no digit first"));
        }
        let (value, length_power) = value_of(param.name, entry)?;
        Ok(NamedConstant {
            name: entry.key.clone(),
            value,
            length_power,
        })
    };
    table.entries().iter().map(constant).collect()
}

/// Whether a formula can have this name.
fn is_name(key: &str) -> bool {
    key.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && key.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// The value in powers of mm and in rad, and the power of the length.
fn value_of(name: &str, entry: &Entry) -> Result<(f64, i32), Diagnostic> {
    let key = format!("{name}.{}", entry.key);
    let Value::Text(text) = &entry.node.value else {
        return value::number(&key, &entry.node).map(|number| (number, 0));
    };
    match LengthPower::parse(text) {
        Ok(read) => Ok((read.value, read.power)),
        Err(error) => Err(wrong_value(&key, entry, text, &error)),
    }
}

fn wrong_value(key: &str, entry: &Entry, text: &str, error: &QuantityError) -> Diagnostic {
    let help = match error {
        QuantityError::NoUnit { text, .. } => {
            format!("write a number without quotes, {key} = {text}, or a length as \"{text} mm\"")
        }
        QuantityError::UnknownUnit {
            meant: Some(meant), ..
        } => format!("did you mean `{meant}`?"),
        _ => format!("for example: {key} = \"5 mm\", \"0.08 /mm\", \"1e-6 /mm^3\" or \"45 deg\""),
    };
    let title = format!("`{key}` cannot be {}", quoted(text));
    Diagnostic::new(entry.node.span.clone(), title)
        .with_label("a number, a length, a power of a length or an angle belongs here")
        .with_help(help)
}
