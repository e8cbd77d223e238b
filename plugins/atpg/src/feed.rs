//! The feed strategy `atpg`.

use turnpath_plugin::prelude::*;
use turnpath_plugin::ring::FeedTable;

use crate::acceleration::largest_acceleration;
use crate::cubic::{CubicFit, FIT, explicit_pairs};
use crate::pieces::{pieces, revolutions};
use crate::residual::Residual;
use crate::smooth::SmoothFeed;

/// Half width h of the average over ρ, as a part of the aperture. A wider average makes X smoother,
/// and costs revolutions where the feed varies (AST-5: 0.2 % at this width).
const WINDOW: f64 = 0.01;
/// What smoothing may cost in revolutions, compared with the fastest law. The feed goes up and down
/// with every lens of an array; the window is halved there until it costs no more than this.
const LARGEST_COST: f64 = 0.01;
/// The narrowest window, in feeds. With a narrower one X would change its speed within a turn.
const NARROWEST: f64 = 0.25;

/// The factor by which the window grows in each step while X accelerates more than the machine can.
const GROWTH: f64 = 1.5;
/// The part of the machine's limit that the law may take. Played cubics follow the law up to a few
/// thousandths.
const SHARE: f64 = 0.99;

/// How the law follows F.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fit {
    Smooth,
    Cubic,
}

/// ρ' = F(ρ), the feed that keeps the residual at every angle of a radius. X does not follow the
/// angle.
#[derive(Debug, Clone, PartialEq)]
pub struct AtpgFeed {
    residual: Residual,
    fit: Fit,
}

const RESIDUAL: Param<Choice> = Param::choice(
    "residual",
    &["held", "paper"],
    "held: the feed for the cusps that the compensator leaves; paper: the feed of a contact \
             with any compensator, from the smallest curvature and the largest slope, each at \
             its own angle",
)
.default("held");

impl Strategy for AtpgFeed {
    const NAME: &'static str = "atpg";
    const SUMMARY: &'static str = "at each radius the largest feed that holds the residual at \
        every angle, made smooth";
    const SOURCE: &'static str = "Wang et al. 2019, Materials 12, 810, \
        doi:10.3390/ma12050810, §3.2 and 3.3; fit = \"smooth\" stays below the feed, which the paper's cubic does not; large feeds from the \
        exact cusp, as far as neighbouring noses meet within their edges";
    const PARAMS: &'static [ParamInfo] = &[RESIDUAL.info(), FIT.info()];

    fn new(params: &Params) -> Result<Self> {
        let residual = match params.get(RESIDUAL) {
            "paper" => Residual::Paper,
            _ => Residual::Exact,
        };
        let fit = match params.get(FIT) {
            "cubic" => Fit::Cubic,
            _ => Fit::Smooth,
        };
        Ok(Self { residual, fit })
    }
}

impl FeedStrategy for AtpgFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let task = setup.task;
        let table = self.residual.table(setup)?;
        let law = match self.fit {
            Fit::Smooth => smooth_law(&table, task)?,
            Fit::Cubic => {
                let pairs = explicit_pairs(&table, task.range)?;
                let turns = (pairs.len() - 1) as f64;
                vec![CubicFit::through(&pairs)?.piece(task.range, turns, task.direction)?]
            }
        };
        Ok(Box::new(CompletePlan(law)))
    }
}

/// The law of the smooth feed. If the machine has a limit for X, the window grows until the law
/// keeps to the limit, since a wider average changes less. At most the window is as wide as the
/// part.
fn smooth_law(table: &FeedTable, task: &Task) -> Result<Vec<FeedPiece>> {
    let aperture = 2.0 * task.part.aperture_radius;
    let mut smooth = smoothed(table, WINDOW * aperture);
    let mut law = pieces(&smooth, task.range, task.direction)?;
    let Some(limit) = task.machine.x.acceleration else {
        return Ok(law);
    };
    // The feed is planned before the spindle's schedule: at the largest speed.
    let spindle = SpindleLaw::constant(task.spindle_speed);
    while largest_acceleration(&law, &spindle) > SHARE * limit && smooth.window() < aperture {
        smooth = SmoothFeed::new(table, (GROWTH * smooth.window()).min(aperture));
        law = pieces(&smooth, task.range, task.direction)?;
    }
    Ok(law)
}

/// The smooth feed with the widest window that does not cost too many revolutions.
fn smoothed(table: &FeedTable, widest: f64) -> SmoothFeed {
    let (from, to) = table.range();
    let fastest = table.fewest_revolutions();
    let mut window = widest;
    loop {
        let smooth = SmoothFeed::new(table, window);
        let cost = revolutions(&smooth, from, to) / fastest - 1.0;
        if cost <= LARGEST_COST || window <= 2.0 * NARROWEST * table.largest() {
            return smooth;
        }
        window *= 0.5;
    }
}

/// All pieces at once. F has one value at each radius, so there are some hundred pieces for any
/// part.
struct CompletePlan(Vec<FeedPiece>);

impl FeedPlan for CompletePlan {
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        pieces.append(&mut self.0);
        Ok(Continuation::End)
    }
}
