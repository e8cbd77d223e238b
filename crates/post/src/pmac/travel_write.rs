//! Writes the moves before and after a path.
//!
//! `RAPID` moves one axis after the other: a rapid move is never blended with another. Z goes down by a
//! `LINEAR` move with its time, `TM`, so that no setting of the controller gives `F` its unit. `DWELL0`
//! ends it before the first move of the path.
//!
//! Facts on the language: Turbo PMAC User Manual, "Rapid-Mode Moves" and "Linear Blended Moves";
//! Turbo PMAC Software Reference, `TM`, `DWELL` and `STOP`.

use std::io::Write;

use crate::decimal::push;
use crate::digits::AXES;
use crate::program_format::ProgramFormat;
use crate::travel::{Travel, Z};

/// Milliseconds of a minute.
const MINUTE_MS: f64 = 60_000.0;

/// A statement.
pub(super) fn push_travel(text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
    match travel {
        Travel::Begin => text.extend_from_slice(b"ABS\nRAPID\n"),
        Travel::Rapid { axis, to } => push_place(text, format, axis, to),
        Travel::Feed { to, way } => {
            let way = way as f64 / 10u64.pow(format.position_decimals) as f64;
            let ms = (way / format.approach_feed * MINUTE_MS).ceil().max(1.0);
            // Writing to memory cannot fail.
            let _ = writeln!(text, "LINEAR TM{ms}");
            push_place(text, format, Z, to);
            text.extend_from_slice(b"DWELL0\n");
        }
        Travel::Stop => text.extend_from_slice(b"STOP\n"),
    }
}

fn push_place(text: &mut Vec<u8>, format: &ProgramFormat, axis: usize, to: i64) {
    text.extend(AXES.get(axis).map(|axis| *axis as u8));
    push(text, to, format.position_decimals);
    text.push(b'\n');
}
