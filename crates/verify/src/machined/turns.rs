//! A stretch of path by turns: where the tool is when C passes an angle for the nth time.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment};

use crate::cusp::Point;
use crate::residual::crossing;

/// Turns closer than this, mm, do not say which way the tool feeds.
const SAME_PLACE: f64 = 1e-9;

/// Successive segments, on which X at any one angle only grows or only falls from turn to turn.
pub(super) struct Turns {
    segments: Vec<Segment>,
    /// C at the begin of each segment, and at the end of the last one.
    c: Vec<f64>,
    /// The segment in which each turn since the first point begins, and the last segment.
    begins: Vec<usize>,
    /// Whether X grows.
    pub grows: bool,
    /// Smallest and largest X of the points, mm.
    pub x: (f64, f64),
}

impl Turns {
    /// A block in as many stretches as its feed changes direction.
    pub fn of(block: &PathBlock) -> Vec<Self> {
        let segments: Vec<Segment> = block.segments().collect();
        let mut found = Vec::new();
        let mut begin = 0;
        for (end, grows) in runs(block) {
            let stretch = segments.get(begin..end).unwrap_or_default();
            if let (false, Some(c), Some(x)) = (
                stretch.is_empty(),
                block.c.get(begin..=end),
                block.x.get(begin..=end),
            ) {
                found.push(Self::new(stretch, c, x, grows));
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

    /// How often C passes an angle: the numbers n of angle + 2πn, first and one after the last.
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

    /// Where the tool is as played when C is this, unwrapped.
    pub fn at(&self, c: f64) -> Point {
        let segment = &self.segments[self.segment_at(c)];
        let instant = crossing(segment, c);
        Point::new(segment.x.value(instant), segment.z.value(instant))
    }

    /// X there, as if C ran evenly through each segment.
    fn about_x(&self, c: f64) -> f64 {
        let index = self.segment_at(c);
        let (from, to) = (self.c[index], self.c[index + 1]);
        self.segments[index].x.value((c - from) / (to - from))
    }

    /// Of the passes at an angle, the first that is at `x` or beyond it in the direction of feed.
    pub fn first_beyond(&self, angle: f64, x: f64) -> i64 {
        let (mut low, mut high) = self.passes(angle);
        while low < high {
            let middle = low + (high - low) / 2;
            let here = self.about_x(angle + TAU * middle as f64);
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

/// Stretches of points over which X at the same angle a turn later has moved one way: the index
/// of each one's last point, and whether X grew.
fn runs(block: &PathBlock) -> Vec<(usize, bool)> {
    let (c, x) = (&block.c, &block.x);
    let mut found = Vec::new();
    let mut way: Option<bool> = None;
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
        if moved.abs() <= SAME_PLACE {
            continue;
        }
        let grows = moved > 0.0;
        if way.is_some_and(|way| way != grows) && index > 0 {
            found.push((index, !grows));
        }
        way = Some(grows);
    }
    if c.len() > 1 {
        found.push((c.len() - 1, way.unwrap_or(true)));
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
    fn a_path_that_turns_back_is_two_stretches() {
        let block = path(|n| (n - 6.0).abs(), 12.0);
        let found = Turns::of(&block);
        let ways: Vec<bool> = found.iter().map(|turns| turns.grows).collect();
        assert_eq!(ways, [false, true]);
        let points: usize = found.iter().map(|turns| turns.segments.len()).sum();
        assert_eq!(points, block.len() - 1);
    }

    #[test]
    fn turns_that_lie_on_each_other_turn_no_way() {
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
