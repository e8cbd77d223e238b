//! The meter of a program: the figures that its digits and times of a path's own can change, and no
//! others. What the path itself would cut is measured on the path. Where X goes on straight lines and the
//! path's does not, the passes lie elsewhere too, and what they leave is measured on the program.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::coverage::{Coverage, CoverageFigures};
use crate::machined::{Fan, FormScope, Lines, SectionPasses, SurfaceExtremes};
use crate::playback::{PlaybackFigures, play_back};
use crate::residual::{Passes, ResidualFigures};
use crate::touch::FirstTouch;

/// The figures of one block of a program's cutting section.
#[derive(Debug, Clone)]
pub struct ProgramBlockFigures {
    playback: PlaybackFigures,
    /// `None` where the form is not measured.
    sections: Option<SectionPasses>,
    /// `None` where the passes are not measured.
    passes: Option<MeasuredPasses>,
}

/// What the passes of a program leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassFigures {
    /// Residual. It includes the cusps around the axis if [`ProgramMeter::measuring_passes`] says so.
    pub residual: ResidualFigures,
    /// The material that stays uncut at the part's edges and around the axis.
    pub coverage: CoverageFigures,
}

/// Passes, those of a block or the last ones so far, with what they leave.
#[derive(Debug, Clone, Default)]
struct MeasuredPasses {
    passes: Passes,
    residual: ResidualFigures,
    coverage: Coverage,
}

impl MeasuredPasses {
    /// Those of one block.
    fn of(touch: &FirstTouch, points: &PathBlock) -> Result<Self> {
        let passes = Passes::of(touch, points)?;
        let mut residual = ResidualFigures::default();
        passes.for_each_cusp(touch, |cusp| residual.append(&cusp))?;
        let coverage = Coverage::of(touch, points, &passes)?;
        Ok(Self {
            passes,
            residual,
            coverage,
        })
    }

    /// Appends those of the next block.
    fn append(&mut self, touch: &FirstTouch, next: &Self) -> Result<()> {
        let mut joint = ResidualFigures::default();
        let passes = &mut self.passes;
        passes.follow(touch, &next.passes, |cusp| joint.append(&cusp))?;
        self.residual.append(&next.residual);
        self.residual.append(&joint);
        self.coverage.append(&next.coverage, &next.passes);
        Ok(())
    }

    /// What they leave so far.
    fn figures(&self, touch: &FirstTouch, counts_centre: bool) -> Result<PassFigures> {
        let (coverage, around_axis) = self.coverage.figures(touch)?;
        let mut residual = self.residual;
        if counts_centre {
            residual.append(&around_axis);
        }
        Ok(PassFigures { residual, coverage })
    }
}

/// Measures a program against its subject.
pub struct ProgramMeter {
    touch: FirstTouch,
    form: Option<FormScope>,
    playback: PlaybackFigures,
    lines: Lines,
    /// `None` where the passes are not measured.
    passes: Option<MeasuredPasses>,
    counts_centre: bool,
}

impl ProgramMeter {
    /// A meter that has measured nothing yet. `form` is the part of the machined surface that counts for
    /// its form; without it the form is not measured.
    pub fn new(touch: FirstTouch, form: Option<FormScope>) -> Self {
        Self {
            touch,
            form,
            playback: PlaybackFigures::default(),
            lines: Lines::new(Fan::WHOLE),
            passes: None,
            counts_centre: false,
        }
    }

    /// The same with what the passes leave, for a program whose X is not that of its path.
    /// `counts_centre` says whether the path is meant to cover the axis: the cusps there then count as
    /// residual.
    #[must_use]
    pub fn measuring_passes(mut self, counts_centre: bool) -> Self {
        self.passes = Some(MeasuredPasses::default());
        self.counts_centre = counts_centre;
        self
    }

    /// The search for first touches that this meter uses.
    pub fn touch(&self) -> &FirstTouch {
        &self.touch
    }

    /// Measures the segments between neighbouring points; can run in parallel.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn measure(&self, points: &PathBlock) -> Result<ProgramBlockFigures> {
        let playback = play_back(&self.touch, points, &mut Vec::new(), |_| ())?;
        let sections = self.form.map(|_| self.sections(points)).transpose()?;
        let passes = self.passes.as_ref();
        let passes = passes.map(|_| MeasuredPasses::of(&self.touch, points));
        Ok(ProgramBlockFigures {
            playback,
            sections,
            passes: passes.transpose()?,
        })
    }

    /// The passes of the real nose.
    fn sections(&self, points: &PathBlock) -> Result<SectionPasses> {
        let subject = self.touch.subject();
        match subject.compensates_nose {
            true => SectionPasses::of(&self.touch, &Fan::WHOLE, points),
            false => {
                let radius = subject.tool.nose_radius;
                Ok(SectionPasses::of_lowest_point(radius, &Fan::WHOLE, points))
            }
        }
    }

    /// Appends the program's next block. The block begins with the last control point of the block
    /// before it.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn append(&mut self, next: ProgramBlockFigures) -> Result<()> {
        self.playback.append(&next.playback);
        if let Some(sections) = next.sections {
            self.lines.append(sections);
        }
        match (&mut self.passes, &next.passes) {
            (Some(passes), Some(next)) => passes.append(&self.touch, next),
            _ => Ok(()),
        }
    }

    /// The interpolation error.
    pub fn playback(&self) -> &PlaybackFigures {
        &self.playback
    }

    /// The form of the machined surface; `None` if it is not asked for, or if the path cuts nothing of
    /// the part.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn form(&self) -> Result<Option<SurfaceExtremes>> {
        match self.form {
            Some(scope) => self.lines.form(&self.touch, scope),
            None => Ok(None),
        }
    }

    /// What the passes leave; `None` unless [`Self::measuring_passes`] asks for it.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn passes(&self) -> Result<Option<PassFigures>> {
        let passes = self.passes.as_ref();
        let figures = passes.map(|passes| passes.figures(&self.touch, self.counts_centre));
        figures.transpose()
    }
}
