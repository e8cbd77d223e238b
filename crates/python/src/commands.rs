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
    Section, ToolPath,
};

use turnpath_core::Overrun;

use crate::catalogue::{Sources, catalogue};
use crate::failure::exception;
use crate::observer::Control;

/// The share of the interpolation tolerance that the error of a surface may take before it counts.
const SHARE: f64 = 0.05;

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
/// Report, files, how many runs had a record, and why runs failed by their rows.
type AblationAnswer = (String, Vec<PathBuf>, usize, Vec<(usize, String)>);

/// Does the work of a command on threads of its own, without the interpreter's lock.
fn work<R: Send>(
    py: Python<'_>,
    sources: &Sources<'_>,
    threads: usize,
    work: impl FnOnce(&Catalogue) -> Result<R, Error> + Send,
) -> PyResult<R> {
    let catalogue = catalogue(sources)?;
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let done = py.detach(move || {
        let catalogue = catalogue.map_err(Error::from)?;
        pool.install(|| work(&catalogue))
    });
    done.map_err(|error| exception(py, &error))
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
#[pyo3(signature = (recipe, sources, *, threads=0))]
pub fn check(
    py: Python<'_>,
    recipe: RecipeText,
    sources: Sources<'_>,
    threads: usize,
) -> PyResult<String> {
    let report = work(py, &sources, threads, |catalogue| {
        Job::new(recipe.read()?, catalogue)?.check()
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

/// Makes the variants of a recipe: report, files, how many were there already, and why runs failed.
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
    let failures = result.failures.iter();
    let failures = failures.map(|(row, error)| (*row, error.title()));
    let json = to_json(&result.report);
    Ok((json, result.files, result.reused, failures.collect()))
}

/// Half the side of the square in which a path may meet its surface, and the error of a surface that
/// does not count beside the interpolation tolerance, both in mm; `None` for a recipe that is wrong,
/// which the command itself will say.
#[pyfunction]
pub fn reach(recipe: RecipeText) -> Option<(f64, f64)> {
    let recipe = recipe.read().ok()?;
    let part = recipe.part.aperture_radius + recipe.tool.nose_radius;
    let overrun = match recipe.overrun {
        Overrun::Length(length) => length,
        Overrun::Contact | Overrun::None => 0.0,
    };
    let places = recipe.surfaces.iter().map(|entry| {
        let place = &entry.placement;
        place.decentre_x.hypot(place.decentre_y)
    });
    let away = places.fold(0.0, f64::max) + recipe.pose.map_or(0.0, |pose| pose.x.hypot(pose.y));
    let tolerance = recipe.tolerance.interpolation;
    Some((part + overrun + away, SHARE * tolerance))
}

/// Slot, name and summary of every strategy, and where it comes from.
#[pyfunction]
pub fn strategies(
    py: Python<'_>,
    sources: Sources<'_>,
) -> PyResult<Vec<(String, String, String, String)>> {
    let catalogue = catalogue(&sources)?.map_err(|error| exception(py, &error.into()))?;
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
    let catalogue = catalogue(&sources)?;
    let status = py.detach(|| turnpath_cli::main_with(arguments, catalogue));
    let number = (0..=u8::MAX).find(|number| ExitCode::from(*number) == status);
    Ok(number.unwrap_or(u8::MAX))
}
