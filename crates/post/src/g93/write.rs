//! Writes the lines of a path.

use crate::decimal::push;
use crate::digits::{AXES, DigitSegment, Digits, said_place};
use crate::program_format::{FeedMeaning, ProgramFormat};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// Decimals of a time in seconds, of which a step is 10⁻⁹.
const TIME_DECIMALS: u32 = 9;

/// The first point: the words that say what the numbers mean, and a line that takes a second.
pub(super) fn push_first(text: &mut Vec<u8>, format: &ProgramFormat, modes: &str, point: &Digits) {
    text.extend_from_slice(modes.as_bytes());
    text.extend_from_slice(b"\nG1 ");
    push_place(text, format, point);
    push_feed(text, format, format.steps_per_s);
}

/// The end of a line, and its time.
pub(super) fn push_line(text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
    push_place(text, format, &segment.to);
    push_feed(text, format, segment.steps());
}

/// A time in which nothing moves.
pub(super) fn push_dwell(text: &mut Vec<u8>, steps: i64) {
    text.extend_from_slice(b"G4 P");
    push(text, steps, TIME_DECIMALS);
    text.push(b'\n');
}

fn push_place(text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
    for (axis, place) in AXES.into_iter().zip(said_place(format, point)) {
        text.push(axis as u8);
        push(text, place, format.position_decimals);
        text.push(b' ');
    }
}

fn push_feed(text: &mut Vec<u8>, format: &ProgramFormat, steps: i64) {
    text.push(b'F');
    match format.chords.map(|chords| chords.feed) {
        Some(FeedMeaning::Seconds) => push(text, steps, TIME_DECIMALS),
        _ => {
            // The shortest text that gives the double back, which has no exponent.
            let feed = inverse_minutes(format, steps);
            text.extend_from_slice(feed.to_string().as_bytes());
        }
    }
    text.push(b'\n');
}

/// One over the minutes of so many steps.
pub(super) fn inverse_minutes(format: &ProgramFormat, steps: i64) -> f64 {
    MINUTE * format.steps_per_s as f64 / steps as f64
}
