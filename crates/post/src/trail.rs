//! The way of a program from point to point: each segment as one line, or divided into several.

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Segment, SegmentShape};

use crate::chord::chords_within;
use crate::digit_columns::DigitColumns;
use crate::digit_segments::DigitSegments;
use crate::digits::{DigitSegment, Digits, Place, steps_of, turn};
use crate::program_error::ProgramError;
use crate::program_format::{LIFTS, ProgramFormat, Slowest};

/// Most chords of a segment: far more than any path needs that a machine can play.
const MOST_CHORDS: i64 = 1_000_000;

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
    /// Along segments of which none is divided.
    Segments(&'a DigitSegments<'a>),
}

impl Move<'_> {
    /// Whether it ends at a point of the path, and not at one between two of them.
    pub(crate) fn reaches_point(&self) -> bool {
        match self {
            Self::Start(_) | Self::Segments(_) => true,
            Self::Segment { reaches_point, .. } => *reaches_point,
        }
    }

    /// The points of the program that it reaches.
    pub(crate) fn points(&self) -> usize {
        match self {
            Self::Start(_) | Self::Segment { .. } => 1,
            Self::Segments(segments) => segments.count(),
        }
    }
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
        for _ in 0..LIFTS {
            if self.is_slow(from, to) {
                to.position[2] += step;
            }
        }
    }
}

/// What the lines before have left.
pub(crate) struct Trail {
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
    pub(crate) fn new(shape: SegmentShape) -> Self {
        Self {
            shape,
            point: None,
            in_lead: false,
            digits: None,
            steps: None,
        }
    }

    /// Goes on to the next point, which may be of a lead, and whose digits may be known.
    pub(crate) fn go_to(
        &mut self,
        format: &ProgramFormat,
        (point, in_lead): (&ControlPoint, bool),
        known: Option<Digits>,
        write: &mut impl FnMut(Move<'_>),
    ) -> Result<(), ProgramError> {
        // Known digits need no segment, and most segments are not divided.
        let segment = known.map_or_else(|| self.segment_to(point), |_| None);
        let end = match known {
            Some(digits) => digits,
            None => {
                let place = self.place(point, segment.as_ref(), in_lead);
                Digits::at(format, &place, steps_of(format, point))?
            }
        };
        match self.digits {
            None => write(Move::Start(&end)),
            Some(from) => {
                let steps = end.steps - from.steps;
                if steps < 1 {
                    let (t, c_deg) = (point.t, point.c / DEG);
                    return Err(ProgramError::Short { t, c_deg });
                }
                // A cubic that is not longer than the longest is one line.
                if format.chords.is_some() || steps > format.longest {
                    let segment = segment.or_else(|| self.segment_to(point));
                    let divided = (point, segment.as_ref());
                    self.write_inner_lines(format, divided, in_lead, &end, write)?;
                }
                self.write_segment(format, point, (end, true), write)?;
            }
        }
        self.point = Some(*point);
        self.in_lead = in_lead;
        self.digits = Some(end);
        Ok(())
    }

    /// The segments to the next points, whose digits are known, where each of them is one line.
    pub(crate) fn segments_to<'a>(
        &self,
        format: &ProgramFormat,
        ends: (&'a DigitColumns, usize),
    ) -> Option<DigitSegments<'a>> {
        DigitSegments::new(format, (self.digits?, self.steps), ends)
    }

    /// Takes up the end of segments that were written: a point, which may be of a lead.
    pub(crate) fn went_along(
        &mut self,
        segments: &DigitSegments<'_>,
        point: Option<ControlPoint>,
        in_lead: bool,
    ) {
        let last = segments.count() - 1;
        self.point = point;
        self.in_lead = in_lead;
        self.digits = segments.ends().at(last);
        self.steps = segments.steps(last);
    }

    /// Writes all lines of a segment but the last: there are some where it is divided. It ends at a point.
    fn write_inner_lines(
        &mut self,
        format: &ProgramFormat,
        (point, segment): (&ControlPoint, Option<&Segment>),
        in_lead: bool,
        end: &Digits,
        write: &mut impl FnMut(Move<'_>),
    ) -> Result<(), ProgramError> {
        let Some((from, segment)) = self.digits.zip(segment) else {
            return Ok(());
        };
        let steps = end.steps - from.steps;
        let of_lead = in_lead || self.in_lead;
        let slowest = format.chords.and_then(|chords| chords.slowest);
        let slowest = slowest.filter(|_| of_lead);
        let parts = self.parts(format, segment, (steps, of_lead), point)?;
        let parts = match slowest.is_some_and(|slowest| slowest.is_slow(&from, end)) {
            // There must be a place between the ends that is far enough from both.
            true => parts.max(2).min(steps),
            false => parts,
        };
        let middle = Place {
            grid: end.position,
            ..self.place(point, Some(segment), of_lead)
        };
        for part in 1..parts {
            let at = from.steps + steps / parts * part + steps % parts * part / parts;
            let mut middle = Digits::at(format, &middle, at)?;
            if let Some((slowest, from)) = slowest.zip(self.digits) {
                slowest.lift(&from, &mut middle);
            }
            self.write_segment(format, point, (middle, false), write)?;
        }
        Ok(())
    }

    /// What the path plays up to the next point.
    fn segment_to(&self, point: &ControlPoint) -> Option<Segment> {
        let before = self.point.as_ref()?;
        Some(Segment::of_shape(self.shape, before, point))
    }

    /// A place at the next point.
    fn place<'a>(
        &self,
        point: &ControlPoint,
        segment: Option<&'a Segment>,
        in_lead: bool,
    ) -> Place<'a> {
        Place {
            arrival: self.arrival(point, segment),
            segment,
            in_lead,
            grid: [0; 3],
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
        write: &mut impl FnMut(Move<'_>),
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
