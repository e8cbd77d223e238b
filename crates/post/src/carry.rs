//! Control points on a program's steps of time and in its digits: the half of writing that all
//! dialects share.

use turnpath_core::DEG;
use turnpath_core::toolpath::{
    ControlPoint, PathBlock, Section, SectionBlock, Segment, SegmentShape,
};

use crate::chord::chords_within;
use crate::program_error::ProgramError;
use crate::program_format::{ProgramFormat, Slowest, TURN_DEG};

/// Beyond this a double times a power of ten is not exact.
const LARGEST_UNITS: f64 = 9e15;
/// Most chords of a segment: far more than any path needs that a machine can play.
const MOST_CHORDS: i64 = 1_000_000;
/// The program's axes, in the order in which they are written.
pub(crate) const AXES: [char; 3] = ['C', 'X', 'Z'];

/// A control point in a program's digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits {
    /// Time in steps.
    pub steps: i64,
    /// C, X, Z in last digits; C unwrapped.
    pub position: [i64; 3],
    /// Their velocities in last digits; zero in a program without velocities.
    pub velocity: [i64; 3],
}

/// A segment in a program's digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DigitSegment {
    /// Where it begins.
    pub from: Digits,
    /// Where it ends.
    pub to: Digits,
    /// The steps of the segment before; `None` for the first segment.
    pub steps_before: Option<i64>,
}

/// A line between a lead and the cut begins or ends on the finer steps of the cut. So X and Z may be left
/// with a way that is too short for the slowest motion.
impl Slowest {
    /// Whether X and Z move in a line of a lead, and both by less than a step of leads.
    fn is_slow(&self, from: &Digits, to: &Digits) -> bool {
        let way = |k: usize| to.position[k].abs_diff(from.position[k]);
        let is_short = |k: usize| way(k) < self.lead_steps[k].unsigned_abs();
        way(1) + way(2) > 0 && is_short(1) && is_short(2)
    }

    /// Moves a place of a lead away from the part, by a step or two, so that the line to it is not slow.
    fn lift(&self, from: &Digits, to: &mut Digits) {
        let step = self.lead_steps[2];
        while self.is_slow(from, to) {
            to.position[2] += step;
        }
    }
}

impl DigitSegment {
    /// The steps that it takes.
    pub fn steps(&self) -> i64 {
        self.to.steps - self.from.steps
    }

    /// Time in s and C of the path in deg where it ends.
    pub(crate) fn end(&self, format: &ProgramFormat) -> (f64, f64) {
        let c = self.to.position[0] as f64 / 10u64.pow(format.position_decimals) as f64;
        let t = self.to.steps as f64 / format.steps_per_s as f64;
        (t, format.c_sign() * c)
    }
}

/// A move of a program.
pub(crate) enum Move<'a> {
    /// To the path's first point.
    Start(&'a Digits),
    /// Along a segment, or along a part of one.
    Segment {
        /// The segment.
        segment: &'a DigitSegment,
        /// Whether it ends at a point of the path, and not at one between two of them.
        reaches_point: bool,
    },
}

/// Gives the first point and the segments of a stretch in their order, long segments divided; returns
/// the number of their points.
pub(crate) fn carry(
    format: &ProgramFormat,
    stretch: &SectionBlock<'_>,
    write: &mut dyn FnMut(Move<'_>),
) -> Result<usize, ProgramError> {
    let mut trail = Trail::new(stretch.points.shape);
    let in_lead = stretch.section != Section::Cutting;
    // The section before a cut is the lead-in, and that before a lead-out is the cut.
    let before_in_lead = in_lead != stretch.opens_section;
    for point in stretch.before {
        trail.go_to(format, point, before_in_lead, &mut |_| {})?;
    }
    let mut points = 0;
    for point in stretch.points.points() {
        trail.go_to(format, &point, in_lead, &mut |step| {
            points += 1;
            write(step);
        })?;
    }
    Ok(points)
}

/// Points of a program.
#[derive(Debug, Clone, Default)]
pub struct CarriedPoints {
    /// The points.
    pub points: PathBlock,
    /// How many of them, at the beginning, belong to the section before: those between the last point of
    /// a lead-in and the first point of the cut.
    pub of_section_before: usize,
}

/// The points of a stretch as a program carries them: on the controller's steps of time, in the
/// program's digits, C unwrapped, long segments divided.
pub(crate) fn carried(
    format: &ProgramFormat,
    stretch: &SectionBlock<'_>,
) -> Result<CarriedPoints, ProgramError> {
    let mut carried = CarriedPoints {
        points: PathBlock {
            shape: format.shape(),
            ..PathBlock::default()
        },
        of_section_before: 0,
    };
    let mut is_before = leads_into_cut(stretch);
    carry(format, stretch, &mut |step| {
        let (digits, reaches_point) = match step {
            Move::Start(digits) => (digits, true),
            Move::Segment {
                segment,
                reaches_point,
            } => (&segment.to, reaches_point),
        };
        is_before &= !reaches_point;
        carried.of_section_before += usize::from(is_before);
        carried.points.push(digits.point(format));
    })?;
    Ok(carried)
}

/// Whether a stretch begins with the way from a lead-in to the cut, which belongs to the lead-in.
pub(crate) fn leads_into_cut(stretch: &SectionBlock<'_>) -> bool {
    stretch.opens_section && stretch.section == Section::Cutting
}

/// Whole turns of C that a program leaves out because it begins within 0 to 360 deg, rad.
pub(crate) fn turns_left_out(
    format: &ProgramFormat,
    first: &ControlPoint,
) -> Result<f64, ProgramError> {
    let place = Place {
        arrival: *first,
        segment: None,
        in_lead: false,
        grid: [0; 3],
    };
    let digits = Digits::at(format, &place, steps_of(format, first))?;
    let left_out = match format.c_wrapped {
        true => digits.position[0].div_euclid(turn(format)),
        false => 0,
    };
    Ok(format.c_sign() * std::f64::consts::TAU * left_out as f64)
}

/// The positions that a program's line says: absolute ones with C wrapped where the format has it so,
/// or distances.
pub(crate) fn said_positions(format: &ProgramFormat, segment: &DigitSegment) -> [i64; 3] {
    let ([c, x, z], [from_c, from_x, from_z]) = (segment.to.position, segment.from.position);
    match format.incremental {
        true => [c - from_c, x - from_x, z - from_z],
        false => said_place(format, &segment.to),
    }
}

/// The absolute position of a point as a program says it.
pub(crate) fn said_place(format: &ProgramFormat, digits: &Digits) -> [i64; 3] {
    let [c, x, z] = digits.position;
    match format.c_wrapped {
        true => [c.rem_euclid(turn(format)), x, z],
        false => [c, x, z],
    }
}

/// What the lines before have left.
struct Trail {
    /// What the path plays between its points.
    shape: SegmentShape,
    point: Option<ControlPoint>,
    /// Whether that point is of a lead.
    in_lead: bool,
    digits: Option<Digits>,
    /// The steps of the segment before.
    steps: Option<i64>,
}

impl Trail {
    fn new(shape: SegmentShape) -> Self {
        Self {
            shape,
            point: None,
            in_lead: false,
            digits: None,
            steps: None,
        }
    }

    /// Goes on to the next point, which may be of a lead.
    fn go_to(
        &mut self,
        format: &ProgramFormat,
        point: &ControlPoint,
        in_lead: bool,
        write: &mut dyn FnMut(Move<'_>),
    ) -> Result<(), ProgramError> {
        let segment = self.point.map(|before| self.segment(&before, point));
        let place = Place {
            arrival: self.arrival(point, segment.as_ref()),
            segment: segment.as_ref(),
            in_lead,
            grid: [0; 3],
        };
        let end = Digits::at(format, &place, steps_of(format, point))?;
        match self.digits.zip(segment.as_ref()) {
            None => write(Move::Start(&end)),
            Some((from, segment)) => {
                let steps = end.steps - from.steps;
                let (t, c_deg) = (point.t, point.c / DEG);
                if steps < 1 {
                    return Err(ProgramError::Short { t, c_deg });
                }
                let of_lead = in_lead || self.in_lead;
                let slowest = format.chords.and_then(|chords| chords.slowest);
                let slowest = slowest.filter(|_| of_lead);
                let parts = self.parts(format, segment, (steps, of_lead), point)?;
                let parts = match slowest.is_some_and(|slowest| slowest.is_slow(&from, &end)) {
                    // There must be a place between the ends that is far enough from both.
                    true => parts.max(2).min(steps),
                    false => parts,
                };
                let middle = Place {
                    in_lead: of_lead,
                    grid: end.position,
                    ..place
                };
                for part in 1..parts {
                    let at = from.steps + steps / parts * part + steps % parts * part / parts;
                    let mut middle = Digits::at(format, &middle, at)?;
                    if let Some((slowest, from)) = slowest.zip(self.digits) {
                        slowest.lift(&from, &mut middle);
                    }
                    self.write_segment(format, point, (middle, false), write)?;
                }
                self.write_segment(format, point, (end, true), write)?;
            }
        }
        self.point = Some(*point);
        self.in_lead = in_lead;
        self.digits = Some(end);
        Ok(())
    }

    /// What the path plays from one point to the next.
    fn segment(&self, before: &ControlPoint, point: &ControlPoint) -> Segment {
        match self.shape {
            SegmentShape::Cubic => Segment::between(before, point),
            SegmentShape::Linear => Segment::straight(before, point),
        }
    }

    /// A point with the velocities at which it is reached. Between straight lines, its own are those
    /// of the line behind it.
    fn arrival(&self, point: &ControlPoint, segment: Option<&Segment>) -> ControlPoint {
        match segment.filter(|_| self.shape == SegmentShape::Linear) {
            None => *point,
            Some(segment) => ControlPoint {
                vc: segment.c.slope(1.0) / segment.duration,
                vx: segment.x.slope(1.0) / segment.duration,
                vz: segment.z.slope(1.0) / segment.duration,
                ..*point
            },
        }
    }

    /// How many lines a segment of so many steps becomes.
    fn parts(
        &self,
        format: &ProgramFormat,
        segment: &Segment,
        (steps, of_lead): (i64, bool),
        point: &ControlPoint,
    ) -> Result<i64, ProgramError> {
        // Rounded up, without a sum that could be too large.
        let of_time = |longest: i64| (steps - 1) / longest + 1;
        let parts = of_time(format.longest);
        let Some(chords) = &format.chords else {
            return Ok(parts);
        };
        let slowest = chords.slowest.filter(|_| of_lead);
        let in_lead = slowest.map_or(1, |slowest| of_time(slowest.longest_in_lead));
        let needed = match self.shape {
            SegmentShape::Cubic => chords_within(chords.deviation, segment),
            SegmentShape::Linear => 1.0,
        };
        if needed > MOST_CHORDS as f64 || needed.is_nan() {
            let (t, c_deg) = (point.t, point.c / DEG);
            let most = MOST_CHORDS;
            return Err(ProgramError::ManyChords { most, t, c_deg });
        }
        Ok(parts.max(in_lead).max(needed as i64).min(steps))
    }

    /// Writes one segment, or a part of one; `point` is the end of the whole, for messages.
    fn write_segment(
        &mut self,
        format: &ProgramFormat,
        point: &ControlPoint,
        (to, reaches_point): (Digits, bool),
        write: &mut dyn FnMut(Move<'_>),
    ) -> Result<(), ProgramError> {
        let Some(from) = self.digits else {
            return Ok(());
        };
        let turned = to.position[0] - from.position[0];
        if format.c_wrapped && !format.incremental && turned.abs() >= turn(format) / 2 {
            let (t, c_deg) = (point.t, point.c / DEG);
            return Err(ProgramError::HalfTurn { t, c_deg });
        }
        let segment = DigitSegment {
            from,
            to,
            steps_before: self.steps,
        };
        refuse_beyond_c(format, &segment)?;
        if segment.steps() < format.shortest {
            let ms = |steps: i64| 1e3 * steps as f64 / format.steps_per_s as f64;
            let (t, c_deg) = segment.end(format);
            return Err(ProgramError::ShorterThanSaid {
                t,
                c_deg,
                ms: ms(segment.steps()),
                shortest_ms: ms(format.shortest),
            });
        }
        write(Move::Segment {
            segment: &segment,
            reaches_point,
        });
        self.steps = Some(segment.steps());
        self.digits = Some(to);
        Ok(())
    }
}

/// Refuses a C that the axis does not reach. A C within a turn is that of an axis without an end.
fn refuse_beyond_c(format: &ProgramFormat, segment: &DigitSegment) -> Result<(), ProgramError> {
    let limit = format.c_limit.filter(|_| !format.c_wrapped);
    let c = segment.to.position[0];
    match limit.filter(|limit| c.unsigned_abs() > limit.unsigned_abs()) {
        None => Ok(()),
        Some(limit) => {
            let one = 10u64.pow(format.position_decimals) as f64;
            Err(ProgramError::BeyondC {
                c_deg: c as f64 / one,
                limit_deg: limit as f64 / one,
                t: segment.end(format).0,
            })
        }
    }
}

/// A place on the path at or near a control point.
#[derive(Clone, Copy)]
struct Place<'a> {
    /// The point with the velocities at which it is reached.
    arrival: ControlPoint,
    /// What is played up to the point; `None` at the path's first point.
    segment: Option<&'a Segment>,
    /// Whether it is of a lead.
    in_lead: bool,
    /// A position from which places are multiples of their steps away.
    grid: [i64; 3],
}

/// The time of a point in steps.
fn steps_of(format: &ProgramFormat, point: &ControlPoint) -> i64 {
    (point.t * format.steps_per_s as f64).round() as i64
}

impl Digits {
    /// The digits at a step of time at or near a place.
    fn at(format: &ProgramFormat, place: &Place<'_>, steps: i64) -> Result<Self, ProgramError> {
        let point = &place.arrival;
        let moved = at_time(
            point,
            place.segment,
            steps as f64 / format.steps_per_s as f64,
        );
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let positions = [sign * moved.c / DEG, moved.x, moved.z - format.z_above];
        let velocities = [sign * moved.vc / DEG, moved.vx, moved.vz].map(|v| v * per);
        let has_velocities = format.shape() == SegmentShape::Cubic;
        let slowest = format.chords.and_then(|chords| chords.slowest);
        let multiples = slowest.map_or([1; 3], |slowest| slowest.steps(place.in_lead));
        let (mut position, mut velocity) = ([0; 3], [0; 3]);
        for (k, axis) in AXES.into_iter().enumerate() {
            let units = |value: f64, decimals: u32| {
                let t = point.t;
                units(value, decimals).ok_or(ProgramError::Digits {
                    axis,
                    value,
                    decimals,
                    t,
                })
            };
            let digits = units(positions[k], format.position_decimals)?;
            let origin = place.grid[k];
            position[k] = origin + nearest_multiple(digits - origin, multiples[k]);
            if has_velocities {
                velocity[k] = units(velocities[k], format.velocity_decimals)?;
            }
        }
        Ok(Self {
            steps,
            position,
            velocity,
        })
    }

    /// The control point that has these digits.
    fn point(&self, format: &ProgramFormat) -> ControlPoint {
        let one = |decimals: u32| 10u64.pow(decimals) as f64;
        let position = |p: i64| p as f64 / one(format.position_decimals);
        let held = |p: i64| match format.mantissa_bits {
            Some(bits) if !format.incremental => held(position(p), bits),
            _ => position(p),
        };
        let [c, x, z] = self.position;
        let turns_apart = match format.c_wrapped {
            true => c.div_euclid(turn(format)) * turn(format),
            false => 0,
        };
        let c = position(turns_apart) + held(c - turns_apart);
        let [x, z] = [x, z].map(held);
        let velocity = one(format.velocity_decimals) * format.velocity_time();
        let [vc, vx, vz] = self.velocity.map(|v| v as f64 / velocity);
        let to_angle = format.c_sign() * DEG;
        ControlPoint {
            t: self.steps as f64 / format.steps_per_s as f64,
            c: to_angle * c,
            x,
            z: z + format.z_above,
            vc: to_angle * vc,
            vx,
            vz,
        }
    }
}

/// A number with so many bits of its size, rounded: the other bits of the double's 53 are cut.
fn held(value: f64, bits: u32) -> f64 {
    let cut = f64::MANTISSA_DIGITS.saturating_sub(bits);
    let half = (1_u64 << cut) >> 1;
    f64::from_bits((value.to_bits() + half) >> cut << cut)
}

/// A value in last digits, if it fits.
fn units(value: f64, decimals: u32) -> Option<i64> {
    let scaled = (value * 10u64.pow(decimals) as f64).round();
    (scaled.abs() <= LARGEST_UNITS).then_some(scaled as i64)
}

/// The multiple of `step` next to a value.
fn nearest_multiple(value: i64, step: i64) -> i64 {
    (value + step / 2).div_euclid(step) * step
}

/// The point at a time in or near the segment that ends at `point` with the velocities of the point.
fn at_time(point: &ControlPoint, segment: Option<&Segment>, time: f64) -> ControlPoint {
    let by = time - point.t;
    let bends = segment.map_or([(0.0, 0.0); 3], |segment| {
        let h = segment.duration;
        [&segment.c, &segment.x, &segment.z]
            .map(|axis| (axis.bend(1.0) / (h * h), axis.jerk() / (h * h * h)))
    });
    let place = |p: f64, v: f64, (a, j): (f64, f64)| p + by * (v + by * (a / 2.0 + by * j / 6.0));
    let speed = |v: f64, (a, j): (f64, f64)| v + by * (a + by * j / 2.0);
    let [c, x, z] = bends;
    ControlPoint {
        t: time,
        c: place(point.c, point.vc, c),
        x: place(point.x, point.vx, x),
        z: place(point.z, point.vz, z),
        vc: speed(point.vc, c),
        vx: speed(point.vx, x),
        vz: speed(point.vz, z),
    }
}

/// A revolution in last digits.
fn turn(format: &ProgramFormat) -> i64 {
    TURN_DEG * 10i64.pow(format.position_decimals)
}
