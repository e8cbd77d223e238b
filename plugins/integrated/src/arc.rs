//! Steps of equal arc in the plane of the part: ∫ sqrt(ρ² + ρ_θ²) dθ from node to node.

use turnpath_plugin::prelude::*;

/// Smallest step. 360,000 points on a revolution come from a wrong unit, and finer steps fill the
/// memory.
pub const SMALLEST_STEP: f64 = 1e-3 * DEG;
/// The parameter `spacing`.
pub const SPACING: Param<Length> = Param::length(
    "spacing",
    "largest arc between neighbouring points, in the plane of the part",
)
.positive();
/// Nodes and weights of Gauss' rule of 6th order on (0, 1), relative to the middle node.
const GAUSS: f64 = 0.387_298_334_620_741_7;
const OUTER: f64 = 5.0 / 18.0;
const MIDDLE: f64 = 8.0 / 18.0;
/// A panel of the integral, in revolutions. Over an eighth the rule is exact to a millionth where
/// the radius is no less than the feed.
const PANEL: f64 = 0.125;
/// Rounds of the search for a step's end: more than it takes to halve any step down to rounding.
const ROUNDS: usize = 60;
/// The search for a step ends when it changes the step by less than this part.
const SETTLED: f64 = 1e-12;
/// A node that lies closer to the path's end than this part of a step is left out: it would
/// coincide with the end.
const SLACK: f64 = 1e-6;

/// Steps of one arc length, none longer than an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcSteps {
    /// Arc length of a step, mm.
    pub spacing: f64,
    /// Largest step, rad.
    pub max_step: f64,
}

impl ArcSteps {
    /// Steps of a strategy that declares [`SPACING`].
    pub fn new(params: &Params, max_step: f64) -> Self {
        Self {
            spacing: params.get(SPACING),
            max_step,
        }
    }

    /// The length of the step from `n`, in revolutions.
    fn step_from(&self, path: &Path<'_>, n: f64) -> f64 {
        let longest = self.max_step / TAU;
        if arc(path, n, longest) <= self.spacing {
            return longest;
        }
        let (mut shorter, mut longer) = (0.0, longest);
        let mut step = (self.spacing / arc_rate(path, n)).min(0.5 * longest);
        for _ in 0..ROUNDS {
            let beyond = arc(path, n, step) - self.spacing;
            if beyond > 0.0 {
                longer = step;
            } else {
                shorter = step;
            }
            let next = step - beyond / arc_rate(path, n + step);
            let next = match next > shorter && next < longer {
                true => next,
                false => 0.5 * (shorter + longer),
            };
            if (next - step).abs() <= SETTLED * step {
                return next;
            }
            step = next;
        }
        step
    }
}

impl SamplerPlan for ArcSteps {
    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        self.place_sequential(path, block, &mut Vec::new(), nodes)
    }

    /// Appends the nodes of a block. `state` holds the next node after the block before, in
    /// revolutions; it is empty for the first block.
    fn place_sequential(
        &self,
        path: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut NodeList,
    ) -> Result<()> {
        let mut n = state.first().copied().unwrap_or(block.start);
        let ends_path = block.end >= path.law.end();
        while n < block.end {
            nodes.push(n);
            let step = self.step_from(path, n);
            if !step.is_finite() {
                return Err(no_arc(path, n));
            }
            if step < SMALLEST_STEP / TAU {
                return Err(too_short(path, n));
            }
            n += step;
            if ends_path && block.end - n < SLACK * step {
                break;
            }
        }
        state.clear();
        state.push(n);
        Ok(())
    }
}

/// ds/dN = 2π·sqrt(ρ² + ρ_θ²), mm.
fn arc_rate(path: &Path<'_>, n: f64) -> f64 {
    let series = path.law.series(n);
    let along = TAU * series[0];
    (along * along + series[1] * series[1]).sqrt()
}

/// The arc from `n` over `length` revolutions, mm.
fn arc(path: &Path<'_>, n: f64, length: f64) -> f64 {
    let panels = (length / PANEL).ceil().max(1.0);
    let width = length / panels;
    let panel = |i: usize| {
        let middle = n + (i as f64 + 0.5) * width;
        let beside = GAUSS * width;
        OUTER * (arc_rate(path, middle - beside) + arc_rate(path, middle + beside))
            + MIDDLE * arc_rate(path, middle)
    };
    width * (0..panels as usize).map(panel).sum::<f64>()
}

fn too_short(path: &Path<'_>, n: f64) -> StrategyError {
    let least = arc(path, n, SMALLEST_STEP / TAU) / UM;
    SPACING.refused(format!(
        "it takes steps below {:.3} deg at ρ = {:.3} mm; give at least {least:.2} um",
        SMALLEST_STEP / DEG,
        path.radius_at(n)
    ))
}

fn no_arc(path: &Path<'_>, n: f64) -> StrategyError {
    let rho = path.radius_at(n);
    StrategyError::failed(format!(
        "no step can be found at C = {:.3} deg, ρ = {rho} mm",
        360.0 * n
    ))
}
