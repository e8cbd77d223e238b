//! The meter: measures the blocks of a path separately and combines their figures in order.

use std::ops::Range;

use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{Radial, RadialRange, Result};

use crate::axes::AxesMotion;
use crate::block_playback::BlockPlayback;
use crate::coverage::CoverageFigures;
use crate::cutting_speed::CuttingSpeed;
use crate::largest_errors::{errors_against, errors_at_middles};
use crate::machined::{Fan, FormScope, Lines, MachinedFigures, SectionPasses, SurfaceExtremes};
use crate::measured_passes::MeasuredPasses;
use crate::playback::{PlaybackFigures, play_back};
use crate::points::PointFigures;
use crate::residual::ResidualFigures;
use crate::sketch::{BlockSketch, PathSketch, SectionHeights, Sketch};
use crate::spokes::{BlockSpokes, SpiralArms, Spoke, Spokes};
use crate::touch::FirstTouch;

/// The figures of one block of the cutting section.
#[derive(Debug, Clone, Default)]
pub struct BlockFigures {
    /// Interpolation error.
    pub playback: PlaybackFigures,
    /// Largest |error| of each segment, mm.
    pub per_segment: Vec<f64>,
    /// Error of the control points.
    pub points: PointFigures,
    /// Z − first touch at each control point, mm.
    pub per_point: Vec<f64>,
    /// Motion of the axes.
    pub axes: AxesMotion,
    /// Cutting speed.
    pub cutting_speed: CuttingSpeed,
    passes: MeasuredPasses,
    sections: SectionPasses,
    /// The passes of the real nose, where the path takes its radius as 0.
    real_nose: Option<SectionPasses>,
    spokes: BlockSpokes,
    sketch: BlockSketch,
    ends: Option<[ControlPoint; 2]>,
}

/// The figures of a whole path.
#[derive(Debug, Clone, Default)]
pub struct PathFigures {
    /// Interpolation error.
    pub playback: PlaybackFigures,
    /// Error of the control points.
    pub points: PointFigures,
    /// Residual. It includes the cusps around the axis if [`Meter::counting_centre`] says so.
    pub residual: ResidualFigures,
    /// The material that stays uncut at the part's edges and around the axis.
    pub coverage: CoverageFigures,
    /// Motion of the axes.
    pub axes: AxesMotion,
    /// Cutting speed.
    pub cutting_speed: CuttingSpeed,
    /// The largest spoke; `None` on a path of less than a turn.
    pub spoke: Option<Spoke>,
    /// The largest spiral arms; `None` on a path of a few turns.
    pub arms: Option<SpiralArms>,
}

/// Measures a path against its subject.
pub struct Meter {
    touch: FirstTouch,
    figures: PathFigures,
    passes: MeasuredPasses,
    lines: Lines,
    /// The lines of the real nose, where the path takes its radius as 0.
    real_nose: Option<Lines>,
    spokes: Spokes,
    sketch: Sketch,
    counts_centre: bool,
    form: Option<FormScope>,
    ends: Option<[ControlPoint; 2]>,
}

impl Meter {
    /// A meter that has measured nothing yet.
    pub fn new(touch: FirstTouch) -> Self {
        let real_nose = !touch.subject().compensates_nose;
        Self {
            real_nose: real_nose.then(|| Lines::new(Fan::WHOLE)),
            touch,
            figures: PathFigures::default(),
            passes: MeasuredPasses::default(),
            lines: Lines::new(Fan::WHOLE),
            spokes: Spokes::default(),
            sketch: Sketch::default(),
            counts_centre: false,
            form: None,
            ends: None,
        }
    }

    /// Sets whether the path is meant to cover the axis. If so, the cusps between the passes of
    /// the two sides of the axis count as residual. If not, only the coverage reports them.
    #[must_use]
    pub fn counting_centre(mut self, counts: bool) -> Self {
        self.counts_centre = counts;
        self
    }

    /// Sets which part of the machined surface counts for its form; without it the form is not
    /// measured.
    #[must_use]
    pub fn with_form(mut self, scope: Option<FormScope>) -> Self {
        self.form = scope;
        self
    }

    /// The search for first touches that this meter uses.
    pub fn touch(&self) -> &FirstTouch {
        &self.touch
    }

    /// Measures the segments between neighbouring points; can run in parallel.
    pub fn measure(touch: &FirstTouch, points: &PathBlock) -> Result<BlockFigures> {
        let playback = BlockPlayback::of(touch, points)?;
        Self::measure_played(touch, playback, points, &[], true)
    }

    /// Measures what the playback of these points leaves open. `offsets` has Z of each point above the
    /// locus, mm; it is empty for points on the locus. `wants_sketch` asks for what pictures need.
    pub fn measure_played(
        touch: &FirstTouch,
        playback: BlockPlayback,
        points: &PathBlock,
        offsets: &[f64],
        wants_sketch: bool,
    ) -> Result<BlockFigures> {
        let BlockPlayback {
            figures,
            per_segment,
            per_point,
            spokes,
        } = playback;
        let mut block = BlockFigures {
            axes: AxesMotion::of(points),
            cutting_speed: CuttingSpeed::of(points),
            ends: ends(points),
            playback: figures,
            points: PointFigures::of(points, &per_point, offsets),
            per_segment,
            per_point,
            spokes,
            ..BlockFigures::default()
        };
        let mut heights = SectionHeights::default();
        block.passes = MeasuredPasses::of(touch, points, |cusp| {
            if wants_sketch {
                heights.include(cusp);
            }
        })?;
        if wants_sketch {
            block.sketch = BlockSketch::of(points, &block.per_segment, heights);
        }
        block.sections = SectionPasses::of(touch, &Fan::WHOLE, points)?;
        if !touch.subject().compensates_nose {
            let radius = touch.subject().tool.nose_radius;
            let passes = SectionPasses::of_lowest_point(radius, &Fan::WHOLE, points);
            block.real_nose = Some(passes);
        }
        Ok(block)
    }

    /// The largest |error| of each segment alone, mm.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn segment_errors(touch: &FirstTouch, points: &PathBlock) -> Result<Vec<f64>> {
        let mut errors = Vec::new();
        play_back(touch, points, &mut errors, |_| ())?;
        Ok(errors)
    }

    /// An |error| of each segment of some runs of a block, mm, one run after the other: the largest one, or one that lies
    /// on the same side of all `limits`, mm. Refinement needs no more, and tops of sharp peaks take time.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn errors_against(
        touch: &FirstTouch,
        points: &PathBlock,
        runs: &[Range<usize>],
        limits: &[f64],
    ) -> Result<Vec<f64>> {
        errors_against(touch, points, runs, limits)
    }

    /// The |error| in the middle of each segment of some runs of a block, mm, one run after the other; 0 where it is not
    /// known. The largest one is no smaller, and takes ten times as long.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn errors_at_middles(
        touch: &FirstTouch,
        points: &PathBlock,
        runs: &[Range<usize>],
    ) -> Result<Vec<f64>> {
        errors_at_middles(touch, points, runs)
    }

    /// Appends the path's next block. The block begins with the last control point of the block
    /// before it.
    pub fn append(&mut self, next: BlockFigures) -> Result<()> {
        let mut joint_heights = SectionHeights::default();
        self.passes.append(&self.touch, &next.passes, |cusp| {
            joint_heights.include(cusp);
        })?;
        let Self {
            figures,
            sketch,
            lines,
            real_nose,
            spokes,
            ..
        } = self;
        // The transforms of spokes take as long as all else.
        rayon::join(
            || spokes.append(next.spokes),
            || {
                figures.playback.append(&next.playback);
                figures.points.include(&next.points);
                figures.axes.append(&next.axes);
                figures.cutting_speed.append(&next.cutting_speed);
                sketch.append(&next.sketch, &joint_heights);
                lines.append(next.sections);
                if let (Some(lines), Some(passes)) = (real_nose, next.real_nose) {
                    lines.append(passes);
                }
            },
        );
        self.ends = match (self.ends, next.ends) {
            (Some([first, _]), Some([_, last])) => Some([first, last]),
            (own, next) => own.or(next),
        };
        Ok(())
    }

    /// The range of radii that the path covers, from its two ends. The radius is that of the
    /// contact. Where ρ is X, it is X or the contact, whichever lies further out at the outer end
    /// and further in at the inner end. Either of them may end at the part's edge, depending on the
    /// overrun. `None` before the first block.
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

    /// The figures of the machined surface; `None` if the path cuts nothing of the part.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn machined(&self) -> Result<Option<MachinedFigures>> {
        let Some(figures) = self.lines.figures(&self.touch, self.counts_centre)? else {
            return Ok(None);
        };
        let of_real_nose = |lines: &Lines| lines.extremes(self.touch.subject());
        let real_nose = self.real_nose.as_ref().map(of_real_nose).transpose()?;
        Ok(Some(MachinedFigures {
            real_nose: real_nose.flatten(),
            ..figures
        }))
    }

    /// The form of the machined surface, of the real nose where the path takes its radius as 0;
    /// `None` if it is not asked for, or if the path cuts nothing of the part.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn form(&self) -> Result<Option<SurfaceExtremes>> {
        let lines = self.real_nose.as_ref().unwrap_or(&self.lines);
        match self.form {
            Some(scope) => lines.form(&self.touch, scope),
            None => Ok(None),
        }
    }

    /// What pictures of the path need.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn sketch(&self) -> Result<PathSketch> {
        Ok(PathSketch {
            rings: self.lines.rings(&self.touch)?,
            harmonics: self.spokes.harmonics(),
            spiral: self.sketch.spiral(),
            turns: self.sketch.turns(),
            residual: self.sketch.residual(),
            edges: self.passes.coverage.edges(&self.touch)?,
        })
    }

    /// The figures so far.
    pub fn figures(&self) -> Result<PathFigures> {
        let mut figures = self.figures.clone();
        let of_passes = self.passes.figures(&self.touch, self.counts_centre)?;
        (figures.residual, figures.coverage) = (of_passes.residual, of_passes.coverage);
        figures.spoke = self.spokes.largest();
        figures.arms = self.spokes.largest_arms();
        Ok(figures)
    }
}

fn ends(points: &PathBlock) -> Option<[ControlPoint; 2]> {
    Some([points.get(0)?, points.get(points.len() - 1)?])
}
