//! The sketch of a path: what pictures of it need, in bounded memory, however long the path is.
//!
//! It has a sample of the places of the tool with their errors ([`SpiralSample`]), the motion of the
//! axes turn by turn ([`TurnMotion`]), the cusps against the angle, the harmonics of the error as
//! played, and the mean error of the machined surface on rings ([`ErrorRings`]). Figures and verdicts
//! do not ask it.
//!
//! [`ErrorRings`]: crate::machined::ErrorRings

mod sections;
mod spiral;
mod turns;

use turnpath_core::toolpath::PathBlock;

use crate::coverage::EdgeHeights;
use crate::machined::ErrorRings;

pub use sections::SectionHeights;
use spiral::Spiral;
pub use spiral::SpiralSample;
use turns::TurnLog;
pub use turns::TurnMotion;

/// What pictures of a path need.
#[derive(Debug, Clone)]
pub struct PathSketch {
    /// The mean error of the machined surface on rings; `None` where nothing of the part is cut.
    pub rings: Option<ErrorRings>,
    /// The amplitude of each harmonic of the error as played, mm, at its largest over all windows:
    /// entry k has k periods a turn. Empty on a path of less than a turn.
    pub harmonics: Vec<f64>,
    /// Places of the tool along the path, with the largest errors around them.
    pub spiral: Vec<SpiralSample>,
    /// The motion of the axes, turn by turn or by some neighbouring turns.
    pub turns: Vec<TurnMotion>,
    /// The highest cusp on each section, mm; not a number where none was measured.
    pub residual: Vec<f64>,
    /// What stays uncut on each section of the part's edges, mm.
    pub edges: EdgeHeights,
}

/// What one block adds to a sketch.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockSketch {
    samples: Vec<SpiralSample>,
    turns: TurnLog,
    sections: SectionHeights,
}

/// What blocks have added so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sketch {
    spiral: Spiral,
    turns: TurnLog,
    sections: SectionHeights,
}

impl BlockSketch {
    /// A block with the largest |error| of each of its segments, mm, and its highest cusps.
    pub fn of(points: &PathBlock, per_segment: &[f64], cusps: SectionHeights) -> Self {
        Self {
            samples: spiral::samples(points, per_segment),
            turns: TurnLog::of(points, per_segment),
            sections: cusps,
        }
    }
}

impl Sketch {
    /// Appends the path's next block, and the highest cusps between it and the block before.
    pub fn append(&mut self, next: &BlockSketch, joint: &SectionHeights) {
        self.spiral.append(&next.samples);
        self.turns.append(&next.turns);
        self.sections.append(&next.sections);
        self.sections.append(joint);
    }

    /// The places of the tool.
    pub fn spiral(&self) -> Vec<SpiralSample> {
        self.spiral.samples()
    }

    /// The motion of the axes, in the order of the path.
    pub fn turns(&self) -> Vec<TurnMotion> {
        self.turns.all()
    }

    /// The highest cusp on each section, mm.
    pub fn residual(&self) -> Vec<f64> {
        self.sections.heights()
    }
}
