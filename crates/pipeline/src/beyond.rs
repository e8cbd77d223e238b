//! Whether the tool fits where a law goes beyond the range of ρ.
//!
//! Preparation checks the range itself, before there is a law. A law that follows the angle goes
//! beyond the range at its fast angles while it still runs to the end of the range at its slow
//! ones. There the check runs along the law itself: a check of the whole ring would refuse tools
//! for places that are never cut.

use std::f64::consts::TAU;

use turnpath_core::interference;
use turnpath_core::{CentreBuffers, Cut, Locus, SpiralLaw, StrategyError};

use crate::contact::no_contact;
use crate::prepare::conflicts;
use crate::{Chain, PipelineError, Preparation, Result};

/// Checked points on a revolution.
const ANGLES: u32 = 720;
/// A law goes beyond the range where it exceeds it by this, mm: the slack that laws have at their
/// ends.
const BEYOND: f64 = 1e-5;

/// Checks turn by turn from either end of the law, until a turn lies within the range.
///
/// # Errors
/// When the tool does not fit somewhere, or the surface has no height there.
pub fn check(chain: &Chain, preparation: &Preparation, law: &SpiralLaw) -> Result<()> {
    let turns = law.end().ceil() as u64;
    let outside = |turn: u64| Some(points_beyond(preparation, law, turn)).filter(|p| !p.is_empty());
    for points in (0..turns).map_while(outside) {
        check_points(chain, preparation, &points)?;
    }
    for points in (0..turns).rev().map_while(outside) {
        check_points(chain, preparation, &points)?;
    }
    Ok(())
}

/// θ and ρ of the checked points of a turn that lie beyond the range.
fn points_beyond(preparation: &Preparation, law: &SpiralLaw, turn: u64) -> Vec<(f64, f64)> {
    let range = preparation.task.range;
    let parts = (0..=ANGLES).map(|i| f64::from(i) / f64::from(ANGLES));
    let on_law = parts.filter(|part| turn as f64 + part <= law.end());
    let points = on_law.map(|part| (TAU * part, law.value(turn as f64 + part)));
    let within = range.inner - BEYOND..=range.outer + BEYOND;
    points
        .filter(|(_, rho)| !within.contains(&rho.abs()))
        .collect()
}

fn check_points(chain: &Chain, preparation: &Preparation, points: &[(f64, f64)]) -> Result<()> {
    let Preparation { task, locus, .. } = preparation;
    let (theta, rho): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let mut centres = CentreBuffers::default();
    centres.resize(theta.len());
    let answer = locus.centre(&theta, &rho, centres.as_centres());
    answer.map_err(|error| attribute(chain, error))?;
    let feet = centres.foot.iter().zip(points);
    if let Some((_, (theta, rho))) = feet.into_iter().find(|(foot, _)| !foot.is_finite()) {
        return Err(no_contact(&chain.locus_links(), &task.tool, *theta, *rho));
    }
    let cut = Cut {
        surface: locus.surface(),
        tool: &task.tool,
    };
    let interference =
        interference::at(cut, &theta, &centres.foot).map_err(|error| attribute(chain, error))?;
    let conflicts = conflicts(
        &interference,
        &task.tool,
        chain.compensator.strategy.as_ref(),
    );
    if conflicts.is_empty() {
        return Ok(());
    }
    Err(PipelineError::Gouge {
        conflicts,
        interference: Box::new(interference),
    })
}

fn attribute(chain: &Chain, error: StrategyError) -> PipelineError {
    let context = "where the law goes beyond the range";
    match error {
        StrategyError::Failed(_) => PipelineError::NoSurface(error),
        other => chain.compensator.failed(context, other),
    }
}
