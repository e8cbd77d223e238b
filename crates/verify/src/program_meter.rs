//! The meter of a program: the figures that its digits and times of a path's own can change, and no
//! others. What the path itself would cut is measured on the path.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::machined::{Fan, FormScope, Lines, SectionPasses, SurfaceExtremes};
use crate::playback::{PlaybackFigures, play_back};
use crate::touch::FirstTouch;

/// The figures of one block of a program's cutting section.
#[derive(Debug, Clone)]
pub struct ProgramBlockFigures {
    playback: PlaybackFigures,
    /// `None` where the form is not measured.
    sections: Option<SectionPasses>,
}

/// Measures a program against its subject.
pub struct ProgramMeter {
    touch: FirstTouch,
    form: Option<FormScope>,
    playback: PlaybackFigures,
    lines: Lines,
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
        }
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
        Ok(ProgramBlockFigures { playback, sections })
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
    pub fn append(&mut self, next: ProgramBlockFigures) {
        self.playback.append(&next.playback);
        if let Some(sections) = next.sections {
            self.lines.append(sections);
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
}
