//! What step one place of the path allows: eq. 1 and 4.

use turnpath_plugin::prelude::*;

use crate::chord::Chord;

/// Arcs are taken for this long at least, mm/rad: a tool that stands still on the axis has none.
const STILL: f64 = 1e-9;

/// With [`Misfit::CutWhatFits`] steps are no shorter than this, rad: where the nose passes from one
/// side of a seam to the other the path has a kink, and no step is right. Refinement halves there.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// How a place is curved along a curve of the tool centre.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    /// d²z/dθ², mm.
    second: f64,
    /// The in-plane arc, mm/rad.
    arc: f64,
    /// sqrt(1 + (dz/dl)²).
    stretch: f64,
}

impl Bend {
    /// That of no place: no step follows from it.
    pub const UNKNOWN: Self = Self {
        second: f64::NAN,
        arc: f64::NAN,
        stretch: f64::NAN,
    };

    /// From the series of X and Z in θ.
    pub fn of(x: &Series, z: &Series) -> Self {
        let arc = (x[0] * x[0] + x[1] * x[1]).sqrt().max(STILL);
        let slope = z[1] / arc;
        Self {
            second: 2.0 * z[2],
            arc,
            stretch: (1.0 + slope * slope).sqrt(),
        }
    }

    /// A part of the way to another.
    pub fn between(self, other: Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Self {
            second: mix(self.second, other.second),
            arc: mix(self.arc, other.arc),
            stretch: mix(self.stretch, other.stretch),
        }
    }
}

/// The tolerance's chord, and the bounds of a step.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    chord: Chord,
    tolerance: f64,
    shortest: f64,
    longest: f64,
}

impl Rule {
    /// Steps of at most `longest` rad.
    pub fn new(task: &Task, chord: Chord, longest: f64) -> Self {
        Self {
            chord,
            tolerance: task.tolerance.interpolation,
            shortest: match task.tool.misfit {
                Misfit::Refuse => 0.0,
                Misfit::CutWhatFits => LEAST_NEAR_SEAMS,
            },
            longest,
        }
    }

    /// Δθ of eq. 1 and 4, rad: the chord on the circle of curvature d²z/dl²/(1 + (dz/dl)²)^{3/2},
    /// projected on the arc l, over dl/dθ; `None` where the place has no curvature.
    pub fn step(&self, bend: Bend) -> Option<f64> {
        let Bend {
            second,
            arc,
            stretch,
        } = bend;
        let curvature = second / (arc * arc * stretch * stretch * stretch);
        let step = self.chord.length(curvature, self.tolerance) / (stretch * arc);
        (!step.is_nan()).then(|| step.max(self.shortest).min(self.longest))
    }
}
