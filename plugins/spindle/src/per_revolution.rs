//! The spindle strategy `per-revolution`.

use turnpath_plugin::prelude::*;

use crate::plan::fastest_law;

/// As fast as the machine's limits allow, smoothly from turn to turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PerRevolution;

impl Strategy for PerRevolution {
    const NAME: &'static str = "per-revolution";
    const SUMMARY: &'static str = "as fast as the machine's limits allow, smoothly from turn to \
        turn; `speed` is the largest";
    const SOURCE: &'static str = "own; velocity, acceleration and jerk of X, Z and C along the path, \
        and of the path as played";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl SpindleStrategy for PerRevolution {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        check_limits(&path.task.machine)?;
        fastest_law(path, ask, |_| f64::INFINITY)
    }

    fn follows_factors(&self) -> bool {
        true
    }
}

/// Checks that the machine has the limits without which no speed is the largest.
fn check_limits(machine: &Machine) -> Result<()> {
    let Machine { x, z, c } = machine;
    let known = |limits: &AxisLimits| {
        [limits.velocity, limits.acceleration, limits.jerk]
            .iter()
            .any(Option::is_some)
    };
    if c.acceleration.is_none() {
        return Err(missing(
            "c_acceleration",
            "how fast the spindle may change its speed",
        ));
    }
    if !known(x) && !known(z) {
        return Err(missing(
            "z_acceleration",
            "what the spindle's speed may ask of the axes",
        ));
    }
    Ok(())
}

fn missing(key: &str, what: &str) -> StrategyError {
    StrategyError::parameter(
        "use",
        format!(
            "[machine] has no `{key}`, and so nothing says {what}; give it, or choose another spindle"
        ),
    )
}
