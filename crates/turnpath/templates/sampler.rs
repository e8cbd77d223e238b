//! Steps whose chord stays within a tolerance of the tool centre's path.
//!
//! A chord over the angle h lies at most h²/8 · max|φ″| beside the path, where φ″ = Z″ − ∂Z/∂X · X″ is
//! the second derivative by θ of the path's distance along Z. The controller plays cubics, which stay
//! much closer: the chord is a cautious rule that looks at the shape alone.
#![forbid(unsafe_code)]
use turnpath_plugin::prelude::*;

const CHORD: Param<Length> = Param::length("chord", "largest distance of a chord from the path")
    .default(1.0 * UM)
    .positive();
const MAX_STEP: Param<Angle> = Param::angle("max_step", "largest step of C")
    .default(10.0 * DEG)
    .positive()
    .max(45.0 * DEG);

/// Places of a turn at which the path's bend is computed.
const CELLS: usize = 180;
/// A node this close to the next turn is left out, rad: the next turn begins with one.
const CLOSE: f64 = 1e-6;

#[derive(Clone)]
struct ChordSteps {
    chord: f64,
    max_step: f64,
}

impl Strategy for ChordSteps {
    const NAME: &'static str = "chord-steps";
    const SUMMARY: &'static str = "steps whose chord stays within a tolerance of the path";
    const SOURCE: &'static str = "sagitta h²/8·max|φ″|";
    const PARAMS: &'static [ParamInfo] = &[CHORD.info(), MAX_STEP.info()];

    fn new(p: &Params) -> Result<Self> {
        Ok(Self {
            chord: p.get(CHORD),
            max_step: p.get(MAX_STEP),
        })
    }
}

impl ChordSteps {
    /// |φ″| at both ends of every cell of a turn, mm/rad².
    fn bends(&self, path: &Path<'_>, turn: Turn) -> Result<Vec<f64>> {
        let n: Vec<f64> = (0..=CELLS)
            .map(|i| turn.start + i as f64 / CELLS as f64)
            .collect();
        let mut x = vec![[0.0; 5]; n.len()];
        let mut z = x.clone();
        path.series_at(&n, &mut x, &mut z)?;
        let theta: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
        let rho: Vec<f64> = n.iter().map(|n| path.radius_at(*n)).collect();
        let blank = vec![0.0; n.len()];
        let (mut x_theta, mut x_rho) = (blank.clone(), blank.clone());
        let (mut z_theta, mut z_x) = (blank.clone(), blank);
        let out = Rates {
            x_theta: &mut x_theta,
            x_rho: &mut x_rho,
            z_theta: &mut z_theta,
            z_x: &mut z_x,
        };
        path.locus.rates(&theta, &rho, out)?;
        // The second derivative is twice the second coefficient of a series.
        let bend = |i: usize| 2.0 * (z[i][2] - z_x[i] * x[i][2]).abs();
        Ok((0..n.len()).map(bend).collect())
    }

    /// The step from a place of the turn, as long as the sharpest bend on it allows, rad.
    fn step(&self, bends: &[f64], from: f64) -> f64 {
        let allowed = |bend: f64| (8.0 * self.chord / bend).sqrt().min(self.max_step);
        let cell = |angle: f64| ((angle / TAU * CELLS as f64) as usize).min(CELLS - 1);
        let sharpest = |cells: &[f64]| cells.iter().copied().fold(0.0, f64::max);
        let first = cell(from);
        let longest = allowed(sharpest(&bends[first..first + 2]));
        // The step may reach cells that bend more.
        allowed(sharpest(&bends[first..cell(from + longest) + 2]))
    }
}

impl SamplerPlan for ChordSteps {
    /// Every turn begins with a node, so that a block depends on itself alone.
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        for turn in block.turns() {
            let bends = self.bends(path, turn)?;
            let end = TAU * (turn.end - turn.start);
            let mut at = 0.0;
            while at < end - CLOSE {
                nodes.push(turn.start + at / TAU);
                at += self.step(&bends, at);
            }
        }
        Ok(())
    }
}

turnpath_plugin::export!(samplers: [ChordSteps]);

#[cfg(test)]
mod tests {
    #[test]
    fn conforms() {
        turnpath_plugin_test::check!();
    }
}
