//! A sphere with a ripple along x, such as the marks of an earlier cut.
//!
//! z = s / (R (1 + sqrt(1 − s/R²))) + A cos 2πfx with s = x² + y². Written for any number, so that
//! slopes and series follow from it exactly.
#![forbid(unsafe_code)]
use turnpath_plugin::prelude::*;

const RADIUS: Param<Length> = Param::length("radius", "radius of the sphere; positive: concave")
    .default(60.0)
    .nonzero();
const AMPLITUDE: Param<Length> =
    Param::length("amplitude", "half the height of the ripple").default(0.2 * UM);
const FREQUENCY: Param<PerLength> =
    Param::per_length("frequency", "waves of the ripple on a length along x").default(0.5);

struct RippledSphere {
    radius: f64,
    amplitude: f64,
    frequency: f64,
}

impl Strategy for RippledSphere {
    const NAME: &'static str = "rippled-sphere";
    const SUMMARY: &'static str = "a sphere with a ripple along x";
    const SOURCE: &'static str = "z = s/(R(1 + sqrt(1 − s/R²))) + A cos 2πfx, s = x² + y²";
    const PARAMS: &'static [ParamInfo] = &[RADIUS.info(), AMPLITUDE.info(), FREQUENCY.info()];

    fn new(p: &Params) -> Result<Self> {
        Ok(Self {
            radius: p.get(RADIUS),
            amplitude: p.get(AMPLITUDE),
            frequency: p.get(FREQUENCY),
        })
    }
}

impl Surface for RippledSphere {
    // So eight cosines are found at a time.
    const SIDE_BY_SIDE: bool = false;

    // So the formula runs in the widest vector registers of the CPU.
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let s = x.squared() + y.squared();
        // Beyond the equator the root has no value, and the height is NaN, as it should be.
        let root = (s * (-1.0 / (self.radius * self.radius)) + 1.0).sqrt();
        let sphere = s / ((root + 1.0) * self.radius);
        sphere + (x * (TAU * self.frequency)).cos() * self.amplitude
    }
}

turnpath_plugin::export!(surfaces: [RippledSphere]);

#[cfg(test)]
mod tests {
    #[test]
    fn conforms() {
        turnpath_plugin_test::check!();
    }
}
