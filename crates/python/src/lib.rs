//! The native part of the Python package `turnpath`: what crosses between the interpreter and the
//! library, in arrays and in JSON. Its Python part, in `python/turnpath`, has what a person calls.
//!
//! - [`commands`] has the entries: run, check, verify, ablate and its parts for a queue, and the whole
//!   command line. Each gives up the interpreter's lock for its whole work, as soon as it has read
//!   what Python gave.
//! - [`catalogue`] turns declarations of Python into strategies of the program's own;
//!   [`strategies`] has one adapter for each slot.
//! - [`views`] is what a strategy may ask; each question gives up the lock while turnpath answers.
//!   [`loan`] makes sure that no answer is asked for after the call.

mod arrays;
mod catalogue;
mod commands;
mod declared;
mod failure;
mod loan;
mod observer;
mod strategies;
mod views;

use pyo3::prelude::*;

/// See the crate.
#[pymodule(gil_used = true)]
mod _turnpath {
    #[pymodule_export]
    use crate::commands::{ablate, check, main, merge, plan, run, run_of, strategies, verify};
    #[pymodule_export]
    use crate::declared::{parse_quantity, subdivide};
    #[pymodule_export]
    use crate::observer::Control;
    #[pymodule_export]
    use crate::views::{
        cut::{CutView, SurfaceView},
        locus::LocusView,
        path::{BlockView, PathView, SetupView},
        task::TaskView,
    };

    #[pymodule_init]
    fn init(module: &super::Bound<'_, super::PyModule>) -> super::PyResult<()> {
        use super::PyModuleMethods;
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
