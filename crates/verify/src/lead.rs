//! Leads: their clearance from the part, and how smoothly they join the cut.
//!
//! A segment between two control points of different sections belongs to the lead. The lead-in's
//! last segment ends at the first point that cuts. The lead-out's first segment begins at the last
//! point that cuts.

use turnpath_core::Result;
use turnpath_core::toolpath::{Cubic, PathBlock, Segment, SegmentShape};

use crate::axes::AxesMotion;
use crate::coverage::lowest;
use crate::instants::{INSTANTS, InstantBatch, batches};
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
    fn include(&mut self, before: Acceleration, after: Acceleration) {
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

/// The figures of a path's leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadFigures {
    /// Smallest difference of Z, played − first touch, mm. It is negative where the tool would
    /// plunge, infinite without a lead, and NaN if the difference is NaN anywhere.
    pub clearance: f64,
    /// C of its position, unwrapped, rad.
    pub at_c: f64,
    /// X of its position, mm.
    pub at_x: f64,
    /// How far X as played goes below 0, mm.
    pub x_beyond_axis: f64,
    /// Steps of the acceleration at the control points of leads, including the points where a lead
    /// joins the cut. Zero for straight segments, which have no such steps.
    pub jumps: Jumps,
    /// Motion of the axes.
    pub axes: AxesMotion,
    /// Number of segments.
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
    fn include(&mut self, clearance: f64, c: f64, x: f64) {
        if !self.clearance.is_nan() && (clearance.is_nan() || clearance < self.clearance) {
            (self.clearance, self.at_c, self.at_x) = (clearance, c, x);
        }
    }

    fn append(&mut self, next: &Self) {
        self.include(next.clearance, next.at_c, next.at_x);
        self.x_beyond_axis = self.x_beyond_axis.max(next.x_beyond_axis);
        self.jumps.append(&next.jumps);
        self.axes.append(&next.axes);
        self.segments += next.segments;
    }
}

/// Accelerations of C, X and Z.
type Acceleration = [f64; 3];

/// The figures of one block of a lead.
#[derive(Debug, Clone, Default)]
pub struct LeadBlockFigures {
    /// The figures of all its segments together.
    pub figures: LeadFigures,
    /// Smallest clearance of each segment, mm.
    pub per_segment: Vec<f64>,
    /// Clearance of the first control point of each segment, mm; infinite where there is nothing
    /// to touch.
    pub per_start: Vec<f64>,
    ends: Option<[Acceleration; 2]>,
}

/// Measures the leads of a path. It needs all blocks of the path in order, those of the cut too.
#[derive(Debug, Clone, Default)]
pub struct LeadMeter {
    figures: LeadFigures,
    /// The acceleration at the end of the last block of cubics.
    end: Option<Acceleration>,
    /// Whether that block, or one of straight segments, belongs to the cut.
    is_behind_cut: bool,
}

impl LeadMeter {
    /// Measures the segments between neighbouring points of a lead; can run in parallel.
    ///
    /// Beyond the rim by more than the nose's reach there is nothing to touch, even if the
    /// surface's formula has a height there.
    pub fn measure(touch: &FirstTouch, points: &PathBlock) -> Result<LeadBlockFigures> {
        let segments: Vec<Segment> = points.segments().collect();
        let mut block = LeadBlockFigures {
            ends: ends(points),
            ..LeadBlockFigures::default()
        };
        block.figures.axes = AxesMotion::of(points);
        let mut instants = InstantBatch::default();
        for batch in batches(0..segments.len()) {
            instants.play(points, batch.clone(), touch)?;
            for (i, segment) in segments[batch].iter().enumerate() {
                let smallest = block.figures.include_segment(touch, &instants, i, segment);
                block.per_segment.push(smallest);
                block.per_start.push(at_start(touch, &instants, i));
            }
        }
        block.figures.segments = segments.len() as u64;
        let beyond = segments.iter().map(|segment| -lowest(&segment.x));
        block.figures.x_beyond_axis = beyond.fold(0.0, f64::max);
        if points.shape == SegmentShape::Cubic {
            for pair in segments.windows(2) {
                let (before, after) = (at(&pair[0], 1.0), at(&pair[1], 0.0));
                block.figures.jumps.include(before, after);
            }
        }
        Ok(block)
    }

    /// Appends the next block of a lead.
    pub fn append(&mut self, next: &LeadBlockFigures) {
        self.figures.append(&next.figures);
        if let Some(ends) = next.ends {
            self.follow(ends, false);
        }
        self.is_behind_cut = false;
    }

    /// Appends the next block of the cut. Only its two ends count.
    pub fn append_cut(&mut self, points: &PathBlock) {
        let Some([first, last]) = outer_segments(points) else {
            return;
        };
        match points.shape {
            SegmentShape::Cubic => self.follow([at(&first, 0.0), at(&last, 1.0)], true),
            SegmentShape::Linear => {
                let first = (!self.is_behind_cut).then_some(&first);
                self.figures.axes.pass_straight(first, &last);
            }
        }
        self.is_behind_cut = true;
    }

    fn follow(&mut self, [first, last]: [Acceleration; 2], cutting: bool) {
        if let Some(end) = self.end.filter(|_| !(self.is_behind_cut && cutting)) {
            self.figures.jumps.include(end, first);
        }
        self.end = Some(last);
    }

    /// The figures so far; `None` if the path has no lead so far.
    pub fn figures(&self) -> Option<&LeadFigures> {
        (self.figures.segments > 0).then_some(&self.figures)
    }
}

impl LeadFigures {
    /// Includes the instants of one segment of a batch, and returns their smallest clearance.
    fn include_segment(
        &mut self,
        touch: &FirstTouch,
        instants: &InstantBatch,
        index: usize,
        segment: &Segment,
    ) -> f64 {
        let part_ends = part_ends(touch);
        let mut smallest = f64::INFINITY;
        for k in 0..INSTANTS {
            let (clearance, x) = (instants.error(index, k), instants.x(index, k));
            if x.abs() > part_ends {
                continue;
            }
            if clearance.is_nan() || clearance < smallest {
                smallest = clearance;
            }
            self.include(clearance, segment.c.value(k as f64 / INSTANTS as f64), x);
            if clearance.is_nan() {
                break;
            }
        }
        smallest
    }
}

/// |X| beyond which no part lies below the nose, mm.
fn part_ends(touch: &FirstTouch) -> f64 {
    let subject = touch.subject();
    subject.part.aperture_radius + subject.tool.reach()
}

/// The clearance at the start of a segment of a batch.
fn at_start(touch: &FirstTouch, instants: &InstantBatch, index: usize) -> f64 {
    match instants.x(index, 0).abs() > part_ends(touch) {
        true => f64::INFINITY,
        false => instants.error(index, 0),
    }
}

/// Accelerations at the two ends of a block; `None` for straight segments.
fn ends(points: &PathBlock) -> Option<[Acceleration; 2]> {
    let [first, last] = outer_segments(points).filter(|_| points.shape == SegmentShape::Cubic)?;
    Some([at(&first, 0.0), at(&last, 1.0)])
}

/// The first and the last segment of a block.
fn outer_segments(points: &PathBlock) -> Option<[Segment; 2]> {
    let last = points.len().checked_sub(2)?;
    Some([points.segment(0)?, points.segment(last)?])
}

/// Accelerations at the position `s` of a segment, 0 to 1.
fn at(segment: &Segment, s: f64) -> Acceleration {
    let per_time = (segment.duration * segment.duration).recip();
    let of = |axis: &Cubic| axis.bend(s) * per_time;
    [of(&segment.c), of(&segment.x), of(&segment.z)]
}
