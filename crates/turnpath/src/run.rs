//! A run: the path made, measured, put where it is wanted, and reported.

use std::path::{Path, PathBuf};

use turnpath_core::{Misfit, Slot};
use turnpath_files::{Draft, ResultFolder};
use turnpath_host::sha256_hex;
use turnpath_pipeline::{DraftSink, Observer, Outcome, run as run_pipeline};
use turnpath_report as report;
use turnpath_report::{FormSplit, PathSketch, ProgramReport, RunReport};
use turnpath_verify::unreached;

use crate::axis_notes::feed_direction;
use crate::commands::controller_commands;
use crate::diagnosis::{not_carried, of_measure};
use crate::drawings::{DrawingFileError, Drawings};
use crate::error::Error;
use crate::figures::{self, CutFigures, material_threshold};
use crate::folder::{FolderSink, WholeResult, open_folder, result_files};
use crate::form::{FormPath, search_split};
use crate::input_files::refuse_as_output;
use crate::job::Job;
use crate::memory::MemorySink;
use crate::named_files::UsedFile;
use crate::outputs::{Destination, Outputs};
use crate::page::{page_of_run, path_sketch};
use crate::plots::{PlotError, PlotRequest, Plots};
use crate::plugins::used;
use crate::program::ProgramText;
use crate::remarks::{PathSubject, shortest_segments};
use crate::rough_paths::{RoughJob, can_be_in_result};
use crate::sinks::{RowCount, SinkError, of_run};
use crate::toolpath::ToolPath;

/// What a run gave.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// The figures and the verdict.
    pub report: RunReport,
    /// The files that were written, the summary last; empty without a folder.
    pub files: Vec<PathBuf>,
    /// The path, where it was asked for in memory.
    pub toolpath: Option<ToolPath>,
    /// The programs by their file names, where they were asked for in memory.
    pub programs: Vec<(String, Vec<u8>)>,
}

/// What a folder gets beside the path and its programs.
struct BesidePath {
    plots: Plots,
    drawings: Drawings,
    dry_run: bool,
    page: bool,
}

impl RunResult {
    fn of(report: RunReport) -> Self {
        Self {
            report,
            files: Vec::new(),
            toolpath: None,
            programs: Vec::new(),
        }
    }
}

impl Job {
    /// Makes the path, measures it, and puts it where `outputs` says. A program is read back and
    /// measured on its own text.
    ///
    /// # Errors
    /// When a plot cannot be drawn so, when a strategy fails, when a file cannot be written, or when
    /// the observer cancels. The folder then has the files that it had, and no new folder is left
    /// behind. Only where a whole result cannot give a file its name, the next run does it.
    pub fn run(&self, outputs: Outputs, observer: &dyn Observer) -> Result<RunResult, Error> {
        let has_folder = matches!(outputs.destination, Destination::Folder(_));
        if !has_folder && outputs.plots != PlotRequest::default() {
            return Err(PlotError::NoFolder.into());
        }
        if !has_folder && !outputs.drawings.is_empty() {
            return Err(DrawingFileError::NoFolder.into());
        }
        // The report needs them. What cannot be hashed shall not fail a run at its end.
        for plugin in used(&self.recipe, &self.catalogue) {
            plugin.sha256()?;
        }
        match &outputs.destination {
            Destination::Nowhere => self.run_nowhere(observer),
            Destination::Memory => self.run_in_memory(observer),
            Destination::Folder(folder) => {
                let beside = BesidePath {
                    plots: Plots::new(&outputs.plots, &self.recipe.part, folder)?,
                    drawings: Drawings::new(&outputs.drawings, folder)?,
                    dry_run: outputs.dry_run,
                    page: outputs.page,
                };
                let job = Job {
                    keeps_sketch: beside.page || !beside.drawings.is_empty(),
                    ..self.clone()
                };
                job.run_in_folder(folder, &beside, observer)
            }
        }
    }

    /// The path into a sink.
    pub(crate) fn run_into<S>(
        &self,
        sink: &mut S,
        observer: &dyn Observer,
    ) -> Result<Outcome, Error>
    where
        S: DraftSink,
        S::Error: Into<SinkError>,
    {
        let outcome = run_pipeline(
            &self.chain,
            &self.path_preparation(),
            self.options(),
            sink,
            observer,
        );
        outcome.map_err(|error| of_run(&self.recipe, error))
    }

    fn run_nowhere(&self, observer: &dyn Observer) -> Result<RunResult, Error> {
        let path = search_split(self, observer, |job| {
            let mut sink = RowCount::default();
            let outcome = job.run_into(&mut sink, observer)?;
            Ok((sink, outcome))
        })?;
        let report = self.report(path.sink.rows, &path.outcome, path.split, Vec::new())?;
        Ok(RunResult::of(self.with_recipe(report)))
    }

    fn run_in_memory(&self, observer: &dyn Observer) -> Result<RunResult, Error> {
        let path = search_split(self, observer, |job| {
            let mut sink = MemorySink::new(&self.programs);
            let outcome = job.run_into(&mut sink, observer)?;
            Ok((sink, outcome))
        })?;
        let FormPath {
            sink,
            outcome,
            split,
        } = path;
        let rows = sink.toolpath.len() as u64;
        let (mut reports, mut programs) = (Vec::new(), Vec::new());
        for (program, writer) in self.programs.iter().zip(sink.writers) {
            let path = writer.close();
            let (points, name) = (path.points(), Path::new(&program.file));
            let mut reader = program.layout.read(path.text(), name);
            let text = ProgramText {
                reader: &mut reader,
                name,
                points,
            };
            let touch = self.preparation.touch.clone();
            let carried = self.carried_path(&outcome);
            let report = program.measure(text, (&self.recipe, touch), carried, observer)?;
            drop(reader);
            let frame = program.frame(&self.recipe, &outcome, points, &report);
            let size = path.size(&frame.header, &frame.footer);
            let failed = |error| not_carried(&self.recipe, error);
            program.refuse_large(size).map_err(failed)?;
            let around = [frame.header.as_str(), &frame.footer];
            match program.limits_of(size) {
                None => {
                    let bytes = path.assemble(around, &program.file)?;
                    programs.push((program.file.clone(), bytes));
                }
                Some(limits) => {
                    let files = path.assemble_parts(around, (&program.file, limits));
                    let files = files.map_err(|error| program.not_divided(&self.recipe, error))?;
                    let mut whole = program.layout.read_files(files.clone())?;
                    program.read_whole(&mut whole, name, points)?;
                    programs.extend(files);
                }
            }
            reports.push(report);
        }
        Ok(RunResult {
            toolpath: Some(sink.toolpath),
            programs,
            ..RunResult::of(self.with_recipe(self.report(rows, &outcome, split, reports)?))
        })
    }

    fn run_in_folder(
        &self,
        folder: &Path,
        beside: &BesidePath,
        observer: &dyn Observer,
    ) -> Result<RunResult, Error> {
        let dry_run = beside.dry_run;
        self.refuse_outputs(folder, beside)?;
        let rough_paths = self.rough_jobs()?;
        let result = self.take_folder(folder, &rough_paths, beside)?;
        let (mut of_rough, mut files) = (Vec::new(), Vec::new());
        for rough in &rough_paths {
            let (report, whole) = rough.run(&result, dry_run, observer)?;
            of_rough.push(report);
            files.extend(whole);
        }
        let path = search_split(self, observer, |job| {
            let mut sink = FolderSink::new(&result, self);
            let outcome = job.run_into(&mut sink, observer)?;
            Ok((sink, outcome))
        })?;
        let FormPath {
            mut sink,
            outcome,
            split,
        } = path;
        sink.plot(self, &beside.plots, &outcome, observer)?;
        let reports = sink.read_back(self, &outcome, dry_run, observer)?;
        let report = self.with_recipe(self.report(sink.rows(), &outcome, split, reports)?);
        files.extend(sink.finish()?);
        let sketch = outcome.sketch.as_ref().map(path_sketch);
        if let Some(sketch) = &sketch {
            let begin = |file: &Path| result.draft(file);
            let drawn = beside.drawings.draw(&report, sketch, &begin)?;
            let drawn = drawn.into_iter().map(Draft::finish);
            files.extend(drawn.collect::<Result<Vec<_>, _>>()?);
        }
        let whole = WholeResult::new(files, result);
        let report = RunReport {
            files: Some(whole.listed()),
            rough_paths: of_rough,
            ..report
        };
        let report = report.with_verdict();
        let page = beside.page.then(|| self.page(&report, sketch));
        let page = page.transpose()?;
        let files = whole.commit(&report::to_json(&report), page.as_deref())?;
        Ok(RunResult {
            files,
            ..RunResult::of(report)
        })
    }

    /// Refuses what is asked for beside the path and cannot be made.
    fn refuse_outputs(&self, folder: &Path, beside: &BesidePath) -> Result<(), Error> {
        beside.plots.need_toolpath(&self.recipe)?;
        if beside.dry_run && self.programs.is_empty() {
            return Err(Error::NoProgram);
        }
        beside.plots.can_be_in_result(folder)?;
        beside.drawings.can_be_in_result(folder)?;
        Ok(())
    }

    /// Takes the folder for a result, once it is sure that no output replaces what the run reads.
    fn take_folder(
        &self,
        folder: &Path,
        rough_paths: &[RoughJob],
        beside: &BesidePath,
    ) -> Result<ResultFolder, Error> {
        let (plots, dry_run) = (&beside.plots, beside.dry_run);
        can_be_in_result(folder, rough_paths, dry_run)?;
        let names = rough_paths.iter().flat_map(|rough| rough.files(dry_run));
        let names = names.chain(result_files(self, dry_run));
        let pictures = plots.files().chain(beside.drawings.files());
        let mut outputs = names
            .map(|name| folder.join(name))
            .chain(pictures.map(Path::to_owned));
        let of_rough = rough_paths.iter().flat_map(RoughJob::inputs);
        let inputs: Vec<PathBuf> = self.inputs().into_iter().chain(of_rough).collect();
        outputs.try_for_each(|output| {
            refuse_as_output(&output, inputs.iter().map(PathBuf::as_path))
        })?;
        let mut result = open_folder(folder, self, dry_run)?;
        // What the run reads stays, though a result before it may list it.
        let behind_links = inputs.iter().filter_map(|input| input.canonicalize().ok());
        for input in behind_links.chain(inputs.iter().cloned()) {
            if let Some(name) = ResultFolder::member(folder, &input) {
                result.keeps(name);
            }
        }
        Ok(result)
    }

    /// The page of the run.
    fn page(&self, report: &RunReport, sketch: Option<PathSketch>) -> Result<String, Error> {
        let surface = &self.chain.surface;
        let made_by = (&self.recipe, &self.catalogue);
        page_of_run(made_by, surface.strategy.as_ref(), report, sketch)
    }

    /// What a path gave; `split` is how a tolerance of form was divided for it.
    pub(crate) fn report(
        &self,
        rows: u64,
        outcome: &Outcome,
        split: Option<FormSplit>,
        programs: Vec<ProgramReport>,
    ) -> Result<RunReport, Error> {
        let recipe = &self.recipe;
        let leads = outcome.lead.as_ref();
        let lead = leads
            .map(|leads| figures::lead(&leads.figures, Some(leads), Some(&leads.certain), recipe));
        let cut = CutFigures {
            certain: outcome.certain.as_ref(),
            path: &outcome.figures,
            machined: outcome.machined.as_ref(),
            form: outcome.form.as_ref(),
            servo: outcome.servo.as_ref(),
        };
        let mut path = figures::path(recipe, &cut, lead);
        let made_for = split.as_ref().map(FormSplit::tolerance);
        let subject = PathSubject {
            tolerance: made_for.unwrap_or(self.preparation.task.tolerance),
            cutting_time: outcome.cutting_time,
            lead_time: leads.map_or(0.0, |leads| leads.in_time + leads.out_time),
            revolutions: outcome.revolutions,
            control_points: outcome.control_points as f64,
            z_acceleration: Some(path.axes.z.acceleration.max),
        };
        let on_data = self.data_remarks(subject.tolerance.interpolation)?;
        let mut remarks = self.remarks(&subject, on_data);
        if recipe.refine {
            remarks.extend(shortest_segments(
                &subject.tolerance,
                &outcome.figures.playback,
            ));
        }
        if let Some(form) = &mut path.form {
            form.split = split;
        }
        let segments = rows.saturating_sub(1);
        let beside_path = |program: ProgramReport| program.beside_path(segments);
        let report = RunReport {
            format: report::FORMAT,
            turnpath: env!("CARGO_PKG_VERSION").to_owned(),
            name: recipe.name.clone(),
            chain: chain_names(recipe),
            direction: feed_direction(recipe),
            refine: recipe.refine,
            control_points: outcome.control_points,
            rows,
            points_added_by_refine: outcome.added_by_refine,
            revolutions: outcome.revolutions,
            cutting_time: outcome.cutting_time,
            feed_cap: figures::feed_cap(outcome.feed_cap.as_ref()),
            remarks,
            within: path.verdict(None),
            path,
            axes_of_law: outcome.own_axes.as_ref().map(figures::axes),
            unreached: self.unreached()?,
            programs: programs.into_iter().map(beside_path).collect(),
            rough_paths: Vec::new(),
            controller_commands: controller_commands(&self.recipe),
            plugins: self.plugin_sources()?,
            data_files: self.data_sources(),
            recipe: None,
            files: None,
        };
        Ok(report.with_verdict())
    }

    /// The report of a run, which says what was run. A run of an ablation is known by its key.
    fn with_recipe(&self, report: RunReport) -> RunReport {
        let file = self.recipe.path().file_name().unwrap_or_default();
        let recipe = report::RecipeSource {
            file: file.to_string_lossy().into_owned(),
            sha256: sha256_hex(self.recipe.text().as_bytes()),
            sets: self.recipe.sets().to_vec(),
            text: Some(self.recipe.text().to_owned()),
        };
        RunReport {
            recipe: Some(recipe),
            ..report
        }
    }

    /// What the nose leaves standing; `None` unless the recipe asks for what fits of a nose.
    pub(crate) fn unreached(&self) -> Result<Option<report::Unreached>, Error> {
        let touch = &self.preparation.touch;
        if !touch.leaves_seams() {
            let asked = self.recipe.tool.misfit == Misfit::CutWhatFits && self.compensates_nose();
            return Ok(asked.then(report::Unreached::default));
        }
        let figures = unreached(touch, material_threshold(&self.recipe));
        let figures = figures.map_err(|error| of_measure(&self.recipe, error))?;
        Ok(Some(figures::unreached(&figures)))
    }

    fn plugin_sources(&self) -> Result<Vec<report::PluginSource>, Error> {
        let sources = used(&self.recipe, &self.catalogue).into_iter();
        let source = sources.map(|plugin| {
            Ok(report::PluginSource {
                name: plugin.name.clone(),
                version: plugin.version.clone(),
                file: match &plugin.file {
                    Some(file) => Some(file.display().to_string()),
                    None => plugin.source.clone(),
                },
                sha256: plugin.sha256()?.map(str::to_owned),
            })
        });
        source.collect()
    }

    fn data_sources(&self) -> Vec<report::DataSource> {
        let source = |file: &UsedFile| report::DataSource {
            slot: file.table.clone(),
            param: file.param.to_owned(),
            file: file.path.clone(),
            bytes: file.contents.bytes.len() as u64,
            sha256: file.contents.sha256.clone(),
        };
        self.data_files.iter().map(source).collect()
    }
}

/// The names of the strategies that a recipe chooses.
pub(crate) fn chain_names(recipe: &turnpath_recipe::Recipe) -> report::ChainNames {
    let name = |slot| recipe.choice(slot).name().to_owned();
    report::ChainNames {
        surface: recipe.surface_name(),
        feed: name(Slot::Feed),
        sampler: name(Slot::Sampler),
        compensator: name(Slot::Compensator),
        velocity: name(Slot::Velocity),
        spindle: name(Slot::Spindle),
    }
}
