//! The post for the machines of Moore Nanotechnology Systems (350, 450 and 650 FG).
//!
//! The words of the header and the digits are those of programs that such machines have run. What F
//! means is not known from a manual: it is a key of the table, and `1/min` is what `G93` means where
//! RS274 is followed.

use turnpath_core::toolpath::SegmentShape;

use super::depth_lines::depth_lines;
use super::depth_loop::WhileLoop;
use super::read::{LineGrammar, Words};
use super::write::{push_first, push_line};
use crate::digits::{DigitSegment, Digits};
use crate::g_code::{commands, ends_program};
use crate::post::{Command, DepthLoop, Dialect, Grammar, Post};
use crate::program_format::{Depths, FeedMeaning, ProgramFormat};
use crate::settings::{
    C_LIMIT, C_SIGN, C_WITHIN_TURN, CHORD_SHARE, DEPTH_STEP, DEPTHS, FEED_MEANING, FOOTER, HEADER,
    MEMORY, SEGMENTS_PER_SECOND, SHORTEST_SEGMENT, SIX_DECIMALS,
};

/// Programs for Moore Nanotech machines.
pub(crate) const NANOTECH_G93: Post = Post {
    name: "nanotech-g93",
    table: "output.nanotech-g93",
    extension: "nc",
    summary: "the layout of the programs of the post `nanotech-g93`",
    comment: ";",
    keys: &[
        SIX_DECIMALS.info(),
        CHORD_SHARE.info(),
        FEED_MEANING.info(),
        C_SIGN.info(),
        C_WITHIN_TURN.info(),
        DEPTHS.info(),
        DEPTH_STEP.info(),
        SHORTEST_SEGMENT.info(),
        SEGMENTS_PER_SECOND.info(),
        MEMORY.info(),
        C_LIMIT.info(),
        HEADER.info(),
        FOOTER.info(),
    ],
    header: "\
; {name}
; recipe {recipe}, SHA-256 {sha256}
; changed by --set: {changes}
; turnpath {turnpath}, post nanotech-g93: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; F in {f_means}: G93
; X: {axis_x}
; Z: {axis_z}
; C: {axis_c}
; the path begins and ends {ends}
; verified on this text: {verified}
G52 G63 G71 G103 G40 G18 G90
G54
T0202
",
    footer: "M30\n",
    shape: SegmentShape::Linear,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: None,
    dialect: &Nanotech,
};

/// Lines for Moore Nanotech machines.
#[derive(Debug)]
struct Nanotech;

const MODES: &str = "G90 G93";
/// Words that move nothing: the modes of the header and of the path, one work coordinate and one tool,
/// and the ends of programs.
const HARMLESS: &[&str] = &[
    "G52", "G63", "G71", "G103", "G40", "G18", "G90", "G93", "G54", "T0202", "M2", "M30",
];
/// Numbers of words with M that end a program.
const ENDS: &[u32] = &[2, 30];
/// The words of a path.
const WORDS: Words = Words {
    needed: &["G90", "G93"],
    allowed: &["G18", "G40", "G63", "G71"],
    dwells: false,
    numbers_have_blanks: false,
};

impl Dialect for Nanotech {
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits) {
        push_first(text, format, MODES, point);
    }

    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment) {
        push_line(text, format, segment);
    }

    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar> {
        Box::new(LineGrammar::new(format, WORDS))
    }

    fn depth_lines(&self, format: &ProgramFormat, depths: &Depths) -> Option<[String; 2]> {
        Some(depth_lines(format, depths))
    }

    fn depth_loop(&self) -> Option<Box<dyn DepthLoop>> {
        Some(Box::new(WhileLoop::default()))
    }

    fn commands(&self, template: &str) -> Vec<Command> {
        commands(template, HARMLESS)
    }

    fn ends_program(&self, command: &str) -> bool {
        ends_program(command, ENDS)
    }
}
