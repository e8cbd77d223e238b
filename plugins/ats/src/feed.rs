//! The feed strategy `ats`.

use turnpath_plugin::prelude::*;

use crate::turn::{Turn, Turns};

/// Places of a piece at which it is held against the end of the range.
const LOOKS: usize = 32;
/// How far beyond its end every angle must come, in feeds of the largest size, R/10: between the
/// looks ρ may lie lower by less than that.
const BEYOND: f64 = 2.5e-4;
/// What is left of a turn below this is rounding.
const SHORTEST: f64 = 1e-9;
/// Turns handed out together.
const BATCH: usize = 8;

/// At every cutting point the feed that holds the residual there:
/// ℓ(N + 1) = ℓ(N) ± f, so that X moves back and forth within each turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AtsFeed;

impl Strategy for AtsFeed {
    const NAME: &'static str = "ats";
    const SUMMARY: &'static str = "at every cutting point the feed that holds the residual there; X \
        moves back and forth within each turn";
    const SOURCE: &'static str = "Zhu and To 2015, Opt. Express 23, 20234, from its abstract and \
        from Wang et al. 2019; the law is derived here";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl FeedStrategy for AtsFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.job.range;
        if !(inner.is_finite() && outer.is_finite() && inner < outer) {
            return Err(StrategyError::failed(format!(
                "there is nothing to cut: ρ runs from {inner} mm to {outer} mm"
            )));
        }
        Ok(Box::new(AtsPlan {
            made: 0,
            last: None,
            count: None,
            short: None,
        }))
    }
}

/// The law as far as it has come: one turn is all that the next one needs.
struct AtsPlan {
    /// How many turns are made.
    made: usize,
    last: Option<Turn>,
    /// Pieces that the next turn should try.
    count: Option<usize>,
    /// Where in the last turn ρ last fell short of the range's end, in parts of it.
    short: Option<f64>,
}

impl FeedPlan for AtsPlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<Stretch>) -> Result<Onward> {
        let goal = Goal::of(setup.job);
        let mut turns = Turns::new(setup, self.count);
        for _ in 0..BATCH {
            let turn = turns.turn(self.made, goal.start, self.last.as_ref())?;
            self.made += 1;
            let short = goal.last_short(&turn);
            match (self.last.is_some(), short, self.short) {
                // Every angle has passed: the turn that began where the last fell short ends it.
                (true, None, before) => {
                    cut(&turn, before.unwrap_or(0.0), pieces);
                    return Ok(Onward::Done);
                }
                _ => pieces.extend(&turn.pieces),
            }
            (self.last, self.short) = (Some(turn), short);
        }
        self.count = Some(turns.count());
        Ok(Onward::More)
    }
}

/// Which circle the law goes to, and from which.
struct Goal {
    start: f64,
    end: f64,
    outward: f64,
}

impl Goal {
    fn of(job: &Job) -> Self {
        let RadialRange { inner, outer } = job.range;
        let beyond = BEYOND * 0.1 * job.tool.nose_radius;
        match job.direction {
            Direction::Outward => Self {
                start: inner,
                end: outer + beyond,
                outward: 1.0,
            },
            Direction::Inward => Self {
                start: outer,
                end: inner - beyond,
                outward: -1.0,
            },
        }
    }

    /// The last part of the turn at which ρ is short of the end; `None` where it nowhere is.
    fn last_short(&self, turn: &Turn) -> Option<f64> {
        let count = turn.pieces.len() as f64;
        for (i, piece) in turn.pieces.iter().enumerate().rev() {
            let short = |look: usize| {
                let n = piece.length * look as f64 / LOOKS as f64;
                let rho = piece.coefficients.iter().rev();
                let rho = rho.fold(0.0, |sum, c| sum * n + c);
                self.outward * (self.end - rho) > 0.0
            };
            if let Some(look) = (0..=LOOKS).rev().find(|look| short(*look)) {
                // The next look is not short: up to there it may be.
                let part = (i as f64 + (look + 1) as f64 / LOOKS as f64) / count;
                return Some(part.min(1.0));
            }
        }
        None
    }
}

/// The pieces of a turn up to a part of it.
fn cut(turn: &Turn, part: f64, pieces: &mut Vec<Stretch>) {
    let mut left = part;
    for piece in &turn.pieces {
        if left <= SHORTEST {
            break;
        }
        let length = piece.length.min(left);
        pieces.push(Stretch { length, ..*piece });
        left -= length;
    }
}
