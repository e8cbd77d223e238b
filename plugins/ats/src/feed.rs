//! The feed strategy `ats`.

use turnpath_plugin::locus::LARGEST_FEED;
use turnpath_plugin::prelude::*;

use crate::turn::{Turn, Turns, Way, backwards};

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AtsFeed {
    inward: Inward,
}

/// What an inward law is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Inward {
    /// The recursion in the direction of cutting, from the rim's circle.
    #[default]
    Recursion,
    /// The outward law backwards, which ends on the inner circle at every angle.
    Backwards,
}

impl Strategy for AtsFeed {
    const NAME: &'static str = "ats";
    const SUMMARY: &'static str = "at every cutting point the feed that holds the residual there; X \
        moves back and forth within each turn";
    const SOURCE: &'static str = "Zhu and To 2015, Opt. Express 23, 20234, from its abstract and \
        from Wang et al. 2019; the law is derived here";

    const PARAMS: &'static [Param] = &[Param::choice(
        "inward",
        &["recursion", "backwards"],
        "recursion: from the rim's circle, so that fast angles pass the axis; backwards: the outward \
         law run backwards, which begins beyond the rim and closes at the axis",
    )
    .default_choice("recursion")];

    fn new(params: &Params) -> Result<Self> {
        let inward = match params.choice("inward") {
            "backwards" => Inward::Backwards,
            _ => Inward::Recursion,
        };
        Ok(Self { inward })
    }
}

impl FeedStrategy for AtsFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.task.range;
        if !(inner.is_finite() && outer.is_finite() && inner < outer) {
            return Err(StrategyError::failed(format!(
                "there is nothing to cut: ρ runs from {inner} mm to {outer} mm"
            )));
        }
        Ok(Box::new(AtsPlan {
            inward: self.inward,
            made: 0,
            last: None,
            count: None,
            short: None,
        }))
    }
}

/// The law as far as it has come: one turn is all that the next one needs.
struct AtsPlan {
    inward: Inward,
    /// How many turns are made.
    made: usize,
    last: Option<Turn>,
    /// Pieces that the next turn should try.
    count: Option<usize>,
    /// Where in the last turn ρ last fell short of the range's end, in parts of it.
    short: Option<f64>,
}

impl FeedPlan for AtsPlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        match (setup.task.direction, self.inward) {
            (Direction::Inward, Inward::Backwards) => {
                let goal = Goal::outward(setup.task, -1.0);
                let mut law = Vec::new();
                while self.further(setup, &goal, &mut law)? == Continuation::More {}
                pieces.extend(backwards(&law));
                Ok(Continuation::End)
            }
            (Direction::Inward, Inward::Recursion) => {
                self.further(setup, &Goal::inward(setup.task), pieces)
            }
            (Direction::Outward, _) => self.further(setup, &Goal::outward(setup.task, 1.0), pieces),
        }
    }
}

impl AtsPlan {
    /// Some turns more.
    fn further(
        &mut self,
        setup: Setup<'_>,
        goal: &Goal,
        pieces: &mut Vec<FeedPiece>,
    ) -> Result<Continuation> {
        let mut turns = Turns::new(setup, goal.way, self.count);
        for _ in 0..BATCH {
            let turn = turns.turn(self.made, goal.start, self.last.as_ref())?;
            self.made += 1;
            let short = goal.last_short(&turn);
            match (self.last.is_some(), short, self.short) {
                // Every angle has passed: the turn that began where the last fell short ends it.
                (true, None, before) => {
                    cut(&turn, goal.needed(before.unwrap_or(0.0)), pieces);
                    return Ok(Continuation::End);
                }
                _ => pieces.extend(&turn.pieces),
            }
            (self.last, self.short) = (Some(turn), short);
        }
        self.count = Some(turns.count());
        Ok(Continuation::More)
    }
}

/// Which circle the law goes to, and from which.
struct Goal {
    start: f64,
    end: f64,
    way: Way,
}

impl Goal {
    /// `sense` as in [`Way`].
    fn outward(task: &Task, sense: f64) -> Self {
        Self {
            start: task.range.inner,
            end: task.range.outer + beyond(task),
            way: Way {
                outward: 1.0,
                sense,
            },
        }
    }

    fn inward(task: &Task) -> Self {
        Self {
            start: task.range.outer,
            end: task.range.inner - beyond(task),
            way: Way {
                outward: -1.0,
                sense: 1.0,
            },
        }
    }

    /// Which part of the last turn is wanted: all of it where the path begins there, at θ = 0.
    fn needed(&self, part: f64) -> f64 {
        if self.way.sense < 0.0 { 1.0 } else { part }
    }

    /// The last part of the turn at which ρ is short of the end; `None` where it nowhere is.
    fn last_short(&self, turn: &Turn) -> Option<f64> {
        let count = turn.pieces.len() as f64;
        for (i, piece) in turn.pieces.iter().enumerate().rev() {
            let short = |look: usize| {
                let n = piece.length * look as f64 / LOOKS as f64;
                let rho = piece.coefficients.iter().rev();
                let rho = rho.fold(0.0, |sum, c| sum * n + c);
                self.way.outward * (self.end - rho) > 0.0
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

/// How far beyond the range's end every angle must come, mm.
fn beyond(task: &Task) -> f64 {
    BEYOND * LARGEST_FEED * task.tool.nose_radius
}

/// The pieces of a turn up to a part of it.
fn cut(turn: &Turn, part: f64, pieces: &mut Vec<FeedPiece>) {
    let mut left = part;
    for piece in &turn.pieces {
        if left <= SHORTEST {
            break;
        }
        let length = piece.length.min(left);
        pieces.push(FeedPiece { length, ..*piece });
        left -= length;
    }
}
