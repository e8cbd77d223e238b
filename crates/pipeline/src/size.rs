//! Refuses a recipe whose path would be too long, before the work.

use std::f64::consts::TAU;

use turnpath_core::{JobSpec, Locus, Overrun, RadialRange, SpiralLaw, Task};

use crate::path_size::{Excess, MOST_PIECES, MOST_POINTS, MOST_REVOLUTIONS, PathSize};
use crate::{PipelineError, Result};

/// Fewest revolutions from which the length of the whole law is foretold.
const FORETOLD: f64 = 1000.0;
/// How much longer than allowed a law must be foretold to be refused before it is planned. Its feed
/// may grow on the way. A larger factor would let a strategy that plans turn by turn work for
/// minutes before it is refused.
const CERTAIN: f64 = 2.0;
/// A law whose mean feed is at least this part of the one that the residual asks for is as long as
/// the recipe makes it. A slower one is its strategy's own.
const ASKED_FOR: f64 = 0.01;
/// Angles and radii at which the residual's feed is looked at.
const LOOKED_AT: [usize; 2] = [12, 9];

/// Refuses a part of which even the largest feed of the nose, two radii, would take too many
/// revolutions. No search on the part runs before this.
pub(crate) fn check_part(spec: &JobSpec) -> Result<()> {
    let beyond = match spec.overrun {
        Overrun::Length(length) => length,
        Overrun::None | Overrun::Contact => 0.0,
    };
    let distance = spec.part.aperture_radius - spec.part.inner_radius + beyond;
    let revolutions = distance / (2.0 * spec.tool.nose_radius);
    if revolutions <= MOST_REVOLUTIONS {
        return Ok(());
    }
    Err(PipelineError::TooLong(PathSize {
        distance,
        revolutions,
        excess: Excess::Revolutions,
    }))
}

/// Refuses a law that is too long, or that will be too long as it goes on, where the recipe asks
/// for such a law. `more` pieces are about to come.
pub(crate) fn check_law(
    law: &SpiralLaw,
    more: usize,
    task: &Task,
    locus: &dyn Locus,
) -> Result<()> {
    let distance = task.range.outer - task.range.inner;
    let revolutions = law.end();
    let moved = (law.value(revolutions) - law.value(0.0)).abs();
    let covered = (moved / distance).min(1.0);
    let pieces = (law.pieces().len() + more) as f64;
    let [whole, whole_pieces] = [revolutions / covered, pieces / covered];
    let foretold = revolutions >= FORETOLD;
    let of_revolutions =
        revolutions > MOST_REVOLUTIONS || foretold && whole > CERTAIN * MOST_REVOLUTIONS;
    let most = MOST_PIECES as f64;
    let of_pieces = foretold && (pieces > most || whole_pieces > CERTAIN * most);
    let excess = match (of_revolutions, of_pieces) {
        (true, _) => Excess::Revolutions,
        (_, true) => Excess::Pieces(whole_pieces),
        _ => return Ok(()),
    };
    match moved / revolutions >= ASKED_FOR * asked_for(task, locus) {
        true => Err(PipelineError::TooLong(PathSize {
            distance,
            revolutions: whole.max(revolutions),
            excess,
        })),
        false => Ok(()),
    }
}

/// The least feed of the residual at some places of the range, mm; infinite where there is none.
fn asked_for(task: &Task, locus: &dyn Locus) -> f64 {
    let [angles, radii] = LOOKED_AT;
    let RadialRange { inner, outer } = task.range;
    let (mut theta, mut rho) = (Vec::new(), Vec::new());
    for place in 0..angles * radii {
        theta.push(TAU * (place % angles) as f64 / angles as f64);
        rho.push(inner + (outer - inner) * (place / angles) as f64 / (radii - 1) as f64);
    }
    let mut feed = vec![f64::NAN; theta.len()];
    let residual = task.tolerance.residual;
    let found = locus.residual_feed(residual, locus.radial(), &theta, &rho, &mut feed);
    match found {
        Ok(()) => feed.into_iter().fold(f64::INFINITY, f64::min),
        Err(_) => f64::INFINITY,
    }
}

/// Refuses a path with too many control points on a revolution.
pub(crate) fn check_points(distance: f64, revolutions: f64, per_revolution: f64) -> Result<()> {
    let points = revolutions * per_revolution;
    if points <= MOST_POINTS {
        return Ok(());
    }
    Err(PipelineError::TooLong(PathSize {
        distance,
        revolutions,
        excess: Excess::Points(points),
    }))
}
