//! The motion of the axes turn by turn, and what the path is like there.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment, SegmentShape};

use crate::axes::AxesMotion;

/// Most entries of a path: a picture is not as wide in points.
const MOST: usize = 1024;
/// The first point of a turn may lie below its beginning by this part of a turn, by rounding of C.
const ROUNDING: f64 = 1e-9;

/// A place of the path at which C is a whole number of turns. X swings within a turn, so only such
/// places say how far it went.
#[derive(Debug, Clone, Copy, PartialEq)]
struct WholeTurn {
    number: i64,
    /// X as played, mm.
    x: f64,
}

/// Halvings of a segment that find a whole turn to the last digit of C.
const HALVINGS: usize = 60;

impl WholeTurn {
    /// Those that a segment passes.
    fn of(segment: &Segment) -> impl Iterator<Item = Self> {
        let [from, to] = [0.0, 1.0].map(|at| segment.c.value(at) / TAU);
        let numbers = (from - ROUNDING).ceil() as i64..=(to + ROUNDING).floor() as i64;
        numbers.map(move |number| Self {
            number,
            x: segment.x.value(place_of(segment, TAU * number as f64)),
        })
    }
}

/// Where on a segment C has a value: C grows along it.
fn place_of(segment: &Segment, c: f64) -> f64 {
    let (mut below, mut above) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (below + above);
        match segment.c.value(middle) < c {
            true => below = middle,
            false => above = middle,
        }
    }
    0.5 * (below + above)
}

/// One turn, or some neighbouring ones: the segments that begin in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnMotion {
    /// The turn, C / 2π rounded down, or the first of the turns.
    first: i64,
    /// C from the first point to the end of the last segment, rad.
    travel: f64,
    /// ∫ X dC, mm rad.
    moment: f64,
    /// The first and the last whole turn that the part of the path passes.
    whole: Option<[WholeTurn; 2]>,
    time: f64,
    segments: u64,
    /// Largest |played − true|, mm.
    pub error: f64,
    /// How the axes move.
    pub axes: AxesMotion,
}

impl TurnMotion {
    fn begin(turn: i64) -> Self {
        Self {
            first: turn,
            travel: 0.0,
            moment: 0.0,
            whole: None,
            time: 0.0,
            segments: 0,
            error: 0.0,
            axes: AxesMotion::default(),
        }
    }

    fn include(&mut self, segment: &Segment, shape: SegmentShape, error: f64) {
        let travel = segment.c.value(1.0) - segment.c.value(0.0);
        let x = [segment.x.value(0.0), segment.x.value(1.0)];
        self.travel += travel;
        self.moment += 0.5 * (x[0] + x[1]) * travel;
        WholeTurn::of(segment).for_each(|whole| self.pass([whole; 2]));
        self.time += segment.duration;
        self.segments += 1;
        self.error = self.error.max(error);
        self.axes.include(segment, shape);
    }

    /// Joins the part of the path that follows.
    fn join(&mut self, next: &Self) {
        self.travel += next.travel;
        self.moment += next.moment;
        next.whole.into_iter().for_each(|whole| self.pass(whole));
        self.time += next.time;
        self.segments += next.segments;
        self.error = self.error.max(next.error);
        self.axes.append(&next.axes);
    }

    /// Passes whole turns, from the first to the last.
    fn pass(&mut self, [first, last]: [WholeTurn; 2]) {
        let [known, _] = self.whole.unwrap_or([first; 2]);
        let before = if first.number < known.number {
            first
        } else {
            known
        };
        self.whole = Some([before, last]);
    }

    /// Begins at the whole turn at which the part before ended.
    fn follow(&mut self, before: &Self) {
        let Some([_, last]) = before.whole.filter(|[_, last]| last.number == self.first) else {
            return;
        };
        let end = self.whole.map_or(last, |[_, end]| end);
        self.whole = Some([last, end]);
    }

    /// The mean X, mm.
    pub fn radius(&self) -> f64 {
        self.moment / self.travel
    }

    /// How far X goes in a turn, from whole turn to whole turn, mm; not a number on a part that has
    /// not a whole turn.
    pub fn feed(&self) -> f64 {
        let Some([first, last]) = self.whole else {
            return f64::NAN;
        };
        let turns = (last.number - first.number) as f64;
        (last.x - first.x).abs() / turns
    }

    /// Control points in a turn.
    pub fn points_per_turn(&self) -> f64 {
        self.segments as f64 / self.turns()
    }

    /// The mean speed of the spindle, rad/s.
    pub fn spindle(&self) -> f64 {
        self.travel / self.time
    }

    fn turns(&self) -> f64 {
        self.travel / TAU
    }
}

/// The turns of a path in their order. Neighbouring ones are joined as the path grows.
#[derive(Debug, Clone)]
pub(super) struct TurnLog {
    entries: Vec<TurnMotion>,
    /// Turns of an entry: those from a multiple of this number on.
    stride: i64,
}

impl Default for TurnLog {
    fn default() -> Self {
        Self {
            entries: Vec::new(),
            stride: 1,
        }
    }
}

impl TurnLog {
    /// The turns of a block.
    pub fn of(points: &PathBlock, per_segment: &[f64]) -> Self {
        let mut log = Self::default();
        for ((segment, c), error) in points.segments().zip(&points.c).zip(per_segment) {
            let turn = (c / TAU + ROUNDING).floor() as i64;
            let same = log.entries.last().is_some_and(|last| last.first == turn);
            if !same {
                let mut begun = TurnMotion::begin(turn);
                log.entries
                    .last()
                    .into_iter()
                    .for_each(|last| begun.follow(last));
                log.entries.push(begun);
            }
            if let Some(last) = log.entries.last_mut() {
                last.include(&segment, points.shape, *error);
            }
        }
        log
    }

    /// Appends the turns of the path's next block.
    pub fn append(&mut self, next: &Self) {
        for entry in &next.entries {
            self.push(entry);
            if self.entries.len() > MOST {
                self.thin_out();
            }
        }
    }

    fn push(&mut self, next: &TurnMotion) {
        let first = next.first.div_euclid(self.stride) * self.stride;
        match self.entries.last_mut().filter(|last| last.first == first) {
            Some(last) => last.join(next),
            None => {
                let mut begun = *next;
                self.entries
                    .last()
                    .into_iter()
                    .for_each(|last| begun.follow(last));
                self.entries.push(TurnMotion { first, ..begun });
            }
        }
    }

    /// Joins every two neighbouring entries.
    fn thin_out(&mut self) {
        self.stride *= 2;
        let all = std::mem::take(&mut self.entries);
        all.iter().for_each(|entry| self.push(entry));
    }

    /// The entries so far.
    pub fn all(&self) -> Vec<TurnMotion> {
        self.entries.clone()
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    /// Points of a turn.
    const POINTS: usize = 8;

    /// A spiral of 0.01 mm a turn that swings by 0.2 mm, in steps that meet no whole turn but the
    /// first.
    fn swinging(turns: usize, per_turn: f64) -> PathBlock {
        let mut block = PathBlock::default();
        for i in 0..=(turns as f64 * per_turn) as usize {
            let n = i as f64 / per_turn;
            let (sin, cos) = Scalar::sin_cos(n * TAU);
            let speed = 2.0 * TAU;
            block.push(ControlPoint {
                t: 0.5 * n,
                c: n * TAU,
                x: 50.0 - 0.01 * n + 0.2 * sin,
                vc: speed,
                vx: -0.02 + 0.2 * cos * speed,
                ..ControlPoint::default()
            });
        }
        block
    }

    /// With 64.3 cubics a turn, a sine of 0.2 mm is played to a tenth of a nanometre.
    #[test]
    fn the_feed_is_that_of_the_law_wherever_the_points_lie_while_x_swings() {
        let path = swinging(6, 64.3);
        let errors = vec![0.0; path.c.len() - 1];
        let log = TurnLog::of(&path, &errors);
        let whole = log.all().into_iter().filter(|turn| turn.turns() > 0.99);
        let feeds: Vec<f64> = whole.map(|turn| turn.feed()).collect();
        assert_eq!(feeds.len(), 5, "{:?}", log.all());
        for feed in &feeds {
            assert!((feed - 0.01).abs() < 1e-6, "{feed}");
        }
        // The same in two blocks, cut within a turn and beside a whole turn.
        for cut in [100, 129, 130] {
            let part = |range: std::ops::RangeInclusive<usize>| {
                let mut block = PathBlock::default();
                let (from, to) = (*range.start(), *range.end());
                let points = path.points().skip(from).take(to - from + 1);
                points.for_each(|point| block.push(point));
                TurnLog::of(&block, &errors[from..to])
            };
            let mut both = TurnLog::default();
            both.append(&part(0..=cut));
            both.append(&part(cut..=path.c.len() - 1));
            for (one, other) in log.all().iter().zip(both.all()) {
                assert!((one.feed() - other.feed()).abs() < 1e-12 || one.feed().is_nan());
            }
        }
    }

    #[test]
    fn a_part_of_a_turn_has_no_feed() {
        let path = path(1);
        let mut begun = PathBlock::default();
        path.points()
            .take(POINTS)
            .for_each(|point| begun.push(point));
        let log = TurnLog::of(&begun, &[0.0; POINTS - 1]);
        assert!(log.all().iter().all(|turn| turn.feed().is_nan()));
    }

    /// A spiral of 0.01 mm a turn from 50 mm inwards at 2 turns a second, X swinging on each turn.
    fn path(turns: usize) -> PathBlock {
        let mut block = PathBlock::default();
        for i in 0..=turns * POINTS {
            let n = i as f64 / POINTS as f64;
            let swing = [0.0, 0.1, 0.2, 0.1, 0.0, -0.1, -0.2, -0.1][i % POINTS];
            block.push(ControlPoint {
                t: 0.5 * n,
                c: n * TAU,
                x: 50.0 - 0.01 * n + swing,
                vc: 2.0 * TAU,
                ..ControlPoint::default()
            });
        }
        block
    }

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }

    #[test]
    fn a_turn_has_its_feed_points_and_speed_however_x_swings() {
        let log = TurnLog::of(&path(5), &[1e-6; 5 * POINTS]);
        assert_eq!(log.all().len(), 5);
        for (number, turn) in log.all().iter().enumerate() {
            near(turn.feed(), 0.01);
            near(turn.points_per_turn(), POINTS as f64);
            near(turn.spindle(), 2.0 * TAU);
            near(turn.radius(), 50.0 - 0.01 * (number as f64 + 0.5));
            assert_eq!(turn.error, 1e-6);
        }
    }

    #[test]
    fn a_long_path_joins_neighbours_and_keeps_the_largest_amounts() {
        let turns = 5000;
        let mut errors = vec![1e-6; turns * POINTS];
        errors[4321 * POINTS + 3] = 9e-6;
        let path = path(turns);
        let whole = TurnLog::of(&path, &errors);
        let mut log = TurnLog::default();
        log.append(&whole);
        let found = log.all();
        assert_eq!((found.len(), log.stride), (625, 8));
        found.iter().for_each(|turn| near(turn.feed(), 0.01));
        let largest = found.iter().position(|turn| turn.error == 9e-6);
        assert_eq!(largest, Some(4321 / 8));
        let mut axes = AxesMotion::default();
        found.iter().for_each(|turn| axes.append(&turn.axes));
        let expected = AxesMotion::of(&path);
        assert_eq!(axes.x.velocity, expected.x.velocity);
        assert_eq!(axes.x.acceleration, expected.x.acceleration);
    }

    #[test]
    fn a_turn_that_two_blocks_share_is_one_entry() {
        let errors = [0.0; 3 * POINTS];
        let whole = path(3);
        let cut = POINTS + 3;
        let block = |from: usize, to: usize| {
            let mut block = PathBlock::default();
            whole
                .points()
                .skip(from)
                .take(to - from + 1)
                .for_each(|point| block.push(point));
            TurnLog::of(&block, &errors[from..to])
        };
        let mut log = TurnLog::default();
        log.append(&block(0, cut));
        log.append(&block(cut, 3 * POINTS));
        assert_eq!(log.all().len(), 3);
        log.all()
            .iter()
            .for_each(|turn| near(turn.points_per_turn(), POINTS as f64));
    }
}
