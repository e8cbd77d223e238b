//! Writes the calls before and after a path.
//!
//! A program begins with what the last one left, so the units of distances and of times come first.
//! `WaitMode.MotionDone` makes the task wait until an axis rests before the next one moves. The speed of
//! `MoveLinear` is in mm/s, since the task's time units are seconds.

use crate::decimal::push;
use crate::digits::AXES;
use crate::program_format::ProgramFormat;
use crate::travel::{Travel, Z};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;

/// A statement.
pub(super) fn push_travel(text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
    match travel {
        Travel::Begin => text.extend_from_slice(
            b"SetupTaskDistanceUnits(DistanceUnits.Primary)\n\
              SetupTaskTimeUnits(TimeUnits.Seconds)\n\
              SetupTaskTargetMode(TargetMode.Absolute)\n\
              SetupTaskWaitMode(WaitMode.MotionDone)\n",
        ),
        Travel::Rapid { axis, to } => {
            push_call(text, format, "MoveRapid", axis, to);
            text.extend_from_slice(b")\n");
        }
        Travel::Feed { to, .. } => {
            push_call(text, format, "MoveLinear", Z, to);
            let speed = format!(", {})\n", format.approach_feed / MINUTE);
            text.extend_from_slice(speed.as_bytes());
        }
        Travel::Stop => text.extend_from_slice(b"ProgramPause()\n"),
    }
}

fn push_call(text: &mut Vec<u8>, format: &ProgramFormat, name: &str, axis: usize, to: i64) {
    text.extend_from_slice(name.as_bytes());
    text.extend_from_slice(b"([");
    text.extend(AXES.get(axis).map(|axis| *axis as u8));
    text.extend_from_slice(b"], [");
    push(text, to, format.position_decimals);
    text.push(b']');
}
