//! Any tool path in a file, measured against a recipe's surface, tool and tolerances.
//!
//! Control points do not say what is played between them. The recipe's velocity solver says it:
//! cubics or straight lines. Figures and verdicts come from the file's own rows. Whether these rows are
//! the recipe's is found by making the recipe's path again ([`remake`]).

mod anomalies;
mod remake;
mod whole;

use std::path::{Path, PathBuf};

use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Misfit, RadialRange};
use turnpath_files::Draft;
use turnpath_host::Catalogue;
use turnpath_pipeline::{Observer, Stage};
use turnpath_post::{post_of_extension, text_name};
use turnpath_recipe::{Recipe, RoughPath};
use turnpath_report as report;
use turnpath_report::FileReport;
use turnpath_verify::{AnomalyDetector, CertainMeter, FirstTouch, ServoMeter, Subject, unreached};

use crate::commands::{CommandDifferences, command_differences};
use crate::data_files::DataFiles;
use crate::diagnosis::of_measure;
use crate::error::Error;
use crate::figures::{self, CutFigures, material_threshold};
use crate::folder::rough_toolpath;
use crate::input_files::refuse_as_output;
use crate::meters::{PathMeters, measure};
use crate::plots::{PlayedPath, PlotRequest, Plots, draw, make_folder};
use crate::result_check::result_check;
use crate::strategies;
use crate::subject::{locus_links, subject};

use crate::path_file::SourceFile;
use remake::{Comparison, compare};
use whole::{EndRow, wholeness};

/// Measures the tool path in a file: a `toolpath.csv`, or a program of a post. Plots go
/// to `folder`.
///
/// # Errors
/// When the file cannot be read or has no cut in it, when a plot cannot be drawn, or when the
/// recipe's surface, compensator or solver is not there or fails.
pub fn verify(
    recipe: &Recipe,
    catalogue: &Catalogue,
    file: &Path,
    request: &PlotRequest,
    folder: &Path,
    observer: &dyn Observer,
) -> Result<FileReport, Error> {
    let rough = rough_path_of(recipe, file)?;
    let recipe = rough.as_ref().unwrap_or(recipe);
    let target = Target::new(recipe, catalogue)?;
    let plots = Plots::new(request, &recipe.part, folder)?;
    let read = target.data_files.paths();
    let read = read.iter().map(PathBuf::as_path);
    let read: Vec<&Path> = read.chain([file, recipe.path()]).collect();
    let mut outputs = plots.files();
    outputs.try_for_each(|output| refuse_as_output(output, read.iter().copied()))?;
    plots.leave_results()?;
    plots.try_folder(folder)?;
    let file = SourceFile::new(file, recipe, target.subject.compensates_nose)?;
    target.verify(&file, (&plots, folder), observer)
}

/// The recipe of the rough path that a file has by its name; `None` for any other file.
fn rough_path_of(recipe: &Recipe, file: &Path) -> Result<Option<Recipe>, Error> {
    let paths = recipe.rough_paths().map_err(Error::refused)?;
    let own = file.file_name().unwrap_or_default();
    let is_own = |rough: &&RoughPath| is_of_path(&rough.recipe, &own.to_string_lossy());
    Ok(paths.iter().find(is_own).map(|rough| rough.recipe.clone()))
}

/// Whether a file has the name of a program of a rough path's recipe, or of its table.
fn is_of_path(recipe: &Recipe, file: &str) -> bool {
    let table = recipe.rough_name().map(rough_toolpath);
    let program = text_name(file).strip_prefix(recipe.stem().as_str());
    let extension = program.and_then(|rest| rest.strip_prefix('.'));
    table.is_some_and(|table| table == file)
        || extension.is_some_and(|extension| post_of_extension(extension).is_some())
}

/// What a file is measured against, and how it is played.
struct Target<'a> {
    recipe: &'a Recipe,
    catalogue: &'a Catalogue,
    data_files: DataFiles,
    subject: Subject,
    shape: SegmentShape,
    /// What the compensator's ρ stands for.
    radial: turnpath_core::Radial,
}

impl<'a> Target<'a> {
    fn new(recipe: &'a Recipe, catalogue: &'a Catalogue) -> Result<Self, Error> {
        let files = DataFiles::default();
        let links = locus_links(recipe, catalogue, &files)?;
        let velocity = strategies::velocity(recipe, catalogue, &files)?.strategy;
        Ok(Self {
            recipe,
            catalogue,
            data_files: files,
            subject: subject(recipe, &links),
            shape: velocity.segments(),
            radial: links.compensator.strategy.radial(),
        })
    }

    fn verify(
        &self,
        file: &SourceFile,
        plots: (&Plots, &Path),
        observer: &dyn Observer,
    ) -> Result<FileReport, Error> {
        let recipe = self.recipe;
        let failed = |error| of_measure(recipe, error);
        let mut reader = file.open()?;
        let touch = FirstTouch::new(self.subject.clone()).map_err(failed)?;
        let meters = PathMeters::new(recipe, touch)
            .with_servo(recipe)
            .with_certain(recipe, file.roundings())
            .with_anomalies(recipe);
        observer.begin(Stage::Measure, 0);
        let shape = file.shape(self.shape);
        let meters = measure(recipe, meters, shape, reader.as_mut(), observer)?;
        let (meter, read) = (&meters.cut, reader.read_count());
        let range = meter.reach(self.radial).map_err(failed)?;
        let Some(range) = range.filter(|_| read.cutting_points() >= 2) else {
            let file = file.path.clone();
            return Err(Error::NothingCut { file });
        };
        let machined = meter.machined().map_err(failed)?;
        let figures = meter.figures().map_err(failed)?;
        let lead = meters.lead.figures();
        let certain = meters.certain.as_ref();
        let of_leads = certain.and_then(CertainMeter::leads);
        let lead = lead.map(|lead| figures::lead(lead, None, of_leads, recipe));
        let servo = meters.servo.as_ref().map(ServoMeter::figures);
        let form = meter.form().map_err(failed)?;
        let cut = CutFigures {
            path: &figures,
            machined: machined.as_ref(),
            form: form.as_ref(),
            certain: certain.and_then(CertainMeter::cut),
            servo,
        };
        let path = figures::path(recipe, &cut, lead);
        let played = PlayedPath {
            recipe,
            touch: meter.touch(),
            shape,
            largest_error: figures.playback.max(),
            points: read.points(),
        };
        let anomalies = self.anomalies(file, &played, meters.anomalies, observer)?;
        let (reach, unreached) = (self.reach(range), self.unreached(meter.touch())?);
        let commands = self.command_differences(file)?;
        let report = FileReport {
            format: report::FORMAT,
            name: recipe.name.clone(),
            file: file.path.display().to_string(),
            surface: recipe.surface_name(),
            control_points: read.cutting_points(),
            rows: read.points(),
            within: path.verdict(Some(&reach)),
            reach,
            wholeness: self.wholeness(file, read.last())?,
            spindle_limit: Some(recipe.spindle_speed),
            path,
            files: self.draw(file, plots, &played, observer)?,
            anomalies,
            unreached,
            result: result_check(&file.path, reader.parts(), recipe),
            controller_commands: commands.foreign,
            missing_commands: commands.missing,
        };
        Ok(report.with_verdict())
    }

    /// How what the file tells the controller before its path and behind it differs from the recipe, if it is
    /// a program.
    fn command_differences(&self, file: &SourceFile) -> Result<CommandDifferences, Error> {
        let Some(layout) = file.program else {
            return Ok(CommandDifferences::default());
        };
        let around = layout.around_path(&file.path)?;
        Ok(command_differences(self.recipe, layout.post, &around))
    }

    /// Whether the file's path goes from its beginning to its end, by the file itself.
    fn wholeness(
        &self,
        file: &SourceFile,
        last: Option<&EndRow>,
    ) -> Result<Option<report::Wholeness>, Error> {
        let ends = file.first_row()?.zip(last.copied());
        let digit = file.velocity_digit();
        let shape = file.shape(self.shape);
        Ok(ends.and_then(|ends| wholeness(self.recipe, shape, digit, ends)))
    }

    /// The rows that are not as the recipe gives them; else those that stand out among their
    /// neighbours.
    fn anomalies(
        &self,
        file: &SourceFile,
        played: &PlayedPath<'_>,
        neighbours: Option<AnomalyDetector>,
        observer: &dyn Observer,
    ) -> Result<report::Anomalies, Error> {
        let made_by = (self.recipe, self.catalogue, &self.data_files);
        let compared = compare(made_by, file, played.points, played.touch, observer)?;
        Ok(match compared {
            Comparison::Compared(figures) => anomalies::of_rows(figures),
            Comparison::OtherMaker => {
                let reason = "more than 1 % of them differ, so the file is another maker's";
                anomalies::of_neighbours(neighbours, reason.to_owned())
            }
            Comparison::NotRemade(reason) => anomalies::of_neighbours(neighbours, reason),
        })
    }

    fn reach(&self, range: RadialRange) -> report::Reach {
        let part = self.recipe.part;
        report::Reach {
            path: report::Radii {
                inner: range.inner,
                outer: range.outer,
            },
            of: self.radial.into(),
            part: report::Radii {
                inner: part.inner_radius,
                outer: part.aperture_radius,
            },
        }
    }

    /// What the nose leaves standing; `None` unless the recipe asks for what fits of a nose.
    fn unreached(&self, touch: &FirstTouch) -> Result<Option<report::Unreached>, Error> {
        if !touch.leaves_seams() {
            let allowed = self.recipe.tool.misfit == Misfit::CutWhatFits;
            let asked = allowed && self.subject.compensates_nose;
            return Ok(asked.then(report::Unreached::default));
        }
        let figures = unreached(touch, material_threshold(self.recipe));
        let figures = figures.map_err(|error| of_measure(self.recipe, error))?;
        Ok(Some(figures::unreached(&figures)))
    }

    /// Draws the plots into their folder from a second reading; gives the names of their files.
    fn draw(
        &self,
        file: &SourceFile,
        (plots, folder): (&Plots, &Path),
        played: &PlayedPath<'_>,
        observer: &dyn Observer,
    ) -> Result<Vec<String>, Error> {
        if plots.is_empty() {
            return Ok(Vec::new());
        }
        let mut reader = file.open()?;
        make_folder(folder)?;
        let mut files = Vec::new();
        for draft in draw(
            plots,
            played,
            reader.as_mut(),
            &|file| Draft::begin(file),
            observer,
        )? {
            files.push(draft.complete()?.display().to_string());
        }
        Ok(files)
    }
}
