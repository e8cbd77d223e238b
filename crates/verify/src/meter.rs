//! The meter: a path in stretches, measured apart and put together in order.

use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{Radial, RadialRange, Result};

use crate::axes::AxesMotion;
use crate::coverage::{Coverage, CoverageFigures};
use crate::machined::{Fan, Lines, MachinedFigures, SectionPasses};
use crate::playback::{PlaybackFigures, play_back};
use crate::points::{PointFigures, point_errors};
use crate::residual::{Passes, ResidualFigures};
use crate::touch::FirstTouch;

/// The measure of one stretch.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    /// Interpolation error.
    pub playback: PlaybackFigures,
    /// Largest |error| of each segment, mm.
    pub per_segment: Vec<f64>,
    /// Error of the control points.
    pub points: PointFigures,
    /// Z − first touch at each control point, mm.
    pub per_point: Vec<f64>,
    /// Residual within the stretch.
    pub residual: ResidualFigures,
    /// Motion of the axes.
    pub axes: AxesMotion,
    passes: Passes,
    sections: SectionPasses,
    coverage: Coverage,
    ends: Option<[ControlPoint; 2]>,
}

/// The measure of a whole path.
#[derive(Debug, Clone, Default)]
pub struct PathFigures {
    /// Interpolation error.
    pub playback: PlaybackFigures,
    /// Error of the control points.
    pub points: PointFigures,
    /// Residual; the cusps around the axis are in it where [`Meter::counting_centre`] says so.
    pub residual: ResidualFigures,
    /// What stays uncut at the part's edges and around the axis.
    pub coverage: CoverageFigures,
    /// Motion of the axes.
    pub axes: AxesMotion,
}

/// Measures a path against its subject.
pub struct Meter {
    touch: FirstTouch,
    figures: PathFigures,
    passes: Passes,
    lines: Lines,
    coverage: Coverage,
    counts_centre: bool,
    ends: Option<[ControlPoint; 2]>,
}

impl Meter {
    /// Nothing measured yet.
    pub fn new(touch: FirstTouch) -> Self {
        Self {
            touch,
            figures: PathFigures::default(),
            passes: Passes::default(),
            lines: Lines::new(Fan::WHOLE),
            coverage: Coverage::default(),
            counts_centre: false,
            ends: None,
        }
    }

    /// Whether the path covers the axis on purpose. The cusps between the passes of its both
    /// sides are then residual like any other; if not, they are told by the coverage alone.
    #[must_use]
    pub fn counting_centre(mut self, counts: bool) -> Self {
        self.counts_centre = counts;
        self
    }

    /// Finds first touches as this meter does.
    pub fn touch(&self) -> &FirstTouch {
        &self.touch
    }

    /// Measures the segments between neighbouring points; can run in parallel.
    pub fn measure(touch: &FirstTouch, points: &PathBlock) -> Result<Measured> {
        let mut measured = Measured {
            axes: AxesMotion::of(points),
            ends: ends(points),
            ..Measured::default()
        };
        measured.playback = play_back(touch, points, &mut measured.per_segment)?;
        measured.per_point = point_errors(touch, points)?;
        measured.points = PointFigures::of(points, &measured.per_point);
        measured.passes = Passes::of(touch, points)?;
        measured.residual = measured.passes.residual(touch)?;
        measured.sections = SectionPasses::of(touch, &Fan::WHOLE, points)?;
        measured.coverage = Coverage::of(touch, points, &measured.passes)?;
        Ok(measured)
    }

    /// Only the largest |error| of each segment, for refinement.
    pub fn segment_errors(touch: &FirstTouch, points: &PathBlock) -> Result<Vec<f64>> {
        let mut errors = Vec::new();
        play_back(touch, points, &mut errors)?;
        Ok(errors)
    }

    /// Puts the path's next stretch behind what has been measured. It begins with the control
    /// point with which the one before ended.
    pub fn append(&mut self, next: &Measured) -> Result<()> {
        self.figures.playback.append(&next.playback);
        self.figures.points.see(&next.points);
        self.figures.axes.append(&next.axes);
        self.figures.residual.append(&next.residual);
        let seam = self.passes.follow(&self.touch, &next.passes)?;
        self.figures.residual.append(&seam);
        self.lines.append(&next.sections);
        self.coverage.append(&next.coverage, &next.passes);
        self.ends = match (self.ends, next.ends) {
            (Some([first, _]), Some([_, last])) => Some([first, last]),
            (own, next) => own.or(next),
        };
        Ok(())
    }

    /// From which radius to which the path runs, by its two ends: of the contact, or where ρ is X,
    /// of X or the contact, whichever is further on. A path may end with either at the part's edge,
    /// by its overrun. `None` before anything was measured.
    pub fn reach(&self, radial: Radial) -> Result<Option<RadialRange>> {
        let Some(mut ends) = self.ends else {
            return Ok(None);
        };
        ends.sort_by(|one, other| one.x.total_cmp(&other.x));
        let mut touches = Vec::new();
        self.touch
            .find(&ends.map(|end| end.c), &ends.map(|end| end.x), &mut touches)?;
        let (inner, outer) = (touches[0].foot, touches[1].foot);
        Ok(Some(match radial {
            Radial::Contact => RadialRange {
                inner: inner.min(outer),
                outer: inner.max(outer),
            },
            Radial::Centre => RadialRange {
                inner: inner.min(ends[0].x),
                outer: outer.max(ends[1].x),
            },
        }))
    }

    /// The machined surface in figures; `None` where nothing of the part was cut.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn machined(&self) -> Result<Option<MachinedFigures>> {
        self.lines.figures(self.touch.subject())
    }

    /// The figures so far.
    pub fn figures(&self) -> Result<PathFigures> {
        let mut figures = self.figures.clone();
        let (coverage, around_axis) = self.coverage.figures(&self.touch)?;
        figures.coverage = coverage;
        if self.counts_centre {
            figures.residual.append(&around_axis);
        }
        Ok(figures)
    }
}

fn ends(points: &PathBlock) -> Option<[ControlPoint; 2]> {
    Some([points.get(0)?, points.get(points.len() - 1)?])
}
