//! Writes the blocks of a path.

use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place};
use crate::polynomial::{COEFFICIENT_DECIMALS, Coefficients, coefficients};
use crate::program_format::ProgramFormat;

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
        let Coefficients { square, cube, .. } = coefficients(format, segment, k);
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
