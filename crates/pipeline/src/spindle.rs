//! The spindle law: the spindle strategy plans it, and the host checks it.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use turnpath_core::law_limits::STEADY_REVOLUTIONS;
use turnpath_core::{Path, Piece, PiecewisePolynomial, SpindleAsk, SpindleLaw, SpiralLaw};

use crate::{Chain, Preparation, Result};

/// By how much the law may end before the path, in revolutions: the rounding of its lengths.
const END_SLACK: f64 = 1e-9;
/// By how much t may jump at a knot, as a part of a revolution's time.
const TIME_JUMP: f64 = 1e-9;
/// By how much t may jump at a knot, as a part of itself: its rounding. At high speeds it is more than
/// the part of a revolution's time.
const TIME_ROUNDING: f64 = 16.0 * f64::EPSILON;
/// By how much the speed may jump at a knot, or exceed its bound, as a part of itself.
const SPEED_JUMP: f64 = 1e-9;
/// By how much the change of the speed over a revolution may jump at a knot, as a part of the speed.
const CHANGE_JUMP: f64 = 1e-6;
/// How often a piece is divided in the search for its highest speed: down to a millionth of it.
const MOST_DIVISIONS: usize = 20;

/// The spindle law of a path. `factors` are those of [`SpindleAsk`].
pub fn plan(
    chain: &Chain,
    preparation: &Preparation,
    law: &SpiralLaw,
    factors: &[f64],
) -> Result<SpindleLaw> {
    let Preparation { task, locus, .. } = preparation;
    let speed = task.spindle_speed;
    let path = Path {
        task,
        locus,
        law,
        spindle: &SpindleLaw::constant(speed),
    };
    let link = &chain.spindle;
    let planned = link.strategy.plan(&path, &SpindleAsk { speed, factors });
    let spindle = planned.map_err(|error| link.failed("while it planned the speed", error))?;
    let check = SpindleCheck {
        time: spindle.as_time(),
        end: law.end(),
        speed,
    };
    check.check().map_err(|what| link.bad_answer(what))?;
    Ok(spindle)
}

/// What the host requires of a spindle law.
struct SpindleCheck<'a> {
    time: &'a PiecewisePolynomial,
    /// The path's end, in revolutions.
    end: f64,
    /// The largest speed, rad/s.
    speed: f64,
}

/// What is wrong with a law, if anything is.
type CheckResult = std::result::Result<(), String>;

impl SpindleCheck<'_> {
    fn check(&self) -> CheckResult {
        self.check_range()?;
        for piece in self.pieces() {
            self.check_speed(piece)?;
            self.check_knot(piece.start)?;
        }
        self.check_steady(0.0..=STEADY_REVOLUTIONS.min(self.end))?;
        self.check_steady((self.end - STEADY_REVOLUTIONS).max(0.0)..=self.end)
    }

    /// The pieces that the path uses.
    fn pieces(&self) -> impl Iterator<Item = &Piece> {
        let within = |piece: &&Piece| piece.start < self.end;
        self.time.pieces().iter().take_while(within)
    }

    /// A revolution's time at the largest speed, s.
    fn least_period(&self) -> f64 {
        TAU / self.speed
    }

    fn check_range(&self) -> CheckResult {
        let mut next = 0.0;
        for (i, piece) in self.time.pieces().iter().enumerate() {
            let is_next = match i {
                0 => piece.start == 0.0,
                _ => piece.start > next && piece.start.is_finite(),
            };
            if !is_next {
                return Err(format!(
                    "piece {i} of t begins at {} revolutions, after {next}",
                    piece.start
                ));
            }
            next = piece.start;
        }
        let finite = |piece: &Piece| piece.coefficients.iter().all(|c| c.is_finite());
        if let Some(piece) = self.time.pieces().iter().find(|piece| !finite(piece)) {
            let Piece {
                start,
                coefficients,
            } = piece;
            return Err(format!(
                "t has the coefficients {coefficients:?} {}",
                at(*start)
            ));
        }
        if self.time.pieces().is_empty() {
            return Err("a law without pieces".to_owned());
        }
        if !within(self.end - END_SLACK, self.time.end()) {
            return Err(format!(
                "the law ends after {:.3} revolutions, and the path after {:.3}",
                self.time.end(),
                self.end
            ));
        }
        let begin = self.time.value(0.0);
        if !within(begin.abs(), TIME_JUMP * self.least_period()) {
            return Err(format!("the law begins at t = {begin} s, not at 0"));
        }
        Ok(())
    }

    fn check_knot(&self, n: f64) -> CheckResult {
        if n <= 0.0 {
            return Ok(());
        }
        let (before, after) = (self.time.series_before(n), self.time.series(n));
        let jump = |order: usize| (after[order] - before[order]).abs();
        let rounding = TIME_ROUNDING * before[0].abs();
        if !within(jump(0), TIME_JUMP * self.least_period() + rounding) {
            return Err(format!(
                "t jumps from {} s to {} s {}",
                before[0],
                after[0],
                at(n)
            ));
        }
        if !within(jump(1), SPEED_JUMP * before[1].abs()) {
            let [from, to] = [before[1], after[1]].map(rpm);
            return Err(format!("the speed jumps from {from} to {to} {}", at(n)));
        }
        if !within(2.0 * jump(2), CHANGE_JUMP * before[1].abs()) {
            return Err(format!("the acceleration of the spindle jumps {}", at(n)));
        }
        Ok(())
    }

    /// Checks that dt/dN is nowhere below that of the largest speed.
    fn check_speed(&self, piece: &Piece) -> CheckResult {
        let next = self
            .time
            .pieces()
            .partition_point(|other| other.start <= piece.start);
        let end = self
            .time
            .pieces()
            .get(next)
            .map_or(self.end, |next| next.start);
        let length = end.min(self.end) - piece.start;
        let rate = bernstein(piece, length);
        let least = self.least_period() * (1.0 - SPEED_JUMP);
        let Some((part, rate)) = below(rate, least, MOST_DIVISIONS) else {
            return Ok(());
        };
        let place = at(piece.start + part * length);
        if !within(f64::MIN_POSITIVE, rate) {
            return Err(format!("t does not grow {place}"));
        }
        let [speed, most] = [rate, self.least_period()].map(rpm);
        Err(format!(
            "a speed of {speed} {place}; at most {most} are allowed"
        ))
    }

    /// Checks that the speed is the same all over a range. Within a piece, dt/dN is a polynomial of
    /// degree 4: it is constant if it has one value at five places.
    fn check_steady(&self, range: RangeInclusive<f64>) -> CheckResult {
        let (from, to) = (*range.start(), *range.end());
        let mut borders = vec![from];
        borders.extend(self.time.knots(from, to));
        borders.push(to);
        let steady = self.time.rate(from);
        for pair in borders.windows(2) {
            for i in 0..5 {
                let n = pair[0] + (pair[1] - pair[0]) * f64::from(i) / 4.0;
                let rate = self.time.rate(n);
                if !within((rate - steady).abs(), SPEED_JUMP * steady) {
                    let [here, there] = [rate, steady].map(rpm);
                    return Err(format!(
                        "the speed must be constant from {from:.3} to {to:.3} revolutions, where a \
                         lead joins; it is {here} {} and {there} {}",
                        at(n),
                        at(from)
                    ));
                }
            }
        }
        Ok(())
    }
}

/// Whether an amount is at most `most`. It is not if either is NaN.
fn within(amount: f64, most: f64) -> bool {
    amount <= most
}

fn at(n: f64) -> String {
    format!("at {n:.3} revolutions")
}

/// The speed of a dt/dN, for messages.
fn rpm(rate: f64) -> String {
    format!("{:.4} rpm", 60.0 / rate)
}

/// dt/dN over the first `length` revolutions of a piece, as its coefficients after Bernstein. The
/// smallest of them is a lower bound, and the first and the last are the values at the ends.
fn bernstein(piece: &Piece, length: f64) -> [f64; 5] {
    let mut power = [0.0; 5];
    let mut scale = 1.0;
    for (i, power) in power.iter_mut().enumerate() {
        *power = (i + 1) as f64 * piece.coefficients[i + 1] * scale;
        scale *= length;
    }
    let binomial =
        |n: usize, k: usize| (0..k).fold(1.0, |all, i| all * (n - i) as f64 / (i + 1) as f64);
    std::array::from_fn(|j| {
        let term = |i: usize| power[i] * binomial(j, i) / binomial(4, i);
        (0..=j).map(term).sum()
    })
}

/// A place, 0 to 1, where a polynomial lies below `least` or is no number, with its value; `None` if
/// there is none.
fn below(coefficients: [f64; 5], least: f64, divisions: usize) -> Option<(f64, f64)> {
    for (place, value) in [(0.0, coefficients[0]), (1.0, coefficients[4])] {
        if !within(least, value) {
            return Some((place, value));
        }
    }
    if divisions == 0 || coefficients.iter().all(|c| *c >= least) {
        return None;
    }
    let [first, second] = halves(coefficients);
    let in_first = below(first, least, divisions - 1);
    let in_second = || below(second, least, divisions - 1);
    in_first
        .map(|(place, value)| (0.5 * place, value))
        .or_else(|| in_second().map(|(place, value)| (0.5 + 0.5 * place, value)))
}

/// The two halves of a polynomial, after de Casteljau.
fn halves(mut coefficients: [f64; 5]) -> [[f64; 5]; 2] {
    let (mut first, mut second) = ([0.0; 5], [0.0; 5]);
    for i in 0..5 {
        first[i] = coefficients[0];
        second[4 - i] = coefficients[4 - i];
        for j in 0..4 - i {
            coefficients[j] = 0.5 * (coefficients[j] + coefficients[j + 1]);
        }
    }
    [first, second]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a second for a revolution: 240 rpm.
    const PERIOD: f64 = 0.25;

    fn check(time: &PiecewisePolynomial) -> CheckResult {
        SpindleCheck {
            time,
            end: 10.0,
            speed: TAU / PERIOD,
        }
        .check()
    }

    /// A law of these pieces: length, t, dt/dN, and the further coefficients.
    fn law<const N: usize>(pieces: [(f64, [f64; 6]); N]) -> PiecewisePolynomial {
        let mut time = PiecewisePolynomial::new();
        for (length, coefficients) in pieces {
            time.push(length, coefficients);
        }
        time
    }

    fn straight(t: f64, rate: f64) -> [f64; 6] {
        [t, rate, 0.0, 0.0, 0.0, 0.0]
    }

    /// From the largest speed to half of it between 4 and 6 revolutions.
    fn slowing() -> PiecewisePolynomial {
        let (from, to) = ([1.0, PERIOD, 0.0], [1.75, 2.0 * PERIOD, 0.0]);
        law([
            (4.0, straight(0.0, PERIOD)),
            (2.0, turnpath_core::quintic(from, to, 2.0)),
            (4.0, straight(1.75, 2.0 * PERIOD)),
        ])
    }

    #[track_caller]
    fn refused(time: &PiecewisePolynomial, parts: &[&str]) {
        let message = check(time).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn a_constant_and_a_smooth_law_pass() {
        assert_eq!(check(SpindleLaw::constant(TAU / PERIOD).as_time()), Ok(()));
        assert_eq!(check(&slowing()), Ok(()));
    }

    #[test]
    fn a_law_that_is_too_short_or_begins_late_is_refused() {
        refused(&PiecewisePolynomial::new(), &["without pieces"]);
        refused(&law([(9.0, straight(0.0, PERIOD))]), &["9.000", "10.000"]);
        refused(
            &law([(10.0, straight(1.0, PERIOD))]),
            &["begins at t = 1 s"],
        );
        refused(
            &law([(10.0, straight(0.0, f64::NAN))]),
            &["NaN", "at 0.000"],
        );
    }

    #[test]
    fn pieces_that_do_not_follow_each_other_are_refused() {
        for starts in [[1.0, 2.0], [0.0, f64::NAN], [0.0, 0.0], [0.0, -1.0]] {
            let pieces = starts.map(|start| Piece {
                start,
                coefficients: straight(PERIOD * start, PERIOD),
            });
            let time = PiecewisePolynomial::from_pieces(pieces.to_vec(), 10.0);
            refused(&time, &["begins at"]);
        }
        let piece = Piece {
            start: 0.0,
            coefficients: straight(0.0, PERIOD),
        };
        let endless = PiecewisePolynomial::from_pieces(vec![piece], f64::NAN);
        refused(&endless, &["ends after NaN"]);
    }

    /// Each coefficient is a number, and their sum is none.
    #[test]
    fn a_law_that_overflows_is_refused_at_once() {
        let huge = [0.0, PERIOD, f64::MAX, -f64::MAX, f64::MAX, f64::MAX];
        refused(&law([(10.0, huge)]), &["at 10.000"]);
    }

    #[test]
    fn jumps_are_refused_with_their_place() {
        let two = |rest| law([(5.0, straight(0.0, PERIOD)), (5.0, rest)]);
        let time = two(straight(1.3, PERIOD));
        refused(
            &time,
            &["t jumps from 1.25 s to 1.3 s at 5.000 revolutions"],
        );
        let speed = two(straight(1.25, 2.0 * PERIOD));
        refused(&speed, &["from 240.0000 rpm to 120.0000 rpm at 5.000"]);
        let bend = two([1.25, PERIOD, 0.01, 0.0, 0.0, 0.0]);
        refused(&bend, &["acceleration of the spindle jumps at 5.000"]);
    }

    /// After 5000 s a double has steps of 9e-13 s, far more than a billionth of a short turn.
    #[test]
    fn a_jump_by_the_rounding_of_t_passes_at_any_largest_speed() {
        let next = f64::from_bits(5000f64.to_bits() + 1);
        let of = |t| law([(5.0, straight(0.0, 1000.0)), (5.0, straight(t, 1000.0))]);
        let check = |time: &PiecewisePolynomial| {
            let speed = TAU / 1e-7;
            let end = 10.0;
            SpindleCheck { time, end, speed }.check()
        };
        assert_eq!(check(&of(next)), Ok(()));
        assert!(check(&of(5000.0 + 1e-9)).is_err());
    }

    #[test]
    fn a_speed_beyond_the_bound_is_found_within_a_piece() {
        refused(
            &law([(10.0, straight(0.0, 0.99 * PERIOD))]),
            &["242.4242 rpm", "at most 240.0000"],
        );
        refused(
            &law([(10.0, straight(0.0, -PERIOD))]),
            &["t does not grow at 0.000"],
        );
        // Both ends of the piece keep to the bound, and its middle does not.
        let (from, to) = ([1.0, 2.0 * PERIOD, 0.0], [1.66, 2.0 * PERIOD, 0.0]);
        let dips = law([
            (2.0, straight(0.0, 2.0 * PERIOD)),
            (2.0, turnpath_core::quintic(from, to, 2.0)),
            (6.0, straight(1.66, 2.0 * PERIOD)),
        ]);
        refused(&dips, &["rpm at 3.000", "at most 240.0000 rpm"]);
    }

    #[test]
    fn the_spindle_is_steady_where_leads_join() {
        let ramp = turnpath_core::quintic([0.0, PERIOD, 0.0], [1.0, 1.5 * PERIOD, 0.0], 3.0);
        let begins = law([(3.0, ramp), (7.0, straight(1.0, 1.5 * PERIOD))]);
        refused(&begins, &["from 0.000 to 0.500"]);
        let end = turnpath_core::quintic([1.75, PERIOD, 0.0], [2.7, 1.5 * PERIOD, 0.0], 3.0);
        let ends = law([(7.0, straight(0.0, PERIOD)), (3.0, end)]);
        refused(&ends, &["from 9.500 to 10.000"]);
    }
}
