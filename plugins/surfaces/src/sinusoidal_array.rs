//! The sinusoidal array: waves along x and along y, added or multiplied.

use std::f64::consts::TAU;

use turnpath_plugin::prelude::*;

/// Waves along x and y.
///
/// Sum: z = A_x cos(2π f_x x) + A_y cos(2π f_y y). Product: z = A sin(2π f_x x) sin(2π f_y y).
#[derive(Debug, Clone, PartialEq)]
pub struct SinusoidalArray {
    form: Form,
    amplitude_x: f64,
    amplitude_y: f64,
    /// 2π f_x.
    wave_number_x: f64,
    /// 2π f_y.
    wave_number_y: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Sum,
    Product,
}

const AMPLITUDE_X: Param<Length> = Param::length(
    "amplitude_x",
    "amplitude of the wave along x, or of the product",
);
const AMPLITUDE_Y: Param<Option<Length>> = Param::length(
    "amplitude_y",
    "amplitude of the wave along y; as amplitude_x if left out",
)
.optional();
const FREQUENCY_X: Param<PerLength> = Param::per_length("frequency_x", "waves per length along x");
const FREQUENCY_Y: Param<Option<PerLength>> = Param::per_length(
    "frequency_y",
    "waves per length along y; as frequency_x if left out",
)
.optional();
const FORM: Param<Choice> = Param::choice(
    "form",
    &["sum", "product"],
    "cosines added, or sines multiplied",
)
.default("sum");

impl Strategy for SinusoidalArray {
    const NAME: &'static str = "sinusoidal-array";
    const SUMMARY: &'static str = "waves along x and y: cosines added, or sines multiplied";
    const SOURCE: &'static str = "the lens array of Zhong et al. (sum) and the sinusoidal array of the integrated discretization paper (product)";
    const PARAMS: &'static [ParamInfo] = &[
        AMPLITUDE_X.info(),
        AMPLITUDE_Y.info(),
        FREQUENCY_X.info(),
        FREQUENCY_Y.info(),
        FORM.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let form = if params.get(FORM) == "product" {
            Form::Product
        } else {
            Form::Sum
        };
        let amplitude_x = params.get(AMPLITUDE_X);
        let amplitude_y = params.get(AMPLITUDE_Y).unwrap_or(amplitude_x);
        let frequency_x = params.get(FREQUENCY_X);
        let frequency_y = params.get(FREQUENCY_Y).unwrap_or(frequency_x);
        if form == Form::Product && amplitude_x != amplitude_y {
            return Err(AMPLITUDE_Y.refused(
                "a product has one amplitude: leave amplitude_y out, or give it the value of \
                 amplitude_x",
            ));
        }
        Ok(Self {
            form,
            amplitude_x,
            amplitude_y,
            wave_number_x: TAU * frequency_x,
            wave_number_y: TAU * frequency_y,
        })
    }
}

impl Surface for SinusoidalArray {
    const SIDE_BY_SIDE: bool = false;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (along_x, along_y) = (x * self.wave_number_x, y * self.wave_number_y);
        match self.form {
            Form::Sum => along_x.cos() * self.amplitude_x + along_y.cos() * self.amplitude_y,
            Form::Product => along_x.sin() * along_y.sin() * self.amplitude_x,
        }
    }
}
