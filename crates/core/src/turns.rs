//! Revolutions of the spindle: blocks of them, single turns, and the angle after so many.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// θ after `n` revolutions. The function reduces `n` to one turn before it scales, so that large N
/// keep their digits.
pub fn angle(n: f64) -> f64 {
    TAU * (n - n.floor())
}

/// A block: a range of whole revolutions. Only the path's last block may end with a part of one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Revolutions {
    /// Start of the block in revolutions, included.
    pub start: f64,
    /// End of the block in revolutions, excluded.
    pub end: f64,
}

impl Revolutions {
    /// The revolutions of the block one by one. The path's last one may be a part of a revolution.
    pub fn turns(&self) -> impl Iterator<Item = Turn> + use<> {
        let Revolutions { start, end } = *self;
        let count = (end - start).ceil().max(0.0) as usize;
        (0..count).map(move |i| Turn {
            start: start + i as f64,
            end: (start + (i + 1) as f64).min(end),
        })
    }
}

/// One revolution, or the part of it that belongs to the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Start of the turn in revolutions.
    pub start: f64,
    /// End of the turn in revolutions.
    pub end: f64,
}

impl Turn {
    /// Nodes from the turn's start to its end (excluded), 1/`steps` of a revolution apart.
    ///
    /// `steps` is rounded up to a whole number. If `steps` is NaN or less than 1, the result is a
    /// node that the host refuses.
    pub fn subdivide(&self, steps: f64) -> impl Iterator<Item = f64> + use<> {
        let Turn { start, end } = *self;
        let whole = steps.ceil();
        let usable = (1.0..=MOST_STEPS).contains(&whole);
        let first = if usable { start } else { f64::NAN };
        let length = end - start;
        let count = if usable {
            (length * whole - NODE_SLACK).ceil().max(1.0)
        } else {
            1.0
        };
        (0..count as u64).map(move |i| first + i as f64 / whole)
    }
}

/// The most nodes that [`Turn::subdivide`] gives on a revolution. A larger number is likely a
/// mistake.
const MOST_STEPS: f64 = 1e7;
/// A node that lies closer to the turn's end than this part of a step is left out: it would
/// coincide with the end.
const NODE_SLACK: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_cover_the_block_once() {
        let turns: Vec<Turn> = Revolutions {
            start: 64.0,
            end: 66.25,
        }
        .turns()
        .collect();
        assert_eq!(turns.len(), 3);
        assert_eq!(
            turns[2],
            Turn {
                start: 66.0,
                end: 66.25
            }
        );
    }

    #[test]
    fn a_full_turn_has_as_many_nodes_as_steps() {
        let turn = Turn {
            start: 3.0,
            end: 4.0,
        };
        let nodes: Vec<f64> = turn.subdivide(60.0).collect();
        assert_eq!(nodes.len(), 60);
        assert_eq!(nodes[0], 3.0);
        assert!(nodes[59] < 4.0);
    }

    #[test]
    fn a_part_of_a_turn_keeps_the_step() {
        let turn = Turn {
            start: 3.0,
            end: 3.25,
        };
        let nodes: Vec<f64> = turn.subdivide(60.0).collect();
        assert_eq!(nodes.len(), 15);
        assert_eq!(nodes[1], 3.0 + 1.0 / 60.0);
    }

    #[test]
    fn steps_that_are_no_number_give_a_node_that_is_none() {
        let turn = Turn {
            start: 3.0,
            end: 4.0,
        };
        for steps in [f64::NAN, 0.0, -4.0, f64::INFINITY] {
            assert!(turn.subdivide(steps).all(f64::is_nan));
        }
    }
}
