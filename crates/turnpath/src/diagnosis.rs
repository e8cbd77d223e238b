//! Errors of the stages at their places in the recipe: cause, place and remedy.

use std::ops::Range;

use turnpath_core::interference::Conflict;
use turnpath_core::{Misfit, Overrun, Scalar, Slot, StrategyError};
use turnpath_pipeline::{Excess, PathSize, PipelineError};
use turnpath_post::post_named;
use turnpath_recipe::{Choice, Diagnostic, Diagnostics, Recipe, Spanned, SurfaceEntry};
use turnpath_report::Region;
use turnpath_report::text::{millimetres, nose_radius};

use crate::data_files::DataFileError;
use crate::error::Error;
use crate::posts::NotCarried;
use crate::region::region;

/// A feed below this part of the nose radius leaves cusps of less than a thousandth of a nanometre
/// under any usual nose: the residual makes such a path long, and not the part.
const SLOW_FEED: f64 = 1e-4;
/// More control points than this on a revolution, a thousandth of a degree apart, are the
/// interpolation tolerance's.
const DENSE: f64 = 360_000.0;

/// An error of the pipeline at its place in the recipe.
pub fn of_pipeline(recipe: &Recipe, error: PipelineError) -> Error {
    let title = error.to_string();
    match &error {
        // A parameter may turn out wrong only when the path is made.
        PipelineError::Strategy {
            slot,
            error:
                StrategyError::Parameter {
                    name,
                    message,
                    place,
                },
            ..
        } => {
            let diagnostic = wrong_parameter(
                recipe,
                recipe.choice(*slot),
                name,
                message,
                place.as_deref(),
            );
            Error::refused_by(diagnostic, error)
        }
        // A surface without a height on the part's inner ring is wrong only if it lies where its
        // author put it.
        PipelineError::BadAnswer {
            slot: Slot::Surface,
            ..
        } if moves_surface(recipe) => Error::refused_by(nothing_there(recipe), error),
        PipelineError::InnerStrategy { slot, entry, .. } => {
            Error::strategy(at_choice(recipe, *slot, *entry, title), error)
        }
        PipelineError::Strategy { slot, .. } | PipelineError::BadAnswer { slot, .. } => {
            Error::strategy(at_choice(recipe, *slot, 0, title), error)
        }
        PipelineError::Measure(StrategyError::Delegate { slot, entry, .. }) => {
            Error::strategy(at_choice(recipe, *slot, *entry, title), error)
        }
        PipelineError::Measure(_) => {
            Error::strategy(at_choice(recipe, Slot::Surface, 0, title), error)
        }
        PipelineError::Gouge { conflicts, .. } => {
            let all = conflicts.iter().map(|conflict| gouge(recipe, conflict));
            Error::refused_by(all.collect::<Diagnostics>(), error)
        }
        PipelineError::NoSurface(_) => Error::refused_by(no_surface(recipe, title), error),
        PipelineError::TooLong(size) => Error::refused_by(too_long(recipe, size, title), error),
        PipelineError::Lead { .. } => Error::refused_by(no_lead(recipe, title), error),
        PipelineError::Cancelled => Error::Cancelled,
    }
}

/// A surface that fails while a path is measured.
pub fn of_measure(recipe: &Recipe, error: StrategyError) -> Error {
    of_pipeline(recipe, PipelineError::Measure(error))
}

/// A parameter that a strategy cannot work with, underlined where it stands.
pub fn wrong_parameter(
    recipe: &Recipe,
    choice: &Choice,
    parameter: &str,
    message: &str,
    place: Option<&Range<usize>>,
) -> Diagnostic {
    let (noun, name) = (choice.slot.noun(), choice.name());
    let title = format!("the {noun} `{name}` cannot work with this: {message}");
    let span = match place {
        Some(place) => choice.place_span(parameter, place),
        None => choice.param_span(parameter),
    };
    recipe.diagnostic(span, title, format!("`{parameter}`"), [])
}

/// A data file that cannot be read, underlined where the recipe names it.
pub fn unreadable_file(
    recipe: &Recipe,
    choice: &Choice,
    parameter: &str,
    path: &Spanned<String>,
    error: &DataFileError,
) -> Diagnostic {
    let (noun, name) = (choice.slot.noun(), choice.name());
    let whole = recipe.resolve(&path.value);
    let title = format!("cannot read the file {}: {error}", whole.display());
    let label = format!("`{parameter}` of the {noun} `{name}`");
    let help = "the path of a data file is relative to the recipe".to_owned();
    recipe.diagnostic(path.span.clone(), title, label, [help])
}

/// A path that the post cannot carry: the recipe asks for both.
pub fn not_carried(recipe: &Recipe, not_carried: NotCarried) -> Error {
    let NotCarried { post: name, error } = not_carried;
    let mut posts = recipe.output.posts.iter();
    let post = posts.find(|post| post.value == name);
    let span = post.map_or_else(|| recipe.nearest_span("output"), |post| post.span.clone());
    let title = format!("the post `{name}` cannot carry this path: {error}");
    let help = post_named(name).map(|post| error.help(post.keys).to_owned());
    Error::refused_by(recipe.diagnostic(span, title, "chosen here", help), error)
}

/// A sampler with a velocity solver that does not give the rates on which it relies.
pub fn needs_exact_rates(recipe: &Recipe) -> Error {
    let [sampler, velocity] =
        [Slot::Sampler, Slot::Velocity].map(|slot| recipe.choice(slot).name());
    let title = format!(
        "the sampler `{sampler}` needs exact rates, and the velocity solver `{velocity}` does not \
         give them"
    );
    let span = recipe.choice(Slot::Velocity).name.span.clone();
    let help = ["choose a solver with exact rates: use = \"analytic\"".to_owned()];
    Diagnostics::from(recipe.diagnostic(span, title, "chosen here", help)).into()
}

/// A message at the strategy of a slot, or at the surface of that number in a sum.
fn at_choice(recipe: &Recipe, slot: Slot, entry: usize, title: String) -> Diagnostic {
    let numbered = recipe.choices(slot).get(entry).copied();
    let choice = numbered.unwrap_or_else(|| recipe.choice(slot));
    recipe.diagnostic(choice.name.span.clone(), title, "chosen here", [])
}

/// Whether the recipe has the part elsewhere than at the surface's own origin.
fn moves_surface(recipe: &Recipe) -> bool {
    let moved = |entry: &SurfaceEntry| !entry.placement.is_plain();
    recipe.pose.is_some() || recipe.surfaces.iter().any(moved)
}

fn nothing_there(recipe: &Recipe) -> Diagnostic {
    let of_pose = recipe.pose.is_some();
    let span = recipe.nearest_span(if of_pose { "part.pose" } else { "surface" });
    let title = "the part lies where the surface has no height";
    let help = match of_pose {
        true => "choose another `x` and `y`",
        false => "choose smaller decentres, or a surface that reaches farther",
    };
    recipe.diagnostic(span, title, "placed here", [help.to_owned()])
}

fn no_surface(recipe: &Recipe, title: String) -> Diagnostic {
    let span = recipe.nearest_span("part.aperture");
    let longer = matches!(recipe.overrun, Overrun::Length(length) if length > 0.0);
    let help = longer.then(|| "or choose a shorter `overrun` under [path]".to_owned());
    recipe.diagnostic(span, title, "the part reaches there", help)
}

/// The message for a path that is too long, at the number that makes it so.
fn too_long(recipe: &Recipe, size: &PathSize, title: String) -> Diagnostic {
    let feed = size.distance / size.revolutions;
    let longer = matches!(recipe.overrun, Overrun::Length(length) if 2.0 * length > size.distance);
    let slow = feed < SLOW_FEED * recipe.tool.nose_radius;
    let dense = matches!(size.excess, Excess::Points(points) if points > DENSE * size.revolutions);
    let (key, help) = match (longer, slow, dense) {
        (true, ..) => ("path.overrun", "choose a shorter `overrun`"),
        (_, true, _) => ("tolerance.residual", "allow a larger residual"),
        (.., true) => (
            "tolerance.interpolation",
            "allow a larger interpolation error",
        ),
        _ => ("part.aperture", "choose a smaller aperture"),
    };
    let span = recipe.nearest_span(key);
    recipe.diagnostic(span, title, "makes it so long", [help.to_owned()])
}

fn no_lead(recipe: &Recipe, title: String) -> Diagnostic {
    let span = recipe.nearest_span("path.lead");
    let remedy = match recipe.machine.has_limits() {
        true => "choose another `clearance`, wider limits under [machine]",
        false => "choose another `clearance`, a slower spindle",
    };
    let help = format!("{remedy}, or write lead = false under [path]");
    recipe.diagnostic(span, title, "leads are made here", [help])
}

/// A hollow that takes a smaller nose than this is a crease, mm: no recipe may have one.
const SHARPEST_NOSE: f64 = 1e-4;

/// What cuts a part that the nose does not fit everywhere.
const CUT_WHAT_FITS: &str = "write interference = \"cut-what-fits\" under [tool]: the nose goes as deep as it can, \
                             and the report says what stays";

/// The message for a tool that does not fit.
fn gouge(recipe: &Recipe, conflict: &Conflict) -> Diagnostic {
    let (key, cause, help) = match conflict {
        Conflict::NoseRadius { largest, at } if *largest < SHARPEST_NOSE => (
            "tool.nose_radius",
            format!(
                "no nose reaches the bottom of the crease at {}",
                place(recipe, [at.x, at.y])
            ),
            match recipe.tool.misfit {
                Misfit::Refuse => CUT_WHAT_FITS,
                Misfit::CutWhatFits => "choose a smaller aperture",
            },
        ),
        Conflict::NoseRadius { largest, at } => (
            "tool.nose_radius",
            format!(
                "nose radius {} exceeds the smallest concave radius {}, at {} in the radial direction",
                nose_radius(recipe.tool.nose_radius),
                nose_radius(*largest),
                place(recipe, [at.x, at.y])
            ),
            "choose a smaller tool or a smaller aperture",
        ),
        Conflict::IncludedAngle { least, at } => (
            "tool.included_angle",
            format!(
                "the contact leaves the edge: at {} the profile is so steep that it takes an \
                 included angle of {:.2} deg",
                place(recipe, [at.x, at.y]),
                least.to_degrees()
            ),
            "choose a tool with a larger included angle, or a smaller aperture",
        ),
        Conflict::Clearance { least, at, uphill } => (
            "tool.clearance_angle",
            format!(
                "the flank rubs: at {} the surface {} along the cut by {:.2} deg",
                place(recipe, [at.x, at.y]),
                if *uphill { "rises" } else { "falls" },
                least.to_degrees()
            ),
            "choose a tool with a larger clearance angle, or a smaller aperture",
        ),
    };
    let title = format!("the tool would gouge: {cause}");
    let cuts_rest = recipe.tool.misfit == Misfit::CutWhatFits
        && !matches!(conflict, Conflict::Clearance { .. });
    if cuts_rest {
        return cannot_cut_what_fits(recipe, title, help);
    }
    let span = recipe.nearest_span(key);
    let fits = !matches!(conflict, Conflict::Clearance { .. }) && help != CUT_WHAT_FITS;
    let fits = fits.then(|| format!("or {CUT_WHAT_FITS}"));
    let helps = [help.to_owned()].into_iter().chain(fits);
    recipe.diagnostic(span, title, "does not fit", helps)
}

/// A place, and whether it is on the part or on its overrun.
fn place(recipe: &Recipe, [x, y]: [f64; 2]) -> String {
    let on = match region(Scalar::hypot(x, y), &recipe.part) {
        Region::Part => "part",
        Region::Overrun => "overrun",
    };
    let (x, y) = (millimetres(x, 2), millimetres(y, 2));
    format!("x = {x}, y = {y} ({on})")
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
