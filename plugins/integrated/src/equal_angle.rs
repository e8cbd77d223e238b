//! The sampler `equal-angle`.

use turnpath_plugin::prelude::*;

/// A count of steps a revolution this close to a whole one is that one: 6 deg in rad is not a
/// 60th of a revolution to the last digit, and the 60th node must not drift off.
const WHOLE: f64 = 1e-9;
/// A node closer than this part of a step to the path's end is left out: it would be the end.
const SLACK: f64 = 1e-6;

/// Node k lies at k steps of the C angle from the path's start, on whatever revolution that is.
#[derive(Debug, Clone, PartialEq)]
pub struct EqualAngle {
    per_turn: f64,
}

impl Strategy for EqualAngle {
    const NAME: &'static str = "equal-angle";
    const SUMMARY: &'static str = "equal steps of the C angle along the whole path";
    const PARAMS: &'static [Param] = &[
        Param::angle(
            "step",
            "angle between neighbouring points, such as \"6 deg\"; it need not divide a turn",
        )
        .positive()
        .max(90.0 * DEG),
        Param::angle("max_step", "largest angle step that is accepted")
            .default(45.0 * DEG)
            .positive()
            .max(90.0 * DEG),
    ];

    fn new(params: &Params) -> Result<Self> {
        let (step, largest) = (params.angle_rad("step"), params.angle_rad("max_step"));
        if step > largest * (1.0 + WHOLE) {
            let (step, largest) = (step / DEG, largest / DEG);
            return Err(StrategyError::parameter(
                "step",
                format!(
                    "{step:.6} deg is more than max_step, {largest:.6} deg; \
                     choose a smaller step or raise max_step"
                ),
            ));
        }
        let (per_turn, whole) = (TAU / step, (TAU / step).round());
        let near = (per_turn - whole).abs() <= WHOLE * whole;
        Ok(Self {
            per_turn: if near { whole } else { per_turn },
        })
    }
}

impl EqualAngle {
    /// Where node `k` lies, in revolutions.
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
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut Vec<f64>) -> Result<()> {
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
            let step = 360.0 / f64::from(divisor) * DEG;
            let params = Params::new()
                .with("step", step)
                .with("max_step", 90.0 * DEG);
            let sampler = EqualAngle::new(&params).unwrap();
            for turn in [1, 64, 99_999] {
                assert_eq!(sampler.node(divisor as u64 * turn), turn as f64);
                assert_eq!(sampler.first_from(turn as f64), divisor as u64 * turn);
            }
        }
    }
}
