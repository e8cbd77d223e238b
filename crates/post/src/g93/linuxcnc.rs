//! The post for LinuxCNC.

use turnpath_core::toolpath::SegmentShape;

use super::read::{LineGrammar, Words};
use super::timing::{check_time, is_dwell};
use super::write::{push_dwell, push_first, push_line};
use crate::digits::{DigitSegment, Digits};
use crate::g_code::{TravelWords, commands, ends_program};
use crate::part_name::{PartLines, PartName, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post};
use crate::program_error::ProgramError;
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    C_LIMIT, C_SIGN, CHORD_SHARE, FOOTER, HEADER, LOWEST_RATE, MEMORY, POSITION_DECIMALS,
    SEGMENTS_PER_SECOND, SERVO_PERIOD, SPLIT,
};
use crate::travel::{Places, Travel, TravelModes};

/// Programs for LinuxCNC.
pub(crate) const LINUXCNC_G93: Post = Post {
    name: "linuxcnc-g93",
    table: "output.linuxcnc-g93",
    extension: "ngc",
    summary: "the layout of the programs of the post `linuxcnc-g93`",
    comment: ";",
    keys: &[
        POSITION_DECIMALS.info(),
        CHORD_SHARE.info(),
        LOWEST_RATE.info(),
        SERVO_PERIOD.info(),
        C_SIGN.info(),
        SEGMENTS_PER_SECOND.info(),
        MEMORY.info(),
        SPLIT.info(),
        C_LIMIT.info(),
        HEADER.info(),
        FOOTER.info(),
    ],
    header: "\
; {name}
; recipe {recipe}, SHA-256 {sha256}
; changed by --set: {changes}
; turnpath {turnpath}, post linuxcnc-g93: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, X a radius, Z of the {z_reference}; C in deg, {c_range}; F in 1/min: G93
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; the path begins and ends {ends}
; verified on this text: {verified}
",
    footer: "M2\n",
    shape: SegmentShape::Linear,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: None,
    dialect: &LinuxCnc,
};

/// Lines for LinuxCNC.
#[derive(Debug)]
struct LinuxCnc;

/// X is a radius, units are mm, the tool's radius is not compensated, corners are not stopped at,
/// numbers are positions, F is one over minutes.
const MODES: &str = "G8 G21 G40 G64 G90 G93";
/// Words that move nothing and set nothing but what the path sets itself, and the ends of programs.
const HARMLESS: &[&str] = &["G8", "G21", "G40", "G64", "G90", "G93", "M2", "M30", "%"];
/// Numbers of words with M that end a program.
const ENDS: &[u32] = &[2, 30];
/// The words of a path.
const WORDS: Words = Words {
    needed: &["G8", "G21", "G40", "G64", "G90", "G93"],
    allowed: &[],
    dwells: true,
    numbers_have_blanks: true,
};

/// Numbers are mm, X is a radius, no tool is compensated, and each line ends at rest: `G64` would round the
/// corners from axis to axis. The path's first line sets `G64` again.
const TRAVEL: TravelWords = TravelWords {
    text: " G8 G21 G40 G61",
    needed: &["G90", "G94", "G8", "G21", "G40", "G61"],
    allowed: &[],
    numbers_have_blanks: true,
};

impl Dialect for LinuxCnc {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, MODES, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        match is_dwell(segment) {
            true => push_dwell(text, segment.steps()),
            false => push_line(text, format, segment),
        }
    }

    fn check_time(
        &self,
        format: &ProgramFormat,
        segment: &DigitSegment,
    ) -> Result<(), ProgramError> {
        check_time(format, segment)
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(LineGrammar::new(format, WORDS))
    }

    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        TRAVEL.push(text, format, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        TRAVEL.read(code, modes)
    }

    fn part_lines(&self, part: &PartName) -> Option<PartLines> {
        let name = &part.stem;
        Some(PartLines {
            call: format!("o<{name}> call"),
            begin: format!("o<{name}> sub\n"),
            end: format!("o<{name}> endsub\nM2\n"),
        })
    }

    fn part_frame(&self, part: &PartName) -> [Vec<String>; 2] {
        let name = part.stem.to_ascii_uppercase();
        let end = [format!("O<{name}>ENDSUB"), "M2".to_owned()];
        [vec![format!("O<{name}>SUB")], end.to_vec()]
    }

    fn called_part(&self, code: &str, _main: (&str, &PartNumbers)) -> Option<String> {
        let code: String = code.split_whitespace().collect();
        let code = code.to_ascii_lowercase();
        let name = code.strip_prefix("o<")?.strip_suffix(">call")?;
        Some(format!("{name}.{}", LINUXCNC_G93.extension))
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        commands(template, HARMLESS)
    }

    fn ends_program(&self, command: &str) -> bool {
        ends_program(command, ENDS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linuxcnc_does_not_move_before_it_knows_that_numbers_are_mm() {
        let mut modes = TravelModes::default();
        assert!(TRAVEL.read("G90 G94 G8 G40 G61", &mut modes).is_ok());
        let said = TRAVEL.read("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G21`");
        assert!(TRAVEL.read("G21", &mut modes).is_ok());
        assert!(TRAVEL.read("G0 Z6.5", &mut modes).is_ok());
        for unknown in ["G20", "G60", "G9"] {
            assert!(TRAVEL.read(unknown, &mut modes).is_err(), "{unknown}");
        }
    }
}
