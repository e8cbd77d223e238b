//! A recipe made ready: its chain, and the job with a tool that fits.

use turnpath_core::interference::Conflict;
use turnpath_core::{Misfit, Overrun, Slot, SpindleLaw, StrategyError};
use turnpath_host::Catalogue;
use turnpath_pipeline::{Chain, PipelineError, Prepared, Wanted, prepare};
use turnpath_recipe::{Diagnostic, Recipe};

use crate::args::{RecipeArgs, WorkArgs};
use crate::failure::{Failure, with_sources};
use crate::figures::{millimetres, nose_radius};
use crate::programs::not_carried;
use crate::strategies;

/// A recipe with its strategies.
pub struct Job {
    /// What the user wrote.
    pub recipe: Recipe,
    /// What there is to choose from.
    pub catalogue: Catalogue,
    /// What was chosen.
    pub chain: Chain,
    /// The job, with a tool that fits.
    pub prepared: Prepared,
}

impl Job {
    /// Reads the recipe, makes its strategies, checks tool against part.
    pub fn ready(args: &RecipeArgs, work: &WorkArgs) -> Result<Self, Failure> {
        use_threads(work);
        let recipe = Recipe::load(&args.recipe, &args.set)?;
        let catalogue = strategies::catalogue_for(&recipe, args)?;
        Self::of(recipe, catalogue)
    }

    /// Makes the strategies of a recipe, checks tool against part.
    pub fn of(recipe: Recipe, catalogue: Catalogue) -> Result<Self, Failure> {
        let chain = strategies::chain(&recipe, &catalogue)?;
        let wanted = Wanted {
            part: recipe.part,
            tool: recipe.tool,
            tolerance: recipe.tolerance,
            overrun: recipe.overrun,
            direction: recipe.direction,
            spindle: SpindleLaw::constant(recipe.spindle_speed),
            machine: recipe.machine,
        };
        let prepared = prepare(&chain, wanted).map_err(|error| of_pipeline(&recipe, error))?;
        Ok(Self {
            recipe,
            catalogue,
            chain,
            prepared,
        })
    }

    /// Whether the path is that of the nose centre.
    pub fn compensates_nose(&self) -> bool {
        self.chain.compensator.strategy.compensates_nose()
    }
}

/// Sets how many threads work; fails only when they are set already, which changes no result.
pub fn use_threads(work: &WorkArgs) {
    let threads = work.threads.map_or(0, usize::from);
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global();
}

/// An error of the pipeline, at its place in the recipe.
pub fn of_pipeline(recipe: &Recipe, error: PipelineError) -> Failure {
    let title = error.to_string();
    match error {
        // A parameter may turn out wrong only when the path is made.
        PipelineError::Strategy {
            slot,
            error: StrategyError::Parameter { name, message },
            ..
        } => strategies::wrong_parameter(recipe, slot, &name, &message),
        PipelineError::Strategy { slot, .. }
        | PipelineError::Asked { slot, .. }
        | PipelineError::BadAnswer { slot, .. } => Failure::plugin(&at_choice(recipe, slot, title)),
        PipelineError::Gouge { conflicts, .. } => {
            let all = conflicts.iter().map(|conflict| gouge(recipe, conflict));
            Failure::recipe(&all.collect::<Vec<_>>())
        }
        PipelineError::NoSurface(_) => {
            let place = recipe.nearest_span("part.aperture");
            let longer = matches!(recipe.overrun, Overrun::Length(length) if length > 0.0);
            let help = longer.then(|| "or choose a shorter `overrun` under [path]".to_owned());
            recipe
                .diagnostic(place, title, "the part reaches there", help)
                .into()
        }
        PipelineError::Lead { .. } => {
            let place = recipe.nearest_span("path.lead");
            let what = match recipe.machine.has_limits() {
                true => "choose another `clearance`, wider limits under [machine]",
                false => "choose another `clearance`, a slower spindle",
            };
            let help = format!("{what}, or write lead = false under [path]");
            recipe
                .diagnostic(place, title, "leads are made here", [help])
                .into()
        }
        PipelineError::Measure(_) => Failure::plugin(&at_choice(recipe, Slot::Surface, title)),
        PipelineError::Sink(error) => {
            let inner = error.get_ref().and_then(|inner| inner.downcast_ref());
            if let Some(error) = inner {
                return not_carried(recipe, error);
            }
            // It names its file itself.
            Failure::File(with_sources(&error))
        }
    }
}

fn at_choice(recipe: &Recipe, slot: Slot, title: String) -> Diagnostic {
    recipe.diagnostic(
        recipe.choice(slot).name.span.clone(),
        title,
        "chosen here",
        [],
    )
}

/// The message for a tool that does not fit.
fn gouge(recipe: &Recipe, conflict: &Conflict) -> Diagnostic {
    let (key, what, help) = match conflict {
        Conflict::NoseRadius { largest, at } => (
            "tool.nose_radius",
            format!(
                "nose radius {} exceeds the smallest concave radius {}, at x = {}, y = {} in the \
                 radial direction",
                nose_radius(recipe.tool.nose_radius),
                nose_radius(*largest),
                millimetres(at.x, 2),
                millimetres(at.y, 2)
            ),
            "choose a smaller tool or a smaller aperture",
        ),
        Conflict::IncludedAngle { least, at } => (
            "tool.included_angle",
            format!(
                "the contact leaves the edge: at x = {}, y = {} the profile is so steep that \
                 it takes an included angle of {:.2} deg",
                millimetres(at.x, 2),
                millimetres(at.y, 2),
                least.to_degrees()
            ),
            "choose a tool with a larger included angle, or a smaller aperture",
        ),
        Conflict::Clearance { least, at, uphill } => (
            "tool.clearance_angle",
            format!(
                "the flank rubs: at x = {}, y = {} the surface {} along the cut by {:.2} deg",
                millimetres(at.x, 2),
                millimetres(at.y, 2),
                if *uphill { "rises" } else { "falls" },
                least.to_degrees()
            ),
            "choose a tool with a larger clearance angle, or a smaller aperture",
        ),
    };
    let title = format!("the tool would gouge: {what}");
    let cuts_rest = recipe.tool.misfit == Misfit::CutWhatFits
        && !matches!(conflict, Conflict::Clearance { .. });
    if cuts_rest {
        return cannot_cut_what_fits(recipe, title, help);
    }
    recipe.diagnostic(
        recipe.nearest_span(key),
        title,
        "does not fit",
        [help.to_owned()],
    )
}

/// The message for a compensator that would gouge where it should leave something standing.
fn cannot_cut_what_fits(recipe: &Recipe, title: String, help: &str) -> Diagnostic {
    let compensator = &recipe.choice(Slot::Compensator).name;
    recipe.diagnostic(
        compensator.span.clone(),
        title,
        format!("`{}` cannot cut what fits", compensator.value),
        [
            "choose the compensator `z-direction`, which stops at the first touch".to_owned(),
            format!("or {help}"),
        ],
    )
}
