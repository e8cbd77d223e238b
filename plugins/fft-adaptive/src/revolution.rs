//! One revolution of the path on an even grid of angles: what step each place allows.

use turnpath_plugin::hermite::SHORTEST;
use turnpath_plugin::prelude::*;

use crate::chord::Chord;

/// Places of the grid, at first.
const FEWEST: usize = 512;
/// Most places: what asks for more has no steps that are long enough.
const MOST: usize = 1 << 20;
/// Places within a step, at least.
const LOOKS: f64 = 16.0;

/// Arcs are taken for this long at least, mm/rad: a tool that stands still on the axis has none.
const STILL: f64 = 1e-9;

/// With [`Misfit::CutWhatFits`] steps are no shorter than this, rad: where the nose passes from one
/// side of a seam to the other the path has a kink, and no step is right. Refinement halves there.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// How a place is curved along the path.
#[derive(Debug, Clone, Copy)]
struct Bend {
    /// d²z/dθ², mm.
    second: f64,
    /// The in-plane arc, mm/rad.
    arc: f64,
    /// sqrt(1 + (dz/dl)²).
    stretch: f64,
}

impl Bend {
    fn of(x: &Series, z: &Series) -> Self {
        let arc = (x[0] * x[0] + x[1] * x[1]).sqrt().max(STILL);
        let slope = z[1] / arc;
        Self {
            second: 2.0 * z[2],
            arc,
            stretch: (1.0 + slope * slope).sqrt(),
        }
    }

    fn between(self, other: Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Self {
            second: mix(self.second, other.second),
            arc: mix(self.arc, other.arc),
            stretch: mix(self.stretch, other.stretch),
        }
    }

    /// Δθ of eq. 1 and 4, rad: the chord on the circle of curvature d²z/dl²/(1 + (dz/dl)²)^{3/2},
    /// projected on the arc l, over dl/dθ.
    fn step(self, chord: Chord, tolerance: f64) -> f64 {
        let Self {
            second,
            arc,
            stretch,
        } = self;
        let curvature = second / (arc * arc * stretch * stretch * stretch);
        chord.length(curvature, tolerance) / (stretch * arc)
    }
}

/// The steps that a revolution's places allow.
pub struct Revolution {
    turn: Turn,
    bends: Vec<Bend>,
    chord: Chord,
    tolerance: f64,
    shortest: f64,
    longest: f64,
}

impl Revolution {
    /// Looks at a revolution on a grid of which the smallest step has 16 places. Steps are at most
    /// `longest` rad.
    ///
    /// # Errors
    /// Where the path has no curvature, or one that asks for steps below the shortest.
    pub fn look(path: &Path<'_>, turn: Turn, chord: Chord, longest: f64) -> Result<Self> {
        let mut revolution = Self {
            turn,
            bends: Vec::new(),
            chord,
            tolerance: path.job.tolerance.interpolation,
            shortest: match path.job.tool.misfit {
                Misfit::Refuse => 0.0,
                Misfit::CutWhatFits => LEAST_NEAR_SEAMS,
            },
            longest,
        };
        let mut places = FEWEST;
        loop {
            revolution.sample(path, places)?;
            let least = revolution.least_step();
            let needed = LOOKS * TAU * (turn.end - turn.start) / least;
            if needed <= places as f64 {
                return Ok(revolution);
            }
            if places >= MOST || least < SHORTEST {
                return Err(too_short(path, turn, least));
            }
            places = ((1.25 * needed).ceil() as usize).clamp(places + 1, MOST);
        }
    }

    fn sample(&mut self, path: &Path<'_>, places: usize) -> Result<()> {
        let Turn { start, end } = self.turn;
        let n: Vec<f64> = (0..=places)
            .map(|i| start + (end - start) * i as f64 / places as f64)
            .collect();
        let (mut x, mut z) = (vec![[f64::NAN; 5]; n.len()], vec![[f64::NAN; 5]; n.len()]);
        path.series_at(&n, &mut x, &mut z)?;
        self.bends.clear();
        for ((n, x), z) in n.iter().zip(&x).zip(&z) {
            let bend = Bend::of(x, z);
            if bend.step(self.chord, self.tolerance).is_nan() {
                return Err(no_bend(*n, path.radius_at(*n)));
            }
            self.bends.push(bend);
        }
        Ok(())
    }

    fn allowed(&self, bend: Bend) -> f64 {
        let step = bend.step(self.chord, self.tolerance);
        step.max(self.shortest).min(self.longest)
    }

    fn least_step(&self) -> f64 {
        let steps = self.bends.iter().map(|bend| self.allowed(*bend));
        steps.fold(f64::INFINITY, f64::min)
    }

    /// A place in steps of the grid, and the bend there.
    fn at(&self, n: f64) -> (f64, Bend) {
        let Turn { start, end } = self.turn;
        let last = self.bends.len().saturating_sub(1);
        let place = ((n - start) / (end - start) * last as f64).clamp(0.0, last as f64);
        let cell = (place.floor() as usize).min(last.saturating_sub(1));
        let bend = match self.bends.get(cell..cell + 2) {
            Some([before, after]) => before.between(*after, place - cell as f64),
            _ => Bend {
                second: f64::NAN,
                arc: f64::NAN,
                stretch: f64::NAN,
            },
        };
        (place, bend)
    }

    /// Δθ from `n` by the curvature there alone, rad.
    pub fn step_at(&self, n: f64) -> f64 {
        self.allowed(self.at(n).1)
    }

    /// Δθ from `n` by the largest curvature on the step that the start's own would allow, rad.
    pub fn step_over(&self, n: f64) -> f64 {
        let (from, start) = self.at(n);
        let trial = self.allowed(start);
        let (to, end) = self.at(n + trial / TAU);
        let within = self.bends.get(from.ceil() as usize..=to.floor() as usize);
        let within = within.unwrap_or_default().iter();
        within
            .map(|bend| self.allowed(*bend))
            .fold(trial.min(self.allowed(end)), f64::min)
    }
}

fn no_bend(n: f64, rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the tool centre's path has no curvature at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}

fn too_short(path: &Path<'_>, turn: Turn, least: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the tolerance asks for steps of {:.2e} deg in revolution {:.0}, ρ = {:.4} mm, and the \
         shortest is {:.3} deg: choose a larger interpolation tolerance, or another sampler",
        least / DEG,
        turn.start,
        path.radius_at(turn.start),
        SHORTEST / DEG
    ))
}
