//! Two speeds: `speed` up to a part of the path, a smaller one after it, and a smooth change between.
//!
//! The law is the time t(N). Where the speed changes, t is the polynomial of degree 5 with the value, the
//! rate and no second derivative at both ends. The rate of such a polynomial goes from one value to
//! the other without overshooting, and its mean is that of both.
#![forbid(unsafe_code)]
use turnpath_plugin::prelude::*;

const LATER: Param<Number> = Param::number("later", "the later speed, as a part of `speed`")
    .default(0.7)
    .min(0.01)
    .max(1.0);
const AT: Param<Number> = Param::number("at", "where the change is, as a part of the revolutions")
    .default(0.5)
    .min(0.0)
    .max(1.0);
const CHANGE: Param<Number> = Param::number("change", "revolutions that the change takes")
    .default(5.0)
    .min(1.0);

/// Revolutions at both ends of the path over which the speed is constant, so that leads join.
const STEADY: f64 = 0.5;

struct TwoSpeeds {
    later: f64,
    at: f64,
    change: f64,
}

impl Strategy for TwoSpeeds {
    const NAME: &'static str = "two-speeds";
    const SUMMARY: &'static str = "one speed at first, a smaller one later, smoothly joined";
    const PARAMS: &'static [ParamInfo] = &[LATER.info(), AT.info(), CHANGE.info()];

    fn new(p: &Params) -> Result<Self> {
        Ok(Self {
            later: p.get(LATER),
            at: p.get(AT),
            change: p.get(CHANGE),
        })
    }
}

impl SpindleStrategy for TwoSpeeds {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        let end = path.law.end();
        let length = self.change.min(end - 2.0 * STEADY);
        if length <= 0.0 {
            // A path of a turn has no room for a change.
            return Ok(SpindleLaw::constant(ask.speed));
        }
        let before = (self.at * end - 0.5 * length).clamp(STEADY, end - STEADY - length);
        let after = end - before - length;
        // dt/dN of both speeds.
        let (fast, slow) = (TAU / ask.speed, TAU / (self.later * ask.speed));
        let from = fast * before;
        let to = from + 0.5 * (fast + slow) * length;
        let mut time = PiecewisePolynomial::new();
        time.push(before, [0.0, fast, 0.0, 0.0, 0.0, 0.0]);
        time.push(length, quintic([from, fast, 0.0], [to, slow, 0.0], length));
        time.push(after, [to, slow, 0.0, 0.0, 0.0, 0.0]);
        Ok(SpindleLaw::from_time(time))
    }
}

turnpath_plugin::export!(spindles: [TwoSpeeds]);

#[cfg(test)]
mod tests {
    #[test]
    fn conforms() {
        turnpath_plugin_test::check!();
    }
}
