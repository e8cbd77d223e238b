//! Leads: how far they stay from the part, and how smoothly they join the cut.
//!
//! What is between two control points of different sections belongs to the lead: its last segment
//! ends with the first point that cuts, the lead-out's first begins with the last one.

use turnpath_core::Result;
use turnpath_core::toolpath::{Cubic, PathBlock, Segment, SegmentShape};

use crate::axes::AxesMotion;
use crate::coverage::lowest;
use crate::playback::{BATCH, INSTANTS, Room};
use crate::touch::FirstTouch;

/// Largest steps of the acceleration from one segment to the next.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jumps {
    /// Of C, rad/s².
    pub c: f64,
    /// Of X, mm/s².
    pub x: f64,
    /// Of Z, mm/s².
    pub z: f64,
}

impl Jumps {
    fn see(&mut self, before: Acceleration, after: Acceleration) {
        self.c = self.c.max((after[0] - before[0]).abs());
        self.x = self.x.max((after[1] - before[1]).abs());
        self.z = self.z.max((after[2] - before[2]).abs());
    }

    fn append(&mut self, other: &Self) {
        self.c = self.c.max(other.c);
        self.x = self.x.max(other.x);
        self.z = self.z.max(other.z);
    }
}

/// What was measured on leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadFigures {
    /// Smallest played − first touch of Z, mm: negative where the tool would plunge, infinite
    /// without a lead, no number where there was none.
    pub clearance: f64,
    /// C where it is, unwrapped, rad.
    pub at_c: f64,
    /// X where it is, mm.
    pub at_x: f64,
    /// How far X as played goes below 0, mm.
    pub x_beyond_axis: f64,
    /// Steps of the acceleration at the control points of leads, those where they join the cut
    /// among them; nothing is told of straight segments.
    pub jumps: Jumps,
    /// Motion of the axes.
    pub axes: AxesMotion,
    /// How many segments were measured.
    pub segments: u64,
}

impl Default for LeadFigures {
    fn default() -> Self {
        Self {
            clearance: f64::INFINITY,
            at_c: 0.0,
            at_x: 0.0,
            x_beyond_axis: 0.0,
            jumps: Jumps::default(),
            axes: AxesMotion::default(),
            segments: 0,
        }
    }
}

impl LeadFigures {
    fn see(&mut self, clearance: f64, c: f64, x: f64) {
        if !self.clearance.is_nan() && (clearance.is_nan() || clearance < self.clearance) {
            (self.clearance, self.at_c, self.at_x) = (clearance, c, x);
        }
    }

    fn append(&mut self, next: &Self) {
        self.see(next.clearance, next.at_c, next.at_x);
        self.x_beyond_axis = self.x_beyond_axis.max(next.x_beyond_axis);
        self.jumps.append(&next.jumps);
        self.axes.append(&next.axes);
        self.segments += next.segments;
    }
}

/// Accelerations of C, X and Z.
type Acceleration = [f64; 3];

/// The measure of one stretch of a lead.
#[derive(Debug, Clone, Default)]
pub struct LeadStretch {
    /// What was measured.
    pub figures: LeadFigures,
    /// Smallest clearance of each segment, mm.
    pub per_segment: Vec<f64>,
    /// Clearance of the control point with which each segment begins, mm; infinite where there is
    /// nothing to touch.
    pub per_start: Vec<f64>,
    ends: Option<[Acceleration; 2]>,
}

/// Where the last stretch ended.
#[derive(Debug, Clone, Copy)]
struct End {
    acceleration: Acceleration,
    cutting: bool,
}

/// Measures the leads of a path, which passes it in order, cut and all.
#[derive(Debug, Clone, Default)]
pub struct LeadMeter {
    figures: LeadFigures,
    end: Option<End>,
}

impl LeadMeter {
    /// Measures the segments between neighbouring points of a lead; can run in parallel.
    ///
    /// Beyond the rim by more than the nose's reach there is nothing to touch, whatever the
    /// surface's formula says of it.
    pub fn measure(touch: &FirstTouch, points: &PathBlock) -> Result<LeadStretch> {
        let segments: Vec<Segment> = points.segments().collect();
        let mut stretch = LeadStretch {
            ends: ends(points),
            ..LeadStretch::default()
        };
        stretch.figures.axes = AxesMotion::of(points);
        let mut room = Room::default();
        for batch in segments.chunks(BATCH) {
            room.play(batch, touch)?;
            for (i, segment) in batch.iter().enumerate() {
                let smallest = stretch.figures.play(touch, &room, i, segment);
                stretch.per_segment.push(smallest);
                stretch.per_start.push(at_start(touch, &room, i));
            }
        }
        stretch.figures.segments = segments.len() as u64;
        let beyond = segments.iter().map(|segment| -lowest(&segment.x));
        stretch.figures.x_beyond_axis = beyond.fold(0.0, f64::max);
        if points.shape == SegmentShape::Cubic {
            for pair in segments.windows(2) {
                let (before, after) = (at(&pair[0], 1.0), at(&pair[1], 0.0));
                stretch.figures.jumps.see(before, after);
            }
        }
        Ok(stretch)
    }

    /// Puts a lead's next stretch behind what has passed.
    pub fn append(&mut self, next: &LeadStretch) {
        self.figures.append(&next.figures);
        self.follow(next.ends, false);
    }

    /// The cut's next stretch passes, of which only the ends count.
    pub fn pass(&mut self, points: &PathBlock) {
        self.follow(ends(points), true);
    }

    fn follow(&mut self, ends: Option<[Acceleration; 2]>, cutting: bool) {
        let Some([first, last]) = ends else { return };
        if let Some(end) = self.end.filter(|end| !(end.cutting && cutting)) {
            self.figures.jumps.see(end.acceleration, first);
        }
        self.end = Some(End {
            acceleration: last,
            cutting,
        });
    }

    /// The figures so far; none where no lead has passed.
    pub fn figures(&self) -> Option<&LeadFigures> {
        (self.figures.segments > 0).then_some(&self.figures)
    }
}

impl LeadFigures {
    /// Takes the instants of one segment of a batch; gives the smallest clearance of them.
    fn play(&mut self, touch: &FirstTouch, room: &Room, index: usize, segment: &Segment) -> f64 {
        let part_ends = part_ends(touch);
        let mut smallest = f64::INFINITY;
        for (k, clearance) in room.errors(index).into_iter().enumerate() {
            let x = room.x(index, k);
            if x.abs() > part_ends {
                continue;
            }
            if clearance.is_nan() || clearance < smallest {
                smallest = clearance;
            }
            self.see(clearance, segment.c.value(k as f64 / INSTANTS as f64), x);
            if clearance.is_nan() {
                break;
            }
        }
        smallest
    }
}

/// |X| beyond which the nose has nothing of the part below it.
fn part_ends(touch: &FirstTouch) -> f64 {
    let subject = touch.subject();
    subject.part.aperture_radius + subject.tool.reach()
}

/// The clearance with which a segment of a batch begins.
fn at_start(touch: &FirstTouch, room: &Room, index: usize) -> f64 {
    match room.x(index, 0).abs() > part_ends(touch) {
        true => f64::INFINITY,
        false => room.errors(index)[0],
    }
}

/// Accelerations where a stretch begins and where it ends; none of straight segments.
fn ends(points: &PathBlock) -> Option<[Acceleration; 2]> {
    if points.shape == SegmentShape::Linear {
        return None;
    }
    let between = |from: usize| {
        let (from, to) = (points.get(from)?, points.get(from + 1)?);
        Some(Segment::between(&from, &to))
    };
    let last = between(points.len().checked_sub(2)?)?;
    Some([at(&between(0)?, 0.0), at(&last, 1.0)])
}

/// Accelerations at a place of a segment.
fn at(segment: &Segment, s: f64) -> Acceleration {
    let per_time = (segment.duration * segment.duration).recip();
    let of = |axis: &Cubic| axis.bend(s) * per_time;
    [of(&segment.c), of(&segment.x), of(&segment.z)]
}
