//! How hard the axes work for certain, where the numbers of a file were rounded to their last digits.
//!
//! A jerk is a difference of positions over the third power of a time. On a segment of a millisecond, half a last
//! digit of 10⁻⁷ mm at both ends makes up to 1200 mm/s³, and moves nothing by more than that half digit. So what
//! rounding can make of an amount, segment by segment, is taken away from it.

use turnpath_core::toolpath::{Cubic, PathBlock, Section, Segment, SegmentShape};
use turnpath_core::{Axis, Derivative};

use crate::axis_terms::AxisTerm;

/// By how much numbers of a path may lie beside those that were rounded.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rounding {
    /// Of X and Z, mm.
    pub position: f64,
    /// Of C, rad.
    pub angle: f64,
    /// Of the velocities of X and Z, mm/s. Straight lines have none.
    pub velocity: f64,
    /// Of the velocity of C, rad/s.
    pub angular_velocity: f64,
    /// The part of a position that is rounded besides: that of a controller that holds few bits.
    pub part: f64,
}

impl Rounding {
    /// That of the positions and of the velocities of an axis.
    fn of(&self, axis: Axis) -> [f64; 2] {
        match axis {
            Axis::C => [self.angle, self.angular_velocity],
            Axis::X | Axis::Z => [self.position, self.velocity],
        }
    }

    /// The most that rounding can make of the position of an axis at either end of a segment.
    fn of_positions(&self, axis: Axis, played: &Cubic) -> f64 {
        let size = played.value(0.0).abs().max(played.value(1.0).abs());
        self.of(axis)[0] + self.part * size
    }

    /// The most that rounding can make of the velocity, acceleration and jerk of a cubic. With p and v the rounding
    /// of positions and velocities, and h the time: 3p/h + v, 12p/h² + 6v/h and 24p/h³ + 12v/h², by the Hermite
    /// form of a cubic.
    fn of_cubic(&self, axis: Axis, cubic: &Cubic, duration: f64) -> [f64; 3] {
        let rate = self.of_positions(axis, cubic) / duration;
        let [_, velocity] = self.of(axis);
        let first = 3.0 * rate + velocity;
        let second = (12.0 * rate + 6.0 * velocity) / duration;
        [first, second, 2.0 * second / duration]
    }

    /// The most that rounding can make of the rate of a straight segment.
    fn of_rate(&self, axis: Axis, line: &Segment) -> f64 {
        2.0 * self.of_positions(axis, played(line, axis)) / line.duration
    }
}

/// The largest amounts of velocity, acceleration and jerk of each axis that are certain, in mm or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CertainMotion {
    /// By axis, and by derivative.
    largest: [[f64; Derivative::ALL.len()]; Axis::ALL.len()],
}

impl CertainMotion {
    /// The largest amount of a derivative.
    pub fn amount(&self, axis: Axis, derivative: Derivative) -> f64 {
        self.largest[axis as usize][derivative as usize]
    }

    /// Rises to what is certain of an amount. Of a segment that takes no time everything is.
    fn rise(&mut self, axis: Axis, derivative: Derivative, amount: f64, rounding: f64) {
        let certain = match rounding.is_finite() {
            true => amount - rounding,
            false => amount,
        };
        let largest = &mut self.largest[axis as usize][derivative as usize];
        *largest = largest.max(certain);
    }

    fn include_cubic(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let (cubic, duration) = (played(segment, axis), segment.duration);
            let term = AxisTerm::of(cubic, duration);
            let amounts = [term.velocity, term.acceleration, term.jerk];
            let rounding = rounding.of_cubic(axis, cubic, duration);
            for (derivative, (amount, rounding)) in Derivative::ALL
                .into_iter()
                .zip(amounts.into_iter().zip(rounding))
            {
                self.rise(axis, derivative, amount, rounding);
            }
        }
    }

    fn include_line(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let (rate, rounding) = (rate(segment, axis), rounding.of_rate(axis, segment));
            self.rise(axis, Derivative::Velocity, rate.abs(), rounding);
        }
    }

    /// Includes the blend from one straight segment into the next: see [`AxesMotion`](crate::AxesMotion).
    fn include_blend(&mut self, [before, after]: [&Segment; 2], rounding: &Rounding) {
        let blend = 0.5 * (before.duration + after.duration);
        for axis in Axis::ALL {
            let change = (rate(after, axis) - rate(before, axis)).abs();
            let rounding = rounding.of_rate(axis, before) + rounding.of_rate(axis, after);
            self.rise(
                axis,
                Derivative::Acceleration,
                change / blend,
                rounding / blend,
            );
        }
    }

    fn append(&mut self, next: &Self) {
        let all = self.largest.iter_mut().flatten();
        for (largest, next) in all.zip(next.largest.iter().flatten()) {
            *largest = largest.max(*next);
        }
    }
}

/// What an axis plays.
fn played(segment: &Segment, axis: Axis) -> &Cubic {
    match axis {
        Axis::C => &segment.c,
        Axis::X => &segment.x,
        Axis::Z => &segment.z,
    }
}

/// The rate of a straight segment.
fn rate(line: &Segment, axis: Axis) -> f64 {
    played(line, axis).slope(0.0) / line.duration
}

/// What is certain of a block.
#[derive(Debug, Clone)]
pub struct CertainBlock {
    section: Section,
    motion: CertainMotion,
    /// Its first and its last segment, if they are straight.
    outer: Option<[Segment; 2]>,
}

/// Measures what is certain of a path. Blocks can be measured in parallel, and are appended in their order.
#[derive(Debug, Clone)]
pub struct CertainMeter {
    of_cut: Rounding,
    of_leads: Rounding,
    cut: CertainMotion,
    leads: CertainMotion,
    /// The last straight segment so far, and its section.
    last: Option<(Segment, Section)>,
}

impl CertainMeter {
    /// Nothing measured yet. Numbers of the cut and of leads may be rounded otherwise.
    pub fn new(of_cut: Rounding, of_leads: Rounding) -> Self {
        Self {
            of_cut,
            of_leads,
            cut: CertainMotion::default(),
            leads: CertainMotion::default(),
            last: None,
        }
    }

    fn rounding(&self, section: Section) -> &Rounding {
        match section {
            Section::Cutting => &self.of_cut,
            Section::LeadIn | Section::LeadOut => &self.of_leads,
        }
    }

    /// Measures the segments between neighbouring points of a block.
    pub fn measure(&self, section: Section, points: &PathBlock) -> CertainBlock {
        let rounding = self.rounding(section);
        let mut block = CertainBlock {
            section,
            motion: CertainMotion::default(),
            outer: None,
        };
        for segment in points.segments() {
            match points.shape {
                SegmentShape::Cubic => block.motion.include_cubic(&segment, rounding),
                SegmentShape::Linear => block.include_line(segment, rounding),
            }
        }
        block
    }

    /// Appends the next block. The blend from a lead into the cut, or out of it, belongs to the lead.
    pub fn append(&mut self, next: &CertainBlock) {
        if let Some([first, last]) = next.outer {
            if let Some((before, section)) = self.last {
                let of_blend = match next.section {
                    Section::Cutting => section,
                    lead => lead,
                };
                let rounding = *self.rounding(of_blend);
                self.of_section(of_blend)
                    .include_blend([&before, &first], &rounding);
            }
            self.last = Some((last, next.section));
        }
        self.of_section(next.section).append(&next.motion);
    }

    fn of_section(&mut self, section: Section) -> &mut CertainMotion {
        match section {
            Section::Cutting => &mut self.cut,
            Section::LeadIn | Section::LeadOut => &mut self.leads,
        }
    }

    /// What is certain of the cut.
    pub fn cut(&self) -> &CertainMotion {
        &self.cut
    }

    /// What is certain of the leads.
    pub fn leads(&self) -> &CertainMotion {
        &self.leads
    }
}

impl CertainBlock {
    fn include_line(&mut self, segment: Segment, rounding: &Rounding) {
        self.motion.include_line(&segment, rounding);
        let first = match &self.outer {
            Some([first, before]) => {
                self.motion.include_blend([before, &segment], rounding);
                *first
            }
            None => segment,
        };
        self.outer = Some([first, segment]);
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;
    use crate::AxesMotion;

    /// Half of a last digit of seven decimals, of each number.
    const ROUNDING: Rounding = Rounding {
        position: 0.5e-7,
        angle: 0.5e-7,
        velocity: 0.5e-7,
        angular_velocity: 0.5e-7,
        part: 0.0,
    };

    /// A wave of Z and a slow X, with points about a millisecond apart and each number as `kept`.
    fn path(shape: SegmentShape, kept: impl Fn(f64) -> f64) -> PathBlock {
        let mut t = 0.0;
        let points = (0..300).map(|i| {
            t += 1e-3 * (1.0 + 0.3 * Scalar::sin(f64::from(i)));
            let (sine, cosine) = Scalar::sin_cos(40.0 * t);
            ControlPoint {
                t,
                c: kept(9.0 * t),
                x: kept(20.0 - 0.2 * t - 1e-4 * sine),
                z: kept(0.5 * sine),
                vc: kept(9.0),
                vx: kept(-0.2 - 4e-3 * cosine),
                vz: kept(20.0 * cosine),
            }
        });
        PathBlock::of(shape, points)
    }

    fn rounded(value: f64) -> f64 {
        (value * 1e7).round() / 1e7
    }

    fn certain(points: &PathBlock, rounding: Rounding) -> CertainMotion {
        let mut meter = CertainMeter::new(rounding, Rounding::default());
        meter.append(&meter.measure(Section::Cutting, points));
        *meter.cut()
    }

    fn peaks(points: &PathBlock) -> impl Iterator<Item = (Axis, Derivative, f64)> + use<> {
        let motion = AxesMotion::of(points);
        Axis::ALL.into_iter().flat_map(move |axis| {
            Derivative::ALL.into_iter().map(move |derivative| {
                let peak = motion.peak(axis, derivative);
                (axis, derivative, peak.map_or(0.0, |peak| peak.amount))
            })
        })
    }

    #[test]
    fn without_rounding_everything_is_certain() {
        for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
            let points = path(shape, |value| value);
            let certain = certain(&points, Rounding::default());
            for (axis, derivative, peak) in peaks(&points) {
                assert_eq!(
                    certain.amount(axis, derivative),
                    peak,
                    "{axis:?} {derivative:?}"
                );
            }
        }
    }

    /// The rounded path has jerks of X that the path has not, and what is certain of them lies below those of the
    /// path. Where the path's own are large, nearly all of them is certain.
    #[test]
    fn what_is_certain_of_a_rounded_path_is_not_above_the_path_itself() {
        for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
            let (exact, file) = (path(shape, |value| value), path(shape, rounded));
            let certain = certain(&file, ROUNDING);
            for (axis, derivative, peak) in peaks(&exact) {
                let found = certain.amount(axis, derivative);
                assert!(
                    found <= peak * (1.0 + 1e-9),
                    "{axis:?} {derivative:?}: {found} {peak}"
                );
            }
            let of_file = AxesMotion::of(&file);
            let derivative = match shape {
                SegmentShape::Cubic => Derivative::Jerk,
                SegmentShape::Linear => Derivative::Acceleration,
            };
            let rough = of_file.peak(Axis::X, derivative).unwrap().amount;
            let (_, _, smooth) = peaks(&exact)
                .find(|(axis, of, _)| (*axis, *of) == (Axis::X, derivative))
                .unwrap();
            assert!(rough > 1.2 * smooth, "{rough} {smooth}");
            let speed = certain.amount(Axis::Z, Derivative::Velocity);
            assert!((speed - 20.0).abs() < 1e-2, "{speed}");
        }
    }

    /// Axes at rest whose numbers were rounded as badly as they can be: nothing is certain, and half of it would be
    /// with half the rounding.
    #[test]
    fn rounding_at_its_worst_is_no_motion() {
        let Rounding {
            position: p,
            velocity: v,
            ..
        } = ROUNDING;
        let point = |t: f64, z: f64, vz: f64| ControlPoint {
            t,
            z,
            vz,
            ..ControlPoint::default()
        };
        let half = Rounding {
            position: 0.5 * p,
            velocity: 0.5 * v,
            ..ROUNDING
        };
        let cubic = [point(0.0, -p, -v), point(1e-3, p, -v)];
        let line = [
            point(0.0, p, 0.0),
            point(1e-3, -p, 0.0),
            point(2e-3, p, 0.0),
        ];
        for (shape, points, derivative) in [
            (SegmentShape::Cubic, &cubic[..], Derivative::Acceleration),
            (SegmentShape::Cubic, &cubic[..], Derivative::Jerk),
            (SegmentShape::Linear, &line[..], Derivative::Velocity),
            (SegmentShape::Linear, &line[..], Derivative::Acceleration),
        ] {
            let block = PathBlock::of(shape, points.iter().copied());
            let peak = AxesMotion::of(&block).peak(Axis::Z, derivative).unwrap();
            let [all, of_half] = [ROUNDING, half]
                .map(|rounding| certain(&block, rounding).amount(Axis::Z, derivative));
            assert!(all <= 1e-9 * peak.amount, "{derivative:?}: {all}");
            assert!(
                (of_half / peak.amount - 0.5).abs() < 1e-9,
                "{derivative:?}: {of_half}"
            );
        }
    }

    /// A controller of 24 bits cuts a place of 20 mm by up to 1.2 nm.
    #[test]
    fn few_bits_round_large_places_more() {
        let few_bits = |value: f64| f64::from(value as f32);
        let file = path(SegmentShape::Cubic, few_bits);
        let part = 1.0 / f64::from(1 << 24);
        let of_bits = Rounding {
            velocity: 20.0 * part,
            angular_velocity: 20.0 * part,
            part,
            ..Rounding::default()
        };
        let certain = certain(&file, of_bits);
        for (axis, derivative, peak) in peaks(&path(SegmentShape::Cubic, |value| value)) {
            let found = certain.amount(axis, derivative);
            assert!(
                found <= peak * (1.0 + 1e-9),
                "{axis:?} {derivative:?}: {found} {peak}"
            );
        }
    }

    /// A blend at a border counts, and one with a lead belongs to the lead.
    #[test]
    fn blocks_have_the_blends_of_the_whole_path() {
        let mut points = path(SegmentShape::Linear, |value| value);
        // Corners at the borders of the blocks below.
        for (place, moved) in [(100, 1e-3), (200, 2e-3)] {
            points.z[place] += moved;
        }
        let block = |range: std::ops::RangeInclusive<usize>| {
            let some = points.points().skip(*range.start());
            PathBlock::of(points.shape, some.take(range.count()))
        };
        let parts = [block(0..=100), block(100..=200), block(200..=299)];
        let meter = || CertainMeter::new(Rounding::default(), Rounding::default());
        let mut one = meter();
        for part in &parts {
            one.append(&one.measure(Section::Cutting, part));
        }
        assert_eq!(*one.cut(), certain(&points, Rounding::default()));

        let mut other = meter();
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        for (part, section) in parts.iter().zip(sections) {
            other.append(&other.measure(section, part));
        }
        let of = |motion: &CertainMotion| motion.amount(Axis::Z, Derivative::Acceleration);
        assert_eq!(of(other.leads()), of(one.cut()));
        assert!(of(other.cut()) < 0.5 * of(one.cut()));
    }

    #[test]
    fn a_segment_that_takes_no_time_is_not_excused() {
        let mut points = path(SegmentShape::Cubic, rounded);
        points.t[7] = points.t[6];
        let certain = certain(&points, ROUNDING);
        assert_eq!(certain.amount(Axis::Z, Derivative::Jerk), f64::INFINITY);
    }
}
