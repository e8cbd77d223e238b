//! Strategies that Python declares, as strategies of the program's own.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use turnpath::{Catalogue, Identity, LoadError, OwnPlugin, OwnStrategy, SurfaceNeed};
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
    /// The hash of all that its answers depend on, or why there is none.
    identity: (Option<String>, String),
    /// What the decorator said besides.
    options: Bound<'py, PyDict>,
}

/// What is read from the interpreter: strategies of the program's own, and libraries that are still to
/// be loaded.
pub struct Offered {
    owns: Vec<OwnPlugin>,
    libraries: Vec<PathBuf>,
}

impl Offered {
    /// Reads the declarations.
    ///
    /// # Errors
    /// When one is wrong.
    pub fn read(sources: &Sources<'_>) -> PyResult<Self> {
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
        Ok(Self {
            owns,
            libraries: libraries.clone(),
        })
    }

    /// The strategies that are built in, and these. It loads libraries, whose initialisers may take
    /// any time: the caller does not hold the interpreter's lock.
    ///
    /// # Errors
    /// When a library cannot be loaded, or a name is there already.
    pub fn catalogue(self) -> Result<Catalogue, LoadError> {
        let linked = Catalogue::linked()?;
        let with_libraries = self.libraries.iter().try_fold(linked, with_library)?;
        let mut owns = self.owns.into_iter();
        owns.try_fold(with_libraries, Catalogue::with_own)
    }
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
    let strategy = strategy.with_identity(match &declared.identity {
        (Some(hash), _) => Identity::Hash(hash.clone()),
        (None, why) => Identity::Unknown(why.clone()),
    });
    // Of a surface that is known when it is made: its formula may be exact.
    Ok(match declared.slot == "surface" {
        true => strategy,
        false => strategy.differs_between_machines(),
    })
}

fn of_slot(declared: &StrategySource<'_>, own: Declaration) -> PyResult<OwnStrategy> {
    let options = declared.options.as_any();
    let bind = Arc::new(declared.bind.clone_ref(options.py()));
    let own_bind = Arc::clone(&bind);
    let bound = move |params: &Params| bound(&own_bind, params, own);
    Ok(match declared.slot.as_str() {
        "surface" => OwnStrategy::surface_for(own.name, move |params, need| {
            surface(&surface_made(&bind, params, need, own)?)
        }),
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

/// What Python makes of a surface with these parameters, for what a recipe needs of it.
fn surface_made(
    bind: &Py<PyAny>,
    params: &Params,
    need: SurfaceNeed,
    own: Declaration,
) -> Result<Py<PyAny>, StrategyError> {
    asked(|py| {
        let arguments = arguments(py, params, own.params)?;
        bind.call1(py, (arguments, need.half_width, need.error))
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
