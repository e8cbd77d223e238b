//! The step that one point of the path allows: eq. 1 and 4.

use turnpath_plugin::prelude::*;

use crate::chord::Chord;

/// An arc counts as at least this long, mm/rad. A tool that stands still on the axis has no arc.
const LEAST_ARC: f64 = 1e-9;

/// With [`Misfit::CutWhatFits`] no step is shorter than this, rad. The path has a kink where the
/// nose passes from one side of a seam to the other, and no step is right there. Refinement halves
/// the segments there.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// The bend of the tool centre's path at one point.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    /// d²z/dθ², mm.
    second: f64,
    /// The in-plane arc, mm/rad.
    arc: f64,
    /// sqrt(1 + (dz/dl)²).
    slant: f64,
}

impl Bend {
    /// The bend of a point without a value. It gives no step.
    pub const UNKNOWN: Self = Self {
        second: f64::NAN,
        arc: f64::NAN,
        slant: f64::NAN,
    };

    /// The bend from the series of X and Z in θ.
    pub fn of(x: &Series, z: &Series) -> Self {
        let arc = (x[0] * x[0] + x[1] * x[1]).sqrt().max(LEAST_ARC);
        let slope = z[1] / arc;
        Self {
            second: 2.0 * z[2],
            arc,
            slant: (1.0 + slope * slope).sqrt(),
        }
    }

    /// Interpolates: the bend at `part` of the way to another point.
    pub fn between(self, other: Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Self {
            second: mix(self.second, other.second),
            arc: mix(self.arc, other.arc),
            slant: mix(self.slant, other.slant),
        }
    }
}

/// The chord of the tolerance, and the limits of a step.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    chord: Chord,
    tolerance: f64,
    shortest: f64,
    longest: f64,
}

impl Rule {
    /// A rule for steps of at most `longest` rad.
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
    /// projected on the arc l, over dl/dθ; `None` if the point has no curvature.
    pub fn step(&self, bend: Bend) -> Option<f64> {
        let Bend { second, arc, slant } = bend;
        let curvature = second / (arc * arc * slant * slant * slant);
        let step = self.chord.length(curvature, self.tolerance) / (slant * arc);
        (!step.is_nan()).then(|| step.max(self.shortest).min(self.longest))
    }
}
