//! The meter of a program: the figures that its digits and times of a path's own can change, and no
//! others. What the path itself would cut is measured on the path. Where straight lines stand
//! for cubics, or digits are coarse, the passes lie elsewhere too, and what they leave is measured on the program.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::machined::{Fan, FormScope, Lines, SectionPasses, SurfaceExtremes};
use crate::measured_passes::{MeasuredPasses, PassFigures};
use crate::playback::{PlaybackFigures, play_back};
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

    /// The same with what the passes leave, for a program whose X is not that of its path: where straight
    /// lines stand for cubics, or digits are coarse.
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
        let passes = passes.map(|_| MeasuredPasses::of(&self.touch, points, |_| ()));
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
            (Some(passes), Some(next)) => passes.append(&self.touch, next, |_| ()),
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
