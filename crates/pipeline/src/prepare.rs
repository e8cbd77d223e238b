//! Before any path: the range of ρ, and whether the tool fits.

use std::f64::consts::TAU;
use std::sync::Arc;

use turnpath_core::interference::Interference;
use turnpath_core::{
    CentreBuffers, Compensator, Cut, Direction, Job, Locus, Part, RadialRange, SpindleLaw,
    StrategyError, SurfaceModel, Tolerance, Tool, ToolLocus,
};
use turnpath_verify::{FirstTouch, Subject};

use crate::attributed::{AttributedCompensator, AttributedSurface};
use crate::{Chain, PipelineError, Result};

/// Angles at which the contact is looked for beyond the rim and the hole.
const RIM_ANGLES: usize = 720;

/// A job whose tool fits its part.
pub struct Prepared {
    /// Part, tool, tolerances, range of ρ, direction, spindle.
    pub job: Job,
    /// Surface, compensator and tool put together.
    pub locus: ToolLocus,
    /// What the part asks of a tool.
    pub interference: Interference,
    /// Finds true tool positions.
    pub touch: FirstTouch,
}

/// Checks tool against part over all radii of contact, and settles the range of ρ: the aperture
/// exactly, from the hole (or the axis) to the rim.
///
/// # Errors
/// When the tool does not fit, when the surface has no height somewhere on the part, or when a
/// strategy fails.
pub fn prepare(
    chain: &Chain,
    part: Part,
    tool: Tool,
    tolerance: Tolerance,
    direction: Direction,
    spindle: SpindleLaw,
) -> Result<Prepared> {
    let range = RadialRange {
        inner: part.inner_radius,
        outer: part.aperture_radius,
    };
    let job = Job {
        part,
        tool,
        tolerance,
        range,
        direction,
        spindle,
    };
    let surface: Arc<dyn SurfaceModel> = Arc::new(AttributedSurface::new(&chain.surface));
    let compensator = Arc::new(AttributedCompensator::new(&chain.compensator));
    let locus = ToolLocus::new(surface.clone(), compensator.clone(), tool);
    look_for_numbers(chain, &job)?;
    refuse_conflicts(chain, compensator.as_ref(), surface.as_ref(), &tool, range)?;
    let contact = contact_range(chain, &locus, range)?;
    let interference = refuse_conflicts(
        chain,
        compensator.as_ref(),
        surface.as_ref(),
        &tool,
        contact,
    )?;
    let compensates_nose = compensator.compensates_nose();
    let subject = Subject {
        surface,
        part,
        tool,
        compensates_nose,
    };
    let touch = FirstTouch::new(subject).map_err(PipelineError::Measure)?;
    Ok(Prepared {
        job,
        locus,
        interference,
        touch,
    })
}

/// A surface that has no height anywhere on a ring of the part is a plugin's fault, not the
/// recipe's.
fn look_for_numbers(chain: &Chain, job: &Job) -> Result<()> {
    let radius = job.part.inner_radius;
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

fn refuse_conflicts(
    chain: &Chain,
    compensator: &dyn Compensator,
    surface: &dyn SurfaceModel,
    tool: &Tool,
    region: RadialRange,
) -> Result<Interference> {
    let found = compensator
        .interference(Cut { surface, tool }, region)
        .map_err(|error| match error {
            StrategyError::Failed(_) => PipelineError::NoSurface(error),
            other => chain.compensator.failed("in the interference check", other),
        })?;
    let conflicts = found.conflicts(tool);
    if conflicts.is_empty() {
        return Ok(found);
    }
    Err(PipelineError::Gouge {
        conflicts,
        interference: found,
    })
}

/// The radii of contact while ρ runs over `range`: where ρ is the centre's X, contact reaches
/// beyond it on slopes.
fn contact_range(chain: &Chain, locus: &ToolLocus, range: RadialRange) -> Result<RadialRange> {
    let theta: Vec<f64> = (0..RIM_ANGLES)
        .map(|i| TAU * i as f64 / RIM_ANGLES as f64)
        .collect();
    let mut contact = range;
    for rho in [range.inner, range.outer] {
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        let answer = locus.centre(&theta, &vec![rho; theta.len()], room.as_centres());
        answer.map_err(|error| chain.compensator.failed(format!("at ρ = {rho} mm"), error))?;
        for foot in room.foot.iter().filter(|foot| foot.is_finite()) {
            contact.inner = contact.inner.min(foot.abs());
            contact.outer = contact.outer.max(foot.abs());
        }
    }
    if range.inner == 0.0 {
        contact.inner = 0.0;
    }
    Ok(contact)
}
