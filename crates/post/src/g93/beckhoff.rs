//! The post for Beckhoff TwinCAT CNC (TF5200), whose kernel is that of ISG.
//!
//! ```text
//! ; -- cutting --
//! G40 G52 G71 G90 G93 G359
//! G1 C0 X2.5 Z1.5 F1
//! C0.75 X2.4999499 Z1.5128 F0.00025
//! …
//! ```
//!
//! `G93`: F is the seconds of a line, for linear and rotary axes alike. Facts on the language: Beckhoff,
//! TF5200 Programming manual, "Machining time or feedrate (G93/G94/G95/G194)", and those of
//! [`beckhoff`].

use turnpath_core::toolpath::SegmentShape;

use super::read::{LineGrammar, Words};
use super::write::{push_first, push_line};
use crate::beckhoff;
use crate::digits::{DigitSegment, Digits};
use crate::part_name::{PartLines, PartName, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post};
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    C_SIGN, C_WRAP, CHORD_SHARE, FOOTER, HEADER, MEMORY, POSITION_DECIMALS, SEGMENTS_PER_SECOND,
    SHORTEST_SEGMENT, SPLIT, TWINCAT_C_LIMIT,
};
use crate::travel::{Places, Travel, TravelModes};

/// Programs for TwinCAT CNC.
pub(crate) const BECKHOFF_G93: Post = Post {
    name: "beckhoff-g93",
    table: "output.beckhoff-g93",
    extension: "cnc",
    summary: "the layout of the programs of the post `beckhoff-g93`",
    comment: ";",
    keys: &[
        POSITION_DECIMALS.info(),
        CHORD_SHARE.info(),
        C_SIGN.info(),
        C_WRAP.info(),
        SHORTEST_SEGMENT.info(),
        SEGMENTS_PER_SECOND.info(),
        MEMORY.info(),
        SPLIT.info(),
        TWINCAT_C_LIMIT.info(),
        HEADER.info(),
        FOOTER.info(),
    ],
    header: "\
; {name}
; recipe {recipe}, SHA-256 {sha256}
; changed by --set: {changes}
; turnpath {turnpath}, post beckhoff-g93: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, X a radius, Z of the {z_reference}; C in deg, {c_range}; F in {f_means}: G93
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; the channel must keep its digits: {increments} increments of a mm and of a deg
; the path begins and ends {ends}
; verified on this text: {verified}
",
    footer: "M30\n",
    shape: SegmentShape::Linear,
    feed: FeedMeaning::Seconds,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: Some(4),
    dialect: &Beckhoff,
};

/// Lines for TwinCAT CNC.
#[derive(Debug)]
struct Beckhoff;

/// No tool's radius is compensated, X is a radius, units are mm, numbers are positions, F is the seconds
/// of a line, corners are not stopped at.
const MODES: &str = "G40 G52 G71 G90 G93 G359";
/// The words of a path.
const WORDS: Words = Words {
    needed: &["G40", "G52", "G71", "G90", "G93", "G359"],
    allowed: &[],
    dwells: false,
    numbers_have_blanks: false,
};

impl Dialect for Beckhoff {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, MODES, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_line(text, format, segment);
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(LineGrammar::new(format, WORDS))
    }

    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        beckhoff::TRAVEL.push(text, format, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        beckhoff::TRAVEL.read(code, modes)
    }

    fn part_lines(&self, part: &PartName) -> Option<PartLines> {
        Some(beckhoff::part_lines(part))
    }

    fn part_frame(&self, _part: &PartName) -> [Vec<String>; 2] {
        beckhoff::part_frame()
    }

    fn called_part(&self, code: &str, _main: (&str, &PartNumbers)) -> Option<String> {
        beckhoff::called_part(code)
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        beckhoff::commands(template)
    }

    fn ends_program(&self, command: &str) -> bool {
        beckhoff::ends_program(command)
    }
}
