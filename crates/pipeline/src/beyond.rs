//! Whether the tool fits where a law goes beyond the range of ρ.
//!
//! What is within the range is looked at before there is a law. One that follows the angle goes
//! beyond it at its fast angles, while the slow ones have yet to arrive: there the contact is asked
//! along the law itself, since a whole ring out there would ask for more than is cut.

use std::f64::consts::TAU;

use turnpath_core::interference;
use turnpath_core::{CentreBuffers, Cut, Locus, SpiralLaw, StrategyError};

use crate::prepare::{conflicts, no_contact};
use crate::{Chain, PipelineError, Prepared, Result};

/// Places looked at on a revolution.
const ANGLES: u32 = 720;
/// What counts as beyond, mm: the slack that laws have at their ends.
const BEYOND: f64 = 1e-5;

/// Asks turn by turn from either end of the law, until one is within the range.
///
/// # Errors
/// When the tool does not fit somewhere, or the surface has no height there.
pub fn check(chain: &Chain, prepared: &Prepared, law: &SpiralLaw) -> Result<()> {
    let turns = law.end().ceil() as u64;
    let outside = |turn: &u64| Some(places(prepared, law, *turn)).filter(|one| !one.is_empty());
    for places in (0..turns).map_while(|turn| outside(&turn)) {
        fits(chain, prepared, &places)?;
    }
    for places in (0..turns).rev().map_while(|turn| outside(&turn)) {
        fits(chain, prepared, &places)?;
    }
    Ok(())
}

/// θ and ρ of a turn's places beyond the range.
fn places(prepared: &Prepared, law: &SpiralLaw, turn: u64) -> Vec<(f64, f64)> {
    let range = prepared.task.range;
    let parts = (0..=ANGLES).map(|i| f64::from(i) / f64::from(ANGLES));
    let on_law = parts.filter(|part| turn as f64 + part <= law.end());
    let places = on_law.map(|part| (TAU * part, law.value(turn as f64 + part)));
    let within = range.inner - BEYOND..=range.outer + BEYOND;
    places
        .filter(|(_, rho)| !within.contains(&rho.abs()))
        .collect()
}

fn fits(chain: &Chain, prepared: &Prepared, places: &[(f64, f64)]) -> Result<()> {
    let Prepared { task, locus, .. } = prepared;
    let (theta, rho): (Vec<f64>, Vec<f64>) = places.iter().copied().unzip();
    let mut room = CentreBuffers::default();
    room.resize(theta.len());
    let answer = locus.centre(&theta, &rho, room.as_centres());
    answer.map_err(|error| attributed(chain, error))?;
    let feet = room.foot.iter().zip(places);
    if let Some((_, (theta, rho))) = feet.into_iter().find(|(foot, _)| !foot.is_finite()) {
        return Err(no_contact(chain, &task.tool, *theta, *rho));
    }
    let cut = Cut {
        surface: locus.surface(),
        tool: &task.tool,
    };
    let found =
        interference::at(cut, &theta, &room.foot).map_err(|error| attributed(chain, error))?;
    let conflicts = conflicts(&found, &task.tool, chain.compensator.strategy.as_ref());
    if conflicts.is_empty() {
        return Ok(());
    }
    Err(PipelineError::Gouge {
        conflicts,
        interference: Box::new(found),
    })
}

fn attributed(chain: &Chain, error: StrategyError) -> PipelineError {
    let place = "where the law goes beyond the range";
    match error {
        StrategyError::Failed(_) => PipelineError::NoSurface(error),
        other => chain.compensator.failed(place, other),
    }
}
