//! Before any path: the range of ρ, and whether the tool fits.

use std::f64::consts::TAU;

use turnpath_core::interference::{Conflict, Interference};
use turnpath_core::{
    CentreBuffers, Compensator, Direction, Locus, Machine, Misfit, Overrun, Part, RadialRange,
    SpindleLaw, StrategyError, Task, Tolerance, Tool, ToolLocus,
};
use turnpath_verify::{FirstTouch, Subject};

use crate::largest_nose::Fit;
use crate::{Chain, PipelineError, Result};

/// Angles at which the contact is looked for beyond the rim and the hole.
const RIM_ANGLES: usize = 720;
/// Places of the nose's reach at which the surface is looked for.
const REACH_PLACES: usize = 64;

/// What is wanted, as a recipe says it.
#[derive(Debug, Clone)]
pub struct Wanted {
    /// What is cut.
    pub part: Part,
    /// With what.
    pub tool: Tool,
    /// How exactly.
    pub tolerance: Tolerance,
    /// How far the path runs beyond the part.
    pub overrun: Overrun,
    /// Which way it feeds.
    pub direction: Direction,
    /// How fast the spindle turns.
    pub spindle: SpindleLaw,
    /// What the machine can do.
    pub machine: Machine,
}

impl Wanted {
    /// The job over a range of ρ.
    fn task(self, range: RadialRange) -> Task {
        Task {
            part: self.part,
            tool: self.tool,
            tolerance: self.tolerance,
            range,
            direction: self.direction,
            spindle: self.spindle,
            machine: self.machine,
        }
    }
}

/// A job whose tool fits its part.
pub struct Prepared {
    /// Part, tool, tolerances, range of ρ, direction, spindle, machine.
    pub task: Task,
    /// How far the path runs beyond the part.
    pub overrun: Overrun,
    /// Surface, compensator and tool put together.
    pub locus: ToolLocus,
    /// What the part asks of a tool.
    pub interference: Interference,
    /// Finds true tool positions.
    pub touch: FirstTouch,
}

/// Checks tool against part over all radii of contact, and settles the range of ρ.
///
/// # Errors
/// When the tool does not fit, when the surface has no height somewhere on the part or on its
/// overrun, or when a strategy fails.
pub fn prepare(chain: &Chain, wanted: Wanted) -> Result<Prepared> {
    if wanted.tool.misfit == Misfit::Refuse {
        return settle(chain, wanted);
    }
    // Where all fits after all, the touch is where it is for any tool: no edge need be scanned.
    let mut strict = wanted.clone();
    strict.tool.misfit = Misfit::Refuse;
    match settle(chain, strict) {
        Err(PipelineError::Gouge { .. }) => settle(chain, wanted),
        settled => settled,
    }
}

fn settle(chain: &Chain, wanted: Wanted) -> Result<Prepared> {
    let (part, tool, overrun) = (wanted.part, wanted.tool, wanted.overrun);
    let fit = Fit::new(chain, part, tool, overrun);
    let (surface, compensator) = (fit.surface.clone(), fit.compensator.clone());
    let locus = ToolLocus::new(surface.clone(), compensator.clone(), tool);
    look_for_numbers(chain, &part)?;
    // Where the contact goes beyond the rim is known only if the nose fits the part itself.
    let on_part = fit.interference(tool, fit.whole_part())?;
    let of_nose = |conflict: &Conflict| matches!(conflict, Conflict::NoseRadius { .. });
    refuse(&fit, &on_part, &on_part, of_nose)?;
    let range = fit.range(tool)?;
    let subject = Subject {
        surface,
        part,
        tool,
        compensates_nose: compensator.compensates_nose(),
    };
    let touch = FirstTouch::new(subject).map_err(PipelineError::Measure)?;
    let region = contact_range(chain, &locus, &tool, range)?;
    let interference = fit.interference(tool, region)?;
    refuse(&fit, &on_part, &interference, |_| true)?;
    Ok(Prepared {
        task: wanted.task(range),
        overrun,
        locus,
        interference,
        touch,
    })
}

/// A surface that has no height anywhere on a ring of the part is a plugin's fault, not the
/// recipe's.
fn look_for_numbers(chain: &Chain, part: &Part) -> Result<()> {
    let radius = part.inner_radius;
    let x: Vec<f64> = (0..8).map(|i| radius * turn(i).1).collect();
    let y: Vec<f64> = (0..8).map(|i| radius * turn(i).0).collect();
    let mut z = vec![f64::NAN; x.len()];
    let answer = chain.surface.strategy.heights(&x, &y, &mut z);
    answer.map_err(|error| chain.surface.failed("at the middle of the part", error))?;
    if z.iter().any(|z| z.is_finite()) {
        return Ok(());
    }
    let what = format!("no number for z anywhere at radius {radius} mm");
    Err(chain.surface.bad_answer(what))
}

fn turn(eighths: usize) -> (f64, f64) {
    turnpath_core::Scalar::sin_cos(TAU * eighths as f64 / 8.0)
}

/// In which ways the tool does not fit, but for those that leave something standing where that is
/// what the recipe asks for and the compensator can do.
pub(crate) fn conflicts(
    found: &Interference,
    tool: &Tool,
    compensator: &dyn Compensator,
) -> Vec<Conflict> {
    let mut conflicts = found.conflicts(tool);
    if tool.misfit == Misfit::CutWhatFits && compensator.cuts_what_fits() {
        conflicts.retain(|conflict| matches!(conflict, Conflict::Clearance { .. }));
    }
    conflicts
}

/// Refuses a tool that does not fit, where a conflict is one of `which`; of a nose that is too
/// large the message tells the one that would really do.
fn refuse(
    fit: &Fit<'_>,
    on_part: &Interference,
    found: &Interference,
    which: impl Fn(&Conflict) -> bool,
) -> Result<()> {
    let mut conflicts = conflicts(found, &fit.tool, fit.compensator.as_ref());
    if !conflicts.iter().any(which) {
        return Ok(());
    }
    let noses = conflicts.iter_mut().find_map(|conflict| match conflict {
        Conflict::NoseRadius { largest, at } => Some((largest, at)),
        _ => None,
    });
    if let Some((radius, at)) = noses {
        let nose = fit.largest_nose(on_part.curvature)?;
        (*radius, *at) = (nose.radius, nose.at.position());
    }
    let interference = Box::new(*found);
    Err(PipelineError::Gouge {
        conflicts,
        interference,
    })
}

/// The radii of contact while ρ runs over `range`: where ρ is the centre's X, contact reaches
/// beyond it on slopes.
pub(crate) fn contact_range(
    chain: &Chain,
    locus: &ToolLocus,
    tool: &Tool,
    range: RadialRange,
) -> Result<RadialRange> {
    let theta: Vec<f64> = (0..RIM_ANGLES)
        .map(|i| TAU * i as f64 / RIM_ANGLES as f64)
        .collect();
    let mut contact = RadialRange {
        inner: range.inner.abs(),
        ..range
    };
    for rho in [range.inner, range.outer] {
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        let answer = locus.centre(&theta, &vec![rho; theta.len()], room.as_centres());
        answer.map_err(|error| chain.compensator.failed(format!("at ρ = {rho} mm"), error))?;
        for (foot, theta) in room.foot.iter().zip(&theta) {
            if !foot.is_finite() {
                return Err(no_contact(chain, tool, *theta, rho));
            }
            contact.inner = contact.inner.min(foot.abs());
            contact.outer = contact.outer.max(foot.abs());
        }
    }
    if range.inner <= 0.0 {
        contact.inner = 0.0;
    }
    Ok(contact)
}

/// Where a compensator finds no contact: the recipe's fault if the surface ends within the
/// nose's reach, the compensator's if not.
pub(crate) fn no_contact(chain: &Chain, tool: &Tool, theta: f64, rho: f64) -> PipelineError {
    let place = format!(
        "at C = {:.1} deg, ρ = {rho:.4} mm",
        theta / turnpath_core::DEG
    );
    let (s, c) = turnpath_core::Scalar::sin_cos(theta);
    let reach = tool.reach();
    let feet =
        (0..=REACH_PLACES).map(|i| rho + reach * (2.0 * i as f64 / REACH_PLACES as f64 - 1.0));
    let (x, y): (Vec<f64>, Vec<f64>) = feet.map(|foot| (foot * c, foot * s)).unzip();
    let mut z = vec![f64::NAN; x.len()];
    match chain.surface.strategy.heights(&x, &y, &mut z) {
        Err(error) => chain.surface.failed(place, error),
        Ok(()) if z.iter().all(|z| z.is_finite()) => chain
            .compensator
            .bad_answer(format!("no number for the contact {place}")),
        Ok(()) => PipelineError::NoSurface(StrategyError::failed(format!(
            "the nose finds no contact {place}, since the surface ends within its reach; choose a \
             smaller aperture or a smaller tool"
        ))),
    }
}
