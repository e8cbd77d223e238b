//! Runs a tape on a number type.
//!
//! At the axis itself ρ and θ have no derivatives. There ρ is 0 and θ is 0, and the derivatives of
//! both are 0: for ρ the mean of both sides. [`crate::polar`] leaves ρ and θ only where no
//! polynomial has the same values.

use turnpath_plugin::prelude::*;

use crate::names::{Function, PairFunction};
use crate::tape::{MOST_REGISTERS, Operation, Step, Tape, X, Y};

/// ρ² below which a point counts as one of the axis, mm². The fifth derivative of ρ is still
/// finite there, as a product too.
const AXIS: f64 = 1e-50;

impl Tape {
    /// The height at (x, y).
    pub fn at<S: Scalar>(&self, x: S, y: S) -> S {
        self.run(x, y)
    }

    /// The same within the loop over a batch: there x and y are put into their registers at once, and
    /// the registers get their room once a batch.
    #[inline(always)]
    pub fn run<S: Scalar>(&self, x: S, y: S) -> S {
        // Fewer registers are set faster, which counts for series.
        match self.registers {
            0..=2 => self.on::<S, 2>(x, y),
            3..=4 => self.on::<S, 4>(x, y),
            5..=8 => self.on::<S, 8>(x, y),
            9..=16 => self.on::<S, 16>(x, y),
            17..=32 => self.on::<S, 32>(x, y),
            _ => self.on::<S, MOST_REGISTERS>(x, y),
        }
    }

    /// The same on `N` registers, a power of two: so no index is out of range.
    #[inline(always)]
    fn on<S: Scalar, const N: usize>(&self, x: S, y: S) -> S {
        let mut registers = [x; N];
        registers[usize::from(Y) % N] = y;
        for step in &self.steps {
            apply(step, &mut registers);
        }
        registers[usize::from(self.height) % N]
    }
}

/// Each operation reads and writes its registers itself: a value that goes through a variable is
/// copied, and a register of a series is large.
#[inline(always)]
fn apply<S: Scalar, const N: usize>(step: &Step, r: &mut [S; N]) {
    let [a, b, out] = [step.a, step.b, step.out].map(|register| usize::from(register) % N);
    let [x, y] = [X, Y].map(|register| usize::from(register) % N);
    match step.operation {
        Operation::Sum => r[out] = r[a] + r[b],
        Operation::Difference => r[out] = r[a] - r[b],
        Operation::Product => r[out] = r[a] * r[b],
        Operation::Quotient => r[out] = r[a] / r[b],
        Operation::Square => r[out] = r[a].squared(),
        Operation::PlusNumber(number) => r[out] = r[a] + number,
        Operation::TimesNumber(number) => r[out] = r[a] * number,
        Operation::Line(line) => r[out] = line.at(r[a]),
        Operation::SumOfMultiples(first, second) => r[out] = r[a] * first + r[b] * second,
        Operation::ProductOfLines(first, second) => r[out] = first.at(r[a]) * second.at(r[b]),
        Operation::QuotientOfLines(first, second) => r[out] = first.at(r[a]) / second.at(r[b]),
        Operation::SquareOfRho => r[out] = r[x].squared() + r[y].squared(),
        Operation::One(Function::Sqrt) => r[out] = r[a].sqrt(),
        Operation::One(Function::Cos) => r[out] = r[a].cos(),
        Operation::One(Function::Sin) => r[out] = r[a].sin(),
        Operation::OneOfLine(Function::Sqrt, line) => r[out] = line.at(r[a]).sqrt(),
        Operation::OneOfLine(Function::Cos, line) => r[out] = line.at(r[a]).cos(),
        Operation::OneOfLine(Function::Sin, line) => r[out] = line.at(r[a]).sin(),
        Operation::Negative => r[out] = -r[a],
        Operation::Power(exponent) => r[out] = power(r[a], exponent),
        Operation::RealPower(exponent) => r[out] = r[a].powf(exponent),
        Operation::Number(number) => r[out] = S::constant(number),
        Operation::NumberOver(number) => r[out] = over(number, r[a]),
        Operation::Rho => r[out] = rho(r[x], r[y]),
        Operation::RealPowerOfRho(exponent) => r[out] = power_of_rho(r[x], r[y], exponent),
        Operation::Theta => r[out] = theta(r[x], r[y]),
        Operation::One(function) => r[out] = one(function, r[a]),
        Operation::OneOfLine(function, line) => r[out] = one(function, line.at(r[a])),
        Operation::Two(function) => r[out] = two(function, r[a], r[b]),
    }
}

// What takes long anyway stays out of the loop, so that the loop is small.

#[inline(never)]
fn power<S: Scalar>(a: S, exponent: i32) -> S {
    a.powi(exponent)
}

#[inline(never)]
fn over<S: Scalar>(number: f64, a: S) -> S {
    a.recip() * number
}

#[inline(never)]
fn one<S: Scalar>(function: Function, a: S) -> S {
    function.of(a)
}

#[inline(never)]
fn two<S: Scalar>(function: PairFunction, a: S, b: S) -> S {
    function.of(a, b)
}

#[inline(never)]
fn rho<S: Scalar>(x: S, y: S) -> S {
    let square = x.squared() + y.squared();
    let at_axis = square.less(S::constant(AXIS));
    let beside = S::select(at_axis, S::constant(1.0), square).sqrt();
    S::select(at_axis, S::constant(0.0), beside)
}

/// Its derivatives at the axis count as 0, as those of ρ do.
#[inline(never)]
fn power_of_rho<S: Scalar>(x: S, y: S, exponent: f64) -> S {
    let square = x.squared() + y.squared();
    let at_axis = square.less(S::constant(AXIS));
    let beside = S::select(at_axis, S::constant(1.0), square).powf(0.5 * exponent);
    S::select(at_axis, S::constant(0.0), beside)
}

#[inline(never)]
fn theta<S: Scalar>(x: S, y: S) -> S {
    let at_axis = (x.squared() + y.squared()).less(S::constant(AXIS));
    let (x, y) = (
        S::select(at_axis, S::constant(1.0), x),
        S::select(at_axis, S::constant(0.0), y),
    );
    y.atan2(x)
}
