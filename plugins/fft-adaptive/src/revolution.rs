//! One revolution of the path on an even grid of angles, with the step that each point allows.

use turnpath_plugin::hermite::{MAX_STEP, SHORTEST};
use turnpath_plugin::prelude::*;

use crate::rule::{Bend, Rule};

/// Points of the first grid.
const FEWEST: usize = 512;
/// Most points of a grid. A surface that needs more has no steps that are long enough.
const MOST: usize = 1 << 20;
/// The least number of points within a step.
const LEAST_POINTS: f64 = 16.0;

/// The steps that the points of a revolution allow.
pub struct Revolution {
    turn: Turn,
    bends: Vec<Bend>,
    rule: Rule,
}

impl Revolution {
    /// Evaluates a revolution on a grid on which the smallest step has 16 points.
    ///
    /// # Errors
    /// If the path has no curvature, or a curvature that needs steps below the shortest.
    pub fn evaluate(path: &Path<'_>, turn: Turn, rule: Rule) -> Result<Self> {
        let mut revolution = Self {
            turn,
            bends: Vec::new(),
            rule,
        };
        let mut places = FEWEST;
        loop {
            revolution.sample(path, places)?;
            let least = revolution.least_step();
            let needed = LEAST_POINTS * TAU * (turn.end - turn.start) / least;
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
            if self.rule.step(bend).is_none() {
                return Err(no_bend(*n, path.radius_at(*n)));
            }
            self.bends.push(bend);
        }
        Ok(())
    }

    fn allowed(&self, bend: Bend) -> f64 {
        self.rule.step(bend).unwrap_or(f64::NAN)
    }

    fn least_step(&self) -> f64 {
        let steps = self.bends.iter().map(|bend| self.allowed(*bend));
        steps.fold(f64::INFINITY, f64::min)
    }

    /// The position of `n` in steps of the grid, and the bend there.
    fn at(&self, n: f64) -> (f64, Bend) {
        let Turn { start, end } = self.turn;
        let last = self.bends.len().saturating_sub(1);
        let place = ((n - start) / (end - start) * last as f64).clamp(0.0, last as f64);
        let cell = (place.floor() as usize).min(last.saturating_sub(1));
        let bend = match self.bends.get(cell..cell + 2) {
            Some([before, after]) => before.between(*after, place - cell as f64),
            _ => Bend::UNKNOWN,
        };
        (place, bend)
    }

    /// Δθ from `n`, rad, by the largest curvature on the step that the curvature at `n` alone would
    /// allow.
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

/// The error of a point without a curvature.
pub fn no_bend(n: f64, rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the tool centre's path has no curvature at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}

/// The error of steps below the shortest.
pub fn too_short(path: &Path<'_>, turn: Turn, least: f64) -> StrategyError {
    MAX_STEP.refused(format!(
        "the tolerance needs steps of {:.2e} deg in revolution {:.0}, ρ = {:.4} mm, but the \
         shortest allowed step is {:.3} deg: choose a larger interpolation tolerance, or another sampler",
        least / DEG,
        turn.start,
        path.radius_at(turn.start),
        SHORTEST / DEG
    ))
}
