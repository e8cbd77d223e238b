//! Writes the calls of a path.

use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place, said_positions};
use crate::program_format::ProgramFormat;

/// Time of the move to the first control point, s. It is not a part of the path.
const ENTRY_S: i64 = 1;
/// Decimals of a time in seconds: its steps are nanoseconds.
const TIME_DECIMALS: u32 = 9;

/// The first point: a place, also where distances follow.
pub(super) fn push_first(text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
    text.extend_from_slice(b"SetupTaskDistanceUnits(DistanceUnits.Primary)\n");
    text.extend_from_slice(b"SetupTaskTimeUnits(TimeUnits.Seconds)\n");
    text.extend_from_slice(b"SetupTaskTargetMode(TargetMode.Absolute)\n");
    let steps = ENTRY_S * 10i64.pow(TIME_DECIMALS);
    push_call(
        text,
        format,
        said_place(format, point),
        point.velocity,
        steps,
    );
    if format.incremental {
        text.extend_from_slice(b"SetupTaskTargetMode(TargetMode.Incremental)\n");
    }
}

/// Behind the last segment: targets are positions again, whatever follows.
pub(super) fn push_last(text: &mut Vec<u8>, format: &ProgramFormat) {
    if format.incremental {
        text.extend_from_slice(b"SetupTaskTargetMode(TargetMode.Absolute)\n");
    }
}

/// A segment.
pub(super) fn push_segment(text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
    let positions = said_positions(format, segment);
    push_call(
        text,
        format,
        positions,
        segment.to.velocity,
        segment.steps(),
    );
}

fn push_call(
    text: &mut Vec<u8>,
    format: &ProgramFormat,
    positions: [i64; 3],
    velocities: [i64; 3],
    steps: i64,
) {
    text.extend_from_slice(b"MovePvt([");
    for (k, axis) in AXES.into_iter().enumerate() {
        push_comma(text, k);
        text.push(axis as u8);
    }
    text.extend_from_slice(b"], [");
    push_list(text, positions, format.position_decimals);
    text.extend_from_slice(b"], [");
    push_list(text, velocities, format.velocity_decimals);
    text.extend_from_slice(b"], ");
    push(text, steps, TIME_DECIMALS);
    text.extend_from_slice(b")\n");
}

fn push_list(text: &mut Vec<u8>, values: [i64; 3], decimals: u32) {
    for (k, value) in values.into_iter().enumerate() {
        push_comma(text, k);
        push(text, value, decimals);
    }
}

fn push_comma(text: &mut Vec<u8>, k: usize) {
    if k > 0 {
        text.extend_from_slice(b", ");
    }
}
