//! The moves before and after a path.
//!
//! LinuxCNC needs more words for them than other controllers, because a program begins with what the last
//! one left: `G21` makes numbers mm, `G8` makes X a radius, `G40` compensates no tool. `G64` would round
//! the corners from axis to axis, so the moves have `G61`. The path's first line sets `G64` again.

use super::read::without_comments;
use crate::fixed_point::{ONE, number};
use crate::g_code;
use crate::program_format::ProgramFormat;
use crate::travel::{Places, Travel, TravelModes};

/// What the first of LinuxCNC's moves says besides `G90` and `G94`.
const LINUXCNC_MODES: &str = " G8 G21 G40 G61";
/// `G21`: mm.
const METRIC: i128 = 21 * ONE;
/// `G8` and `G40`: X is a radius, and no tool is compensated.
const WITHOUT_MOVE: [i128; 2] = [8 * ONE, 40 * ONE];

/// Writes a statement for LinuxCNC.
pub(super) fn push_for_linuxcnc(text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
    g_code::push_travel(text, format, LINUXCNC_MODES, travel);
}

/// Reads a line for LinuxCNC, which must know that numbers are mm before it moves.
pub(super) fn read_for_linuxcnc(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = spaced(code)?;
    let mut rest = Vec::new();
    for word in code.split_whitespace() {
        let mode = word.strip_prefix('G').map(|text| number("G", text));
        match mode.and_then(Result::ok) {
            Some(METRIC) => modes.metric = true,
            Some(mode) if WITHOUT_MOVE.contains(&mode) => {}
            _ => rest.push(word),
        }
    }
    let places = g_code::read_travel(&rest.join(" "), modes)?;
    match !modes.metric && places.iter().any(Option::is_some) {
        true => Err("a move before `G21`".to_owned()),
        false => Ok(places),
    }
}

/// Reads a line. Comments stand in parentheses anywhere in it.
pub(super) fn read(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    g_code::read_travel(&spaced(code)?, modes)
}

/// The words of a line in capitals with a space between them, without its comments.
fn spaced(code: &str) -> Result<String, String> {
    let mut spaced = String::with_capacity(2 * code.len());
    for c in without_comments(code)?.chars() {
        if c.is_ascii_alphabetic() {
            spaced.push(' ');
        }
        spaced.push(c);
    }
    Ok(spaced)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_with_and_without_spaces_and_comments() {
        for code in ["G0 Z6.5", "g0z6.5", "G0 (up) Z6.5", "(up)G0Z6.5"] {
            let mut modes = TravelModes::default();
            read("G90 G94", &mut modes).unwrap();
            let places = read(code, &mut modes).unwrap();
            assert_eq!(places, [None, None, Some(ONE * 13 / 2)], "{code}");
        }
        assert!(read("G0 (up Z6.5", &mut TravelModes::default()).is_err());
    }

    #[test]
    fn linuxcnc_does_not_move_before_it_knows_that_numbers_are_mm() {
        let mut modes = TravelModes::default();
        assert!(read_for_linuxcnc("G90 G94 G8 G40 G61", &mut modes).is_ok());
        let said = read_for_linuxcnc("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G21`");
        assert!(read_for_linuxcnc("G21", &mut modes).is_ok());
        assert!(read_for_linuxcnc("G0 Z6.5", &mut modes).is_ok());
        assert!(read_for_linuxcnc("G20", &mut modes).is_err());
    }
}
