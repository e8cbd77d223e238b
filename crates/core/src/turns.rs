//! Revolutions of the spindle: blocks of them, single turns, and the angle after so many.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::registers::{Loop, in_widest};

/// θ after `n` revolutions. The function reduces `n` to one turn before it scales, so that large N
/// keep their digits.
#[inline(always)]
pub fn angle(n: f64) -> f64 {
    TAU * (n - n.floor())
}

/// The angle θ after each of these numbers of revolutions, rad, as [`angle`] gives it. `theta` has the length
/// of `n`.
pub fn angles(n: &[f64], theta: &mut [f64]) {
    in_widest(Angles(n, theta));
}

/// The loop of [`angles`].
struct Angles<'a>(&'a [f64], &'a mut [f64]);

impl Loop for Angles<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (theta, n) in self.1.iter_mut().zip(self.0) {
            *theta = angle(*n);
        }
    }
}

/// So many angles, evenly over a turn from 0 on, rad.
pub fn even_angles(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |number| TAU * number as f64 / count as f64)
}

/// An angle without its whole turns, in 0 to 2π: the same double as `c.rem_euclid(TAU)`, without the
/// division that takes longer the more turns there are.
pub fn within_turn(c: f64) -> f64 {
    match (0.0..=LARGEST_ANGLE).contains(&c) {
        true => rest_of_turns(c),
        false => c.rem_euclid(TAU),
    }
}

/// Takes the whole turns off each angle, as [`within_turn`] does.
pub fn within_turns(angles: &mut [f64]) {
    match in_widest(AreReducible(angles)) {
        true => in_widest(Turns(angles)),
        false => angles.iter_mut().for_each(|c| *c = within_turn(*c)),
    }
}

/// The loop that finds out whether [`rest_of_turns`] holds for all angles.
struct AreReducible<'a>(&'a [f64]);

impl Loop for AreReducible<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let angles = self.0.iter();
        angles.fold(true, |all, c| all & (0.0 <= *c) & (*c <= LARGEST_ANGLE))
    }
}

/// The loop of [`within_turns`].
struct Turns<'a>(&'a mut [f64]);

impl Loop for Turns<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for c in self.0 {
            *c = rest_of_turns(*c);
        }
    }
}

/// What whole turns leave of an angle of 0 to [`LARGEST_ANGLE`].
#[inline(always)]
fn rest_of_turns(c: f64) -> f64 {
    let rest = |turns: f64| (c - turns * TAU_HIGH) - turns * TAU_LOW;
    // The nearest whole number: the turns, or one more of them.
    let turns = (c * TURNS_PER_RAD + TO_WHOLE) - TO_WHOLE;
    match rest(turns) {
        below if below < 0.0 => rest(turns - 1.0),
        within => within,
    }
}

/// Up to here products of a number of turns with both halves of 2π are exact, and so is what they
/// leave of an angle: a multiple of 2⁻⁵⁰ below 8. It is more than the longest path turns.
const LARGEST_ANGLE: f64 = 1e8;
const TURNS_PER_RAD: f64 = 1.0 / TAU;
/// Adding this rounds a number to a whole one.
const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
/// The upper 26 bits of 2π.
const TAU_HIGH: f64 = f64::from_bits(TAU.to_bits() >> 27 << 27);
/// The lower 27 bits.
const TAU_LOW: f64 = TAU - TAU_HIGH;

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
    /// `steps` is rounded up to a whole number. If `steps` is NaN, less than 1 or more than [`MOST_STEPS_OF_TURN`], the
    /// result is a node that is NaN, which the host refuses.
    pub fn subdivide(&self, steps: f64) -> impl Iterator<Item = f64> + use<> {
        let Turn { start, end } = *self;
        let whole = steps.ceil();
        let usable = (1.0..=MOST_STEPS_OF_TURN).contains(&whole);
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
pub const MOST_STEPS_OF_TURN: f64 = 1e7;
/// A node that lies closer to the turn's end than this part of a step is left out: it would
/// coincide with the end.
const NODE_SLACK: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_many_are_those_of_each() {
        let n: Vec<f64> = (0..37).map(|k| 0.37 * f64::from(k * k) - 2.0).collect();
        let mut theta = vec![0.0; n.len()];
        angles(&n, &mut theta);
        let each: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
        assert_eq!(theta, each);
    }

    /// Angles at and beside whole turns, and in between, up to beyond the largest.
    #[test]
    fn an_angle_within_a_turn_is_the_remainder_to_the_last_bit() {
        let (mut turns, mut angles) = (0.0_f64, Vec::new());
        while turns < 3e7 {
            for part in [0.0, 1e-9, 0.1, 0.25, 0.5, 0.79, 0.999_999_999] {
                let c = TAU * (turns + part);
                for c in [c.next_down().next_down(), c.next_down(), c, c.next_up(), -c] {
                    let (fast, exact) = (within_turn(c), c.rem_euclid(TAU));
                    assert_eq!(fast.to_bits(), exact.to_bits(), "{c:e}");
                    angles.push(c);
                }
            }
            turns = (turns * 1.003).floor() + 1.0;
        }
        // Batches with angles that are not reducible, and without.
        let reducible: Vec<f64> = angles
            .iter()
            .copied()
            .filter(|c| (0.0..1e8).contains(c))
            .collect();
        for angles in [angles, reducible] {
            let mut reduced = angles.clone();
            within_turns(&mut reduced);
            for (c, reduced) in angles.iter().zip(reduced) {
                assert_eq!(reduced.to_bits(), c.rem_euclid(TAU).to_bits(), "{c:e}");
            }
        }
        assert!(within_turn(f64::NAN).is_nan() && within_turn(f64::INFINITY).is_nan());
    }

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
