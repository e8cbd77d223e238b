//! Declarations of strategies and parameters that Python gives, and the values for them.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use turnpath::Quantity;
use turnpath_core::{ParamInfo, ParamKind, ParamValue, Params, Turn};

/// A strategy's name, its summary and its parameters. They stay for the whole program.
#[derive(Debug, Clone, Copy)]
pub struct Declaration {
    /// The name in recipes.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The parameters.
    pub params: &'static [ParamInfo],
}

/// All declarations so far: each stays once, however often a strategy is used.
static KNOWN: Mutex<Option<HashMap<String, Declaration>>> = Mutex::new(None);

/// Reads a declaration: a JSON text with `name`, `summary` and `params`.
///
/// # Errors
/// When a parameter is of no known kind.
pub fn declaration(text: &str) -> PyResult<Declaration> {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let known = known.get_or_insert_with(HashMap::new);
    if let Some(declaration) = known.get(text) {
        return Ok(*declaration);
    }
    let wrong = |error: serde_json::Error| PyValueError::new_err(error.to_string());
    let value: &'static Value = Box::leak(Box::new(serde_json::from_str(text).map_err(wrong)?));
    let params: Vec<ParamInfo> = match value.get("params") {
        Some(params) => serde::Deserialize::deserialize(params).map_err(wrong)?,
        None => Vec::new(),
    };
    let word = |key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default();
    let declaration = Declaration {
        name: word("name"),
        summary: word("summary"),
        params: params.leak(),
    };
    known.insert(text.to_owned(), declaration);
    Ok(declaration)
}

/// The values of parameters as keyword arguments: quantities as numbers in mm, rad and s.
pub fn arguments<'py>(
    py: Python<'py>,
    params: &Params,
    declared: &[ParamInfo],
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    for param in declared {
        arguments.set_item(param.name, py.None())?;
    }
    for (name, value) in params.iter() {
        let kind = declared
            .iter()
            .find(|param| param.name == name)
            .map(|param| param.kind);
        match value {
            ParamValue::Number(number) if kind == Some(ParamKind::Count) => {
                arguments.set_item(name, *number as u64)?;
            }
            ParamValue::Number(number) => arguments.set_item(name, number)?,
            ParamValue::Flag(flag) => arguments.set_item(name, flag)?,
            ParamValue::Text(text) => arguments.set_item(name, text)?,
            ParamValue::List(texts) => arguments.set_item(name, texts)?,
            ParamValue::Rows(rows) => arguments.set_item(name, rows)?,
            ParamValue::Constants(constants) => {
                let named = constants.iter().map(|one| (one.name.clone(), one.value));
                arguments.set_item(name, named.collect::<HashMap<_, _>>())?;
            }
            ParamValue::File(file) => {
                arguments.set_item(name, pyo3::types::PyBytes::new(py, &file.bytes))?;
            }
        }
    }
    Ok(arguments)
}

/// The number, in mm, rad and s, of a quantity of this kind: `parse_quantity("length", "5 um")`.
#[pyfunction]
pub fn parse_quantity(kind: &str, text: &str) -> PyResult<f64> {
    let quantity = Quantity::all().find(|quantity| {
        serde_json::to_value(quantity).is_ok_and(|name| name.as_str() == Some(kind))
    });
    let quantity =
        quantity.ok_or_else(|| PyValueError::new_err(format!("there is no quantity `{kind}`")))?;
    let number = quantity.parse(text);
    number.map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Nodes from `start` to `end` (excluded), in revolutions, 1/`steps` of a revolution apart. `steps` is
/// rounded up to a whole number.
#[pyfunction]
pub fn subdivide(py: Python<'_>, start: f64, end: f64, steps: f64) -> Bound<'_, PyAny> {
    let nodes = Turn { start, end }.subdivide(steps);
    crate::arrays::array(py, nodes.collect())
}
