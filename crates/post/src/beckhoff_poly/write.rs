//! Writes the blocks of a path.

use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place};
use crate::polynomial::{COEFFICIENT_DECIMALS, Coefficients, coefficients};
use crate::program_format::{ProgramFormat, TimeAxis};

/// Decimals of the axis of time: a nanosecond at a µm/s.
const TIME_DECIMALS: u32 = 12;
/// Seconds of a minute.
const MINUTE: i64 = 60;
/// Decimals of a speed in µm/s as mm/min.
const SPEED_DECIMALS: u32 = 3;

/// The first point: a line that takes a second, and the axis of time to its beginning.
pub(super) fn push_first(text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
    text.extend_from_slice(b"G40 G52 G71 G90 G93 G359\nG1");
    for (axis, place) in AXES.into_iter().zip(said_place(format, point)) {
        text.push(b' ');
        text.push(axis as u8);
        push(text, place, format.position_decimals);
    }
    text.extend_from_slice(b" F1\n");
    if let Some(time_axis) = format.time_axis {
        text.extend_from_slice(b"G0 ");
        push_time(text, format, time_axis, point.steps);
        text.extend_from_slice(format!("\n#FGROUP [{}]\n", time_axis.name).as_bytes());
    }
}

/// A segment.
pub(super) fn push_segment(text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
    let is_first = segment.steps_before.is_none();
    if is_first {
        text.extend_from_slice(b"G94 G1 ");
    }
    if let Some(time_axis) = format.time_axis {
        push_time(text, format, time_axis, segment.to.steps);
    }
    for (k, axis) in AXES.into_iter().enumerate() {
        text.push(b' ');
        text.push(axis as u8);
        push_polynomial(text, &coefficients(format, segment, k));
    }
    if let Some(time_axis) = format.time_axis.filter(|_| is_first) {
        text.extend_from_slice(b" F");
        push(text, MINUTE * time_axis.speed_um_per_s, SPEED_DECIMALS);
    }
    text.push(b'\n');
}

/// Where the axis of time is after so many steps.
fn push_time(text: &mut Vec<u8>, format: &ProgramFormat, time_axis: TimeAxis, steps: i64) {
    let steps_per_s = i128::from(format.steps_per_s);
    // mm in 10⁻¹²: a step of a nanosecond at 1 µm/s.
    let way = i128::from(steps) * i128::from(time_axis.speed_um_per_s) * 1_000_000_000;
    text.push(time_axis.name as u8);
    push(text, way / steps_per_s, TIME_DECIMALS);
}

fn push_polynomial(text: &mut Vec<u8>, polynomial: &Coefficients) {
    let Coefficients {
        start,
        linear,
        square,
        cube,
    } = *polynomial;
    text.extend_from_slice(b"[POLY A0=");
    push(text, start, COEFFICIENT_DECIMALS);
    for (name, coefficient) in [("A1", linear), ("A2", square), ("A3", cube)] {
        // One that is left out is zero.
        if coefficient != 0 {
            text.extend_from_slice(format!(" {name}=").as_bytes());
            push(text, coefficient, COEFFICIENT_DECIMALS);
        }
    }
    text.push(b']');
}
