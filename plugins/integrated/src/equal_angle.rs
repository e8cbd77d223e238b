//! The sampler `equal-angle`.

use turnpath_plugin::prelude::*;

use crate::sharpest::{Spot, position, sharpest};

/// A number of steps on a revolution that lies this close to a whole number counts as that number.
/// 6 deg in rad is not exactly a 60th of a revolution, and the 60th node must not drift off.
const WHOLE: f64 = 1e-9;
/// A node that lies closer to the path's end than this part of a step is left out: it would
/// coincide with the end.
const SLACK: f64 = 1e-6;
/// The part of the interpolation tolerance that a derived step aims at. It lies a little below what
/// refinement accepts, so that refinement finds nothing to halve. It costs half a percent more
/// points.
const AIM: f64 = 0.98;
/// Smallest step, given or derived. 360,000 points on a revolution come from a wrong unit or from a
/// kink of the surface; nobody wants them. Finer steps fill the memory: a block of 64 revolutions
/// already has 23 million points.
const SMALLEST_STEP: f64 = 1e-3 * DEG;
/// With [`Misfit::CutWhatFits`] no derived step is smaller than this. No step is right where the
/// nose passes from one side of a seam to the other, and refinement halves the steps that are too
/// long.
const LEAST_NEAR_SEAMS: f64 = 0.25 * DEG;

/// Node k lies at k steps of the C angle from the path's start, on whatever revolution that is.
///
/// If no step is given, the sampler takes the largest step for which L⁴/384·max|φ⁗| over the whole
/// path, the error of cubics with exact slopes, stays within the interpolation tolerance. This step
/// does not consider knots of the feed's law; refinement corrects their effect.
#[derive(Debug, Clone, PartialEq)]
pub struct EqualAngle {
    step: Option<f64>,
    largest: f64,
}

const STEP: Param<Option<Angle>> = Param::angle(
    "step",
    "angle between neighbouring points, such as \"6 deg\"; left out: the largest that holds \
             tolerance.interpolation everywhere",
)
.min(SMALLEST_STEP)
.max(90.0 * DEG)
.optional();
const MAX_STEP: Param<Angle> = Param::angle("max_step", "largest angle step, given or derived")
    .default(45.0 * DEG)
    .min(SMALLEST_STEP)
    .max(90.0 * DEG);

impl Strategy for EqualAngle {
    const NAME: &'static str = "equal-angle";
    const SUMMARY: &'static str = "equal steps of the C angle along the whole path";
    const SOURCE: &'static str = "the conventional sampling; derived step after Wang et al. 2019, \
        eq. 10, at the worst place of the tool centre's path";
    const PARAMS: &'static [ParamInfo] = &[STEP.info(), MAX_STEP.info()];

    fn new(params: &Params) -> Result<Self> {
        let (step, largest) = (params.get(STEP), params.get(MAX_STEP));
        if let Some(step) = step.filter(|step| *step > largest * (1.0 + WHOLE)) {
            let (step, largest) = (step / DEG, largest / DEG);
            return Err(STEP.refused(format!(
                "{step:.6} deg is more than max_step, {largest:.6} deg; \
                     choose a smaller step or raise max_step"
            )));
        }
        Ok(Self { step, largest })
    }
}

impl EqualAngle {
    /// The largest step that the interpolation tolerance allows at the sharpest point of the path,
    /// rad.
    fn derive(&self, path: &Path<'_>) -> Result<f64> {
        let Spot { n, sharpness } = sharpest(path)?;
        let fourth_power = 384.0 * AIM * path.task.tolerance.interpolation / sharpness;
        let step = match path.task.tool.misfit {
            Misfit::Refuse => fourth_power.sqrt().sqrt(),
            Misfit::CutWhatFits => fourth_power.sqrt().sqrt().max(LEAST_NEAR_SEAMS),
        };
        let step = step.min(self.largest);
        if step < SMALLEST_STEP {
            return Err(StrategyError::failed(format!(
                "tolerance.interpolation would take steps of {:.2e} deg: the tool centre's path \
                 bends too sharply at {}; give `step`",
                step / DEG,
                position(path, n)
            )));
        }
        Ok(step)
    }
}

/// Equal steps.
#[derive(Debug, Clone, Copy)]
struct Steps {
    per_turn: f64,
}

impl Steps {
    fn of(step: f64) -> Self {
        let (per_turn, whole) = (TAU / step, (TAU / step).round());
        let near = (per_turn - whole).abs() <= WHOLE * whole;
        Self {
            per_turn: if near { whole } else { per_turn },
        }
    }

    /// Position of node `k`, in revolutions.
    fn node(&self, k: u64) -> f64 {
        k as f64 / self.per_turn
    }

    /// The first node at or after `n` revolutions.
    fn first_from(&self, n: f64) -> u64 {
        let near = (n * self.per_turn).floor() as u64;
        let mut k = near.saturating_sub(1);
        while self.node(k) < n {
            k += 1;
        }
        k
    }
}

impl Sampler for EqualAngle {
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        let step = match self.step {
            Some(step) => step,
            None => self.derive(path)?,
        };
        Ok(Box::new(Steps::of(step)))
    }
}

impl SamplerPlan for Steps {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let ends_path = block.end >= path.law.end();
        let slack = if ends_path {
            SLACK / self.per_turn
        } else {
            0.0
        };
        let from = self.first_from(block.start);
        nodes.extend(
            (from..)
                .map(|k| self.node(k))
                .take_while(|n| *n < block.end - slack),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_above_the_largest_is_an_error_on_step() {
        let params = Params::new()
            .with("step", 50.0 * DEG)
            .with("max_step", 45.0 * DEG);
        let error = EqualAngle::new(&params).unwrap_err();
        assert!(matches!(&error, StrategyError::Parameter { name, .. } if name == "step"));
        assert!(error.to_string().contains("50.000000 deg"), "{error}");
    }

    #[test]
    fn steps_that_divide_a_turn_meet_every_revolution() {
        for divisor in [4, 60, 97, 256, 36_000] {
            let steps = Steps::of(360.0 / f64::from(divisor) * DEG);
            for turn in [1, 64, 99_999] {
                assert_eq!(steps.node(divisor as u64 * turn), turn as f64);
                assert_eq!(steps.first_from(turn as f64), divisor as u64 * turn);
            }
        }
    }
}
