//! The moves before and after a path.
//!
//! A program begins with what the last one left. LinuxCNC: `G21` makes numbers mm, `G8` makes X a
//! radius, `G40` compensates no tool. `G64` would round the corners from axis to axis, so the moves have
//! `G61`. The path's first line sets `G64` again. TwinCAT CNC has `G71`, `G52` and `G40` for these, and
//! `G360` for a stop at the end of each line, which the path's first line takes back.

use super::read::without_comments;
use crate::fixed_point::{ONE, number};
use crate::g_code;
use crate::program_format::ProgramFormat;
use crate::travel::{Places, Travel, TravelModes};

/// What the first of a controller's moves says besides `G90` and `G94`, and how a reader knows it.
struct Modes {
    /// The words as they are written.
    text: &'static str,
    /// The number of the word that makes numbers mm, in 10⁻¹².
    metric: i128,
    /// The numbers of words that move nothing.
    without_move: &'static [i128],
}

/// Numbers are mm, X is a radius, no tool is compensated, and each line ends at rest.
const LINUXCNC: Modes = Modes {
    text: " G8 G21 G40 G61",
    metric: 21 * ONE,
    without_move: &[8 * ONE, 40 * ONE],
};
/// The same on TwinCAT CNC.
const BECKHOFF: Modes = Modes {
    text: " G40 G52 G71 G360",
    metric: 71 * ONE,
    without_move: &[40 * ONE, 52 * ONE, 360 * ONE],
};

/// Writes a statement for LinuxCNC.
pub(super) fn push_for_linuxcnc(text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
    g_code::push_travel(text, format, LINUXCNC.text, travel);
}

/// Writes a statement for TwinCAT CNC.
pub(super) fn push_for_beckhoff(text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
    g_code::push_travel(text, format, BECKHOFF.text, travel);
}

/// Reads a line for LinuxCNC, which must know that numbers are mm before it moves.
pub(super) fn read_for_linuxcnc(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    read_with(&LINUXCNC, code, modes)
}

/// Reads a line for TwinCAT CNC, which must know the same.
pub(super) fn read_for_beckhoff(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    read_with(&BECKHOFF, code, modes)
}

fn read_with(own: &Modes, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = spaced(code)?;
    let mut rest = Vec::new();
    for word in code.split_whitespace() {
        let mode = word.strip_prefix('G').map(|text| number("G", text));
        match mode.and_then(Result::ok) {
            Some(mode) if mode == own.metric => modes.metric = true,
            Some(mode) if own.without_move.contains(&mode) => {}
            _ => rest.push(word),
        }
    }
    let places = g_code::read_travel(&rest.join(" "), modes)?;
    match !modes.metric && places.iter().any(Option::is_some) {
        true => Err(format!("a move before `G{}`", own.metric / ONE)),
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

    #[test]
    fn twincat_does_not_move_before_it_knows_that_numbers_are_mm() {
        let mut modes = TravelModes::default();
        assert!(read_for_beckhoff("G90 G94 G40 G52 G360", &mut modes).is_ok());
        let said = read_for_beckhoff("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G71`");
        assert!(read_for_beckhoff("G71", &mut modes).is_ok());
        assert!(read_for_beckhoff("G0 Z6.5", &mut modes).is_ok());
        assert!(read_for_beckhoff("G21", &mut modes).is_err());
    }
}
