//! A post: the data of a dialect of motion programs, and the small trait of what is no data.

use std::fmt::Debug;

use turnpath_core::toolpath::{ControlPoint, SegmentShape};
use turnpath_core::{ParamDefault, ParamInfo, Params};

use crate::comment::code_before_comment;
use crate::digit_segments::DigitSegments;
use crate::digits::{DigitSegment, Digits};
use crate::g_code;
use crate::part_name::{PartLines, PartName, PartNames, PartNumbers};
use crate::program_error::ProgramError;
use crate::program_format::{Depths, FeedMeaning, ProgramFormat};
use crate::travel::{Places, Travel, TravelModes};

/// A dialect of motion programs.
#[derive(Debug, Clone, Copy)]
pub struct Post {
    /// Its name in recipes.
    pub name: &'static str,
    /// The recipe's table with its settings, `output.` and the name.
    pub table: &'static str,
    /// What the names of its files end with. No two posts have the same.
    pub extension: &'static str,
    /// One line that says what its table is about.
    pub summary: &'static str,
    /// What begins a comment that reaches to the end of the line.
    pub comment: &'static str,
    /// The keys of its table.
    pub keys: &'static [ParamInfo],
    /// The template of what stands before the path.
    pub header: &'static str,
    /// The template of what stands after the path.
    pub footer: &'static str,
    /// What its controller plays between two points: cubics, or straight lines that stand for them.
    pub shape: SegmentShape,
    /// What F says of a straight line, where its table has no key for it.
    pub feed: FeedMeaning,
    /// Steps of time in a second.
    pub steps_per_s: i64,
    /// The longest segment, in steps. A longer one is divided.
    pub longest: i64,
    /// Bits of the size of a number that the controller holds, where it holds less than a double.
    pub mantissa_bits: Option<u32>,
    /// Whether the controller keeps the speed of C within a segment, and lets X and Z follow C. The curve
    /// is then the path's, and the speeds step at control points.
    pub c_is_even: bool,
    /// Decimals of positions that the controller keeps as it is delivered, where it rounds positions to
    /// them whatever the program has.
    pub delivered_decimals: Option<u32>,
    /// How it writes and reads lines.
    pub dialect: &'static dyn Dialect,
}

impl Post {
    /// The first key that its table must have and that `settings` has no value of: what no default can
    /// know of a machine.
    pub fn undecided(&self, settings: &Params) -> Option<&'static ParamInfo> {
        let has = |key: &ParamInfo| settings.iter().any(|(name, _)| name == key.name);
        let is_missing = |key: &&ParamInfo| key.default == ParamDefault::Required && !has(key);
        self.keys.iter().find(is_missing)
    }
}

/// How a dialect writes the lines of a path, and how it reads them. Writer and reader share no code.
pub trait Dialect: Debug + Send + Sync {
    /// Writes the lines that bring the axes to the first control point. They are no part of the path.
    fn write_first(&self, text: &mut Vec<u8>, format: &ProgramFormat, point: &Digits);

    /// Writes the lines of a segment.
    fn write_segment(&self, text: &mut Vec<u8>, format: &ProgramFormat, segment: &DigitSegment);

    /// Writes the lines of segments in a row, each of them in its time as [`Dialect::check_time`] proves.
    ///
    /// # Errors
    /// When the controller takes another time for one of them. Some lines are then missing.
    fn write_segments(
        &self,
        text: &mut Vec<u8>,
        format: &ProgramFormat,
        segments: &DigitSegments<'_>,
    ) -> Result<(), ProgramError> {
        for segment in segments.segments() {
            self.check_time(format, &segment)?;
            self.write_segment(text, format, &segment);
        }
        Ok(())
    }

    /// Proves that the controller plays a segment in its time.
    ///
    /// # Errors
    /// When it takes another time for it.
    fn check_time(
        &self,
        _format: &ProgramFormat,
        _segment: &DigitSegment,
    ) -> Result<(), ProgramError> {
        Ok(())
    }

    /// Writes the lines behind the last segment, before the end mark.
    fn write_last(&self, _text: &mut Vec<u8>, _format: &ProgramFormat) {}

    /// A reader of lines, at the beginning of a program.
    fn grammar(&self, format: &ProgramFormat) -> Box<dyn Grammar>;

    /// The commands of a template, line by line. Comments and empty lines are none.
    fn commands(&self, template: &str) -> Vec<Command>;

    /// Writes a statement before or after the path. Unless a dialect says otherwise, these are words of
    /// G code.
    fn write_travel(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        g_code::push_travel(text, format, "", travel);
    }

    /// Reads a line before or after the path: the places that it gives to the axes.
    ///
    /// # Errors
    /// When the line is not of the dialect: what is wrong with it.
    fn read_travel(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        g_code::read_spaced_travel(code, modes)
    }

    /// The lines with which the controller begins and ends a loop that plays what is between them once for
    /// each depth. `None` where turnpath knows no such loop.
    fn depth_lines(&self, _format: &ProgramFormat, _depths: &Depths) -> Option<[String; 2]> {
        None
    }

    /// A reader of such lines.
    fn depth_loop(&self) -> Option<Box<dyn DepthLoop>> {
        None
    }

    /// The template of the header that these settings ask for in place of the post's own, if they do,
    /// behind the name of the key that asks.
    fn other_header(&self, _settings: &Params) -> Option<(&'static str, &'static str)> {
        None
    }

    /// What stands around the lines of a part of a program, and how the main program calls it. `None`
    /// where no document says how the controller does that.
    fn part_lines(&self, _part: &PartName) -> Option<PartLines> {
        None
    }

    /// The lines of code that a reader finds before those of a part and behind them, in capitals and without
    /// blanks. Nothing else stands there.
    fn part_frame(&self, _part: &PartName) -> [Vec<String>; 2] {
        [Vec::new(), Vec::new()]
    }

    /// The file of the part that a line of the main program calls, if it calls one. `main` is the main
    /// program's own file, with the numbers of its parts.
    fn called_part(&self, _code: &str, _main: (&str, &PartNumbers)) -> Option<String> {
        None
    }

    /// Which names the controller takes for parts.
    fn part_names(&self) -> PartNames {
        PartNames::Free
    }

    /// Whether the controller calls a part by a number, and not by a name.
    fn calls_by_number(&self) -> bool {
        false
    }

    /// Whether the path's lines go into a program after a header. Where a file is a program as it is,
    /// they always do.
    fn leaves_program_open(&self, _header: &str) -> bool {
        true
    }

    /// Whether a command ends the program in which it stands, or halts it: in a header, the path then
    /// does not run.
    fn ends_program(&self, command: &str) -> bool;
}

/// Reads the lines of a program in their order.
pub trait Grammar: Send + Sync {
    /// The code of a line, before any comment, and the comment, if there is one.
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>);

    /// Reads a line's code, and appends the control points that are known with it. A point may wait for
    /// the line behind it.
    ///
    /// # Errors
    /// When the line is not of the dialect: what is wrong with it.
    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String>;

    /// Reads the lines with which a text begins, up to its next control point, where they are written as nearly
    /// all lines of a path are. `None` where they are not, or where the text ends before: nothing has changed
    /// then, and [`Grammar::read`] takes them one by one.
    fn read_plain(&mut self, _text: &[u8]) -> Option<PlainLines> {
        None
    }

    /// Whether a point waits for the line behind it: the first of those that are known next.
    fn holds_point(&self) -> bool {
        false
    }

    /// The control point that waits for a line behind it, at the end of the path.
    fn finish(&mut self) -> Option<ControlPoint> {
        None
    }
}

/// The lines of a control point, written as nearly all lines of a path are.
#[derive(Debug, Clone, Copy)]
pub struct PlainLines {
    /// The point.
    pub point: ControlPoint,
    /// The bytes of its lines, with their ends.
    pub bytes: usize,
    /// How many lines they are.
    pub lines: usize,
}

/// Reads the lines with which a controller begins and ends a loop over depths.
pub trait DepthLoop: Send + Sync {
    /// Reads a line's code: one before the approach, or one behind the retreat if `ends`.
    ///
    /// # Errors
    /// When it is no line of such a loop: what is wrong with it.
    fn read(&mut self, code: &str, ends: bool) -> Result<(), String>;

    /// The places of Z's zero each time that the path is played, in 10⁻¹² mm.
    ///
    /// # Errors
    /// When the lines are no loop that ends: what is wrong.
    fn shifts(&self) -> Result<Vec<i128>, String>;
}

/// A line of a header or a footer that is more than a comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Command {
    /// The line in its template, from 1.
    pub line: usize,
    /// The line without its comment; placeholders stand as the template has them.
    pub text: String,
    /// Whether all of its words are known to move nothing, set nothing and start nothing.
    pub harmless: bool,
}

impl Command {
    /// Whether two commands are the same but for the numbers of their blocks, blanks and small letters. Within
    /// quotes and in the call of a function these count.
    pub fn is_same_as(&self, other: &Self) -> bool {
        let is_plain = |command: &Self| !command.text.contains(['"', '(']);
        let plain = |command: &Self| -> String {
            let code = behind_number(&command.text).split_whitespace();
            code.collect::<String>().to_ascii_uppercase()
        };
        self.text == other.text
            || (is_plain(self) && is_plain(other) && plain(self) == plain(other))
    }
}

/// What stands behind the number of a block, `N10`, which need not be there.
pub(crate) fn behind_number(code: &str) -> &str {
    let code = code.trim_start();
    let digits = |rest: &&str| rest.starts_with(|c: char| c.is_ascii_digit());
    match code.strip_prefix(['N', 'n']).filter(digits) {
        Some(numbered) => numbered.trim_start_matches(|c: char| c.is_ascii_digit()),
        None => code,
    }
}

/// The commands of a template: its lines without their comments, which begin with one of `comments`.
/// Each is judged by itself.
pub(crate) fn commands_of(
    template: &str,
    comments: &[&str],
    is_harmless: impl Fn(&str) -> bool,
) -> Vec<Command> {
    let lines = template.lines().zip(1..);
    // A controller may end a line at such a character, and a comment with it.
    let ends_line = |c: char| c.is_control() && c != '\t';
    let pieces =
        lines.flat_map(|(text, line)| text.split(ends_line).map(move |piece| (piece, line)));
    let commands = pieces.filter_map(|(line_text, line)| {
        let code = code_before_comment(line_text, comments).trim();
        (!code.is_empty()).then(|| Command {
            line,
            text: code.to_owned(),
            harmless: is_harmless(code),
        })
    });
    commands.collect()
}
