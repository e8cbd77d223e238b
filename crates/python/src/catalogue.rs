//! Strategies that Python declares, as strategies of the program's own.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use turnpath::{Catalogue, LoadError, OwnPlugin, OwnStrategy};
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Params, Radial, StrategyError};

use crate::declared::{Declaration, arguments, declaration};
use crate::failure::asked;
use crate::strategies::{
    Callable, PyCompensator, PyFeed, PySampler, PySpindle, PyVelocity, option, surface,
};

/// What a command may choose from besides what is built in: the strategies of modules, and folders and
/// libraries of plugins.
#[derive(FromPyObject)]
pub struct Sources<'py>(Vec<Module<'py>>, Vec<PathBuf>);

/// Strategies of one module, as `turnpath._strategies` gives them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Module<'py> {
    name: String,
    version: String,
    /// Where its source is.
    place: String,
    sha256: String,
    strategies: Vec<StrategySource<'py>>,
}

/// One strategy of a module.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct StrategySource<'py> {
    slot: String,
    /// Name, summary and parameters as JSON.
    declaration: String,
    /// Binds parameters: it gives a callable, or what a surface is made of.
    bind: Py<PyAny>,
    /// Whether its answers have the same bytes on every machine.
    exact: bool,
    /// What the decorator said besides.
    options: Bound<'py, PyDict>,
}

/// The strategies that are built in, and those of these sources.
///
/// # Errors
/// When a declaration is wrong; then when a library cannot be loaded, or a name is there already.
pub fn catalogue(sources: &Sources<'_>) -> PyResult<Result<Catalogue, LoadError>> {
    let Sources(modules, libraries) = sources;
    let mut owns = Vec::new();
    for module in modules {
        let mut own = OwnPlugin::new(&module.name, &module.version)
            .with_source(&module.place, &module.sha256);
        for declared in &module.strategies {
            own = own.with(strategy(declared)?);
        }
        owns.push(own);
    }
    let catalogue = Catalogue::linked().and_then(|linked| {
        let with_libraries = libraries.iter().try_fold(linked, with_library);
        owns.into_iter()
            .try_fold(with_libraries?, Catalogue::with_own)
    });
    Ok(catalogue)
}

fn with_library(catalogue: Catalogue, path: &PathBuf) -> Result<Catalogue, LoadError> {
    match path.is_dir() {
        true => catalogue.with_folder(path),
        false => catalogue.with_file(path),
    }
}

fn strategy(declared: &StrategySource<'_>) -> PyResult<OwnStrategy> {
    let own = declaration(&declared.declaration)?;
    let strategy = of_slot(declared, own)?;
    let strategy = strategy.with_summary(own.summary).with_params(own.params);
    Ok(match declared.exact {
        true => strategy,
        false => strategy.differs_between_machines(),
    })
}

fn of_slot(declared: &StrategySource<'_>, own: Declaration) -> PyResult<OwnStrategy> {
    let options = declared.options.as_any();
    let bind = Arc::new(declared.bind.clone_ref(options.py()));
    let bound = move |params: &Params| bound(&bind, params, own);
    Ok(match declared.slot.as_str() {
        "surface" => OwnStrategy::surface(own.name, move |params| surface(&bound(params)?)),
        "feed" => OwnStrategy::feed(own.name, move |params| {
            Ok(Box::new(PyFeed(callable(bound(params)?))))
        }),
        "sampler" => {
            let needs_exact_rates = option(options, "needs_exact_rates", false)?;
            OwnStrategy::sampler(own.name, move |params| {
                let bound = bound(params)?;
                let (place, plan) =
                    asked(|py| bound.extract::<(Py<PyAny>, Option<Py<PyAny>>)>(py))?;
                Ok(Box::new(PySampler {
                    place: callable(place),
                    plan: plan.map(callable),
                    needs_exact_rates,
                }))
            })
        }
        "compensator" => {
            let radial = radial(&option(options, "radial", String::from("contact"))?)?;
            let compensates_nose = option(options, "compensates_nose", true)?;
            OwnStrategy::compensator(own.name, move |params| {
                let call = callable(bound(params)?);
                Ok(Box::new(PyCompensator {
                    call,
                    radial,
                    compensates_nose,
                }))
            })
        }
        "velocity" => {
            let overlap = option(options, "overlap", 0)?;
            let segments = segments(&option(options, "segments", String::from("cubic"))?)?;
            let exact_rates = option(options, "exact_rates", false)?;
            OwnStrategy::velocity(own.name, move |params| {
                let call = callable(bound(params)?);
                Ok(Box::new(PyVelocity {
                    call,
                    overlap,
                    segments,
                    exact_rates,
                }))
            })
        }
        "spindle" => {
            let follows_factors = option(options, "follows_factors", false)?;
            OwnStrategy::spindle(own.name, move |params| {
                let call = callable(bound(params)?);
                Ok(Box::new(PySpindle {
                    call,
                    follows_factors,
                }))
            })
        }
        other => return Err(no_word("slot", other)),
    })
}

/// What Python makes of a strategy with these parameters.
fn bound(bind: &Py<PyAny>, params: &Params, own: Declaration) -> Result<Py<PyAny>, StrategyError> {
    asked(|py| {
        let arguments = arguments(py, params, own.params)?;
        bind.call1(py, (arguments,))
    })
}

fn callable(bound: Py<PyAny>) -> Callable {
    Arc::new(bound)
}

fn radial(word: &str) -> PyResult<Radial> {
    match word {
        "contact" => Ok(Radial::Contact),
        "centre" => Ok(Radial::Centre),
        other => Err(no_word("radial", other)),
    }
}

fn segments(word: &str) -> PyResult<SegmentShape> {
    match word {
        "cubic" => Ok(SegmentShape::Cubic),
        "linear" => Ok(SegmentShape::Linear),
        other => Err(no_word("segments", other)),
    }
}

fn no_word(what: &str, word: &str) -> PyErr {
    PyValueError::new_err(format!("there is no {what} `{word}`"))
}
