//! Motion programs for Turbo PMAC in position-velocity-time mode, and the reader that checks them.
//!
//! ```text
//! ; -- cutting --
//! ABS
//! PVT1000
//! C0:3000 X2.5:-0.2003846 Z1.5:0
//! PVT3
//! C9:3000 X2.4993989:-0.2003846 Z1.6544085:50.3013247
//! …
//! ; -- end of path: 4160 points --
//! ```
//!
//! The lines before the first mark belong to the header, those after the last mark to the footer.
//! The first move brings the axes from wherever they are to the first control point, within
//! a second, and reaches the velocity of that point. If the path has a lead-in, that point is a
//! rest above the part. Every other move is a segment of the path. Sections follow each other without
//! a break, and each begins with a mark.
//!
//! **Times.** The controller counts times in 1/4096 ms, and a segment takes 4095.9998 ms at the most: a
//! longer one is divided, and the parts play the same cubic. The writer rounds the time of each point since
//! the start of the path, not the time of each segment, so rounding errors do not add up. A point
//! between two such times moves along the played cubic to the nearer one (by 122 ns at the most) and
//! takes the velocity there. So the spindle keeps its speed from segment to segment, and the played
//! curve does not change. If the point kept its position and only its velocity were scaled, the curve
//! would bend on one side of the point, because rounding changes the lengths of the two segments
//! differently. (If the recipe asks for a program, the pipeline places the points at such times from
//! the start, so that the path and the program have the same points.)
//!
//! Facts on the language: Turbo PMAC Software Reference and User Manual, "PVT-Mode Moves".

mod clock;
mod commands;
mod dialect;
mod plain;
mod read;
mod scan;
mod segments;
#[cfg(test)]
mod tests;
mod travel_read;
mod travel_write;
mod write;

use turnpath_core::{ParamInfo, Params};

pub(crate) use clock::Clock;

use commands::{commands, ends_program, leaves_program_open};
pub(crate) use dialect::PmacDialect;
use read::PvtGrammar;
use segments::push_segments;
use travel_read::read_travel;
use travel_write::push_travel;
use write::{push_first, push_last, push_segment};

use turnpath_core::toolpath::SegmentShape;

use crate::digit_segments::DigitSegments;
use crate::digits::{DigitSegment, Digits};
use crate::part_name::{PartLines, PartName, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post};
use crate::program_error::ProgramError;
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    BUFFER, C_LIMIT, C_SIGN, C_WRAP, FOOTER, HEADER, MEMORY, POSITION_DECIMALS, POSITIONING,
    ROTARY, SEGMENTS_PER_SECOND, SHORTEST_SEGMENT, SPLIT, VELOCITY_DECIMALS, VELOCITY_PER,
};
use crate::travel::{Places, Travel, TravelModes};

/// Turbo PMAC with I42 = 0: 24 bits, 12 of them fraction.
pub(crate) const TURBO_CLOCK: Clock = Clock {
    steps_per_ms: 4096,
    decimals: 12,
};

/// Programs for Turbo PMAC.
pub(crate) const PMAC_PVT: Post = Post {
    name: "pmac-pvt",
    table: "output.pmac-pvt",
    extension: "pmc",
    summary: "the layout of the programs of the post `pmac-pvt`",
    comment: ";",
    keys: &[
        POSITION_DECIMALS.info(),
        VELOCITY_DECIMALS.info(),
        VELOCITY_PER.info(),
        C_SIGN.info(),
        C_WRAP.info(),
        POSITIONING.info(),
        BUFFER.info(),
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
; turnpath {turnpath}, post pmac-pvt: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; velocities per {velocity_unit}: Ix90 = {ix90}
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; segment times in steps of 1/4096 ms: I42 = 0
; the path begins and ends {ends}
; verified on this text: {verified}
CLOSE
OPEN PROG 1 CLEAR
",
    footer: "CLOSE\n",
    shape: SegmentShape::Cubic,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 4_096_000,
    longest: (1 << 24) - 1,
    mantissa_bits: Some(35),
    c_is_even: false,
    delivered_decimals: None,
    dialect: &Pvt {
        clock: TURBO_CLOCK,
        dialect: PmacDialect::Turbo,
    },
};

/// The header of a program for the rotary buffer. The buffer is number 0, and has no loops and no jumps:
/// the path's lines have none.
const ROTARY_HEADER: &str = "\
; {name}
; recipe {recipe}, SHA-256 {sha256}
; changed by --set: {changes}
; turnpath {turnpath}, post pmac-pvt: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; velocities per {velocity_unit}: Ix90 = {ix90}
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; segment times in steps of 1/4096 ms: I42 = 0
; the path begins and ends {ends}
; for the rotary buffer: DEFINE ROTARY n once, B0 R to run it, and this file sent as the buffer empties
CLOSE
OPEN ROTARY
";

/// The keys of this family of controllers.
pub(crate) const PVT_KEYS: &[ParamInfo] = &[
    POSITION_DECIMALS.info(),
    VELOCITY_DECIMALS.info(),
    VELOCITY_PER.info(),
    C_SIGN.info(),
    C_WRAP.info(),
    POSITIONING.info(),
    SHORTEST_SEGMENT.info(),
    SEGMENTS_PER_SECOND.info(),
    MEMORY.info(),
    SPLIT.info(),
    C_LIMIT.info(),
    HEADER.info(),
    FOOTER.info(),
];

/// Lines in position-velocity-time mode.
#[derive(Debug)]
pub(crate) struct Pvt {
    pub(crate) clock: Clock,
    pub(crate) dialect: PmacDialect,
}

impl Dialect for Pvt {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_segment(text, self.clock, format, segment);
    }

    fn write_segments(
        &self,
        text: &mut Vec<u8>,
        format: &ProgramFormat,
        segments: &DigitSegments<'_>,
    ) -> Result<(), ProgramError> {
        push_segments(text, self.clock, format, segments);
        Ok(())
    }

    fn write_last(&self, text: &mut Vec<u8>, format: &ProgramFormat) {
        push_last(text, format);
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(PvtGrammar::new(self.clock, format))
    }

    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        push_travel(text, format, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        read_travel(code, modes)
    }

    fn part_lines(&self, part: &PartName) -> Option<PartLines> {
        let number = part.program_number;
        Some(match self.dialect {
            PmacDialect::Turbo => PartLines {
                call: format!("CALL{number}"),
                begin: format!("CLOSE\nOPEN PROG {number} CLEAR\n"),
                end: "CLOSE\n".to_owned(),
            },
            PmacDialect::Power => PartLines {
                call: format!("call {number}"),
                begin: format!("close\nopen prog {number}\n"),
                end: "close\n".to_owned(),
            },
        })
    }

    fn part_frame(&self, part: &PartName) -> [Vec<String>; 2] {
        let open = format!("OPENPROG{}", part.program_number);
        let open = match self.dialect {
            PmacDialect::Turbo => format!("{open}CLEAR"),
            PmacDialect::Power => open,
        };
        let close = "CLOSE".to_owned();
        [vec![close.clone(), open], vec![close]]
    }

    /// A controller of this family knows programs by their numbers, and files by their names alone.
    fn called_part(&self, code: &str, main: (&str, &PartNumbers)) -> Option<String> {
        let code = code.trim();
        let word = code
            .get(..4)
            .filter(|word| word.eq_ignore_ascii_case("CALL"))?;
        let number: u32 = code.get(word.len()..)?.trim().parse().ok()?;
        let (program, numbers) = main;
        let part = numbers.part_of(number)?;
        Some(PartName::of(program, part, numbers).file)
    }

    fn calls_by_number(&self) -> bool {
        true
    }

    fn other_header(&self, settings: &Params) -> Option<(&'static str, &'static str)> {
        let is_rotary = settings.find(BUFFER) == Some(ROTARY);
        is_rotary.then_some((BUFFER.name(), ROTARY_HEADER))
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        commands(template, &self.dialect)
    }

    fn leaves_program_open(&self, header: &str) -> bool {
        leaves_program_open(header)
    }

    fn ends_program(&self, command: &str) -> bool {
        ends_program(command)
    }
}
