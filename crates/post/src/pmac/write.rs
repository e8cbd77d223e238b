//! Writes the lines of a PVT path.

use std::io::Write;

use super::clock::Clock;
use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place, said_positions};
use crate::line_room::{OF_POINT, push_in_room};
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
    let is_new = steps != segment.steps_before.unwrap_or(entry);
    let time = is_new.then(|| i128::from(steps) * i128::from(clock.step()));
    let (positions, velocities) = (said_positions(format, segment), segment.to.velocity);
    // The same lines as below.
    let in_room = push_in_room::<OF_POINT>(text, |line| {
        if let Some(time) = time {
            line.word(b"PVT")?;
            line.number(time.try_into().ok()?, clock.decimals)?;
            line.word(b"\n")?;
        }
        for (k, axis) in AXES.into_iter().enumerate() {
            if k > 0 {
                line.word(b" ")?;
            }
            line.word(&[axis as u8])?;
            line.number(positions[k], format.position_decimals)?;
            line.word(b":")?;
            line.number(velocities[k], format.velocity_decimals)?;
        }
        line.word(b"\n")
    });
    if in_room {
        return;
    }
    if let Some(time) = time {
        text.extend_from_slice(b"PVT");
        push(text, time, clock.decimals);
        text.push(b'\n');
    }
    push_axes(text, format, positions, velocities);
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
    use crate::posts::post_named;

    fn segment(steps: i64, position: [i64; 3], velocity: [i64; 3]) -> DigitSegment {
        let from = Digits {
            steps: 7,
            position: [0; 3],
            velocity: [0; 3],
        };
        DigitSegment {
            from,
            to: Digits {
                steps: 7 + steps,
                position,
                velocity,
            },
            steps_before: None,
        }
    }

    fn written(segment: &DigitSegment) -> String {
        let post = post_named("pmac-pvt").unwrap();
        let format = post.format(&turnpath_core::Params::new(), 0.0, 1e-4);
        let mut text = Vec::new();
        push_segment(&mut text, TURBO_CLOCK, &format, segment);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn every_step_of_time_is_exact() {
        for (steps, time) in [
            (1, "0.000244140625"),
            (12_288, "3"),
            (6145, "1.500244140625"),
        ] {
            let text = written(&segment(steps, [0; 3], [0; 3]));
            assert_eq!(text, format!("PVT{time}\nC0:0 X0:0 Z0:0\n"));
        }
    }

    /// Numbers with many digits go another way than short ones.
    #[test]
    fn lines_with_long_numbers_are_like_those_with_short_ones() {
        let (short, long) = (12_345_678, 9_000_000_000_000_000_001);
        let text = written(&segment(12_288, [short, -short, 5], [0, short, -1]));
        assert_eq!(
            text,
            "PVT3\nC1.2345678:0 X-1.2345678:1.2345678 Z0.0000005:-0.0000001\n"
        );
        let text = written(&segment(12_288, [long, -short, 5], [0, short, -long]));
        let said = "900000000000.0000001";
        let others = "X-1.2345678:1.2345678 Z0.0000005";
        assert_eq!(text, format!("PVT3\nC{said}:0 {others}:-{said}\n"));
    }
}
