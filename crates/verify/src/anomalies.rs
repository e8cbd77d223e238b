//! Anomalies: control points that differ from their neighbours, whether or not tolerances hold.
//!
//! This is the rule for a file whose rows cannot be compared with those of its recipe's path
//! ([`crate::comparison`]): another maker made it, or the path cannot be made again, for example
//! because a strategy or a data file of the recipe is not there. It promises nothing.
//!
//! One program makes the whole of a path in the same way, so the deviations at one control point
//! are much like those at the points around it. The detector compares two deviations. The first is
//! the distance of a cutting point from the first touch: it shows a Z that was moved. The second is
//! the step of the acceleration at a point, separately for C, X and Z, and on leads too. A wrong
//! velocity gives a step of 8δ/h at its own point. A wrong position gives a step of 6δ/h² at both
//! neighbours. A lost row gives a step at both ends of its gap. Straight segments are not played by
//! the velocities of their points: there the velocities must be the rates of the segment that
//! follows.
//!
//! Where points are closer than the tolerance needs, a lost row causes neither deviation. But such
//! points lie evenly, so the detector reports a single gap among even steps.

use std::collections::VecDeque;

use turnpath_core::toolpath::{ControlPoint, Cubic, PathBlock, Segment, SegmentShape};

use crate::worst_first::WorstFirst;

/// Points on each side that a point is compared with.
const AROUND: usize = 16;
/// Points on each side that are left out of the comparison, since a wrong row shows at its
/// neighbours too.
const BESIDE: usize = 2;
/// Fewest points that a usual deviation is computed from.
const FEWEST: usize = 8;
/// A point is an anomaly if its deviation exceeds the usual one by this factor. A larger factor
/// overlooks rows that are wrong by less. A smaller factor reports points of a refined path where
/// its steps change.
const FACTOR: f64 = 8.0;
/// Deviations below this part of the interpolation tolerance are ignored: they come from the
/// rounding to the digits of a program, and from the way splines are closed at their ends.
const FLOOR: f64 = 1e-3;
/// A step is a gap if a row is missing: it is longer than the steps around it by this factor, and
/// those steps are [`EVEN`].
const GAP: f64 = 1.6;
/// Steps are even if all of them are as long as their median within this part of it. In a refined
/// path, one long step among short ones is no anomaly.
const EVEN: f64 = 0.25;
/// Points no further apart than this belong to one anomaly.
const TOGETHER: u64 = 4;

/// The kind of an anomaly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnomalyKind {
    /// Z is off the first touch.
    Height,
    /// The acceleration of C has a step; amounts are along the part's rim.
    MotionOfC,
    /// The acceleration of X has a step.
    MotionOfX,
    /// The acceleration of Z has a step.
    MotionOfZ,
    /// A row is missing; amounts are the step along the part's rim.
    Gap,
}

/// The kinds that are found by comparing deviations.
const KINDS: [AnomalyKind; 4] = [
    AnomalyKind::Height,
    AnomalyKind::MotionOfC,
    AnomalyKind::MotionOfX,
    AnomalyKind::MotionOfZ,
];

/// A control point that differs from the points around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anomaly {
    /// Number of the control point in the path, counted from 1.
    pub point: u64,
    /// Its C, unwrapped, rad.
    pub c: f64,
    /// Its X, mm.
    pub x: f64,
    /// The kind of its largest deviation.
    pub kind: AnomalyKind,
    /// The deviation, mm. For a height it is the height itself. For a step of the acceleration it
    /// is the displacement that a wrong velocity with such a step would cause in the segments on
    /// both sides.
    pub amount: f64,
    /// The usual deviation of the points around it, mm.
    pub usual: f64,
}

impl Anomaly {
    /// How many times the deviation exceeds the usual one, or the floor.
    fn prominence(&self, floor: f64) -> f64 {
        self.amount / self.usual.max(floor)
    }
}

/// A control point with its deviations.
#[derive(Debug, Clone, Copy)]
struct PointRecord {
    point: u64,
    c: f64,
    x: f64,
    /// Deviations in the order of [`KINDS`], mm.
    deviations: [f64; 4],
    /// The turn of C to the next point, along the rim, mm.
    step: f64,
}

/// Looks for anomalies along a path. It needs all blocks of the path in order, those of leads too,
/// and keeps a few points and the most prominent anomalies.
#[derive(Debug, Clone)]
pub struct AnomalyDetector {
    floor: f64,
    rim: f64,
    count: u64,
    window: VecDeque<PointRecord>,
    /// Index in the window of the point that is judged next.
    next: usize,
    /// The last point, and its height above the first touch, mm.
    last: Option<(ControlPoint, f64)>,
    before: Option<Segment>,
    pending: Option<Anomaly>,
    found: WorstFirst<Anomaly>,
}

impl AnomalyDetector {
    /// A detector for a path with this interpolation tolerance, mm, on a part of radius `rim`, mm.
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
            found: WorstFirst::default(),
        }
    }

    /// Appends the path's next block, which begins with the last point of the block before it.
    /// `heights` are Z − first touch of its points, mm, if it cuts; empty for a lead.
    pub fn append(&mut self, points: &PathBlock, heights: &[f64]) {
        let height = |i: usize| heights.get(i).copied().unwrap_or(0.0);
        for (i, point) in points.points().enumerate() {
            match self.last {
                Some((last, known)) if i == 0 && last.t == point.t => {
                    self.last = Some((last, known.abs().max(height(i).abs())));
                }
                _ => self.push(point, height(i), points.shape),
            }
        }
    }

    fn push(&mut self, point: ControlPoint, height: f64, shape: SegmentShape) {
        self.count += 1;
        if let Some((last, last_height)) = self.last.replace((point, height)) {
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
            self.enter(self.count - 1, &last, last_height, kinks, step);
        }
    }

    fn enter(&mut self, point: u64, at: &ControlPoint, height: f64, kinks: [f64; 3], step: f64) {
        self.window.push_back(PointRecord {
            point,
            c: at.c,
            x: at.x,
            deviations: [height.abs(), kinks[0], kinks[1], kinks[2]],
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

    /// Compares the next point with the points around it in the window.
    fn judge(&mut self) {
        let Some(record) = self.window.get(self.next).copied() else {
            return;
        };
        let mut worst: Option<Anomaly> = None;
        for (k, kind) in KINDS.into_iter().enumerate() {
            let amount = record.deviations[k];
            if !(amount.is_finite() && amount > self.floor) {
                continue;
            }
            let Some(usual) = self.usual(k) else { continue };
            let anomaly = Anomaly {
                point: record.point,
                c: record.c,
                x: record.x,
                kind,
                amount,
                usual,
            };
            let prominence = |anomaly: &Anomaly| anomaly.prominence(self.floor);
            let worse = worst.is_none_or(|worst| prominence(&anomaly) > prominence(&worst));
            if amount > FACTOR * usual && worse {
                worst = Some(anomaly);
            }
        }
        let worst = worst.or_else(|| self.gap(&record));
        self.next += 1;
        if let Some(anomaly) = worst {
            self.add(anomaly);
        }
    }

    /// The anomaly of the next point if a gap among even steps follows it.
    fn gap(&self, record: &PointRecord) -> Option<Anomaly> {
        let around = self.window.iter().enumerate();
        let others = around.filter(|(i, other)| *i != self.next && other.step.is_finite());
        let steps = others.map(|(_, other)| other.step);
        // For nearly every step there is another one around it that is as long.
        if steps.clone().any(|step| step >= record.step) {
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
        let is_gap = record.step > GAP * usual && shorter.iter().chain(longer.iter()).all(even);
        is_gap.then_some(Anomaly {
            point: record.point,
            c: record.c,
            x: record.x,
            kind: AnomalyKind::Gap,
            amount: record.step,
            usual,
        })
    }

    /// The upper quartile of the deviations of the points around the next one. A quarter of them
    /// may be wrong themselves.
    fn usual(&self, k: usize) -> Option<f64> {
        let around = self.window.iter().enumerate();
        let mut deviations: Vec<f64> = around
            .filter(|(i, _)| i.abs_diff(self.next) > BESIDE)
            .map(|(_, record)| record.deviations[k])
            .filter(|deviation| deviation.is_finite())
            .collect();
        let quartile = deviations.len() * 3 / 4;
        if deviations.len() < FEWEST {
            return None;
        }
        let (_, usual, _) = deviations.select_nth_unstable_by(quartile, f64::total_cmp);
        Some(*usual)
    }

    /// Adds an anomaly. Of anomalies that belong together, only the most prominent one is kept.
    fn add(&mut self, next: Anomaly) {
        match self.pending {
            Some(pending) if next.point - pending.point <= TOGETHER => {
                if next.prominence(self.floor) > pending.prominence(self.floor) {
                    self.pending = Some(next);
                }
            }
            _ => {
                self.keep_pending();
                self.pending = Some(next);
            }
        }
    }

    fn keep_pending(&mut self) {
        if let Some(anomaly) = self.pending.take() {
            self.found.add(anomaly.prominence(self.floor), anomaly);
        }
    }

    /// Ends the path. Returns the number of anomalies, and the most prominent of them, in the order
    /// of prominence.
    pub fn finish(mut self) -> (u64, Vec<Anomaly>) {
        if let Some((last, height)) = self.last {
            self.enter(self.count, &last, height, [0.0; 3], f64::NAN);
        }
        while self.next < self.window.len() {
            self.judge();
        }
        self.keep_pending();
        (self.found.count(), self.found.into_items())
    }
}

/// The steps of the accelerations of C, X and Z between two segments, each as the displacement that
/// a wrong velocity with this step would cause, mm. A velocity that is wrong by δ causes a step of
/// 8δ/h and a displacement of 4/27 δh, with the duration h of the shorter segment. The displacement
/// of C is along the rim: at the axis it would be zero, although the velocity is as wrong.
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

/// The differences between the velocities of C, X and Z at a point and the rates of the straight
/// segment that follows, each as the displacement that it would cause if the velocity were played,
/// mm. The last point of a section has the rates of the segment before it.
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

    /// 300 points of Z = sin C with exact velocities.
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

    fn anomalies(points: &PathBlock, heights: &[f64]) -> Vec<Anomaly> {
        let mut detector = AnomalyDetector::new(TOLERANCE, 3.0);
        detector.append(points, heights);
        detector.finish().1
    }

    fn assert_reported(points: &PathBlock, row: u64, kind: AnomalyKind) {
        let found = anomalies(points, &[]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].point.abs_diff(row) <= 1, "{found:?}");
        assert_eq!(found[0].kind, kind);
    }

    #[test]
    fn a_path_made_in_one_way_has_no_anomalies() {
        assert_eq!(anomalies(&path(), &[1e-9; 300]), []);
    }

    #[test]
    fn a_wrong_velocity_is_reported_with_its_axis() {
        for row in [0, 1, 150, 298, 299] {
            let mut points = path();
            points.vz[row] *= 1.01;
            points.vz[row] += 1e-3;
            assert_reported(&points, row as u64 + 1, AnomalyKind::MotionOfZ);
            let mut points = path();
            points.vc[row] *= 1.01;
            assert_reported(&points, row as u64 + 1, AnomalyKind::MotionOfC);
            let mut points = path();
            points.vx[row] *= 1.2;
            assert_reported(&points, row as u64 + 1, AnomalyKind::MotionOfX);
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
    fn a_velocity_that_is_not_the_rate_of_its_straight_segment_is_reported() {
        assert_eq!(anomalies(&polygon(), &[]), []);
        for row in [0, 1, 150, 298] {
            let mut points = polygon();
            points.vz[row] *= 1.01;
            assert_reported(&points, row as u64 + 1, AnomalyKind::MotionOfZ);
            let mut points = polygon();
            points.vc[row] *= 1.01;
            assert_reported(&points, row as u64 + 1, AnomalyKind::MotionOfC);
        }
    }

    #[test]
    fn a_row_that_is_lost_where_it_does_no_harm_is_reported_as_a_gap() {
        // C and X move evenly and Z rests, so the path is the same without the lost row.
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
        assert_eq!(anomalies(&resting(0..300, 300), &[]), []);
        for lost in [1, 2, 150, 297, 298] {
            assert_reported(&resting(0..300, lost), lost as u64, AnomalyKind::Gap);
        }
    }

    #[test]
    fn a_point_that_is_moved_is_reported_by_its_height() {
        for row in [0, 1, 150, 298, 299] {
            let mut heights = vec![1e-9; 300];
            heights[row] = -5e-5;
            let found = anomalies(&path(), &heights);
            assert_eq!(found.len(), 1, "{found:?}");
            assert_eq!(
                (found[0].point, found[0].kind, found[0].amount),
                (row as u64 + 1, AnomalyKind::Height, 5e-5)
            );
        }
    }

    #[test]
    fn a_point_of_a_lead_that_is_moved_is_reported_by_its_motion() {
        let mut points = path();
        points.z[150] += 5e-5;
        assert_reported(&points, 151, AnomalyKind::MotionOfZ);
    }

    #[test]
    fn the_division_into_blocks_does_not_matter() {
        let mut points = path();
        points.vz[100] += 0.01;
        points.vz[200] += 0.01;
        let heights = vec![1e-9; 300];
        let whole = anomalies(&points, &heights);
        assert_eq!(whole.len(), 2);
        for joint in [1, 99, 100, 101, 110, 298] {
            let part = |range: std::ops::Range<usize>| {
                let mut part = PathBlock::default();
                range
                    .filter_map(|i| points.get(i))
                    .for_each(|point| part.push(point));
                part
            };
            let mut detector = AnomalyDetector::new(TOLERANCE, 3.0);
            detector.append(&part(0..joint + 1), &heights[..=joint]);
            detector.append(&part(joint..300), &heights[joint..]);
            assert_eq!(detector.finish(), (2, whole.clone()));
        }
    }

    #[test]
    fn the_most_prominent_anomaly_comes_first() {
        let mut points = path();
        for (row, by) in [(50, 0.01), (150, 0.03), (250, 0.02)] {
            points.vz[row] += by;
        }
        let found = anomalies(&points, &[]);
        let rows: Vec<u64> = found.iter().map(|anomaly| anomaly.point).collect();
        assert_eq!(rows, [151, 251, 51]);
    }
}
