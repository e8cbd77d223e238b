//! The page of a result that is there already.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use turnpath_files::{Draft, FileError, read_bounded_text};
use turnpath_host::{Catalogue, sha256_hex};
use turnpath_page::{AblationPage, ablation_page};
use turnpath_pipeline::{Observer, Stage};
use turnpath_recipe::Recipe;
use turnpath_report::{AblationReport, RecipeSource, ResultFile, RunReport, from_json};
use turnpath_verify::{FirstTouch, PathSketch, Subject};

use super::of_run::page_of_run;
use super::request::{PageError, PageRequest};
use super::sketch::path_sketch;
use crate::data_files::DataFiles;
use crate::diagnosis::of_measure;
use crate::drawings::{DrawingFileError, Drawings};
use crate::error::Error;
use crate::meters::{PathMeters, measure};
use crate::path_file::SourceFile;
use crate::result_check::read_result;
use crate::strategies;
use crate::subject::{locus_links, subject};
use crate::summary::{ABLATION, MOST_BYTES, PAGE, SUMMARY};

/// Writes the page of a result into its folder, and the figures for papers; gives their paths, the page
/// first. What shows the path is measured on the path's file.
///
/// # Errors
/// When the folder has no result, or its files have other bytes than listed; when the recipe is not
/// known; when the path's file cannot be read; or when the page cannot be written.
pub fn write_page(
    request: &PageRequest,
    catalogue: &Catalogue,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let drawings = Drawings::new(&request.drawings, &request.folder)?;
    let (page, drafts) = match result_recipe(request)? {
        Some(recipe) => {
            let again = page_again((request, &drawings), (&recipe, catalogue), observer);
            again.map_err(|error| without_data_file(request, error))?
        }
        None if drawings.is_empty() => (page_of_ablation(request)?, Vec::new()),
        None => return Err(no_path(request)),
    };
    let path = request.folder.join(PAGE);
    let mut draft = Draft::begin(&path)?;
    let written = draft.write_all(page.as_bytes());
    written.map_err(FileError::of(&path))?;
    let mut paths = Vec::new();
    for draft in std::iter::once(draft).chain(drafts) {
        paths.push(draft.complete()?);
    }
    Ok(paths)
}

/// The recipe of a result, as it was run; `None` for an ablation.
///
/// # Errors
/// When the folder has no result, or the recipe is not known.
pub fn result_recipe(request: &PageRequest) -> Result<Option<Recipe>, Error> {
    if request.has(SUMMARY) {
        let report = read_result(&request.folder)?;
        return recipe_of(request, &report).map(Some);
    }
    match request.has(ABLATION) {
        true => Ok(None),
        false => Err(PageError::NoResult {
            folder: request.folder.clone(),
        }
        .into()),
    }
}

fn page_of_ablation(request: &PageRequest) -> Result<String, Error> {
    let path = request.folder.join(ABLATION);
    let report: io::Result<AblationReport> = read_bounded_text(&path, MOST_BYTES)
        .and_then(|text| from_json(&text).map_err(io::Error::other));
    match report {
        Ok(report) => Ok(ablation_page(&AblationPage { report })),
        Err(source) => Err(Error::Unreadable { path, source }),
    }
}

fn page_again(
    (request, drawings): (&PageRequest, &Drawings),
    (recipe, catalogue): (&Recipe, &Catalogue),
    observer: &dyn Observer,
) -> Result<(String, Vec<Draft>), Error> {
    let report = read_result(&request.folder)?;
    drawings.leave_result(&request.folder, &report)?;
    let files = DataFiles::default();
    let links = locus_links(recipe, catalogue, &files)?;
    let subject = subject(recipe, &links);
    let sketch = match path_file(&request.folder, &report, recipe, &subject)? {
        None => None,
        Some(file) => {
            let velocity = strategies::velocity(recipe, catalogue, &files)?.strategy;
            let shape = file.shape(velocity.segments());
            Some(sketch_of(recipe, &file, shape, subject, observer)?)
        }
    };
    if sketch.is_none() && request.has(PAGE) {
        let folder = request.folder.clone();
        return Err(PageError::NoPath { folder }.into());
    }
    let sketch = sketch.as_ref().map(path_sketch);
    let drafts = match &sketch {
        Some(sketch) => drawings.draw(&report, sketch, &|file| Draft::begin(file))?,
        None if drawings.is_empty() => Vec::new(),
        None => return Err(no_path(request)),
    };
    let made_by = (recipe, catalogue);
    let page = page_of_run(made_by, links.surface.strategy.as_ref(), &report, sketch)?;
    Ok((page, drafts))
}

/// The recipe of a summary has no place, so the message on a data file says how to give it one.
fn without_data_file(request: &PageRequest, error: Error) -> Error {
    match error {
        Error::DataFile { diagnostic, .. } if request.recipe.is_none() => {
            let title = diagnostic.title().to_owned();
            PageError::NoDataFile { title }.into()
        }
        other => other,
    }
}

fn no_path(request: &PageRequest) -> Error {
    let folder = request.folder.clone();
    DrawingFileError::NoPath { folder }.into()
}

fn recipe_of(request: &PageRequest, report: &RunReport) -> Result<Recipe, Error> {
    let source = report.recipe.as_ref().ok_or(PageError::NoRecipe)?;
    let RecipeSource {
        file,
        sha256,
        sets,
        text,
    } = source;
    let recipe = match (&request.recipe, text) {
        (Some(file), _) => Recipe::load(file, sets)?,
        (None, Some(text)) => Recipe::parse(text, request.folder.join(file), sets)?,
        (None, None) => return Err(PageError::NoRecipe.into()),
    };
    if sha256_hex(recipe.text().as_bytes()) != *sha256 {
        return Err(PageError::OtherRecipe {
            recipe: recipe.path().to_owned(),
        }
        .into());
    }
    Ok(recipe)
}

/// The file of the path that can be read: the table, or else a program of the finishing path.
fn path_file(
    folder: &Path,
    report: &RunReport,
    recipe: &Recipe,
    subject: &Subject,
) -> Result<Option<SourceFile>, Error> {
    let files = report.files.iter().flatten();
    let is_table = |file: &&ResultFile| file.file == crate::folder::TOOLPATH;
    let table = files.clone().find(is_table).map(|file| &file.file);
    let programs = report.programs.iter().map(|program| &program.file);
    let name = table.or_else(|| programs.into_iter().next());
    let open = |name| SourceFile::new(&folder.join(name), recipe, subject.compensates_nose);
    name.map(open).transpose()
}

fn sketch_of(
    recipe: &Recipe,
    file: &SourceFile,
    shape: turnpath_core::toolpath::SegmentShape,
    subject: Subject,
    observer: &dyn Observer,
) -> Result<PathSketch, Error> {
    let failed = |error| of_measure(recipe, error);
    let touch = FirstTouch::new(subject).map_err(failed)?;
    let mut reader = file.open()?;
    observer.begin(Stage::Measure, 0);
    let meters = PathMeters::new(recipe, touch);
    let meters = measure(recipe, meters, shape, reader.as_mut(), observer)?;
    meters.cut.sketch().map_err(failed)
}
