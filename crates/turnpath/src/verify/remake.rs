//! The path of a recipe made again, and the rows of a file compared with it.
//!
//! The pipeline makes the path as a run does, and gives it to a sink block by block. The sink reads
//! as many rows of the file, so neither path is ever whole in memory. No figure and no verdict asks
//! the path that is made here.

use std::path::Path;

use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_core::{FormBudget, StrategyError, Tolerance};
use turnpath_host::{Catalogue, sha256_hex};
use turnpath_pipeline::{Observer, PipelineError, RunError, Sink, Stage, make_unmeasured};
use turnpath_post::{CarriedPoints, Layout, ProgramError, ReadError, ReadPath};
use turnpath_recipe::Recipe;
use turnpath_verify::{ComparisonFigures, FirstTouch, PathRow, RowComparison};

use crate::data_files::DataFiles;
use crate::diagnosis::{not_carried, of_measure, of_pipeline};
use crate::error::Error;
use crate::form::FARTHEST_SUM;
use crate::job::Job;
use crate::outputs::Outputs;
use crate::posts::NotCarried;
use crate::summary::{FolderSummary, folder_of};

use crate::path_file::SourceFile;

/// How far shares in a summary may lie from those of their sum, as a part of themselves: they have
/// the digits of a file.
const LARGEST_ROUNDING: f64 = 1e-9;

/// What came of comparing a file with the path of its recipe.
pub enum Comparison {
    /// The rows that differ.
    Compared(ComparisonFigures),
    /// More rows differ than in a spoiled file.
    OtherMaker,
    /// The recipe's path could not be made: why.
    NotRemade(String),
}

/// Makes the path of a recipe again and compares the rows of `file` with it. `rows` is how many it
/// has.
///
/// # Errors
/// When the file can no longer be read, or when the observer cancels.
pub fn compare(
    (recipe, catalogue, files): (&Recipe, &Catalogue, &DataFiles),
    file: &SourceFile,
    rows: u64,
    touch: &FirstTouch,
    observer: &dyn Observer,
) -> Result<Comparison, Error> {
    let compared = remake(recipe, catalogue, files).and_then(|job| {
        let job = with_split(job, &file.path, &RemakeObserver(observer))?;
        let shape = file.shape(job.shape());
        let comparison = RowComparison::new(touch.clone(), shape, file.half_digits());
        let mut sink = ComparisonSink {
            reader: file.open()?,
            file,
            rows,
            turns: None,
            comparison: match file.has_distances() {
                true => comparison.of_distances(),
                false => comparison,
            },
        };
        let made = make_unmeasured(
            &job.chain,
            &job.path_preparation(),
            job.options(),
            &mut sink,
            &RemakeObserver(observer),
        );
        match made.map_err(Stop::from).and_then(|()| sink.finish()) {
            Ok(()) => Ok(Comparison::Compared(sink.comparison.into_figures())),
            Err(Stop::OtherMaker) => Ok(Comparison::OtherMaker),
            Err(stop) => Err(stop.into_error(recipe)),
        }
    });
    match compared {
        Err(Error::Cancelled) => Err(Error::Cancelled),
        Err(Error::Read(error)) => Err(error.into()),
        Err(error) => Ok(Comparison::NotRemade(error.title())),
        Ok(compared) => Ok(compared),
    }
}

/// The job whose path is made again.
fn remake(recipe: &Recipe, catalogue: &Catalogue, files: &DataFiles) -> Result<Job, Error> {
    Job::with_files(recipe.clone(), catalogue, files)
}

/// The job for the split of its tolerance of form, if it has one: the split of the summary beside
/// the file, or else the one that a run finds.
fn with_split(job: Job, file: &Path, observer: &dyn Observer) -> Result<Job, Error> {
    if job.recipe.tolerances.form.is_none() {
        return Ok(job);
    }
    let split = match split_beside(&job.recipe, file) {
        Some(split) => split,
        None => found_split(&job, observer)?,
    };
    Ok(job.with_tolerance(split))
}

/// The split in the summary beside a file, if the summary is that of this recipe with these changes,
/// and if it says a split that a run may find.
fn split_beside(recipe: &Recipe, file: &Path) -> Option<Tolerance> {
    // The summary has the split of the finishing path, and none of the others'.
    if recipe.rough_name().is_some() {
        return None;
    }
    // The file may be spoiled; the split is then still that of the path that it was.
    let FolderSummary::Read(summary) = FolderSummary::of(&folder_of(file)) else {
        return None;
    };
    let source = summary.recipe.as_ref()?;
    let is_own =
        source.sha256 == sha256_hex(recipe.text().as_bytes()) && source.sets == recipe.sets();
    let split = summary.path.form?.split.filter(|_| is_own)?;
    let tolerance = split.tolerance();
    let budget = recipe.tolerances.budget()?;
    may_be_found(&budget, tolerance).then_some(tolerance)
}

/// Whether a search may end with these shares. Far finer ones would make a path of any length.
fn may_be_found(budget: &FormBudget, tolerance: Tolerance) -> bool {
    let sum = tolerance.residual + 2.0 * tolerance.interpolation;
    let furthest = sum / budget.form();
    let shares = budget.shares(sum);
    let is_near = |found: f64, share: f64| (found - share).abs() <= LARGEST_ROUNDING * share;
    (1.0 / FARTHEST_SUM..=FARTHEST_SUM).contains(&furthest)
        && is_near(tolerance.residual, shares.residual)
        && is_near(tolerance.interpolation, shares.interpolation)
}

/// The split that a run finds.
fn found_split(job: &Job, observer: &dyn Observer) -> Result<Tolerance, Error> {
    let report = job.run(Outputs::nowhere(), observer)?.report;
    let split = report.path.form.and_then(|form| form.split);
    Ok(split.map_or(job.recipe.tolerance, |split| split.tolerance()))
}

/// Why a comparison ended before the paths did.
enum Stop {
    /// The file is another maker's.
    OtherMaker,
    /// The file could not be read.
    Read(ReadError),
    /// A program could not carry the path.
    Program(NotCarried),
    /// The surface failed where a row differs.
    Measure(StrategyError),
    /// There is no path.
    Pipeline(PipelineError),
}

impl Stop {
    fn into_error(self, recipe: &Recipe) -> Error {
        match self {
            Self::OtherMaker | Self::Pipeline(PipelineError::Cancelled) => Error::Cancelled,
            Self::Read(error) => error.into(),
            Self::Program(error) => not_carried(recipe, error),
            Self::Measure(error) => of_measure(recipe, error),
            Self::Pipeline(error) => of_pipeline(recipe, error),
        }
    }
}

impl From<RunError<Self>> for Stop {
    fn from(error: RunError<Self>) -> Self {
        match error {
            RunError::Pipeline(error) => Self::Pipeline(error),
            RunError::Sink(stop) => stop,
        }
    }
}

impl From<StrategyError> for Stop {
    fn from(error: StrategyError) -> Self {
        Self::Measure(error)
    }
}

/// Compares the path with a file while the path is made.
struct ComparisonSink<'a> {
    file: &'a SourceFile,
    reader: Box<dyn ReadPath + Send + Sync>,
    rows: u64,
    /// C that the file leaves out before its first row, rad; `None` before the path's first point.
    turns: Option<f64>,
    comparison: RowComparison,
}

impl ComparisonSink<'_> {
    /// Ends both paths.
    fn finish(&mut self) -> Result<(), Stop> {
        let reader = &mut self.reader;
        self.comparison.finish(&mut || next_row(reader.as_mut()))?;
        self.stop_at_other_maker()
    }

    fn stop_at_other_maker(&self) -> Result<(), Stop> {
        match self.comparison.is_of_other_maker(self.rows) {
            true => Err(Stop::OtherMaker),
            false => Ok(()),
        }
    }

    /// Whole turns that a program leaves out at its beginning.
    fn turns_before(&self, points: &PathBlock) -> Result<f64, Stop> {
        match self.file.program.zip(points.get(0)) {
            Some((layout, first)) => {
                let turns = layout.turns_left_out(&first);
                turns.map_err(|error| not_carried_by(&layout, error))
            }
            None => Ok(0.0),
        }
    }
}

fn not_carried_by(layout: &Layout, error: ProgramError) -> Stop {
    let post = layout.post.name;
    Stop::Program(NotCarried { post, error })
}

/// The file's next row.
fn next_row(reader: &mut dyn ReadPath) -> Result<Option<PathRow>, Stop> {
    let row = reader.next_point().map_err(Stop::Read)?;
    Ok(row.map(|(point, section)| PathRow { point, section }))
}

impl Sink for ComparisonSink<'_> {
    type Block = (Section, CarriedPoints);
    type Error = Stop;

    /// The points in the digits of the file.
    fn encode(&self, block: &SectionBlock<'_>) -> Result<Self::Block, Stop> {
        let points = match self.file.program {
            Some(layout) => {
                let carried = layout.carried(block);
                carried.map_err(|error| not_carried_by(&layout, error))?
            }
            None => CarriedPoints {
                points: block.points.clone(),
                of_section_before: 0,
            },
        };
        Ok((block.section, points))
    }

    fn take(&mut self, _: usize, (section, carried): Self::Block) -> Result<(), Stop> {
        let points = carried.points;
        let turns = match self.turns {
            Some(turns) => turns,
            None => self.turns_before(&points)?,
        };
        self.turns = Some(turns);
        for (mut point, k) in points.points().zip(0..) {
            point.c -= turns;
            let section = match k < carried.of_section_before {
                true => Section::LeadIn,
                false => section,
            };
            let (row, reader) = (PathRow { point, section }, &mut self.reader);
            self.comparison
                .push(row, &mut || next_row(reader.as_mut()))?;
        }
        self.stop_at_other_maker()
    }
}

/// Tells of the making of a path that nobody measures or writes.
struct RemakeObserver<'a>(&'a dyn Observer);

impl Observer for RemakeObserver<'_> {
    fn begin(&self, stage: Stage, blocks: u64) {
        let stage = match stage {
            Stage::Write => Stage::Compare,
            other => other,
        };
        self.0.begin(stage, blocks);
    }

    fn advance(&self, blocks: u64) {
        self.0.advance(blocks);
    }

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_split_that_no_search_finds_is_not_believed() {
        let split = |residual, interpolation| Tolerance {
            residual,
            interpolation,
        };
        let form = 1.5e-4;
        let budget = FormBudget::new(form, None, None);
        for sum in [form, 0.3 * form, 2.5 * form] {
            let Tolerance {
                residual,
                interpolation,
            } = budget.shares(sum);
            let found = split(residual, interpolation);
            assert!(may_be_found(&budget, found), "{sum}");
            // Another division of the same form.
            let other = split(1.01 * residual, interpolation);
            assert!(!may_be_found(&budget, other), "{sum}");
        }
        let Tolerance {
            residual,
            interpolation,
        } = budget.first();
        let bounded = FormBudget::new(form, None, Some(0.5 * residual));
        assert!(!may_be_found(&bounded, split(residual, interpolation)));
        for wrong in [0.0, -1e-5, f64::NAN, f64::INFINITY, 1e-12, 1e300] {
            assert!(!may_be_found(&budget, split(wrong, wrong)), "{wrong}");
            assert!(!may_be_found(&budget, split(residual, wrong)), "{wrong}");
            assert!(
                !may_be_found(&budget, split(wrong, interpolation)),
                "{wrong}"
            );
        }
    }
}
