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

impl Strategy for SinusoidalArray {
    const NAME: &'static str = "sinusoidal-array";
    const SUMMARY: &'static str = "waves along x and y: cosines added, or sines multiplied";
    const SOURCE: &'static str = "the lens array of Zhong et al. (sum) and the sinusoidal array of the integrated discretization paper (product)";
    const PARAMS: &'static [Param] = &[
        Param::length(
            "amplitude_x",
            "amplitude of the wave along x, or of the product",
        ),
        Param::length(
            "amplitude_y",
            "amplitude of the wave along y; as amplitude_x if left out",
        )
        .optional(),
        Param::per_length("frequency_x", "waves per length along x"),
        Param::per_length(
            "frequency_y",
            "waves per length along y; as frequency_x if left out",
        )
        .optional(),
        Param::choice(
            "form",
            &["sum", "product"],
            "cosines added, or sines multiplied",
        )
        .default_choice("sum"),
    ];

    fn new(params: &Params) -> Result<Self> {
        let form = if params.choice("form") == "product" {
            Form::Product
        } else {
            Form::Sum
        };
        let amplitude_x = params.length_mm("amplitude_x");
        let amplitude_y = params.given("amplitude_y").unwrap_or(amplitude_x);
        let frequency_x = params.per_mm("frequency_x");
        let frequency_y = params.given("frequency_y").unwrap_or(frequency_x);
        if form == Form::Product && amplitude_x != amplitude_y {
            return Err(StrategyError::parameter(
                "amplitude_y",
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
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let (along_x, along_y) = (x * self.wave_number_x, y * self.wave_number_y);
        match self.form {
            Form::Sum => along_x.cos() * self.amplitude_x + along_y.cos() * self.amplitude_y,
            Form::Product => along_x.sin() * along_y.sin() * self.amplitude_x,
        }
    }
}
