//! How hard the axes work: velocity, acceleration and jerk of the played path.
//!
//! Straight segments have their acceleration in impulses at the control points, where a controller
//! blends from one rate to the next. The figure reported for them is the jump of the rate divided
//! by the mean duration of the two segments. A blend from the middle of one segment to the middle
//! of the next needs at least this acceleration.

use turnpath_core::registers::in_widest;
use turnpath_core::toolpath::{Cubic, PathBlock, Segment, SegmentShape};

use crate::axis_terms::{AxisTerm, AxisTerms, GROUP, SegmentTerms, turning_place};

/// A largest amount and its position on the path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Peak {
    /// The amount, never negative.
    pub amount: f64,
    /// C of its position, unwrapped, rad.
    pub at_c: f64,
    /// X of its position, mm.
    pub at_x: f64,
}

impl Peak {
    /// An amount at the position `s` of a segment, 0 to 1.
    pub(crate) fn on(segment: &Segment, s: f64, amount: f64) -> Self {
        Self {
            amount,
            at_c: segment.c.value(s),
            at_x: segment.x.value(s),
        }
    }

    /// Rises to an amount at the position `s` of a segment, if that is larger.
    fn rise(&mut self, segment: &Segment, s: f64, amount: f64) {
        if amount > self.amount {
            *self = Self::on(segment, s, amount);
        }
    }

    /// The larger of the two; `self` if they are equal.
    pub(crate) fn or(self, next: Self) -> Self {
        if next.amount > self.amount {
            next
        } else {
            self
        }
    }
}

/// The motion of one axis over a path, in its own unit (mm or rad) and seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisMotion {
    /// Largest speed.
    pub velocity: Peak,
    /// Largest acceleration; between straight segments, that of the slowest blend.
    pub acceleration: Peak,
    /// Largest jerk within segments. It does not include the steps of acceleration between
    /// segments, so straight segments have none.
    pub jerk: Peak,
    /// Time integrals of the squares of velocity, acceleration and jerk.
    squares: [f64; 3],
    /// Signed travel.
    travel: f64,
    /// Time measured, s.
    time: f64,
    /// The first and the last straight segment; `None` if there are none.
    outer: Option<[StraightSegment; 2]>,
}

/// A straight segment of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StraightSegment {
    rate: f64,
    duration: f64,
    /// Its start, with an amount of 0.
    start: Peak,
}

impl StraightSegment {
    fn of(line: &Cubic, segment: &Segment) -> Self {
        let duration = segment.duration;
        Self {
            rate: line.slope(0.0) / duration,
            duration,
            start: Peak::on(segment, 0.0, 0.0),
        }
    }
}

impl AxisMotion {
    /// Root of the mean square of the velocity over time.
    pub fn rms_velocity(&self) -> f64 {
        self.rms(0)
    }

    /// Root of the mean square of the acceleration over time.
    pub fn rms_acceleration(&self) -> f64 {
        self.rms(1)
    }

    /// Root of the mean square of the jerk over time.
    pub fn rms_jerk(&self) -> f64 {
        self.rms(2)
    }

    /// Mean of the velocity over time, signed.
    pub fn mean_velocity(&self) -> f64 {
        if self.time > 0.0 {
            self.travel / self.time
        } else {
            0.0
        }
    }

    /// Whether the path has straight segments.
    pub fn is_straight(&self) -> bool {
        self.outer.is_some()
    }

    fn rms(&self, which: usize) -> f64 {
        if self.time > 0.0 {
            (self.squares[which] / self.time).sqrt()
        } else {
            0.0
        }
    }

    fn include_cubic(&mut self, cubic: &Cubic, segment: &Segment) {
        self.rise(cubic, segment);
        let term = AxisTerm::of(cubic, segment.duration);
        self.add(term.squares, term.travel, segment.duration);
    }

    /// Rises to the largest amounts of a segment.
    fn rise(&mut self, cubic: &Cubic, segment: &Segment) {
        let once = segment.duration.recip();
        let (twice, thrice) = (once * once, once * once * once);
        let (first, last) = (cubic.bend(0.0), cubic.bend(1.0));
        for s in [0.0, turning_place(first, last), 1.0] {
            if (0.0..=1.0).contains(&s) {
                let velocity = cubic.slope(s) * once;
                self.velocity.rise(segment, s, velocity.abs());
            }
        }
        for (s, bend) in [(0.0, first), (1.0, last)] {
            self.acceleration.rise(segment, s, (bend * twice).abs());
        }
        let jerk = cubic.jerk() * thrice;
        self.jerk.rise(segment, 0.5, jerk.abs());
    }

    /// Adds what a segment adds to the sums.
    fn add(&mut self, squares: [f64; 3], travel: f64, duration: f64) {
        for (sum, square) in self.squares.iter_mut().zip(squares) {
            *sum += square;
        }
        self.travel += travel;
        self.time += duration;
    }

    /// The amounts of the peaks of velocity, acceleration and jerk.
    fn amounts(&self) -> [f64; 3] {
        [&self.velocity, &self.acceleration, &self.jerk].map(|peak| peak.amount)
    }

    fn include_straight(&mut self, line: &Cubic, segment: &Segment) {
        let here = StraightSegment::of(line, segment);
        let StraightSegment { rate, duration, .. } = here;
        self.velocity = self.velocity.or(Peak::on(segment, 0.5, rate.abs()));
        self.squares[0] += rate * rate * duration;
        self.travel += line.slope(0.0);
        self.time += duration;
        self.join([here, here]);
    }

    /// Blends from the last straight segment so far into the first of the following segments.
    fn join(&mut self, [first, last]: [StraightSegment; 2]) {
        let Some([begin, before]) = self.outer else {
            self.outer = Some([first, last]);
            return;
        };
        let blend = 0.5 * (before.duration + first.duration);
        let acceleration = (first.rate - before.rate) / blend;
        self.acceleration = self.acceleration.or(Peak {
            amount: acceleration.abs(),
            ..first.start
        });
        self.squares[1] += acceleration * acceleration * blend;
        self.outer = Some([begin, last]);
    }

    fn append(&mut self, next: &Self) {
        if let Some(outer) = next.outer {
            self.join(outer);
        }
        self.velocity = self.velocity.or(next.velocity);
        self.acceleration = self.acceleration.or(next.acceleration);
        self.jerk = self.jerk.or(next.jerk);
        for (own, next) in self.squares.iter_mut().zip(next.squares) {
            *own += next;
        }
        self.travel += next.travel;
        self.time += next.time;
    }
}

/// The cubic of one axis.
type AxisOf = fn(&Segment) -> &Cubic;

/// The motion of all three axes over a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxesMotion {
    /// C in rad.
    pub c: AxisMotion,
    /// X in mm.
    pub x: AxisMotion,
    /// Z in mm.
    pub z: AxisMotion,
}

impl AxesMotion {
    /// The motion between neighbouring control points.
    pub fn of(points: &PathBlock) -> Self {
        let is_finite = |column: &[f64]| column.iter().fold(true, |all, v| all & v.is_finite());
        let has_angles = is_finite(&points.t) && is_finite(&points.c) && is_finite(&points.vc);
        match points.shape {
            SegmentShape::Cubic if has_angles => Self::of_cubics(points),
            // A segment whose C is no number lies between no two angles.
            _ => Self::between(points, [f64::NEG_INFINITY, f64::INFINITY]),
        }
    }

    /// The motion between neighbouring control points that cubics join. Only where an amount exceeds those so far,
    /// segments are looked at one by one.
    fn of_cubics(points: &PathBlock) -> Self {
        let mut motion = Self::default();
        let mut terms = AxisTerms::default();
        let count = points.len().saturating_sub(1);
        for first in (0..count).step_by(GROUP) {
            let group = first..count.min(first + GROUP);
            let ends = group.start..group.end + 1;
            let axes: [(&mut AxisMotion, AxisOf, [&[f64]; 2]); 3] = [
                (&mut motion.c, |segment| &segment.c, [&points.c, &points.vc]),
                (&mut motion.x, |segment| &segment.x, [&points.x, &points.vx]),
                (&mut motion.z, |segment| &segment.z, [&points.z, &points.vz]),
            ];
            let times = &points.t[ends.clone()];
            for (axis, of, columns) in axes {
                let [positions, velocities] = columns.map(|column| &column[ends.clone()]);
                in_widest(SegmentTerms {
                    times,
                    positions,
                    velocities,
                    terms: &mut terms,
                });
                if terms.exceed(group.len(), axis.amounts()) {
                    let segments = group.clone().filter_map(|number| points.segment(number));
                    segments.for_each(|segment| axis.rise(of(&segment), &segment));
                }
                let durations = times.windows(2).map(|ends| ends[1] - ends[0]);
                for ((squares, travel), duration) in terms.sums(group.len()).zip(durations) {
                    axis.add(squares, travel, duration);
                }
            }
        }
        motion
    }

    /// The motion over those segments that lie between two angles of C, rad.
    pub fn between(points: &PathBlock, [from, to]: [f64; 2]) -> Self {
        let mut motion = Self::default();
        let inside = |segment: &Segment| segment.c.value(0.0) >= from && segment.c.value(1.0) <= to;
        for segment in points.segments().filter(inside) {
            motion.include(&segment, points.shape);
        }
        motion
    }

    /// Goes on behind a stretch of straight segments that is measured elsewhere, by its first and its last
    /// segment. The blend into the first one counts, if there is one; what follows begins behind the last one.
    pub(crate) fn pass_straight(&mut self, first: Option<&Segment>, last: &Segment) {
        for (axis, of) in [
            (&mut self.c, (|segment| &segment.c) as AxisOf),
            (&mut self.x, |segment| &segment.x),
            (&mut self.z, |segment| &segment.z),
        ] {
            if let Some(first) = first {
                let first = StraightSegment::of(of(first), first);
                axis.join([first, first]);
            }
            let last = StraightSegment::of(of(last), last);
            let begin = axis.outer.map_or(last, |[begin, _]| begin);
            axis.outer = Some([begin, last]);
        }
    }

    /// Includes the path's next segment.
    pub(crate) fn include(&mut self, segment: &Segment, shape: SegmentShape) {
        let axes = [
            (&mut self.c, &segment.c),
            (&mut self.x, &segment.x),
            (&mut self.z, &segment.z),
        ];
        for (axis, played) in axes {
            match shape {
                SegmentShape::Cubic => axis.include_cubic(played, segment),
                SegmentShape::Linear => axis.include_straight(played, segment),
            }
        }
    }

    /// Appends the motion of the path's next block.
    pub fn append(&mut self, next: &Self) {
        self.c.append(&next.c);
        self.x.append(&next.x);
        self.z.append(&next.z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::toolpath::ControlPoint;

    #[test]
    fn a_known_cubic_has_its_own_derivatives() {
        // z = t³ − t on 0 … 2: v from −1 to 11, turning at 0, a to 12, jerk 6; C = 10 + 3t.
        let point = |t: f64| ControlPoint {
            t,
            c: 10.0 + 3.0 * t,
            vc: 3.0,
            z: t * t * t - t,
            vz: 3.0 * t * t - 1.0,
            ..ControlPoint::default()
        };
        let mut points = PathBlock::default();
        points.push(point(0.0));
        points.push(point(2.0));
        let z = AxesMotion::of(&points).z;
        for (peak, amount, at_c) in [
            (z.velocity, 11.0, 16.0),
            (z.acceleration, 12.0, 16.0),
            (z.jerk, 6.0, 13.0),
        ] {
            assert!((peak.amount - amount).abs() < 1e-12, "{peak:?}");
            assert!((peak.at_c - at_c).abs() < 1e-12, "{peak:?}");
        }
        // ∫ (3t² − 1)² dt over 2 s.
        let mean_square = (9.0 * 32.0 / 5.0 - 16.0 + 2.0) / 2.0;
        assert!((z.rms_velocity() - f64::sqrt(mean_square)).abs() < 1e-12);
        assert!((z.rms_acceleration() - 48f64.sqrt()).abs() < 1e-12);
        assert!((z.rms_jerk() - 6.0).abs() < 1e-12);
        assert!((z.mean_velocity() - 3.0).abs() < 1e-12);
    }

    /// Blocks of more than a group, whose amounts rise and fall.
    #[test]
    fn segments_side_by_side_move_as_each_alone_does() {
        let mut points = PathBlock::default();
        for i in 0..200 {
            let t = f64::from(i);
            let wave = |pace: f64| turnpath_core::Scalar::sin(pace * t * (1.0 + 0.01 * t));
            points.push(ControlPoint {
                t: 0.1 * t + 0.02 * wave(0.7),
                c: 0.3 * t,
                x: 20.0 - 0.01 * t,
                z: wave(0.9),
                vc: 3.0 + 0.1 * wave(1.3),
                vx: -0.1,
                vz: 9.0 * wave(2.1),
            });
        }
        points.z[150] = f64::NAN;
        // A segment that takes no time has speeds that are none or infinite.
        (points.t[170], points.z[170], points.z[171]) = (points.t[171], 1.0, 2.0);
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        for (count, lost) in [0, 1, 2, 64, 65, 66, 140, 160, 200]
            .map(|count| (count, None))
            .into_iter()
            .chain([(200, Some(100))])
        {
            let mut points = points.clone();
            points.truncate(count);
            if let Some(lost) = lost {
                points.c[lost] = f64::NAN;
            }
            let (one, other) = (AxesMotion::of(&points), AxesMotion::between(&points, all));
            // Numbers that are none are not equal, but are written alike.
            assert_eq!(format!("{one:?}"), format!("{other:?}"));
        }
    }

    #[test]
    fn a_speed_that_is_largest_within_a_segment_is_found_there() {
        // z = t − t³/3 on −1 … 1 and −1 … 2: v = 1 − t², the largest amount 1 at 0, or 3 at 2.
        let point = |t: f64| ControlPoint {
            t,
            x: 5.0 - t,
            vx: -1.0,
            z: t - t * t * t / 3.0,
            vz: 1.0 - t * t,
            ..ControlPoint::default()
        };
        for (end, amount, at_x) in [(1.0, 1.0, 5.0), (2.0, 3.0, 3.0)] {
            let mut points = PathBlock::default();
            points.push(point(-1.0));
            points.push(point(end));
            let peak = AxesMotion::of(&points).z.velocity;
            assert!((peak.amount - amount).abs() < 1e-12, "{peak:?}");
            assert!((peak.at_x - at_x).abs() < 1e-12, "{peak:?}");
        }
    }

    #[test]
    fn straight_segments_have_the_blends_acceleration_also_where_blocks_join() {
        let polygon = |points: &[(f64, f64)]| {
            let mut block = PathBlock {
                shape: SegmentShape::Linear,
                ..PathBlock::default()
            };
            for (t, z) in points {
                block.push(ControlPoint {
                    t: *t,
                    c: *t,
                    z: *z,
                    vz: 1e9,
                    ..ControlPoint::default()
                });
            }
            AxesMotion::of(&block)
        };
        let points = [(0.0, 0.0), (1.0, 2.0), (4.0, 2.0), (5.0, -1.0)];
        let whole = polygon(&points);
        // Rates 2, 0, −3; blends of 2 s each: 1 and 1.5 mm/s².
        assert_eq!(whole.z.velocity.amount, 3.0);
        assert_eq!(whole.z.acceleration.amount, 1.5);
        assert_eq!(whole.z.acceleration.at_c, 4.0);
        assert_eq!(whole.z.jerk.amount, 0.0);
        assert_eq!(whole.z.rms_velocity(), f64::sqrt(13.0 / 5.0));
        let mean_square: f64 = (1.0 * 2.0 + 2.25 * 2.0) / 5.0;
        assert!((whole.z.rms_acceleration() - mean_square.sqrt()).abs() < 1e-15);
        for joint in [1, 2] {
            let mut parts = AxesMotion::default();
            parts.append(&polygon(&points[..=joint]));
            parts.append(&polygon(&points[joint..]));
            assert_eq!(parts, whole);
        }
    }
}
