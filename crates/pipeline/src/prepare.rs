//! Before there is a path: the range of ρ, and whether the tool fits.

use turnpath_core::interference::{Conflict, Extreme, Interference};
use turnpath_core::{Compensator, JobSpec, Misfit, Overrun, Task, Tool, ToolLocus};
use turnpath_verify::{FirstTouch, Subject};

use crate::contact::contact_range;
use crate::fit::Fit;
use crate::on_part::{check_data, check_heights};
use crate::size::check_part;
use crate::walls::check_walls;
use crate::{LocusLinks, PipelineError, Result};

/// A task whose tool fits its part.
#[derive(Clone)]
pub struct Preparation {
    /// Part, tool, tolerances, range of ρ, direction, largest spindle speed, machine.
    pub task: Task,
    /// How far the path runs beyond the part.
    pub overrun: Overrun,
    /// Surface, compensator and tool together.
    pub locus: ToolLocus,
    /// What the part requires of a tool, with its overrun.
    pub interference: Interference,
    /// The largest curvature of a radial section of the part itself, without its overrun, 1/mm.
    pub curvature_on_part: Extreme,
    /// Finds true tool positions.
    pub touch: FirstTouch,
}

/// Checks the tool against the part over all radii of contact, and decides the range of ρ.
///
/// # Errors
/// When the tool does not fit, when the surface has no height somewhere on the part or on its
/// overrun, when its map lies elsewhere, when the height jumps, or when a strategy fails.
pub fn prepare(links: &LocusLinks, spec: JobSpec) -> Result<Preparation> {
    check_part(&spec)?;
    if spec.tool.misfit == Misfit::Refuse {
        return prepare_tool(links, spec);
    }
    // Where the whole tool fits, the misfit setting changes no touch, and the edge needs no scan.
    let mut strict = spec.clone();
    strict.tool.misfit = Misfit::Refuse;
    match prepare_tool(links, strict) {
        Err(PipelineError::Gouge { .. }) => prepare_tool(links, spec),
        preparation => preparation,
    }
}

/// The preparation for a tool as it is given.
fn prepare_tool(links: &LocusLinks, spec: JobSpec) -> Result<Preparation> {
    let (part, tool, overrun) = (spec.part, spec.tool, spec.overrun);
    let fit = Fit::new(links, part, tool, overrun);
    let (surface, compensator) = (fit.surface.clone(), fit.compensator.clone());
    let locus = ToolLocus::new(surface.clone(), compensator.clone(), tool);
    check_heights(&links.surface, &part)?;
    check_data(&links.surface, &part)?;
    check_walls(&links.surface, &part)?;
    let on_path = || {
        let range = fit.range(tool)?;
        let region = contact_range(links, &locus, &tool, range)?;
        Ok((range, fit.interference(tool, region)?))
    };
    let (on_part, on_path) = rayon::join(|| fit.interference(tool, fit.whole_part()), on_path);
    let on_part = on_part?;
    // How far the contact goes beyond the rim counts only if the nose fits the part itself.
    let of_nose = |conflict: &Conflict| matches!(conflict, Conflict::NoseRadius { .. });
    refuse(&fit, &on_part, &on_part, of_nose)?;
    let (range, interference) = on_path?;
    let subject = Subject {
        surface,
        part,
        tool,
        compensates_nose: compensator.compensates_nose(),
    };
    let touch = FirstTouch::new(subject).map_err(PipelineError::Measure)?;
    refuse(&fit, &on_part, &interference, |_| true)?;
    Ok(Preparation {
        task: spec.over(range),
        overrun,
        locus,
        interference,
        curvature_on_part: on_part.curvature,
        touch,
    })
}

/// In which ways the tool does not fit. Where the recipe says to cut what fits and the compensator
/// can do so, a conflict that only leaves material standing does not count.
pub(crate) fn conflicts(
    interference: &Interference,
    tool: &Tool,
    compensator: &dyn Compensator,
) -> Vec<Conflict> {
    let mut conflicts = interference.conflicts(tool);
    if tool.misfit == Misfit::CutWhatFits && compensator.cuts_what_fits() {
        conflicts.retain(|conflict| matches!(conflict, Conflict::Clearance { .. }));
    }
    conflicts
}

/// Refuses a tool that does not fit, where a conflict is one of `which`. Where the nose is too
/// large, the message reports the largest nose that fits with its own overrun.
fn refuse(
    fit: &Fit<'_>,
    on_part: &Interference,
    interference: &Interference,
    which: impl Fn(&Conflict) -> bool,
) -> Result<()> {
    let mut conflicts = conflicts(interference, &fit.tool, fit.compensator.as_ref());
    if !conflicts.iter().any(which) {
        return Ok(());
    }
    let too_large = conflicts.iter_mut().find_map(|conflict| match conflict {
        Conflict::NoseRadius { largest, at } => Some((largest, at)),
        _ => None,
    });
    if let Some((radius, at)) = too_large {
        let nose = fit.largest_nose(on_part.curvature)?;
        (*radius, *at) = (nose.radius, nose.at.position());
    }
    Err(PipelineError::Gouge {
        conflicts,
        interference: Box::new(*interference),
    })
}
