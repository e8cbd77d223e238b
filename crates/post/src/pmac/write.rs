//! Writes the lines of a PVT path.

use std::io::Write;

use super::clock::Clock;
use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place, said_positions};
use crate::program_format::ProgramFormat;

/// Time of the move to the first control point, ms. It is not a part of the path.
pub(crate) const ENTRY_MS: i64 = 1000;

/// The first point: a place, also where distances follow.
pub(super) fn push_first(text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
    // Writing to memory cannot fail.
    let _ = writeln!(text, "ABS\nPVT{ENTRY_MS}");
    push_axes(text, format, said_place(format, point), point.velocity);
    if format.incremental {
        text.extend_from_slice(b"INC\n");
    }
}

/// Behind the last segment: numbers are positions again, whatever follows.
pub(super) fn push_last(text: &mut Vec<u8>, format: &ProgramFormat) {
    if format.incremental {
        text.extend_from_slice(b"ABS\n");
    }
}

/// A segment: its time where it changes, and a line with its end.
pub(super) fn push_segment(
    text: &mut Vec<u8>,
    clock: Clock,
    format: &ProgramFormat,
    segment: &DigitSegment,
) {
    let entry = ENTRY_MS * clock.steps_per_ms;
    let steps = segment.steps();
    if steps != segment.steps_before.unwrap_or(entry) {
        text.extend_from_slice(b"PVT");
        push_ms(text, clock, steps);
        text.push(b'\n');
    }
    let positions = said_positions(format, segment);
    push_axes(text, format, positions, segment.to.velocity);
}

/// Appends a time in milliseconds, exactly.
fn push_ms(text: &mut Vec<u8>, clock: Clock, steps: i64) {
    let step = 10i64.pow(clock.decimals) / clock.steps_per_ms;
    push(text, i128::from(steps) * i128::from(step), clock.decimals);
}

fn push_axes(
    text: &mut Vec<u8>,
    format: &ProgramFormat,
    positions: [i64; 3],
    velocities: [i64; 3],
) {
    for (k, axis) in AXES.into_iter().enumerate() {
        if k > 0 {
            text.push(b' ');
        }
        text.push(axis as u8);
        push(text, positions[k], format.position_decimals);
        text.push(b':');
        push(text, velocities[k], format.velocity_decimals);
    }
    text.push(b'\n');
}

#[cfg(test)]
mod tests {
    use super::super::TURBO_CLOCK;
    use super::*;

    #[test]
    fn every_step_of_time_is_exact() {
        for (steps, text) in [
            (1, "0.000244140625"),
            (12_288, "3"),
            (6145, "1.500244140625"),
        ] {
            let mut written = Vec::new();
            push_ms(&mut written, TURBO_CLOCK, steps);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }
}
