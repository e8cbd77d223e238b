//! A recipe with its strategies: everything that can be refused is refused when it is made.

use turnpath_core::Tolerance;
use turnpath_core::toolpath::SegmentShape;
use turnpath_host::Catalogue;
use turnpath_pipeline::{
    Chain, LeadLimits, LeadSettings, Outcome, PathOptions, Preparation, prepare,
};
use turnpath_post::ProgramError;
use turnpath_recipe::{DataFormat, Diagnostics, Recipe};
use turnpath_report::Overrun;

use crate::chain::chain;
use crate::data_files::DataFiles;
use crate::diagnosis::{needs_exact_rates, not_carried};
use crate::error::Error;
use crate::figures::form_scope;
use crate::gap::of_preparation;
use crate::named_files::UsedFile;
use crate::posts::NotCarried;
use crate::program::{CarriedPath, Program, programs};
use crate::strategies::{choices, used_files, wrong_choices};

/// A recipe that can be run: its strategies are made, and its tool fits its part.
#[derive(Clone)]
pub struct Job {
    pub(crate) recipe: Recipe,
    pub(crate) catalogue: Catalogue,
    pub(crate) data_files: Vec<UsedFile>,
    pub(crate) chain: Chain,
    /// The surfaces, `surface dish`, that may have other bytes on another machine.
    pub(crate) inexact_surfaces: Vec<String>,
    pub(crate) preparation: Preparation,
    pub(crate) programs: Vec<Program>,
    /// How a tolerance of form is divided for the path, where that is known already.
    pub(crate) split: Option<Tolerance>,
    /// Whether a run keeps what pictures of its path need.
    pub(crate) keeps_sketch: bool,
}

/// Refuses what is wrong with all of the strategies in one go.
fn refuse_wrong_choices(recipe: &Recipe, catalogue: &Catalogue) -> Result<(), Error> {
    let wrong = wrong_choices(choices(recipe), catalogue);
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(Error::refused(wrong.into_iter().collect::<Diagnostics>())),
    }
}

impl Job {
    /// Makes the strategies of a recipe and checks the tool against the part.
    ///
    /// # Errors
    /// When a strategy is not there or refuses its parameters, when a data file cannot be read, when
    /// the tool does not fit, when the surface has no height somewhere, or when a program could not
    /// carry the path.
    pub fn new(recipe: Recipe, catalogue: &Catalogue) -> Result<Self, Error> {
        Self::with_files(recipe, catalogue, &DataFiles::default())
    }

    /// The same with data files that may have been read already.
    pub(crate) fn with_files(
        recipe: Recipe,
        catalogue: &Catalogue,
        files: &DataFiles,
    ) -> Result<Self, Error> {
        recipe.rough_paths().map_err(Error::refused)?;
        refuse_wrong_choices(&recipe, catalogue)?;
        let (chain, inexact_surfaces) = chain(&recipe, catalogue, files)?;
        let data_files = used_files(&recipe, catalogue, files)?;
        refuse_inexact_rates(&recipe, &chain)?;
        let preparation = prepare(&chain.locus_links(), recipe.job_spec())
            .map_err(|error| of_preparation(&recipe, &chain.surface, error))?;
        let programs = programs(&recipe, chain.compensator.strategy.compensates_nose())?;
        let job = Self {
            recipe,
            catalogue: catalogue.clone(),
            data_files,
            chain,
            inexact_surfaces,
            preparation,
            programs,
            split: None,
            keeps_sketch: false,
        };
        job.refuse_formats_left_out()?;
        job.refuse_straight_lines()?;
        Ok(job)
    }

    /// The recipe.
    pub fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// The same job with its path made for these tolerances, and made once: such as those into which
    /// a run has divided a tolerance of form. What the recipe asks for, and what is judged, stays as
    /// it is.
    #[must_use]
    pub fn with_tolerance(&self, tolerance: Tolerance) -> Self {
        let mut job = self.clone();
        job.preparation.task.tolerance = tolerance;
        job.split = Some(tolerance);
        job
    }

    /// What the path is made from. Where programs go straight from point to point, the path's cubics
    /// leave them their share of the tolerance of interpolation.
    pub(crate) fn path_preparation(&self) -> Preparation {
        let programs = self.programs.iter();
        let chords = programs.filter_map(|program| program.layout.format.chords);
        let share = chords.map(|chords| chords.share).fold(0.0, f64::max);
        let mut preparation = self.preparation.clone();
        if !self.plays_straight_lines() {
            preparation.task.tolerance.interpolation *= 1.0 - share;
        }
        preparation
    }

    /// A build may have been made without a format of data files, or without a compression.
    fn refuse_formats_left_out(&self) -> Result<(), Error> {
        if !self.recipe.output.compression.is_built_in() {
            return Err(self.left_out("compress", ".zst"));
        }
        let left_out = |format: &&DataFormat| match format {
            DataFormat::Csv => false,
            DataFormat::Columns(format) => !format.is_built_in(),
        };
        let Some(DataFormat::Columns(format)) = self.recipe.output.data.iter().find(left_out)
        else {
            return Ok(());
        };
        Err(self.left_out("data", &format!(".{}", format.extension())))
    }

    /// The error of a key of `[output]` that asks for files which this build does not write.
    fn left_out(&self, key: &str, files: &str) -> Error {
        let title = format!("this build of turnpath writes no {files}");
        let help = format!("leave it out of `{key}`, or build turnpath with its feature");
        let span = self.recipe.nearest_span(&format!("output.{key}"));
        let diagnostic = self
            .recipe
            .diagnostic(span, title, "asked for here", [help]);
        Error::refused(diagnostic)
    }

    /// Programs that play cubics cannot carry a path of straight lines.
    fn refuse_straight_lines(&self) -> Result<(), Error> {
        let plays_cubics =
            |program: &&Program| program.layout.format.shape() == SegmentShape::Cubic;
        match self.programs.iter().find(plays_cubics) {
            Some(program) if self.plays_straight_lines() => {
                let (post, error) = (program.layout.post.name, ProgramError::Straight);
                Err(not_carried(&self.recipe, NotCarried { post, error }))
            }
            _ => Ok(()),
        }
    }

    /// The steps of time in a second on which control points lie: the coarsest steps of the programs.
    /// A program with finer ones moves a point along the path by half a fine step at the most.
    fn time_steps(&self) -> Option<f64> {
        let steps = self.programs.iter().map(|program| &program.layout.format);
        let coarsest = steps.map(|format| format.steps_per_s).min();
        coarsest.map(|steps| steps as f64)
    }

    /// What is played between control points.
    pub(crate) fn shape(&self) -> SegmentShape {
        self.chain.velocity.strategy.segments()
    }

    /// The path that it has made, for its programs.
    pub(crate) fn carried_path(&self, outcome: &Outcome) -> CarriedPath {
        let playback = &outcome.figures.playback;
        CarriedPath {
            error: playback.max(),
            longest_time: playback.longest_time,
            shape: self.shape(),
            residual: self.preparation.task.tolerance.residual,
        }
    }

    pub(crate) fn plays_straight_lines(&self) -> bool {
        self.shape() == SegmentShape::Linear
    }

    /// Whether the path is that of the nose centre.
    pub(crate) fn compensates_nose(&self) -> bool {
        self.chain.compensator.strategy.compensates_nose()
    }

    /// How the path is made.
    pub(crate) fn options(&self) -> PathOptions {
        let recipe = &self.recipe;
        PathOptions {
            refine: recipe.refine,
            time_steps: self.time_steps(),
            lead: recipe.lead.then(|| LeadSettings {
                clearance: recipe.clearance,
                limits: LeadLimits::within(recipe.machine),
            }),
            form: form_scope(recipe),
            servo: recipe.servo,
            sketch: self.keeps_sketch,
            covers_centre: Overrun::from(recipe.overrun).covers_centre(),
        }
    }
}

/// A sampler that relies on the exact rates of the path needs a solver that gives them.
fn refuse_inexact_rates(recipe: &Recipe, chain: &Chain) -> Result<(), Error> {
    let needs = chain.sampler.strategy.needs_exact_rates();
    match needs && !chain.velocity.strategy.gives_exact_rates() {
        true => Err(needs_exact_rates(recipe)),
        false => Ok(()),
    }
}
