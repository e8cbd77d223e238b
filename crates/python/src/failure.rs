//! Errors on their way: what Python raised, as the answer of a strategy, and what turnpath found, as
//! an exception.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use turnpath::{Diagnostic, Error, Fault};
use turnpath_core::StrategyError;

/// What a call of Python raised, as the failure of its strategy. The Python part has put kind, text
/// and place into the message.
pub fn failed(py: Python<'_>, error: &PyErr) -> StrategyError {
    StrategyError::failed(error.value(py).to_string())
}

/// Calls Python, from a thread that does not hold the interpreter's lock.
pub fn asked<R>(call: impl FnOnce(Python<'_>) -> PyResult<R>) -> Result<R, StrategyError> {
    Python::attach(|py| call(py).map_err(|error| failed(py, &error)))
}

/// What a strategy that Python asked could not answer, as an exception.
pub fn not_answered(error: &StrategyError) -> PyErr {
    pyo3::exceptions::PyArithmeticError::new_err(error.to_string())
}

/// An error of turnpath as the exception that `turnpath._errors` makes of it.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let made = described(py, error).and_then(|found| {
        let errors = py.import("turnpath._errors")?;
        errors.getattr("of_native")?.call1((found,))
    });
    made.map_or_else(|error| error, PyErr::from_value)
}

/// Whose fault an error is, what is wrong, and where.
fn described<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let fault = match error.fault() {
        Fault::Request => "request",
        Fault::Plugin => "plugin",
        Fault::Files => "files",
        Fault::Cancelled => "cancelled",
    };
    found.set_item("fault", fault)?;
    found.set_item("title", error.title())?;
    found.set_item("causes", causes(error))?;
    let diagnostics = error.diagnostics();
    let text: Vec<String> = diagnostics.iter().map(|one| one.render(false)).collect();
    found.set_item("text", text.join("\n"))?;
    let mut help: Vec<String> = diagnostics
        .iter()
        .flat_map(|one| one.help().to_vec())
        .collect();
    help.extend(error.help().map(str::to_owned));
    found.set_item("help", help)?;
    let places = PyList::empty(py);
    for diagnostic in diagnostics {
        if let Some(place) = place(diagnostic) {
            places.append(place)?;
        }
    }
    found.set_item("places", places)?;
    Ok(found)
}

/// What the stages below said, each in its own words: a message that a person reads may be broken over
/// lines.
fn causes(error: &Error) -> Vec<String> {
    let first = std::error::Error::source(error);
    let all = std::iter::successors(first, |one| one.source());
    all.map(ToString::to_string).collect()
}

/// File, line and column, counted from 1, and the text there.
fn place(diagnostic: &Diagnostic) -> Option<(String, usize, usize, String)> {
    let span = diagnostic.span().filter(|span| !span.is_whole())?;
    let (source, range) = (span.source(), span.range());
    let before = source.text.get(..range.start)?;
    let line = before.matches('\n').count() + 1;
    let column = before
        .rsplit('\n')
        .next()
        .map_or(0, |line| line.chars().count())
        + 1;
    let text = source.text.get(range).unwrap_or_default();
    Some((source.name.clone(), line, column, text.to_owned()))
}
