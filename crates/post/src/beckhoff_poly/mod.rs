//! Motion programs for Beckhoff TwinCAT CNC with polynomials of axes.
//!
//! ```text
//! ; -- cutting --
//! G40 G52 G71 G90 G93 G359
//! G1 C0 X2.5 Z1.5 F1
//! G0 W0
//! #FGROUP [W]
//! G94 G1 W0.03 C[POLY A0=0 A1=9] X[POLY A0=2.5 A1=-0.0006011] Z[POLY A0=1.5 A1=0.15 A2=0.0023 A3=-0.0001] F600
//! W0.06 C[POLY A0=9 A1=9] X[POLY A0=2.4993989 A1=-0.0006011] Z[POLY A0=1.6522 …]
//! …
//! #FGROUP
//! ; -- end of path: 4160 points --
//! ```
//!
//! `X[POLY A0=… A1=… A2=… A3=…]` is the polynomial A0 + A1 s + A2 s² + A3 s³ on s = 0 … 1, for one block.
//! s grows in step with the way of the block, so another axis must move in it. That is the axis of time, W: a
//! simulated linear axis whose position is the time since the beginning of the path, times its speed. All
//! blocks have the same speed, so nothing accelerates between them, and C, X and Z play the cubics that PVT
//! would play, in their times. `#FGROUP [W]` makes F the feed of W alone.
//!
//! A coefficient has twelve decimals. A1 is what makes the sum of all four the end of the segment, which is the
//! A0 of the next one, exactly.
//!
//! Facts on the language: Beckhoff, TF5200 Programming manual, "Programming an axis polynomial (POLY)",
//! "Definition of feed axes (#FGROUP)", "Machining time or feedrate (G93/G94/G95/G194)", "Axis-specific
//! programming", and those of [`beckhoff`]; the page on POLY is in the manual of ISG's kernel too. The text of
//! that page was read, and not the line with its syntax. That a keyword and its number have `=` between them, and
//! stand apart by blanks, is so in the other commands of axes in that manual, such as
//! `Z[OSC ON 1ST_POS=10 2ND_POS=20 FEED=1.00]`.

mod block;
mod read;
#[cfg(test)]
mod tests;
mod write;

use read::PolyGrammar;
use write::{push_first, push_segment};

use turnpath_core::toolpath::SegmentShape;

use crate::beckhoff;
use crate::digits::{DigitSegment, Digits};
use crate::part_name::{PartLines, PartName, PartNumbers};
use crate::post::{Command, Dialect, Grammar, Post};
use crate::program_error::ProgramError;
use crate::program_format::{FeedMeaning, ProgramFormat};
use crate::settings::{
    C_SIGN, FOOTER, HEADER, MEMORY, POSITION_DECIMALS, SEGMENTS_PER_SECOND, SHORTEST_SEGMENT,
    SPLIT, TIME_AXIS, TIME_AXIS_LIMIT, TIME_AXIS_SPEED, TWINCAT_C_LIMIT,
};
use crate::travel::{Places, Travel, TravelModes};

/// Programs for TwinCAT CNC with polynomials.
pub(crate) const BECKHOFF_POLY: Post = Post {
    name: "beckhoff-poly",
    table: "output.beckhoff-poly",
    extension: "ncp",
    summary: "the layout of the programs of the post `beckhoff-poly`",
    comment: ";",
    keys: &[
        POSITION_DECIMALS.info(),
        TIME_AXIS.info(),
        TIME_AXIS_SPEED.info(),
        TIME_AXIS_LIMIT.info(),
        C_SIGN.info(),
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
; turnpath {turnpath}, post beckhoff-poly: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, X a radius, Z of the {z_reference}; C in deg, {c_range}
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; time: {time_axis}: a simulated linear axis of the channel, with a high acceleration
; the channel must keep its digits: {increments} increments of a mm and of a deg
; the path begins and ends {ends}
; verified on this text: {verified}
",
    footer: "M30\n",
    shape: SegmentShape::Cubic,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: Some(4),
    dialect: &BeckhoffPoly,
};

/// Lines with polynomials of axes.
#[derive(Debug)]
struct BeckhoffPoly;

/// F is the feed of the controller's own setting again.
const DEFAULT_FEED_AXES: &[u8] = b"#FGROUP\n";
/// The command that a reader knows for it.
const FEED_AXES: &str = "#FGROUP";

impl Dialect for BeckhoffPoly {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_segment(text, format, segment);
    }

    /// The axis of time goes no farther than the controller's numbers.
    fn check_time(
        &self,
        format: &ProgramFormat,
        segment: &DigitSegment,
    ) -> Result<(), ProgramError> {
        let Some(axis) = format.time_axis else {
            return Ok(());
        };
        let speed = i128::from(axis.speed_um_per_s);
        let way = i128::from(segment.to.steps) * speed;
        if way <= i128::from(axis.limit_um) * i128::from(format.steps_per_s) {
            return Ok(());
        }
        Err(ProgramError::BeyondTimeAxis {
            axis: axis.name,
            way: way as f64 / format.steps_per_s as f64 / 1e3,
            limit: axis.limit_um as f64 / 1e3,
            t: segment.end(format).0,
        })
    }

    fn write_last(&self, text: &mut Vec<u8>, _format: &ProgramFormat) {
        text.extend_from_slice(DEFAULT_FEED_AXES);
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(PolyGrammar::new(format))
    }

    /// A program that did not come to its end has left F to the axis of time.
    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        if travel == Travel::Begin {
            text.extend_from_slice(DEFAULT_FEED_AXES);
        }
        beckhoff::TRAVEL.push(text, format, travel);
    }

    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        if block::feed_axes(code).is_some_and(|axes| axes.is_empty()) {
            modes.say(FEED_AXES);
            return Ok(Places::default());
        }
        let places = beckhoff::TRAVEL.read(code, modes)?;
        match places == Places::default() {
            true => Ok(places),
            false => modes.need(&[FEED_AXES]).map(|()| places),
        }
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
