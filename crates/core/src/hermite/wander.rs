//! Steps whose nodes wander: they fall on other angles from turn to turn.
//!
//! Each segment leaves an error with the same shape. Where a turn has a whole number of steps, the
//! segments of the next turn lie beside it, and their errors stand on the part as spokes. This
//! happens where the largest step divides the turn. It also happens where steps follow the
//! tolerance: their number on a turn changes slowly with the radius, and now and then it is whole
//! for tens of turns.
//!
//! So the number of steps is measured on every turn. Where it would come close to a whole number,
//! steps become a little shorter, and it stays as far from it as [`Wander`] says. Elsewhere steps
//! are as long as they can be: they wander by themselves.

/// The part of a turn's steps by which their number stays off a whole one. Steps are shorter by
/// this part where the largest step divides the turn.
/// Eight steps, those of the default largest step, come round once in [`ROUND`] turns.
const OFF: f64 = 1.0 / (8.0 * ROUND);
/// Turns in which the nodes of steps of one length come round a whole number of times. Then their
/// errors cancel over these turns. A block has as many at the most. Turns of less than eight steps
/// get a part of a round, since a whole one would take more points than [`OFF`].
const ROUND: f64 = 64.0;
/// The nodes come round no more often than this: an eighth of a step from turn to turn.
const MOST_ROUNDS: f64 = 8.0;

/// A turn gets at most so many times the least distance from a whole number. It takes twice that
/// distance to come from below a whole number to above it. Nodes that are drawn to the same angles,
/// because steps are longer there, take more.
const MOST_ADDED: f64 = 4.0;

/// Watches the nodes of one walk, and says by how much its steps must be shortened.
#[derive(Debug, Clone, PartialEq)]
pub struct Wander {
    /// Where steps are counted next, in revolutions; infinite if they never are.
    next: f64,
    /// How many steps the present factor adds to a turn.
    added: f64,
    factor: f64,
}

impl Wander {
    /// For a walk that begins at `start` revolutions; if not `wanted`, steps stay as they are.
    pub fn new(start: f64, wanted: bool) -> Self {
        Self {
            next: match wanted {
                true => start + 1.0,
                false => f64::INFINITY,
            },
            added: 0.0,
            factor: 1.0,
        }
    }

    /// The factor of the steps from here, from 0 to 1.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// Whether a walk that has come to `n` has to [`follow`](Self::follow).
    pub fn is_due(&self, n: f64) -> bool {
        n >= self.next
    }

    /// Counts the steps of the last turn. `nodes` are the nodes of the walk in order, in revolutions;
    /// those more than a turn before the last one may be missing, except for one.
    pub fn follow(&mut self, nodes: &[f64]) {
        let Some((steps, last)) = steps_of_turn(nodes) else {
            return;
        };
        let natural = (steps - self.added).max(1.0);
        let least = rounds(OFF * natural * ROUND) / ROUND;
        let off = steps - steps.round();
        self.added = if off <= -least {
            0.0
        } else {
            (self.added + least - off).clamp(0.0, MOST_ADDED * least)
        };
        self.factor = natural / (natural + self.added);
        self.next = last + 1.0;
    }
}

/// A whole number of rounds if so many can be had, else the part of one that can.
fn rounds(at_most: f64) -> f64 {
    match at_most < 1.0 {
        true => at_most,
        false => at_most.floor().min(MOST_ROUNDS),
    }
}

/// How many steps the turn before the last node has, and the last node. `None` if the nodes do not
/// reach back that far.
fn steps_of_turn(nodes: &[f64]) -> Option<(f64, f64)> {
    let last = *nodes.last()?;
    let after = nodes.partition_point(|node| *node <= last - 1.0);
    let (before, next) = (nodes.get(after.checked_sub(1)?)?, nodes.get(after)?);
    let part = (last - 1.0 - before) / (next - before);
    Some(((nodes.len() - after) as f64 - part, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The nodes of 64 turns of steps that are `length` revolutions long, before they wander.
    fn walk(length: impl Fn(f64) -> f64, wanted: bool) -> Vec<f64> {
        let mut wander = Wander::new(0.0, wanted);
        let mut nodes = vec![0.0];
        while let Some(n) = nodes.last().copied().filter(|n| *n < 64.0) {
            if wander.is_due(n) {
                wander.follow(&nodes);
            }
            nodes.push(n + wander.factor() * length(n));
        }
        nodes
    }

    /// |Σ exp(2πi·step)| over even angles of each turn: 1 if nodes come back to their angles.
    fn coherence(nodes: &[f64]) -> f64 {
        use crate::Scalar;
        let (mut cos, mut sin) = (0.0, 0.0);
        for turn in 0..63 {
            let at = f64::from(turn) + 0.5;
            let after = nodes.partition_point(|node| *node <= at);
            let (before, next) = (nodes[after - 1], nodes[after]);
            let phase = std::f64::consts::TAU * (at - before) / (next - before);
            let (s, c) = Scalar::sin_cos(phase);
            (cos, sin) = (cos + c, sin + s);
        }
        (cos * cos + sin * sin).sqrt() / 63.0
    }

    #[test]
    fn steps_that_divide_the_turn_come_round_evenly_at_half_a_percent_more() {
        for steps in [8.0, 10.0, 36.0] {
            let length = |_: f64| 1.0 / steps;
            let (plain, wandering) = (walk(length, false), walk(length, true));
            assert!(coherence(&plain) > 0.999);
            assert!(coherence(&wandering) < 0.1, "{}", coherence(&wandering));
            let more = wandering.len() as f64 / plain.len() as f64 - 1.0;
            assert!((0.0..=0.005).contains(&more), "{steps}: {more}");
        }
    }

    #[test]
    fn four_steps_on_a_turn_get_a_part_of_a_round_at_half_a_percent_more() {
        let length = |_: f64| 0.25;
        let (plain, wandering) = (walk(length, false), walk(length, true));
        assert!(coherence(&wandering) < 0.7, "{}", coherence(&wandering));
        let more = wandering.len() as f64 / plain.len() as f64 - 1.0;
        assert!((0.0..=0.005).contains(&more), "{more}");
    }

    #[test]
    fn steps_whose_number_becomes_whole_for_a_while_do_not_stand_still() {
        let number = |n: f64| 9.98 + 0.04 * n / 64.0;
        let (plain, wandering) = (
            walk(|n| 1.0 / number(n), false),
            walk(|n| 1.0 / number(n), true),
        );
        assert!(coherence(&plain) > 0.8, "{}", coherence(&plain));
        assert!(coherence(&wandering) < 0.1, "{}", coherence(&wandering));
    }

    #[test]
    fn steps_far_from_a_whole_number_stay_as_they_are() {
        let length = |_: f64| 1.0 / 8.4;
        assert_eq!(walk(length, true), walk(length, false));
    }
}
