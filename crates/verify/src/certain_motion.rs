//! How hard the axes work for certain, where the numbers of a file were rounded to their last digits.
//!
//! A jerk is a difference of positions over the third power of a time. On a segment of a millisecond, half a last
//! digit of 10⁻⁷ mm at both ends makes up to 1200 mm/s³, and moves nothing by more than that half digit. On a segment
//! of a microsecond the last bits of doubles do the same. So what rounding can make of an amount, segment by segment,
//! is taken away from it.

use turnpath_core::toolpath::{Cubic, PathBlock, Section, Segment, SegmentShape};
use turnpath_core::{Axis, Derivative};

use crate::axes::Peak;
use crate::axis_terms::AxisTerm;
use crate::comparison::HalfDigits;

/// What last bits of doubles may make of a number, as a part of it. Several operations lie between it and the path, and
/// with half of this some of what they make stays. With more, real jerks of short segments late in a path would go.
const OF_DOUBLES: f64 = 8.0 * f64::EPSILON;

/// By how much numbers of a path may lie beside those that were rounded, besides the last bits of doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding {
    /// Of positions and velocities. Straight lines have no velocities, and steps of time are exact.
    pub digits: HalfDigits,
    /// By how much places of Z may have been lifted besides, mm.
    pub lift: f64,
    /// The last digit of X, mm; `None` where X has all digits of a double.
    pub last_digit: Option<f64>,
    /// The part of a position that is rounded besides: that of a controller that holds few bits.
    pub part: f64,
    /// The largest angle that the controller holds, rad; infinite where C is not wrapped.
    pub largest_angle: f64,
    /// Z of the path less Z of the program, mm.
    pub z_above: f64,
}

impl Default for Rounding {
    /// All digits of a double.
    fn default() -> Self {
        Self {
            digits: HalfDigits::default(),
            lift: 0.0,
            last_digit: None,
            part: 0.0,
            largest_angle: f64::INFINITY,
            z_above: 0.0,
        }
    }
}

impl Rounding {
    /// The most that rounding can make of the position of an axis at either end of a segment. An axis at a wrong time is
    /// at a wrong place.
    fn of_positions(&self, axis: Axis, segment: &Segment) -> f64 {
        let [from, to] = [0.0, 1.0].map(|s| played(segment, axis).value(s));
        let held = |position: f64| match axis {
            Axis::C => position.abs().min(self.largest_angle),
            Axis::X => position.abs(),
            Axis::Z => (position - self.z_above).abs(),
        };
        let size = held(from).max(held(to));
        let speed = (to - from).abs() / segment.duration;
        let digits = match axis {
            Axis::C => self.digits.angle,
            Axis::X => self.digits.position,
            Axis::Z => self.digits.position + self.lift,
        };
        let end = segment.start.abs() + segment.duration;
        let of_doubles = OF_DOUBLES * (from.abs().max(to.abs()) + speed * end);
        digits + self.part * size + of_doubles
    }

    /// The most that rounding can make of the velocity, acceleration and jerk of a cubic. With p and v the rounding
    /// of positions and velocities, and h the time: 3p/h + v, 12p/h² + 6v/h and 24p/h³ + 12v/h², by the Hermite
    /// form of a cubic.
    fn of_cubic(&self, axis: Axis, segment: &Segment) -> [f64; 3] {
        let (cubic, duration) = (played(segment, axis), segment.duration);
        let rate = self.of_positions(axis, segment) / duration;
        let digits = match axis {
            Axis::C => self.digits.angular_velocity,
            Axis::X | Axis::Z => self.digits.velocity,
        };
        let largest = cubic.slope(0.0).abs().max(cubic.slope(1.0).abs()) / duration;
        let velocity = digits + OF_DOUBLES * largest;
        let first = 3.0 * rate + velocity;
        let second = (12.0 * rate + 6.0 * velocity) / duration;
        [first, second, 2.0 * second / duration]
    }

    /// The most that rounding can make of the rate of a straight segment.
    fn of_rate(&self, axis: Axis, line: &Segment) -> f64 {
        2.0 * self.of_positions(axis, line) / line.duration
    }
}

/// The largest amounts of velocity, acceleration and jerk of each axis that are certain, in mm or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CertainMotion {
    /// By axis, and by derivative.
    largest: [[Peak; Derivative::ALL.len()]; Axis::ALL.len()],
}

impl CertainMotion {
    /// What is certain of the motion between neighbouring control points that are doubles.
    pub fn of(points: &PathBlock) -> Self {
        CertainBlock::of(Section::Cutting, points, &Rounding::default()).motion
    }

    /// The largest amount of a derivative, and the middle of its segment, or the corner of its blend.
    pub fn peak(&self, axis: Axis, derivative: Derivative) -> Peak {
        self.largest[axis as usize][derivative as usize]
    }

    /// Rises to what is certain of an amount at a place.
    fn rise(&mut self, (axis, derivative): (Axis, Derivative), found: Peak, rounding: f64) {
        let certain = match rounding.is_finite() {
            true => found.amount - rounding,
            // Of a segment that takes no time everything is certain.
            false => found.amount,
        };
        let largest = &mut self.largest[axis as usize][derivative as usize];
        if certain > largest.amount {
            *largest = Peak {
                amount: certain,
                ..found
            };
        }
    }

    fn include_cubic(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let term = AxisTerm::of(played(segment, axis), segment.duration);
            let amounts = [term.velocity, term.acceleration, term.jerk];
            let largest = &self.largest[axis as usize];
            if amounts
                .iter()
                .zip(largest)
                .all(|(amount, largest)| *amount <= largest.amount)
            {
                // Rounding takes from an amount, and never adds to it.
                continue;
            }
            let roundings = rounding.of_cubic(axis, segment);
            let each = amounts.into_iter().zip(roundings);
            for (derivative, (amount, rounding)) in Derivative::ALL.into_iter().zip(each) {
                let found = Peak::on(segment, 0.5, amount);
                self.rise((axis, derivative), found, rounding);
            }
        }
    }

    fn include_line(&mut self, segment: &Segment, rounding: &Rounding) {
        for axis in Axis::ALL {
            let found = Peak::on(segment, 0.5, rate(segment, axis).abs());
            let rounding = rounding.of_rate(axis, segment);
            self.rise((axis, Derivative::Velocity), found, rounding);
        }
    }

    /// Includes the blend from one straight segment into the next: see [`AxesMotion`](crate::AxesMotion).
    fn include_blend(&mut self, [before, after]: [&Segment; 2], rounding: &Rounding) {
        let blend = 0.5 * (before.duration + after.duration);
        for axis in Axis::ALL {
            let change = (rate(after, axis) - rate(before, axis)).abs();
            let found = Peak::on(after, 0.0, change / blend);
            let rounding = rounding.of_rate(axis, before) + rounding.of_rate(axis, after);
            self.rise((axis, Derivative::Acceleration), found, rounding / blend);
        }
    }

    fn append(&mut self, next: &Self) {
        let all = self.largest.iter_mut().flatten();
        for (largest, next) in all.zip(next.largest.iter().flatten()) {
            *largest = largest.or(*next);
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

/// How far, in last digits, a number may lie beside a whole number of them.
const OFF_DIGIT: f64 = 1e-2;

/// Whether X is no whole number of last digits, though it was said to be one.
fn is_off_digits(x: f64, rounding: &Rounding) -> bool {
    rounding.last_digit.is_some_and(|digit| {
        let number = x / digit;
        let held = rounding.part * number.abs();
        (number - number.round()).abs() > OFF_DIGIT + held + OF_DOUBLES * number.abs()
    })
}

/// What is certain of a block.
#[derive(Debug, Clone)]
pub struct CertainBlock {
    section: Section,
    motion: CertainMotion,
    /// Its first and its last segment, if they are straight.
    outer: Option<[Segment; 2]>,
    /// Whether it has more digits than it was said to have.
    has_more_digits: bool,
}

impl CertainBlock {
    /// What is certain of the segments between neighbouring points.
    pub fn of(section: Section, points: &PathBlock, rounding: &Rounding) -> Self {
        let mut block = Self {
            section,
            motion: CertainMotion::default(),
            outer: None,
            has_more_digits: points.x.iter().any(|x| is_off_digits(*x, rounding)),
        };
        for segment in points.segments() {
            match points.shape {
                SegmentShape::Cubic => block.motion.include_cubic(&segment, rounding),
                SegmentShape::Linear => block.follow_line(segment, rounding),
            }
        }
        block
    }

    /// Goes on with a straight segment.
    fn follow_line(&mut self, segment: Segment, rounding: &Rounding) {
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

/// Measures what is certain of a path. Blocks can be measured in parallel, and are appended in their order.
#[derive(Debug, Clone, Default)]
pub struct CertainMeter {
    of_cut: Rounding,
    of_leads: Rounding,
    cut: CertainMotion,
    leads: CertainMotion,
    /// The last straight segment so far, and its section.
    last: Option<(Segment, Section)>,
    has_more_digits: bool,
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
            has_more_digits: false,
        }
    }

    fn rounding(&self, section: Section) -> &Rounding {
        match section {
            Section::Cutting => &self.of_cut,
            Section::LeadIn | Section::LeadOut => &self.of_leads,
        }
    }

    /// Measures a block.
    pub fn measure(&self, section: Section, points: &PathBlock) -> CertainBlock {
        CertainBlock::of(section, points, self.rounding(section))
    }

    /// Appends the next block. The blend from a lead into the cut, or out of it, belongs to the lead.
    pub fn append(&mut self, next: &CertainBlock) {
        self.has_more_digits |= next.has_more_digits;
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

    /// What is certain of the cut; `None` if the path has more digits than it was said to have, since then nobody
    /// knows how it was rounded.
    pub fn cut(&self) -> Option<&CertainMotion> {
        (!self.has_more_digits).then_some(&self.cut)
    }

    /// The same of the leads.
    pub fn leads(&self) -> Option<&CertainMotion> {
        (!self.has_more_digits).then_some(&self.leads)
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;
    use crate::AxesMotion;

    /// Half a last digit of each kind of number, all of them different.
    const DIGITS: HalfDigits = HalfDigits {
        time: 0.0,
        position: 0.5e-7,
        angle: 0.25e-7,
        velocity: 2e-7,
        angular_velocity: 3e-7,
    };

    fn rounding() -> Rounding {
        Rounding {
            digits: DIGITS,
            last_digit: Some(2.0 * DIGITS.position),
            ..Rounding::default()
        }
    }

    /// A wave of Z and a slow X, with points about a millisecond apart, after a change.
    fn path(shape: SegmentShape, change: impl Fn(ControlPoint) -> ControlPoint) -> PathBlock {
        let mut t = 0.0;
        let points = (0..300).map(|i| {
            t += 1e-3 * (1.0 + 0.3 * Scalar::sin(f64::from(i)));
            let (sine, cosine) = Scalar::sin_cos(40.0 * t);
            change(ControlPoint {
                t,
                c: 9.0 * t,
                x: 20.0 - 0.2 * t - 1e-4 * sine,
                z: 0.5 * sine,
                vc: 9.0,
                vx: -0.2 - 4e-3 * cosine,
                vz: 20.0 * cosine,
            })
        });
        PathBlock::of(shape, points)
    }

    fn exact(shape: SegmentShape) -> PathBlock {
        path(shape, |point| point)
    }

    /// The path with numbers of [`DIGITS`].
    fn rounded(shape: SegmentShape) -> PathBlock {
        let kept = |value: f64, half: f64| (value / (2.0 * half)).round() * (2.0 * half);
        path(shape, |point| ControlPoint {
            c: kept(point.c, DIGITS.angle),
            x: kept(point.x, DIGITS.position),
            z: kept(point.z, DIGITS.position),
            vc: kept(point.vc, DIGITS.angular_velocity),
            vx: kept(point.vx, DIGITS.velocity),
            vz: kept(point.vz, DIGITS.velocity),
            ..point
        })
    }

    fn certain(points: &PathBlock, rounding: Rounding) -> CertainMotion {
        let mut meter = CertainMeter::new(rounding, Rounding::default());
        meter.append(&meter.measure(Section::Cutting, points));
        meter.cut
    }

    fn peaks(points: &PathBlock) -> impl Iterator<Item = (Axis, Derivative, Peak)> + use<> {
        let motion = AxesMotion::of(points);
        Axis::ALL.into_iter().flat_map(move |axis| {
            Derivative::ALL.into_iter().map(move |derivative| {
                let peak = motion.peak(axis, derivative);
                (axis, derivative, peak.unwrap_or_default())
            })
        })
    }

    /// Nothing above the motion of the path itself is certain of its file.
    #[track_caller]
    fn assert_below(certain: &CertainMotion, path: &PathBlock) {
        for (axis, derivative, peak) in peaks(path) {
            let found = certain.peak(axis, derivative).amount;
            let most = peak.amount * (1.0 + 1e-9);
            assert!(found <= most, "{axis:?} {derivative:?}: {found} of {most}");
        }
    }

    /// Nearly all of the speed of Z is certain.
    #[track_caller]
    fn assert_fast_z(certain: &CertainMotion) {
        let speed = certain.peak(Axis::Z, Derivative::Velocity).amount;
        assert!((speed - 20.0).abs() < 1e-2, "{speed}");
    }

    #[test]
    fn without_rounding_everything_is_certain() {
        for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
            let points = exact(shape);
            let certain = certain(&points, Rounding::default());
            for (axis, derivative, peak) in peaks(&points) {
                let found = certain.peak(axis, derivative);
                if axis == Axis::C {
                    // It turns evenly: its acceleration is that of last bits, and its speed is the same everywhere.
                    let is_speed = derivative == Derivative::Velocity;
                    let wanted = if is_speed { 9.0 } else { 0.0 };
                    assert!((found.amount - wanted).abs() < 1e-6, "{found:?}");
                    continue;
                }
                let most = peak.amount;
                let is_near = (0.999 * most..=most).contains(&found.amount);
                assert!(is_near, "{axis:?} {derivative:?}: {found:?} {peak:?}");
                // Within its segment, which is some millisecond long.
                assert!(
                    (found.at_c - peak.at_c).abs() < 0.02,
                    "{axis:?} {derivative:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_certain_of_a_rounded_path_is_not_above_the_path_itself() {
        for (shape, derivative) in [
            (SegmentShape::Cubic, Derivative::Jerk),
            (SegmentShape::Linear, Derivative::Acceleration),
        ] {
            let file = rounded(shape);
            let certain = certain(&file, rounding());
            assert_below(&certain, &exact(shape));
            assert_fast_z(&certain);
            // The file itself is rougher than the path.
            let of_x = |points: &PathBlock| AxesMotion::of(points).peak(Axis::X, derivative);
            let [rough, smooth] = [of_x(&file), of_x(&exact(shape))].map(Option::unwrap);
            assert!(rough.amount > 1.2 * smooth.amount, "{rough:?} {smooth:?}");
        }
    }

    /// Axes at rest whose numbers were rounded as badly as they can be: nothing is certain, and half of it would be
    /// with half the rounding.
    #[test]
    fn rounding_at_its_worst_is_no_motion() {
        let point = |t: f64, of_positions: f64, of_velocities: f64| ControlPoint {
            t,
            c: of_positions * DIGITS.angle,
            x: of_positions * DIGITS.position,
            z: of_positions * DIGITS.position,
            vc: of_velocities * DIGITS.angular_velocity,
            vx: of_velocities * DIGITS.velocity,
            vz: of_velocities * DIGITS.velocity,
        };
        let half = HalfDigits {
            time: 0.0,
            position: 0.5 * DIGITS.position,
            angle: 0.5 * DIGITS.angle,
            velocity: 0.5 * DIGITS.velocity,
            angular_velocity: 0.5 * DIGITS.angular_velocity,
        };
        let cubic = [point(0.0, -1.0, -1.0), point(1e-3, 1.0, -1.0)];
        let even = [
            point(0.0, 1.0, 0.0),
            point(1e-3, -1.0, 0.0),
            point(3e-3, 1.0, 0.0),
        ];
        for (shape, points, derivative) in [
            (SegmentShape::Cubic, &cubic[..], Derivative::Acceleration),
            (SegmentShape::Cubic, &cubic[..], Derivative::Jerk),
            (SegmentShape::Linear, &even[..], Derivative::Velocity),
            (SegmentShape::Linear, &even[..], Derivative::Acceleration),
        ] {
            let block = PathBlock::of(shape, points.iter().copied());
            for axis in Axis::ALL {
                let peak = AxesMotion::of(&block).peak(axis, derivative).unwrap();
                let [all, of_half] = [DIGITS, half].map(|digits| {
                    let rounding = Rounding {
                        digits,
                        ..Rounding::default()
                    };
                    certain(&block, rounding).peak(axis, derivative).amount / peak.amount
                });
                assert!(all <= 1e-9, "{axis:?} {derivative:?}: {all}");
                assert!(
                    (of_half - 0.5).abs() < 1e-9,
                    "{axis:?} {derivative:?}: {of_half}"
                );
            }
        }
        // 3p/h + v is a little more than the velocity of any place of a cubic can be.
        let block = PathBlock::of(SegmentShape::Cubic, cubic);
        let velocity = certain(&block, rounding()).peak(Axis::X, Derivative::Velocity);
        assert_eq!(velocity.amount, 0.0);
    }

    /// A controller of 24 bits cuts a place of 20 mm by up to 1.2 µm. Its Z is 30 mm below that of the path.
    #[test]
    fn few_bits_round_large_places_more() {
        let held = |value: f64| f64::from(value as f32);
        let file = path(SegmentShape::Cubic, |point| ControlPoint {
            c: held(point.c),
            x: held(point.x),
            z: held(point.z - 30.0) + 30.0,
            ..point
        });
        let of_bits = Rounding {
            part: 1.0 / f64::from(1 << 24),
            z_above: 30.0,
            ..Rounding::default()
        };
        let certain = certain(&file, of_bits);
        let path = exact(SegmentShape::Cubic);
        assert_below(&certain, &path);
        assert_fast_z(&certain);
        let jerk = |points: &PathBlock| AxesMotion::of(points).peak(Axis::Z, Derivative::Jerk);
        let [rough, smooth] = [jerk(&file), jerk(&path)].map(Option::unwrap);
        assert!(rough.amount > 2.0 * smooth.amount, "{rough:?} {smooth:?}");
    }

    /// A controller that holds C within a turn rounds it no more after a thousand turns.
    #[test]
    fn a_wrapped_angle_is_rounded_by_its_part_of_a_turn() {
        let far = path(SegmentShape::Cubic, |point| ControlPoint {
            c: point.c + 1e4,
            vc: 9.0 + Scalar::sin(40.0 * point.t),
            ..point
        });
        let of = |largest_angle: f64| {
            let rounding = Rounding {
                part: 1e-6,
                largest_angle,
                ..Rounding::default()
            };
            certain(&far, rounding)
                .peak(Axis::C, Derivative::Acceleration)
                .amount
        };
        let measured = AxesMotion::of(&far).c.acceleration.amount;
        assert_eq!(of(f64::INFINITY), 0.0);
        assert!((of(std::f64::consts::TAU) - measured).abs() < 0.2 * measured);
    }

    /// A blend at a border counts, and one with a lead belongs to the lead.
    #[test]
    fn blocks_have_the_blends_of_the_whole_path() {
        let mut points = exact(SegmentShape::Linear);
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
        let whole = certain(&points, Rounding::default());
        for axis in Axis::ALL {
            let of = |motion: &CertainMotion| motion.peak(axis, Derivative::Acceleration).amount;
            let [parts, whole] = [&one.cut, &whole].map(of);
            assert!(
                (parts - whole).abs() <= 1e-6 * whole,
                "{axis:?}: {parts} {whole}"
            );
        }

        let mut other = meter();
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        for (part, section) in parts.iter().zip(sections) {
            other.append(&other.measure(section, part));
        }
        let of = |motion: &CertainMotion| motion.peak(Axis::Z, Derivative::Acceleration);
        let [of_leads, of_cut] = [&other.leads, &one.cut].map(of);
        assert!((of_leads.amount / of_cut.amount - 1.0).abs() < 1e-6);
        assert!(of(&other.cut).amount < 0.5 * of(&one.cut).amount);
    }

    #[test]
    fn leads_have_a_rounding_of_their_own() {
        let mut meter = CertainMeter::new(Rounding::default(), rounding());
        meter.append(&meter.measure(Section::LeadOut, &rounded(SegmentShape::Cubic)));
        assert_below(meter.leads().unwrap(), &exact(SegmentShape::Cubic));
        assert_eq!(meter.cut().unwrap(), &CertainMotion::default());
    }

    /// A spindle that turns evenly, with a segment of a third of a microsecond after 17 seconds: the last bits of C and of the
    /// time make a jerk of its own.
    #[test]
    fn last_bits_of_doubles_make_no_jerk() {
        let spindle = 500.0 * std::f64::consts::TAU / 60.0;
        let point = |t: f64| ControlPoint {
            t,
            c: spindle * t,
            vc: spindle,
            ..ControlPoint::default()
        };
        let points = [16.9, 16.919_999_7, 16.92, 16.94].map(point);
        let block = PathBlock::of(SegmentShape::Cubic, points);
        let measured = AxesMotion::of(&block).c.jerk.amount;
        assert!(measured > 1e3, "{measured}");
        let certain = certain(&block, Rounding::default());
        assert_eq!(certain.peak(Axis::C, Derivative::Jerk).amount, 0.0);
        let speed = certain.peak(Axis::C, Derivative::Velocity).amount;
        assert!((speed - spindle).abs() < 1e-6, "{speed}");
    }

    #[test]
    fn a_segment_that_takes_no_time_is_not_excused() {
        let mut points = rounded(SegmentShape::Cubic);
        points.t[7] = points.t[6];
        let jerk = certain(&points, rounding()).peak(Axis::Z, Derivative::Jerk);
        assert_eq!(jerk.amount, f64::INFINITY);
    }

    /// Who says that a file has fewer digits than it has would be told that all its limits hold.
    #[test]
    fn a_path_with_more_digits_than_it_was_said_to_have_has_nothing_that_is_certain() {
        let coarse = Rounding {
            digits: HalfDigits {
                position: 100.0 * DIGITS.position,
                ..DIGITS
            },
            last_digit: Some(200.0 * DIGITS.position),
            ..Rounding::default()
        };
        for (said, is_known) in [
            (rounding(), true),
            (coarse, false),
            (Rounding::default(), true),
        ] {
            let mut meter = CertainMeter::new(said, said);
            meter.append(&meter.measure(Section::Cutting, &rounded(SegmentShape::Cubic)));
            assert_eq!(meter.cut().is_some(), is_known, "{said:?}");
            assert_eq!(meter.leads().is_some(), is_known, "{said:?}");
        }
    }
}
