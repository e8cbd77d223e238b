//! The entries: each reads what Python gives, gives up the interpreter's lock, and works.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use numpy::PyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::ThreadPoolBuilder;
use turnpath::report::to_json;
use turnpath::{
    AblationOptions, Catalogue, Error, Job, MapGrid, MapRequest, Outputs, PlotRequest, Recipe,
    Section, ToolPath, with_wrong_strategies,
};

use crate::catalogue::{Offered, Sources};
use crate::failure::exception;
use crate::observer::Control;

/// A recipe: its text, the path that messages name and files are relative to, and the changes.
#[derive(FromPyObject)]
pub struct RecipeText(String, PathBuf, Vec<String>);

impl RecipeText {
    fn read(&self) -> Result<Recipe, Error> {
        Ok(Recipe::parse(&self.0, &self.1, &self.2)?)
    }
}

/// Report, files, columns, and programs by their names.
type RunAnswer<'py> = (
    String,
    Vec<PathBuf>,
    Option<Bound<'py, PyDict>>,
    Vec<(String, Vec<u8>)>,
);
/// Report, files, and how many runs had a record.
type AblationAnswer = (String, Vec<PathBuf>, usize);

/// Does the work of a command on threads of its own, without the interpreter's lock.
fn work<R: Send>(
    py: Python<'_>,
    sources: &Sources<'_>,
    threads: usize,
    work: impl FnOnce(&Catalogue) -> Result<R, Error> + Send,
) -> PyResult<R> {
    let offered = Offered::read(sources)?;
    let done = py.detach(move || {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let catalogue = offered.catalogue().map_err(Error::from);
        Ok(catalogue.and_then(|catalogue| {
            let done = pool.install(|| work(&catalogue));
            done.map_err(|error| with_wrong_strategies(error, &catalogue))
        }))
    });
    done.and_then(|done| done.map_err(|error| exception(py, &error)))
}

/// Makes a path, measures it, and gives report, files, columns and programs.
#[pyfunction]
#[pyo3(signature = (recipe, sources, control, *, folder=None, map=None, threads=0))]
pub fn run<'py>(
    py: Python<'py>,
    recipe: RecipeText,
    sources: Sources<'py>,
    control: Control,
    folder: Option<PathBuf>,
    map: Option<(PathBuf, usize)>,
    threads: usize,
) -> PyResult<RunAnswer<'py>> {
    let result = work(py, &sources, threads, |catalogue| {
        let outputs = match folder {
            Some(folder) => Outputs::in_folder(folder),
            None => Outputs::in_memory(),
        };
        let outputs = match map {
            Some((file, cells)) => outputs.with_plots(map_request(file, cells)),
            None => outputs,
        };
        Job::new(recipe.read()?, catalogue)?.run(outputs, &control)
    })?;
    let columns = result.toolpath.map(|path| columns(py, path)).transpose()?;
    let json = to_json(&result.report);
    Ok((json, result.files, columns, result.programs))
}

fn map_request(file: PathBuf, cells: usize) -> PlotRequest {
    PlotRequest {
        map: Some(MapRequest {
            file,
            cells,
            grid: MapGrid::Cartesian,
        }),
        ..PlotRequest::default()
    }
}

/// The columns of a path by their names.
fn columns(py: Python<'_>, path: ToolPath) -> PyResult<Bound<'_, PyDict>> {
    let columns = PyDict::new(py);
    let section = |section: &Section| match section {
        Section::LeadIn => 0_u8,
        Section::Cutting => 1,
        Section::LeadOut => 2,
    };
    let sections: Vec<u8> = path.section.iter().map(section).collect();
    columns.set_item("section", PyArray1::from_vec(py, sections))?;
    let named = [
        ("t", path.t),
        ("c", path.c),
        ("x", path.x),
        ("z", path.z),
        ("vc", path.vc),
        ("vx", path.vx),
        ("vz", path.vz),
    ];
    for (name, column) in named {
        columns.set_item(name, PyArray1::from_vec(py, column))?;
    }
    Ok(columns)
}

/// Checks a recipe without making its path: the report.
#[pyfunction]
#[pyo3(signature = (recipe, sources, control, *, threads=0))]
pub fn check(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    control: Control,
    threads: usize,
) -> PyResult<String> {
    let report = work(py, &sources, threads, |catalogue| {
        Job::new(recipe.read()?, catalogue)?.check(&control)
    })?;
    Ok(to_json(&report))
}

/// Measures the tool path in a file: the report.
#[pyfunction]
#[pyo3(signature = (recipe, sources, control, file, *, map=None, threads=0))]
pub fn verify(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    control: Control,
    file: PathBuf,
    map: Option<(PathBuf, usize)>,
    threads: usize,
) -> PyResult<String> {
    let report = work(py, &sources, threads, |catalogue| {
        let request = map.map(|(file, cells)| map_request(file, cells));
        let folder = file.parent().unwrap_or(Path::new("."));
        let request = request.unwrap_or_default();
        turnpath::verify(
            &recipe.read()?,
            catalogue,
            &file,
            &request,
            folder,
            &control,
        )
    })?;
    Ok(to_json(&report))
}

/// Makes the variants of a recipe: report, files, and how many were there already.
#[pyfunction]
#[pyo3(signature = (recipe, sources, control, folder, *, fresh=false, threads=0))]
pub fn ablate(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    control: Control,
    folder: PathBuf,
    fresh: bool,
    threads: usize,
) -> PyResult<AblationAnswer> {
    let result = work(py, &sources, 1, |catalogue| {
        let options = AblationOptions {
            folder,
            fresh,
            threads: NonZero::new(threads),
        };
        turnpath::ablate(&recipe.read()?, catalogue, &options, &control)
    })?;
    Ok((to_json(&result.report), result.files, result.reused))
}

/// The runs of an ablation with their keys, as JSON. Nothing is made.
#[pyfunction]
pub fn plan(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    folder: PathBuf,
) -> PyResult<String> {
    let plan = work(py, &sources, 1, |catalogue| {
        turnpath::plan_ablation(&recipe.read()?, catalogue, &folder)
    })?;
    Ok(to_json(&plan))
}

/// Makes the run of an ablation that has this key, and leaves its record: the run as JSON.
#[pyfunction]
pub fn run_of(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    control: Control,
    folder: PathBuf,
    key: String,
) -> PyResult<String> {
    let run = work(py, &sources, 1, |catalogue| {
        turnpath::run_of_ablation(&recipe.read()?, catalogue, &folder, &key, &control)
    })?;
    Ok(to_json(&run))
}

/// Writes the files of an ablation from the records of its runs: report, files, and how many runs have
/// figures. Nothing is made.
#[pyfunction]
pub fn merge(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    control: Control,
    folder: PathBuf,
) -> PyResult<AblationAnswer> {
    let result = work(py, &sources, 1, |catalogue| {
        turnpath::merge_ablation(&recipe.read()?, catalogue, &folder, &control)
    })?;
    Ok((to_json(&result.report), result.files, result.reused))
}

/// Slot, name and summary of every strategy, and where it comes from.
#[pyfunction]
pub fn strategies(
    py: Python<'_>,
    sources: Sources<'_>,
) -> PyResult<Vec<(String, String, String, String)>> {
    let offered = Offered::read(&sources)?;
    let catalogue = py.detach(|| offered.catalogue());
    let catalogue = catalogue.map_err(|error| exception(py, &error.into()))?;
    let all = catalogue.strategies().map(|strategy| {
        let info = strategy.info();
        let from = strategy.plugin().to_string();
        (
            info.slot.to_string(),
            info.name.to_owned(),
            info.summary.to_owned(),
            from,
        )
    });
    Ok(all.collect())
}

/// The whole command line: its exit status. This is for the whole of a process.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<String>, sources: Sources<'_>) -> PyResult<u8> {
    let offered = Offered::read(&sources)?;
    let status = py.detach(|| turnpath_cli::main_with(arguments, offered.catalogue()));
    let number = (0..=u8::MAX).find(|number| ExitCode::from(*number) == status);
    Ok(number.unwrap_or(u8::MAX))
}
