//! Turns: the position of the tool when C passes an angle for the nth time.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment};

use crate::crossings::crossing;
use crate::cusp::Point;

/// Turns closer together than this, mm, show no direction of feed.
const NO_FEED: f64 = 1e-9;

/// Successive segments on which X at any angle only grows or only falls from turn to turn.
pub(super) struct Turns {
    segments: Vec<Segment>,
    /// C at the start of each segment, and at the end of the last one, rad.
    c: Vec<f64>,
    /// Index of the segment in which each turn since the first point begins, and of the last
    /// segment.
    begins: Vec<usize>,
    /// Whether X grows from turn to turn.
    pub grows: bool,
    /// Smallest and largest X of the points, mm.
    pub x: (f64, f64),
}

impl Turns {
    /// Divides a block where its feed changes direction.
    pub fn of(block: &PathBlock) -> Vec<Self> {
        let segments: Vec<Segment> = block.segments().collect();
        let mut found = Vec::new();
        let mut begin = 0;
        for (end, grows) in runs(block) {
            let run = segments.get(begin..end).unwrap_or_default();
            if let (false, Some(c), Some(x)) = (
                run.is_empty(),
                block.c.get(begin..=end),
                block.x.get(begin..=end),
            ) {
                found.push(Self::new(run, c, x, grows));
            }
            begin = end;
        }
        found
    }

    fn new(segments: &[Segment], c: &[f64], x: &[f64], grows: bool) -> Self {
        let mut begins = Vec::new();
        for (index, pair) in c.windows(2).enumerate() {
            while c[0] + TAU * begins.len() as f64 <= pair[1] {
                begins.push(index);
            }
        }
        begins.push(segments.len() - 1);
        let least = |a: f64, b: &f64| a.min(*b);
        let most = |a: f64, b: &f64| a.max(*b);
        Self {
            segments: segments.to_vec(),
            c: c.to_vec(),
            begins,
            grows,
            x: (
                x.iter().fold(f64::INFINITY, least),
                x.iter().fold(f64::NEG_INFINITY, most),
            ),
        }
    }

    /// The passes of C at an angle: the first n of angle + 2πn, and the n after the last.
    pub fn passes(&self, angle: f64) -> (i64, i64) {
        let ends = [self.c.first(), self.c.last()];
        let [first, end] = ends.map(|c| c.map_or(0.0, |c| ((c - angle) / TAU).ceil()));
        (first as i64, end as i64)
    }

    fn segment_at(&self, c: f64) -> usize {
        let turn = ((c - self.c[0]) / TAU).max(0.0) as usize;
        let last = self.begins.len() - 1;
        let (low, high) = (
            self.begins[turn.min(last)],
            self.begins[(turn + 1).min(last)],
        );
        let after = self.c[low..=high].partition_point(|begin| *begin <= c);
        (low + after).saturating_sub(1).min(self.segments.len() - 1)
    }

    /// The played position of the tool at an unwrapped C, rad.
    pub fn at(&self, c: f64) -> Point {
        let segment = &self.segments[self.segment_at(c)];
        let instant = crossing(segment, c);
        Point::new(segment.x.value(instant), segment.z.value(instant))
    }

    /// X at an unwrapped C, rad, as if C were linear within each segment.
    fn approximate_x(&self, c: f64) -> f64 {
        let index = self.segment_at(c);
        let (from, to) = (self.c[index], self.c[index + 1]);
        self.segments[index].x.value((c - from) / (to - from))
    }

    /// The first pass at an angle that lies at `x` or beyond it in the direction of feed.
    pub fn first_beyond(&self, angle: f64, x: f64) -> i64 {
        let (mut low, mut high) = self.passes(angle);
        while low < high {
            let middle = low + (high - low) / 2;
            let here = self.approximate_x(angle + TAU * middle as f64);
            let before = if self.grows { here < x } else { here > x };
            if before {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }
}

/// Runs of points over which X at the same angle a turn later has moved in one direction: the index
/// of the last point of each run, and whether X grew.
fn runs(block: &PathBlock) -> Vec<(usize, bool)> {
    let (c, x) = (&block.c, &block.x);
    let mut found = Vec::new();
    let mut direction: Option<bool> = None;
    let mut after = 0;
    for (index, (from, here)) in c.iter().zip(x).enumerate() {
        let later = from + TAU;
        while c.get(after + 1).is_some_and(|c| *c < later) {
            after += 1;
        }
        let (Some(&next_c), Some(&next_x)) = (c.get(after + 1), x.get(after + 1)) else {
            break;
        };
        let share = (later - c[after]) / (next_c - c[after]);
        let moved = x[after] + share * (next_x - x[after]) - here;
        if moved.abs() <= NO_FEED {
            continue;
        }
        let grows = moved > 0.0;
        if direction.is_some_and(|direction| direction != grows) && index > 0 {
            found.push((index, !grows));
        }
        direction = Some(grows);
    }
    if c.len() > 1 {
        found.push((c.len() - 1, direction.unwrap_or(true)));
    }
    found
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    fn path(x: impl Fn(f64) -> f64, turns: f64) -> PathBlock {
        let mut block = PathBlock::default();
        for i in 0..=(turns * 20.0) as usize {
            let n = i as f64 / 20.0;
            block.push(ControlPoint {
                t: n,
                c: n * TAU,
                x: x(n),
                z: 7.0,
                vc: TAU,
                ..ControlPoint::default()
            });
        }
        block
    }

    #[test]
    fn a_path_that_turns_back_is_two_runs() {
        let block = path(|n| (n - 6.0).abs(), 12.0);
        let found = Turns::of(&block);
        let directions: Vec<bool> = found.iter().map(|turns| turns.grows).collect();
        assert_eq!(directions, [false, true]);
        let points: usize = found.iter().map(|turns| turns.segments.len()).sum();
        assert_eq!(points, block.len() - 1);
    }

    #[test]
    fn turns_that_lie_on_each_other_are_one_run() {
        assert_eq!(Turns::of(&path(|_| 2.0, 3.0)).len(), 1);
        assert_eq!(Turns::of(&path(|n| n.max(2.0), 5.0)).len(), 1);
    }

    #[test]
    fn passes_of_an_angle_are_found_by_their_x() {
        let turns = Turns::of(&path(|n| 10.0 - n, 8.0)).remove(0);
        assert_eq!(turns.passes(0.3), (0, 8));
        assert_eq!(turns.passes(-0.3), (1, 9));
        // X = 9.5, 8.5 …
        let half = 0.5 * TAU;
        assert_eq!(turns.first_beyond(half, 6.0), 4);
        assert_eq!(turns.first_beyond(half, 99.0), 0);
        assert_eq!(turns.first_beyond(half, 0.0), 8);
        assert_eq!(turns.at(half + 4.0 * TAU), Point::new(5.5, 7.0));
    }
}
