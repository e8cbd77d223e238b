//! Control points that do not belong among their neighbours, whether or not tolerances hold.
//!
//! Whatever made a path made all of it in one way, so what it leaves at one control point is much
//! like what it leaves at those around. Two things are looked at. One is how far a point that cuts
//! lies from the first touch: a Z that was moved. The other is the step of the acceleration at a
//! point, of C, X and Z apart, on leads too: a wrong velocity steps there by 8δ/h, a wrong position
//! at both neighbours by 6δ/h², and a row that is lost at both ends of its gap. Straight segments
//! are not played by their points' velocities: those must be the rates of the segment that follows.
//!
//! Where points are closer than the tolerance asks for, a row that is lost leaves nothing of that;
//! but such points lie evenly, and one gap among even steps is told.

use std::collections::VecDeque;

use turnpath_core::toolpath::{ControlPoint, Cubic, PathBlock, Segment, SegmentShape};

/// Points on each side that a point is held against.
const AROUND: usize = 16;
/// Points on each side that are left out of that: a wrong row shows at its neighbours too.
const BESIDE: usize = 2;
/// Fewest points that say what is usual.
const FEWEST: usize = 8;
/// How many times the usual a point must stand out. A larger factor overlooks rows that are wrong
/// by less; a smaller one suspects what a refined path does where its steps change.
const FACTOR: f64 = 8.0;
/// What stands out by less than this part of the interpolation tolerance is let pass: rounding to
/// the digits of a program, and how splines are closed at their ends.
const FLOOR: f64 = 1e-3;
/// A step is a gap if it is longer than those around by this factor, a row being missing,
const GAP: f64 = 1.6;
/// and all of those are as long as their median within this part of it: where a path was refined,
/// a single long step among short ones is as it should be.
const EVEN: f64 = 0.25;
/// Places that are kept; all are counted.
const KEPT: usize = 10;
/// Suspicious points no further apart than this are one place.
const TOGETHER: u64 = 4;

/// What stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Oddity {
    /// Z is off the first touch.
    Height,
    /// The acceleration of C steps; amounts are along the part's rim.
    TurnsOfC,
    /// The acceleration of X steps.
    MotionOfX,
    /// The acceleration of Z steps.
    MotionOfZ,
    /// A row is missing; amounts are the step along the part's rim.
    Gap,
}

const ODDITIES: [Oddity; 4] = [
    Oddity::Height,
    Oddity::TurnsOfC,
    Oddity::MotionOfX,
    Oddity::MotionOfZ,
];

/// A place where the path is not what it is around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suspect {
    /// Which control point of the path, counted from 1.
    pub point: u64,
    /// Its C, unwrapped, rad.
    pub c: f64,
    /// Its X, mm.
    pub x: f64,
    /// What stands out.
    pub what: Oddity,
    /// By how much, mm: the height itself; of a step of the acceleration the displacement in the
    /// segments beside it that a wrong velocity would need for it.
    pub by: f64,
    /// What the points around have, mm.
    pub usual: f64,
}

impl Suspect {
    fn stands_out(&self, floor: f64) -> f64 {
        self.by / self.usual.max(floor)
    }
}

/// A control point with what it leaves, in the order of [`ODDITIES`], mm.
#[derive(Debug, Clone, Copy)]
struct Seen {
    point: u64,
    c: f64,
    x: f64,
    left: [f64; 4],
    /// How far C turns to the next point, along the rim, mm.
    step: f64,
}

/// Looks for suspicious points along a path, which passes it in order, leads and all. It keeps a
/// few points.
#[derive(Debug, Clone)]
pub struct Suspects {
    floor: f64,
    rim: f64,
    count: u64,
    window: VecDeque<Seen>,
    /// Which of the window is judged next.
    next: usize,
    last: Option<(ControlPoint, f64)>,
    before: Option<Segment>,
    pending: Option<Suspect>,
    found: u64,
    kept: Vec<Suspect>,
}

impl Suspects {
    /// Nothing seen yet, of a path that is to hold an interpolation tolerance, mm, on a part of
    /// this radius, mm.
    pub fn new(tolerance: f64, rim: f64) -> Self {
        Self {
            floor: FLOOR * tolerance,
            rim,
            count: 0,
            window: VecDeque::new(),
            next: 0,
            last: None,
            before: None,
            pending: None,
            found: 0,
            kept: Vec::new(),
        }
    }

    /// The path's next stretch passes. It begins with the point that the one before ended with;
    /// `heights` are its points' Z − first touch where it cuts, empty on leads.
    pub fn pass(&mut self, points: &PathBlock, heights: &[f64]) {
        let height = |i: usize| heights.get(i).copied().unwrap_or(0.0);
        for (i, point) in points.points().enumerate() {
            match self.last {
                Some((last, known)) if i == 0 && last.t == point.t => {
                    self.last = Some((last, known.abs().max(height(i).abs())));
                }
                _ => self.take(point, height(i), points.shape),
            }
        }
    }

    fn take(&mut self, point: ControlPoint, height: f64, shape: SegmentShape) {
        self.count += 1;
        if let Some((last, left)) = self.last.replace((point, height)) {
            let segment = match shape {
                SegmentShape::Cubic => Segment::between(&last, &point),
                SegmentShape::Linear => Segment::straight(&last, &point),
            };
            let before = self.before.replace(segment);
            let kinks = match shape {
                SegmentShape::Cubic => kinks(before.as_ref(), Some(&segment), self.rim),
                SegmentShape::Linear => off_rates(&last, before.as_ref(), &segment, self.rim),
            };
            let step = self.rim * (point.c - last.c).abs();
            self.enter(self.count - 1, &last, left, kinks, step);
        }
    }

    fn enter(&mut self, point: u64, at: &ControlPoint, height: f64, kinks: [f64; 3], step: f64) {
        self.window.push_back(Seen {
            point,
            c: at.c,
            x: at.x,
            left: [height.abs(), kinks[0], kinks[1], kinks[2]],
            step,
        });
        if self.window.len() > self.next + AROUND {
            self.judge();
        }
        if self.next > AROUND {
            self.window.pop_front();
            self.next -= 1;
        }
    }

    /// Judges the next point by what the window has around it.
    fn judge(&mut self) {
        let Some(seen) = self.window.get(self.next).copied() else {
            return;
        };
        let mut worst: Option<Suspect> = None;
        for (k, what) in ODDITIES.into_iter().enumerate() {
            let by = seen.left[k];
            if !(by.is_finite() && by > self.floor) {
                continue;
            }
            let Some(usual) = self.usual(k) else { continue };
            let suspect = Suspect {
                point: seen.point,
                c: seen.c,
                x: seen.x,
                what,
                by,
                usual,
            };
            let stands_out = |suspect: &Suspect| suspect.stands_out(self.floor);
            let worse = worst.is_none_or(|worst| stands_out(&suspect) > stands_out(&worst));
            if by > FACTOR * usual && worse {
                worst = Some(suspect);
            }
        }
        let worst = worst.or_else(|| self.gap(&seen));
        self.next += 1;
        if let Some(suspect) = worst {
            self.suspect(suspect);
        }
    }

    /// The next point, if it is followed by a gap among even steps.
    fn gap(&self, seen: &Seen) -> Option<Suspect> {
        let around = self.window.iter().enumerate();
        let others = around.filter(|(i, other)| *i != self.next && other.step.is_finite());
        let steps = others.map(|(_, other)| other.step);
        // Nearly every step has one as long around it.
        if steps.clone().any(|step| step >= seen.step) {
            return None;
        }
        let mut steps: Vec<f64> = steps.collect();
        if steps.len() < FEWEST {
            return None;
        }
        let middle = steps.len() / 2;
        let (shorter, usual, longer) = steps.select_nth_unstable_by(middle, f64::total_cmp);
        let usual = *usual;
        let even = |step: &f64| (step - usual).abs() < EVEN * usual;
        let gapes = seen.step > GAP * usual && shorter.iter().chain(longer.iter()).all(even);
        gapes.then_some(Suspect {
            point: seen.point,
            c: seen.c,
            x: seen.x,
            what: Oddity::Gap,
            by: seen.step,
            usual,
        })
    }

    /// The upper quartile of what points around the next one leave: a quarter of them may be wrong
    /// themselves.
    fn usual(&self, k: usize) -> Option<f64> {
        let around = self.window.iter().enumerate();
        let mut left: Vec<f64> = around
            .filter(|(i, _)| i.abs_diff(self.next) > BESIDE)
            .map(|(_, seen)| seen.left[k])
            .filter(|left| left.is_finite())
            .collect();
        let quartile = left.len() * 3 / 4;
        if left.len() < FEWEST {
            return None;
        }
        let (_, usual, _) = left.select_nth_unstable_by(quartile, f64::total_cmp);
        Some(*usual)
    }

    /// Puts suspicious points that belong together in one place: that of what stands out most.
    fn suspect(&mut self, next: Suspect) {
        match self.pending {
            Some(pending) if next.point - pending.point <= TOGETHER => {
                if next.stands_out(self.floor) > pending.stands_out(self.floor) {
                    self.pending = Some(next);
                }
            }
            _ => {
                self.settle();
                self.pending = Some(next);
            }
        }
    }

    fn settle(&mut self) {
        if let Some(suspect) = self.pending.take() {
            self.found += 1;
            if self.kept.len() < KEPT {
                self.kept.push(suspect);
            }
        }
    }

    /// How many places there are, and the first of them; the path has ended.
    pub fn end(mut self) -> (u64, Vec<Suspect>) {
        if let Some((last, height)) = self.last {
            self.enter(self.count, &last, height, [0.0; 3], f64::NAN);
        }
        while self.next < self.window.len() {
            self.judge();
        }
        self.settle();
        (self.found, self.kept)
    }
}

/// The steps of the accelerations of C, X and Z between two segments, as the displacements that a
/// wrong velocity there would make: 8δ/h for a step, and 4/27 δh for the displacement,
/// with the shorter of both segments. C's is along
/// the rim: at the axis it does nothing, and is as wrong.
fn kinks(before: Option<&Segment>, after: Option<&Segment>, rim: f64) -> [f64; 3] {
    let (Some(before), Some(after)) = (before, after) else {
        return [0.0; 3];
    };
    let (h0, h1) = (before.duration, after.duration);
    let shorter = h0.min(h1);
    let of = |one: &Cubic, other: &Cubic| {
        let step = other.bend(0.0) / (h1 * h1) - one.bend(1.0) / (h0 * h0);
        (step * shorter * shorter / 54.0).abs()
    };
    [
        rim * of(&before.c, &after.c),
        of(&before.x, &after.x),
        of(&before.z, &after.z),
    ]
}

/// By how much the velocities of C, X and Z at a point are not the rates of the straight segment
/// that follows, as the displacements that they would make if they were played. The last point of
/// a section has those of the segment before.
fn off_rates(
    point: &ControlPoint,
    before: Option<&Segment>,
    after: &Segment,
    rim: f64,
) -> [f64; 3] {
    let off = |velocity: f64, axis: fn(&Segment) -> Cubic| {
        let from = |one: &Segment| (velocity * one.duration - axis(one).slope(0.0)).abs();
        4.0 / 27.0 * before.map_or(f64::INFINITY, from).min(from(after))
    };
    [
        rim * off(point.vc, |segment| segment.c),
        off(point.vx, |segment| segment.x),
        off(point.vz, |segment| segment.z),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::Scalar;

    const TOLERANCE: f64 = 1e-4;

    /// A turn of 100 steps of Z = sin C, as a solver with exact velocities leaves it.
    fn path() -> PathBlock {
        let mut points = PathBlock::default();
        for k in 0..300 {
            let t = 0.02 * f64::from(k);
            let (s, c) = Scalar::sin_cos(2.0 * t);
            points.push(ControlPoint {
                t,
                c: 2.0 * t,
                x: 3.0 - 0.01 * t,
                z: s,
                vc: 2.0,
                vx: -0.01,
                vz: 2.0 * c,
            });
        }
        points
    }

    fn suspects(points: &PathBlock, heights: &[f64]) -> Vec<Suspect> {
        let mut suspects = Suspects::new(TOLERANCE, 3.0);
        suspects.pass(points, heights);
        suspects.end().1
    }

    fn told(points: &PathBlock, row: u64, what: Oddity) {
        let found = suspects(points, &[]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].point.abs_diff(row) <= 1, "{found:?}");
        assert_eq!(found[0].what, what);
    }

    #[test]
    fn a_path_made_in_one_way_has_no_suspects() {
        assert_eq!(suspects(&path(), &[1e-9; 300]), []);
    }

    #[test]
    fn a_wrong_velocity_is_told_with_its_axis() {
        for row in [0, 1, 150, 298, 299] {
            let mut points = path();
            points.vz[row] *= 1.01;
            points.vz[row] += 1e-3;
            told(&points, row as u64 + 1, Oddity::MotionOfZ);
            let mut points = path();
            points.vc[row] *= 1.01;
            told(&points, row as u64 + 1, Oddity::TurnsOfC);
            let mut points = path();
            points.vx[row] *= 1.2;
            told(&points, row as u64 + 1, Oddity::MotionOfX);
        }
    }

    /// The same points with straight segments between them.
    fn polygon() -> PathBlock {
        let mut points = path();
        points.shape = SegmentShape::Linear;
        for k in 0..299 {
            let h = points.t[k + 1] - points.t[k];
            points.vc[k] = (points.c[k + 1] - points.c[k]) / h;
            points.vx[k] = (points.x[k + 1] - points.x[k]) / h;
            points.vz[k] = (points.z[k + 1] - points.z[k]) / h;
        }
        points
    }

    #[test]
    fn a_velocity_that_is_not_the_rate_of_its_straight_segment_is_told() {
        assert_eq!(suspects(&polygon(), &[]), []);
        for row in [0, 1, 150, 298] {
            let mut points = polygon();
            points.vz[row] *= 1.01;
            told(&points, row as u64 + 1, Oddity::MotionOfZ);
            let mut points = polygon();
            points.vc[row] *= 1.01;
            told(&points, row as u64 + 1, Oddity::TurnsOfC);
        }
    }

    #[test]
    fn a_row_that_is_lost_where_it_does_no_harm_is_told_as_a_gap() {
        // C and X go evenly, Z rests: what is lost is on the way.
        let resting = |rows: std::ops::Range<usize>, lost: usize| {
            let mut points = PathBlock::default();
            let whole = path();
            let kept = rows.filter(|row| *row != lost);
            for point in kept.filter_map(|row| whole.get(row)) {
                points.push(ControlPoint {
                    z: 0.0,
                    vz: 0.0,
                    ..point
                });
            }
            points
        };
        assert_eq!(suspects(&resting(0..300, 300), &[]), []);
        for lost in [1, 2, 150, 297, 298] {
            told(&resting(0..300, lost), lost as u64, Oddity::Gap);
        }
    }

    #[test]
    fn a_point_that_is_moved_is_told_by_its_height() {
        for row in [0, 1, 150, 298, 299] {
            let mut heights = vec![1e-9; 300];
            heights[row] = -5e-5;
            let found = suspects(&path(), &heights);
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!(
                (found[0].point, found[0].what, found[0].by),
                (row as u64 + 1, Oddity::Height, 5e-5)
            );
        }
    }

    #[test]
    fn a_point_of_a_lead_that_is_moved_is_told_by_its_motion() {
        let mut points = path();
        points.z[150] += 5e-5;
        told(&points, 151, Oddity::MotionOfZ);
    }

    #[test]
    fn blocks_do_not_matter() {
        let mut points = path();
        points.vz[100] += 0.01;
        points.vz[200] += 0.01;
        let heights = vec![1e-9; 300];
        let whole = suspects(&points, &heights);
        assert_eq!(whole.len(), 2);
        for joint in [1, 99, 100, 101, 110, 298] {
            let part = |range: std::ops::Range<usize>| {
                let mut part = PathBlock::default();
                range
                    .filter_map(|i| points.get(i))
                    .for_each(|point| part.push(point));
                part
            };
            let mut suspects = Suspects::new(TOLERANCE, 3.0);
            suspects.pass(&part(0..joint + 1), &heights[..=joint]);
            suspects.pass(&part(joint..300), &heights[joint..]);
            assert_eq!(suspects.end(), (2, whole.clone()));
        }
    }

    #[test]
    fn all_places_are_counted_and_some_are_kept() {
        let mut points = path();
        for row in (5..300).step_by(20) {
            points.vz[row] += 0.01;
        }
        let mut suspects = Suspects::new(TOLERANCE, 3.0);
        suspects.pass(&points, &[]);
        let (found, kept) = suspects.end();
        assert_eq!((found, kept.len()), (15, KEPT));
    }
}
