//! The feed strategy `ats`.

use turnpath_plugin::law_limits::{MOST_PIECES, room_beyond};
use turnpath_plugin::prelude::*;

use crate::turn::{Findings, Orientation, Turn, Turns, backwards};

/// Number of parts of a piece. ρ is compared with the end of the range at the points between them.
const PARTS: usize = 32;
/// How far every angle must pass the end of the range, as a part of the nose radius. Between the
/// points that are checked, ρ may fall short by less than this.
const BEYOND: f64 = 2.5e-5;
/// A remaining part of a turn below this is rounding.
const SHORTEST: f64 = 1e-9;
/// Number of turns in each answer.
const BATCH: usize = 8;

/// At every cutting point the feed that keeps the residual there: ℓ(N + 1) = ℓ(N) ± f. X therefore
/// moves back and forth within each turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AtsFeed {
    inward: Inward,
}

/// The kind of an inward law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Inward {
    /// The recursion in the direction of cutting, from the rim's circle.
    #[default]
    Recursion,
    /// The outward law run backwards. It ends on the inner circle at every angle.
    Backwards,
}

const INWARD: Param<Choice> = Param::choice(
    "inward",
    &["recursion", "backwards"],
    "recursion: from the rim's circle, so that fast angles pass the axis; backwards: the outward \
         law run backwards, which begins beyond the rim and closes at the axis",
)
.default("recursion");

impl Strategy for AtsFeed {
    const NAME: &'static str = "ats";
    const SUMMARY: &'static str = "at every cutting point the feed that holds the residual there; X \
        moves back and forth within each turn";
    const SOURCE: &'static str = "Zhu and To 2015, Opt. Express 23, 20234, doi:10.1364/OE.23.020234, from its abstract and \
        from Wang et al. 2019; the law is derived here; large feeds from the exact cusp, as far as \
        neighbouring noses meet within their edges";

    const PARAMS: &'static [ParamInfo] = &[INWARD.info()];

    fn new(params: &Params) -> Result<Self> {
        let inward = match params.get(INWARD) {
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
            planned: 0,
            last: None,
            findings: Findings::default(),
            short: None,
        }))
    }
}

/// A law that is being planned. The next turn needs only the last one.
struct AtsPlan {
    inward: Inward,
    /// Number of turns planned so far.
    planned: usize,
    last: Option<Turn>,
    findings: Findings,
    /// The last part of the last turn at which ρ fell short of the range's end.
    short: Option<f64>,
}

impl FeedPlan for AtsPlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        match (setup.task.direction, self.inward) {
            (Direction::Inward, Inward::Backwards) => {
                let goal = Goal::outward(setup.task, -1.0);
                pieces.extend(backwards(&self.plan_whole(setup, &goal)?));
                Ok(Continuation::End)
            }
            (Direction::Inward, Inward::Recursion) => {
                self.plan_turns(setup, &Goal::inward(setup.task), pieces)
            }
            (Direction::Outward, _) => {
                self.plan_turns(setup, &Goal::outward(setup.task, 1.0), pieces)
            }
        }
    }
}

impl AtsPlan {
    /// Plans all turns up to the goal.
    fn plan_whole(&mut self, setup: Setup<'_>, goal: &Goal) -> Result<Vec<FeedPiece>> {
        let mut law = Vec::new();
        loop {
            let continuation = self.plan_turns(setup, goal, &mut law)?;
            if continuation == Continuation::End {
                return Ok(law);
            }
            // This law reaches the host when it is whole, so the host cannot stop it.
            if law.len() > MOST_PIECES {
                return Err(StrategyError::failed(format!(
                    "planned from its end, the law has more than {MOST_PIECES} pieces; give a larger \
                     residual"
                )));
            }
        }
    }

    /// Plans the next turns.
    fn plan_turns(
        &mut self,
        setup: Setup<'_>,
        goal: &Goal,
        pieces: &mut Vec<FeedPiece>,
    ) -> Result<Continuation> {
        let mut turns = Turns::new(setup, goal.orientation, self.findings);
        for _ in 0..BATCH {
            let turn = turns.turn(self.planned, goal.start, self.last.as_ref())?;
            goal.refuse_far_beyond(&turn)?;
            self.planned += 1;
            let short = goal.last_short(&turn);
            match (self.last.is_some(), short, self.short) {
                // Every angle has passed. The last turn fell short up to some part, and this turn
                // ends at that part.
                (true, None, before) => {
                    append_until(&turn, goal.needed(before.unwrap_or(0.0)), pieces);
                    return Ok(Continuation::End);
                }
                _ => pieces.extend(&turn.pieces),
            }
            (self.last, self.short) = (Some(turn), short);
        }
        self.findings = turns.findings();
        Ok(Continuation::More)
    }
}

/// The circle at which the law begins, and the circle that it must pass.
struct Goal {
    start: f64,
    end: f64,
    /// How far the host lets a law go beyond that circle, mm.
    room: f64,
    orientation: Orientation,
}

impl Goal {
    /// The goal of an outward law. `sense` is that of [`Orientation`].
    fn outward(task: &Task, sense: f64) -> Self {
        Self {
            start: task.range.inner,
            end: task.range.outer + beyond(task),
            room: room_beyond(task),
            orientation: Orientation {
                outward: 1.0,
                sense,
            },
        }
    }

    fn inward(task: &Task) -> Self {
        Self {
            start: task.range.outer,
            end: task.range.inner - beyond(task),
            room: room_beyond(task),
            orientation: Orientation {
                outward: -1.0,
                sense: 1.0,
            },
        }
    }

    /// Refuses a law whose fast angles are far beyond the part before the slow ones have passed its end.
    fn refuse_far_beyond(&self, turn: &Turn) -> Result<()> {
        let mut places = turn.pieces.iter().map(|piece| piece.coefficients[0]);
        let far = |rho: &f64| self.orientation.outward * (rho - self.end) > self.room;
        let Some(rho) = places.find(far) else {
            return Ok(());
        };
        Err(StrategyError::failed(format!(
            "the feed is so much larger at some angles than at others that the path would go to ρ = {rho:.3} mm \
             there before all angles have passed ρ = {:.3} mm; the feed `atpg` is the same at all angles of \
             a radius, and for a smaller nose feeds differ less",
            self.end
        )))
    }

    /// The part of the last turn that the law needs. A law that runs backwards needs the whole
    /// turn, since the path begins there, at θ = 0.
    fn needed(&self, part: f64) -> f64 {
        if self.orientation.sense < 0.0 {
            1.0
        } else {
            part
        }
    }

    /// The last part of the turn at which ρ falls short of the end; `None` if ρ falls short
    /// nowhere.
    fn last_short(&self, turn: &Turn) -> Option<f64> {
        let count = turn.pieces.len() as f64;
        for (i, piece) in turn.pieces.iter().enumerate().rev() {
            let short = |k: usize| {
                let n = piece.length * k as f64 / PARTS as f64;
                let rho = piece.coefficients.iter().rev();
                let rho = rho.fold(0.0, |sum, c| sum * n + c);
                self.orientation.outward * (self.end - rho) > 0.0
            };
            if let Some(k) = (0..=PARTS).rev().find(|k| short(*k)) {
                // ρ reaches the end at the next point. It may fall short up to there.
                let part = (i as f64 + (k + 1) as f64 / PARTS as f64) / count;
                return Some(part.min(1.0));
            }
        }
        None
    }
}

/// How far every angle must pass the range's end, mm.
fn beyond(task: &Task) -> f64 {
    BEYOND * task.tool.nose_radius
}

/// Appends the pieces of a turn up to a part of it.
fn append_until(turn: &Turn, part: f64, pieces: &mut Vec<FeedPiece>) {
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
