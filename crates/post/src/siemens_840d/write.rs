//! Writes the blocks of a path.

use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place};
use crate::program_format::ProgramFormat;

/// Decimals of the coefficients: enough that a polynomial begins with the velocity with which the one
/// before ends.
const COEFFICIENT_DECIMALS: u32 = 12;
/// Seconds of a minute.
const MINUTE: f64 = 60.0;

/// The first point: a straight line that takes a second, before C alone is the path: C may stand there
/// already.
pub(super) fn push_first(text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
    text.extend_from_slice(b"G71 G90 G93 G64 FGROUP()\nG1");
    for (axis, place) in AXES.into_iter().zip(said_place(format, point)) {
        text.push(b' ');
        text.push(axis as u8);
        push(text, place, format.position_decimals);
    }
    text.extend_from_slice(b" F60\nFGROUP(C) UPATH\n");
}

/// A segment.
pub(super) fn push_segment(text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
    if segment.steps_before.is_none() {
        text.extend_from_slice(b"POLY ");
    }
    for (k, axis) in AXES.into_iter().enumerate() {
        text.extend_from_slice(b"PO[");
        text.push(axis as u8);
        text.extend_from_slice(b"]=(");
        push(text, segment.to.position[k], format.position_decimals);
        let [square, cube] = coefficients(format, segment, k);
        if square != 0 || cube != 0 {
            text.push(b',');
            push(text, square, COEFFICIENT_DECIMALS);
        }
        if cube != 0 {
            text.push(b',');
            push(text, cube, COEFFICIENT_DECIMALS);
        }
        text.extend_from_slice(b") ");
    }
    let feed = MINUTE * format.steps_per_s as f64 / segment.steps() as f64;
    // The shortest text that gives the double back.
    text.extend_from_slice(format!("F{feed}\n").as_bytes());
}

/// a2 and a3 of an axis, in units of their last digit: of the cubic from one position to the next, as
/// they are written, with the velocities at both ends.
fn coefficients(format: &ProgramFormat, segment: &DigitSegment, axis: usize) -> [i128; 2] {
    let (from, to) = (&segment.from, &segment.to);
    let finer = |decimals: u32| 10i128.pow(COEFFICIENT_DECIMALS.saturating_sub(decimals));
    let rise = i128::from(to.position[axis]) - i128::from(from.position[axis]);
    let rise = rise * finer(format.position_decimals);
    let per_step = i128::from(format.steps_per_s);
    let way = |velocity: i64| {
        let scaled = i128::from(velocity) * finer(format.velocity_decimals);
        rounded(scaled * i128::from(segment.steps()), per_step)
    };
    let (begin, end) = (way(from.velocity[axis]), way(to.velocity[axis]));
    [3 * rise - 2 * begin - end, begin + end - 2 * rise]
}

/// A quotient, rounded.
fn rounded(value: i128, by: i128) -> i128 {
    (2 * value + by).div_euclid(2 * by)
}
