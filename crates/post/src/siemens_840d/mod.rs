//! Motion programs for Siemens Sinumerik 840D with polynomials.
//!
//! ```text
//! ; -- cutting --
//! G71 G90 G93 G64 FGROUP()
//! G1 C0 X2.5 Z1.5 F60
//! FGROUP(C) UPATH
//! POLY PO[C]=(9) PO[X]=(2.4993989) PO[Z]=(1.6544085,0.0023,-0.0001) F20000
//! PO[C]=(18) PO[X]=(2.4987978) PO[Z]=(1.8,0.0021,-0.0001) F20000
//! …
//! ; -- end of path: 4160 points --
//! ```
//!
//! `PO[X]=(xe,a2,a3)` is the polynomial a0 + a1 p + a2 p² + a3 p³ on p = 0 … 1 (`PL` = 1): a0 is where
//! the axis stands, and a1 follows from the end xe. The polynomial is the cubic that PVT would play
//! between the positions as they are written, so a1 is the velocity times the segment's time. The
//! coefficients have twelve decimals: their rounding moves the path by less than 10⁻¹¹ mm.
//!
//! **Time.** `G93`: F is one over the minutes of a segment. `FGROUP(C)` makes C alone the path to which
//! F refers, and `UPATH` makes X and Z follow C by the parameter p. So X and Z belong to their C as
//! the recipe has it, whatever the speed at which C is played. Within a segment the controller keeps
//! the speed of the path, which is that of C: where the spindle's speed changes, C is right at the
//! control points and linear in time between them, and the speeds of all axes step there. A reader
//! takes C as the polynomial says: the curve in C, X and Z is the same. What is measured on it in
//! space is true; [`c_is_even`](crate::Post::c_is_even) makes the run say how far C's speed steps.
//!
//! Facts on the language: Siemens, SINUMERIK Job Planning (6FC5398-2BP40), "Polynomial interpolation
//! (POLY, POLYPATH, PO, PL)" and "Settable path reference (SPATH, UPATH)".
//!
//! What depends on the machine: the digits of a position that the controller keeps
//! (`MD10200 $MN_INT_INCR_PER_MM` and `MD10210 $MN_INT_INCR_PER_DEG`), and whether C may leave 0 to
//! 360 deg (`MD30310 $MA_ROT_IS_MODULO = 0`).

mod read;
#[cfg(test)]
mod tests;
mod travel;
mod write;

use read::PolyGrammar;
use write::{push_first, push_segment};

use turnpath_core::toolpath::SegmentShape;

use crate::digits::{DigitSegment, Digits};
use crate::g_code::push_travel;
use crate::part_name::{PartLines, PartName, PartNames, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post, behind_number, commands_of};
use crate::program_error::ProgramError;
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    C_LIMIT, C_SIGN, FOOTER, HEADER, MEMORY, POSITION_DECIMALS, SEGMENTS_PER_SECOND,
    SHORTEST_SEGMENT, SPLIT,
};
use crate::travel::{C, Places, Travel, TravelModes};

/// Programs for Siemens Sinumerik 840D.
pub(crate) const SIEMENS_840D_POLY: Post = Post {
    name: "siemens-840d-poly",
    table: "output.siemens-840d-poly",
    extension: "mpf",
    summary: "the layout of the programs of the post `siemens-840d-poly`",
    comment: ";",
    keys: &[
        POSITION_DECIMALS.info(),
        C_SIGN.info(),
        SHORTEST_SEGMENT.info(),
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
; turnpath {turnpath}, post siemens-840d-poly: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; F in 1/min: G93
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; the machine must keep its digits: MD10200 and MD10210 = {increments} or more
; the path begins and ends {ends}
; verified on this text: {verified}
",
    footer: "M30\n",
    shape: SegmentShape::Cubic,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: true,
    delivered_decimals: Some(3),
    dialect: &Poly,
};

/// Lines with polynomials.
#[derive(Debug)]
struct Poly;

/// Words that move nothing, and set nothing but units and what the path sets itself.
const HARMLESS: &[&str] = &[
    "G71", "G710", "G90", "G93", "G64", "M0", "M2", "M17", "M30", "UPATH",
];
/// What stands beside `G90` and `G94` before the moves outside of the path. A program begins with what
/// the last one left: `G710` makes lengths and feeds metric, `FGROUP()` makes F that of the axis that
/// moves, and with `G60` each axis comes to rest, so that no corner is rounded.
const TRAVEL_MODES: &str = " G710 G60 FGROUP()";
/// Words that end a program.
const ENDS: &[&str] = &["M2", "M02", "M17", "M30", "RET"];

impl Dialect for Poly {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_segment(text, format, segment);
    }

    /// `FGROUP(C)`: a block takes the time of its way along C, so it has such a way.
    fn check_time(
        &self,
        format: &ProgramFormat,
        segment: &DigitSegment,
    ) -> Result<(), ProgramError> {
        let way = |digits: &Digits| (digits.position[C], digits.velocity[C]);
        let is_still = way(&segment.from) == way(&segment.to) && segment.to.velocity[C] == 0;
        let (t, c_deg) = segment.end(format);
        match is_still {
            true => Err(ProgramError::StillC { t, c_deg }),
            false => Ok(()),
        }
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(PolyGrammar::new(format))
    }

    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        push_travel(text, format, TRAVEL_MODES, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        travel::read(code, modes)
    }

    fn part_lines(&self, part: &PartName) -> Option<PartLines> {
        Some(PartLines {
            call: format!("EXTCALL(\"{}\")", part.file),
            begin: String::new(),
            // `RET` ends a subprogram without an end of the continuous path.
            end: "RET\n".to_owned(),
        })
    }

    fn part_names(&self) -> PartNames {
        PartNames::Sinumerik
    }

    fn part_frame(&self, _part: &PartName) -> [Vec<String>; 2] {
        [Vec::new(), vec!["RET".to_owned()]]
    }

    fn called_part(&self, code: &str, _main: (&str, &PartNumbers)) -> Option<String> {
        travel::called_part(code)
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        let is_harmless = |code: &str| {
            let code = behind_number(code).to_ascii_uppercase();
            code.split_whitespace().all(|word| HARMLESS.contains(&word))
        };
        commands_of(template, &[";"], is_harmless)
    }

    fn ends_program(&self, command: &str) -> bool {
        let command = behind_number(command).to_ascii_uppercase();
        command.split_whitespace().any(|word| ENDS.contains(&word))
    }
}
