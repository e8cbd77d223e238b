//! Strategies of Python as those of the library: one adapter for each slot.
//!
//! An adapter takes the interpreter's lock for one call of Python, with copies of a batch or with
//! something to ask, and has no other lock. The host checks the answers as it does for any plugin.

mod compensator;
mod feed;
mod sampler;
mod spindle;
mod surface;
mod velocity;

pub use compensator::PyCompensator;
pub use feed::PyFeed;
pub use sampler::PySampler;
pub use spindle::PySpindle;
pub use surface::surface;
pub use velocity::PyVelocity;

use std::sync::Arc;

use pyo3::prelude::*;

/// A callable of Python with its parameters bound.
pub type Callable = Arc<Py<PyAny>>;

/// A value that Python gave with the decorator, or its default.
pub fn option<'py, T>(options: &Bound<'py, PyAny>, name: &str, default: T) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
    for<'a> <T as FromPyObject<'a, 'py>>::Error: Into<PyErr>,
{
    match options.get_item(name) {
        Ok(value) => value.extract::<T>().map_err(Into::into),
        Err(_) => Ok(default),
    }
}
