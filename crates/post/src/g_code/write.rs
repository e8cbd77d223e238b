//! Writes the moves.

use crate::decimal::push;
use crate::digits::AXES;
use crate::program_format::ProgramFormat;
use crate::travel::{Travel, Z};

/// A statement. `modes` are words that stand beside `G90` and `G94`, such as the one for an exact stop.
pub(crate) fn push_travel(text: &mut Vec<u8>, format: &ProgramFormat, modes: &str, travel: Travel) {
    match travel {
        Travel::Begin => text.extend_from_slice(format!("G90 G94{modes}").as_bytes()),
        Travel::Rapid { axis, to } => push_move(text, format, "G0 ", axis, to),
        Travel::Feed { to, .. } => {
            push_move(text, format, "G1 ", Z, to);
            text.extend_from_slice(format!(" F{}", format.approach_feed).as_bytes());
        }
        Travel::Stop => text.extend_from_slice(b"M0"),
    }
    text.push(b'\n');
}

fn push_move(text: &mut Vec<u8>, format: &ProgramFormat, word: &str, axis: usize, to: i64) {
    text.extend_from_slice(word.as_bytes());
    text.extend(AXES.get(axis).map(|axis| *axis as u8));
    push(text, to, format.position_decimals);
}
