//! Runs a tape on a number type.
//!
//! At the axis itself ρ and θ have no derivatives. There ρ is 0 and θ is 0, and the derivatives of
//! both are 0: for ρ the mean of both sides. [`crate::polar`] leaves ρ and θ only where no
//! polynomial has the same values.

use turnpath_plugin::prelude::*;

use crate::tape::{MOST_REGISTERS, Operation, Step, Tape, X, Y};

/// ρ² below which a point counts as one of the axis, mm². The fifth derivative of ρ is still
/// finite there, as a product too.
const AXIS: f64 = 1e-50;

impl Tape {
    /// The height at (x, y).
    pub fn run<S: Scalar>(&self, x: S, y: S) -> S {
        // Fewer registers are set faster, which counts for series.
        match self.registers {
            0..=4 => self.on::<S, 4>(x, y),
            5..=8 => self.on::<S, 8>(x, y),
            9..=16 => self.on::<S, 16>(x, y),
            17..=32 => self.on::<S, 32>(x, y),
            _ => self.on::<S, MOST_REGISTERS>(x, y),
        }
    }

    /// The same on `N` registers, a power of two: so no index is out of range.
    fn on<S: Scalar, const N: usize>(&self, x: S, y: S) -> S {
        let mut registers = [S::constant(0.0); N];
        registers[usize::from(X) % N] = x;
        registers[usize::from(Y) % N] = y;
        for step in &self.steps {
            registers[usize::from(step.out) % N] = value(step, &registers);
        }
        registers[usize::from(self.height) % N]
    }
}

#[inline(always)]
fn value<S: Scalar, const N: usize>(step: &Step, registers: &[S; N]) -> S {
    let a = registers[usize::from(step.a) % N];
    let b = || registers[usize::from(step.b) % N];
    match step.operation {
        Operation::Sum => a + b(),
        Operation::Difference => a - b(),
        Operation::Product => a * b(),
        Operation::Quotient => a / b(),
        Operation::Negative => -a,
        Operation::Square => a.squared(),
        Operation::Power(exponent) => a.powi(exponent),
        Operation::RealPower(exponent) => a.powf(exponent),
        Operation::Number(number) => S::constant(number),
        Operation::PlusNumber(number) => a + number,
        Operation::TimesNumber(number) => a * number,
        Operation::NumberMinus(number) => -a + number,
        Operation::NumberOver(number) => a.recip() * number,
        Operation::Rho => rho(registers[usize::from(X) % N], registers[usize::from(Y) % N]),
        Operation::Theta => theta(registers[usize::from(X) % N], registers[usize::from(Y) % N]),
        Operation::One(function) => function.of(a),
        Operation::Two(function) => function.of(a, b()),
    }
}

fn rho<S: Scalar>(x: S, y: S) -> S {
    let square = x.squared() + y.squared();
    let at_axis = square.less(S::constant(AXIS));
    let beside = S::select(at_axis, S::constant(1.0), square).sqrt();
    S::select(at_axis, S::constant(0.0), beside)
}

fn theta<S: Scalar>(x: S, y: S) -> S {
    let at_axis = (x.squared() + y.squared()).less(S::constant(AXIS));
    let (x, y) = (
        S::select(at_axis, S::constant(1.0), x),
        S::select(at_axis, S::constant(0.0), y),
    );
    y.atan2(x)
}
