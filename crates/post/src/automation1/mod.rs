//! Motion programs for Aerotech Automation1: AeroScript with `MovePvt`.
//!
//! ```text
//! // -- cutting --
//! SetupTaskDistanceUnits(DistanceUnits.Primary)
//! SetupTaskTimeUnits(TimeUnits.Seconds)
//! SetupTaskTargetMode(TargetMode.Absolute)
//! MovePvt([C, X, Z], [0, 2.5, 1.5], [3000, -0.2003846, 0], 1)
//! MovePvt([C, X, Z], [9, 2.4993989, 1.6544085], [3000, -0.2003846, 50.3013247], 0.003)
//! …
//! // -- end of path: 4160 points --
//! ```
//!
//! Each call gives positions and velocities at the end of a segment and its time in seconds; between
//! them the controller plays the cubic that has both positions and both velocities. Numbers are
//! doubles. The program writes times in steps of a nanosecond, and rounds the time since the start, so
//! that rounding errors do not add up.
//!
//! The first call brings the axes from wherever they are to the first control point, within a second.
//!
//! What is not known from a manual: the shortest and the longest time that the controller accepts.
//! Segments of more than 1000 s are divided.

mod read;
#[cfg(test)]
mod tests;
mod travel_read;
mod travel_write;
mod write;

use read::AeroScript;
use travel_read::read_travel;
use travel_write::push_travel;
use write::{push_first, push_last, push_segment};

use turnpath_core::toolpath::SegmentShape;

use crate::digits::{DigitSegment, Digits};
use crate::part_name::{PartLines, PartName, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post, commands_of};
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    C_LIMIT, C_SIGN, FOOTER, HEADER, MEMORY, POSITION_DECIMALS, POSITIONING, SEGMENTS_PER_SECOND,
    SHORTEST_SEGMENT, SPLIT, VELOCITY_DECIMALS,
};
use crate::travel::{Places, Travel, TravelModes};

/// Programs for Aerotech Automation1.
pub(crate) const AUTOMATION1_PVT: Post = Post {
    name: "automation1-pvt",
    table: "output.automation1-pvt",
    extension: "ascript",
    summary: "the layout of the programs of the post `automation1-pvt`",
    comment: "//",
    keys: &[
        POSITION_DECIMALS.info(),
        VELOCITY_DECIMALS.info(),
        C_SIGN.info(),
        POSITIONING.info(),
        SHORTEST_SEGMENT.info(),
        SEGMENTS_PER_SECOND.info(),
        MEMORY.info(),
        SPLIT.info(),
        C_LIMIT.info(),
        HEADER.info(),
        FOOTER.info(),
    ],
    header: "\
// {name}
// recipe {recipe}, SHA-256 {sha256}
// changed by --set: {changes}
// turnpath {turnpath}, post automation1-pvt: {points} points, {revolutions} revolutions, {time_s} s
// X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; velocities per {velocity_unit}
// X: {axis_x}
// Z: {axis_z}
// C: {axis_c}
// the path begins and ends {ends}
// verified on this text: {verified}
",
    footer: "",
    shape: SegmentShape::Cubic,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: None,
    dialect: &MovePvt,
};

/// Lines with `MovePvt`.
#[derive(Debug)]
struct MovePvt;

/// Calls that move nothing, set nothing but what the path sets itself, and start nothing.
const HARMLESS: &[&str] = &[
    "program",
    "end",
    "SetupTaskTargetMode(TargetMode.Absolute)",
    "SetupTaskTargetMode(TargetMode.Incremental)",
    "SetupTaskTimeUnits(TimeUnits.Seconds)",
    "SetupTaskDistanceUnits(DistanceUnits.Primary)",
];

impl Dialect for MovePvt {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_segment(text, format, segment);
    }

    fn write_last(&self, text: &mut Vec<u8>, format: &ProgramFormat) {
        push_last(text, format);
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(AeroScript::new(format))
    }

    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        push_travel(text, format, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        read_travel(code, modes)
    }

    fn part_lines(&self, part: &PartName) -> Option<PartLines> {
        Some(PartLines {
            call: format!("#include \"{}\"", part.file),
            begin: String::new(),
            end: String::new(),
        })
    }

    fn called_part(&self, code: &str, _main: (&str, &PartNumbers)) -> Option<String> {
        let rest = code.trim().strip_prefix("#include")?.trim();
        let name = rest.strip_prefix('"')?.strip_suffix('"')?;
        Some(name.to_owned())
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        commands_of(template, &["//"], |code| HARMLESS.contains(&code))
    }

    fn ends_program(&self, command: &str) -> bool {
        command.split_whitespace().any(|word| word == "end")
    }
}
