//! The lower envelope of the lower arcs of equal circles: the profile that passes of a nose leave
//! in a plane.

use turnpath_core::registers::{Loop, in_widest};

use crate::cusp::{self, Point};
use crate::lower_arc::lower_arc;

/// A part of the envelope: an interval of the lower arc of one circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The circle's centre, mm.
    pub centre: Point,
    /// Left end, mm.
    pub from: f64,
    /// Right end, mm.
    pub to: f64,
}

/// The border from which on the second of two circles is the lower one; the first lies to the left.
/// Their difference grows along the line, so there is one such border. If the circles do not
/// overlap, the border is the end of the first, and nothing is cut between it and the start of the
/// second.
#[inline(always)]
fn border(first: Point, second: Point, radius: f64, reach: f64) -> f64 {
    let (begin, end) = (second.x - reach, first.x + reach);
    let tip = cusp::crossing(first, second, radius);
    let begins_lower = lower_arc(second, radius, begin) <= lower_arc(first, radius, begin);
    let edge = if begins_lower { begin } else { end };
    let crosses = (tip.y < first.y.min(second.y)) & (begin <= tip.x) & (tip.x <= end);
    let inner = if crosses { tip.x } else { edge };
    if begin >= end { end } else { inner }
}

/// The loop that finds the border between each circle and the next one.
struct Borders<'a> {
    centres: &'a [Point],
    radius: f64,
    reach: f64,
    borders: &'a mut [f64],
}

impl Loop for Borders<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let pairs = self.centres.iter().zip(self.centres.iter().skip(1));
        for (place, (first, second)) in self.borders.iter_mut().zip(pairs) {
            *place = border(*first, *second, self.radius, self.reach);
        }
    }
}

/// The lower envelope of equal circles. Its memory is used again for the next one.
#[derive(Debug, Default)]
pub(super) struct Envelope {
    arcs: Vec<Arc>,
    /// From each circle to the next one.
    borders: Vec<f64>,
}

impl Envelope {
    /// The arcs of the envelope, from left to right.
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// Becomes the lower envelope of the circles around `centres`, which are sorted from left to
    /// right, each limited to ±`reach`. Neighbouring arcs meet unless the line is uncut between them.
    ///
    /// Two lower arcs cross at most once, so one pass with a stack is enough. It mostly asks for borders
    /// between neighbours, since nearly all circles leave an arc. These borders are found together.
    pub fn set(&mut self, centres: &[Point], radius: f64, reach: f64) {
        self.arcs.clear();
        self.borders.clear();
        self.borders.resize(centres.len().saturating_sub(1), 0.0);
        in_widest(Borders {
            centres,
            radius,
            reach,
            borders: &mut self.borders,
        });
        // Whether the last arc is that of the circle before.
        let mut follows = false;
        let from_before = std::iter::once(&f64::NAN).chain(&self.borders);
        for (centre, from_before) in centres.iter().zip(from_before) {
            let end = centre.x + reach;
            let from = match self.arcs.last_mut() {
                // Nearly all circles go this way.
                Some(last) if follows && last.centre.x != centre.x && *from_before > last.from => {
                    last.to = from_before.min(last.to);
                    (centre.x - reach).max(*from_before)
                }
                _ => {
                    let known = follows.then_some(*from_before);
                    make_room(&mut self.arcs, known, *centre, (radius, reach))
                }
            };
            follows = from < end;
            if follows {
                self.arcs.push(Arc {
                    centre: *centre,
                    from,
                    to: end,
                });
            }
        }
    }
}

/// Shortens the last arcs, or takes them away, where the next circle is lower; gives where its arc begins,
/// mm. Its border to the last arc may be known.
fn make_room(
    arcs: &mut Vec<Arc>,
    mut known: Option<f64>,
    centre: Point,
    (radius, reach): (f64, f64),
) -> f64 {
    let from = centre.x - reach;
    while let Some(last) = arcs.last_mut() {
        let is_above = last.centre.x == centre.x;
        if is_above && last.centre.y <= centre.y {
            return f64::INFINITY;
        }
        let border = match known.take() {
            _ if is_above => last.from,
            Some(border) => border,
            None => border(last.centre, centre, radius, reach),
        };
        if border > last.from {
            last.to = border.min(last.to);
            return from.max(border);
        }
        arcs.pop();
    }
    from
}

/// The lower envelope of the circles around `centres`, which are sorted from left to right, each
/// limited to ±`reach`: its arcs from left to right.
pub fn lower_envelope(centres: &[Point], radius: f64, reach: f64) -> Vec<Arc> {
    let mut envelope = Envelope::default();
    envelope.set(centres, radius, reach);
    envelope.arcs
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn brute_force(centres: &[Point], radius: f64, reach: f64, s: f64) -> f64 {
        let within = centres.iter().filter(|c| (s - c.x).abs() <= reach);
        let heights = within.map(|c| lower_arc(*c, radius, s));
        heights.fold(f64::INFINITY, f64::min)
    }

    fn of_arcs(arcs: &[Arc], radius: f64, s: f64) -> f64 {
        let over = arcs.iter().filter(|arc| (arc.from..=arc.to).contains(&s));
        over.map(|arc| lower_arc(arc.centre, radius, s))
            .fold(f64::INFINITY, f64::min)
    }

    fn sorted(mut centres: Vec<Point>) -> Vec<Point> {
        centres.sort_by(|a, b| a.x.total_cmp(&b.x));
        centres
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]
        #[test]
        fn it_is_the_minimum_of_all_arcs(
            points in prop::collection::vec((-3.0f64..3.0, -1.0f64..1.0), 1..30),
            flat in prop::sample::select(vec![1.0, 0.1, 1e-3, 1e-6]),
            reach in prop::sample::select(vec![1.0, 0.7, 0.2]),
        ) {
            let centres = sorted(points.iter().map(|(x, z)| Point::new(*x, z * flat)).collect());
            let arcs = lower_envelope(&centres, 1.0, reach);
            prop_assert!(arcs.windows(2).all(|pair| pair[0].to <= pair[1].from));
            prop_assert!(arcs.iter().all(|arc| arc.from < arc.to));
            for i in 0..=4000 {
                let s = -4.1 + 0.00205 * f64::from(i);
                let ends = |arc: &Arc| (arc.from - s).abs() < 1e-9 || (arc.to - s).abs() < 1e-9;
                if arcs.iter().any(ends) {
                    continue;
                }
                let (found, expected) = (of_arcs(&arcs, 1.0, s), brute_force(&centres, 1.0, reach, s));
                let same = found == expected || (found - expected).abs() < 1e-12;
                prop_assert!(same, "at {s}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn the_lowest_of_passes_at_one_position_counts() {
        let centres = [
            Point::new(0.0, 1.0),
            Point::new(0.0, 0.9),
            Point::new(0.0, 1.1),
        ];
        let arcs = lower_envelope(&centres, 1.0, 0.5);
        let lowest = Arc {
            centre: centres[1],
            from: -0.5,
            to: 0.5,
        };
        assert_eq!(arcs, [lowest]);
    }

    #[test]
    fn a_gap_that_no_circle_reaches_lies_between_two_arcs() {
        let centres = [Point::new(0.0, 1.0), Point::new(2.0, 1.0)];
        let arcs = lower_envelope(&centres, 1.0, 0.5);
        let ends: Vec<(f64, f64)> = arcs.iter().map(|arc| (arc.from, arc.to)).collect();
        assert_eq!(ends, [(-0.5, 0.5), (1.5, 2.5)]);
    }
}
