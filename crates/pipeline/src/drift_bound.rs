//! A bound of X's own error from the control points alone, where the law is a line and is that of the nose's centre.
//!
//! There X of the true path is a line against C too. So X's error along a segment is the cubic through the
//! errors of its ends, and needs no look at the law within it.

use std::f64::consts::TAU;

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Locus, Radial, SpiralLaw};

use crate::plan::Plan;

/// The largest value of s (1 − s)². An error of the rate at one end, times the duration, gives an error of at most
/// this part within the segment.
const RATE_SHARE: f64 = 4.0 / 27.0;
/// The part of what is allowed up to which the bound decides. Rounding is far below the rest.
const DECIDED_PART: f64 = 0.9;

/// The segments whose X error may exceed this part of the distance between passes, in their order. All of
/// them, where the law is no line.
pub(crate) fn undecided_segments(plan: &Plan<'_>, points: &PathBlock, part: f64) -> Vec<usize> {
    let is_of_centre = plan.preparation.locus.radial() == Radial::Centre;
    let line = LawLine::over(&plan.law, plan.start.turns, points).filter(|_| is_of_centre);
    match line {
        Some(line) => line.undecided(points, part),
        None => (0..points.len().saturating_sub(1)).collect(),
    }
}

/// The law of a block and of a turn on each side: a line against the turns of C since its zero.
struct LawLine {
    /// X at C = 0, mm.
    value: f64,
    /// mm/rev.
    rate: f64,
}

impl LawLine {
    /// The line of the law over the turns of a block, on which C grows. `None` if the law is no line there. The path
    /// begins with so many turns of C.
    fn over(law: &SpiralLaw, start_turns: f64, points: &PathBlock) -> Option<Self> {
        let n = |c: &f64| c / TAU - start_turns;
        let (first, last) = (n(points.c.first()?), n(points.c.last()?));
        let [value, rate] = law.line_over(first - 1.0, last + 1.0)?;
        Some(Self {
            value: value - rate * start_turns,
            rate,
        })
    }

    /// The segments whose X error may exceed this part of the rate.
    fn undecided(&self, points: &PathBlock, part: f64) -> Vec<usize> {
        let most = DECIDED_PART * part * self.rate.abs();
        let mut undecided = Vec::new();
        let mut from = self.errors(points, 0);
        for number in 0..points.len().saturating_sub(1) {
            let to = self.errors(points, number + 1);
            let duration = points.t[number + 1] - points.t[number];
            let error = largest_error([from, to], duration);
            if error.is_nan() || error > most {
                undecided.push(number);
            }
            from = to;
        }
        undecided
    }

    /// By how much X and its velocity differ from those of the line at a control point, mm and mm/s.
    fn errors(&self, points: &PathBlock, index: usize) -> [f64; 2] {
        let x = self.value + self.rate * (points.c[index] / TAU);
        let vx = self.rate * (points.vc[index] / TAU);
        [(points.x[index] - x).abs(), (points.vx[index] - vx).abs()]
    }
}

/// A bound of the error within a segment, mm. The two ends have these amounts of the error, mm, and of its rate,
/// mm/s.
fn largest_error([from, to]: [[f64; 2]; 2], duration: f64) -> f64 {
    from[0].max(to[0]) + RATE_SHARE * duration * (from[1] + to[1])
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::{ControlPoint, Cubic};

    use super::*;

    /// Errors and rates of all signs at both ends.
    #[test]
    fn no_error_within_a_segment_exceeds_the_bound_and_some_reach_it() {
        let values = [-3.0, -1.0, 0.0, 0.5, 2.0];
        let each = || values.into_iter().flat_map(|e| values.map(|v| [e, v]));
        let mut nearest = 0.0_f64;
        for (from, to) in each().flat_map(|from| each().map(move |to| (from, to))) {
            for duration in [0.25, 3.0] {
                let cubic = Cubic::hermite(from[0], from[1], to[0], to[1], duration);
                let errors = (0..=300).map(|k| cubic.value(f64::from(k) / 300.0).abs());
                let largest = errors.fold(0.0, f64::max);
                let bound = largest_error([from.map(f64::abs), to.map(f64::abs)], duration);
                assert!(largest <= bound + 1e-12, "{from:?} {to:?} {duration}");
                if from[0] == 0.0 && to == [0.0; 2] && bound > 0.0 {
                    nearest = nearest.max(largest / bound);
                }
            }
        }
        assert!(nearest > 0.9999);
    }

    /// Points of a path that begins with three turns of C: 5 mm, inward by 0.01 mm a turn.
    fn points(law: &SpiralLaw) -> PathBlock {
        let mut points = PathBlock::default();
        for i in 0..50 {
            let n = 20.0 + 0.02 * f64::from(i);
            points.push(ControlPoint {
                t: 0.1 * n,
                c: TAU * (n + 3.0),
                x: law.value(n),
                vc: TAU / 0.1,
                vx: law.rate(n) / 0.1,
                ..ControlPoint::default()
            });
        }
        points
    }

    #[test]
    fn exact_points_are_decided_and_those_that_moved_are_not() {
        let mut law = SpiralLaw::new();
        law.push(100.0, [5.0, -0.01, 0.0, 0.0, 0.0, 0.0]);
        let mut points = points(&law);
        let line = LawLine::over(&law, 3.0, &points).unwrap();
        assert!(line.undecided(&points, 1e-4).is_empty());
        points.x[7] += 2e-6;
        points.vx[30] -= 1e-2;
        points.vc[40] = f64::NAN;
        assert_eq!(line.undecided(&points, 1e-4), [6, 7, 29, 30, 39, 40]);
    }

    #[test]
    fn a_law_that_bends_within_a_turn_of_the_block_is_no_line() {
        let mut law = SpiralLaw::new();
        law.push(21.5, [5.0, -0.01, 0.0, 0.0, 0.0, 0.0]);
        law.push(50.0, [4.785, -0.01, 1e-4, 0.0, 0.0, 0.0]);
        assert!(LawLine::over(&law, 3.0, &points(&law)).is_none());
    }
}
