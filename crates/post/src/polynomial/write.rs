//! A segment as the cubic of each axis, in decimals.

use crate::digits::DigitSegment;
use crate::program_format::ProgramFormat;

/// Decimals of the coefficients: enough that a polynomial begins with the velocity with which the one
/// before ends.
pub(crate) const COEFFICIENT_DECIMALS: u32 = 12;

/// a0 + a1 p + a2 p² + a3 p³ on p = 0 … 1, in units of the last decimal of coefficients. The sum is the end
/// of the segment as it is written, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Coefficients {
    pub(crate) start: i128,
    pub(crate) linear: i128,
    pub(crate) square: i128,
    pub(crate) cube: i128,
}

/// Those of an axis: of the cubic from one position to the next, as they are written, with the velocities
/// at both ends.
pub(crate) fn coefficients(
    format: &ProgramFormat,
    segment: &DigitSegment,
    axis: usize,
) -> Coefficients {
    let (from, to) = (&segment.from, &segment.to);
    let finer = |decimals: u32| 10i128.pow(COEFFICIENT_DECIMALS.saturating_sub(decimals));
    let place = |units: i64| i128::from(units) * finer(format.position_decimals);
    let start = place(from.position[axis]);
    let rise = place(to.position[axis]) - start;
    let per_step = i128::from(format.steps_per_s);
    let way = |velocity: i64| {
        let scaled = i128::from(velocity) * finer(format.velocity_decimals);
        rounded(scaled * i128::from(segment.steps()), per_step)
    };
    let (begin, end) = (way(from.velocity[axis]), way(to.velocity[axis]));
    Coefficients {
        start,
        linear: begin,
        square: 3 * rise - 2 * begin - end,
        cube: begin + end - 2 * rise,
    }
}

/// A quotient, rounded.
fn rounded(value: i128, by: i128) -> i128 {
    (2 * value + by).div_euclid(2 * by)
}
