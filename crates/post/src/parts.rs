//! A program of several files: a main program, which calls the parts of its path one after the other.
//!
//! The parts have the lines of the path as one file would have them, cut between two lines. Positions,
//! velocities and modes go on from part to part as from line to line, so a join changes nothing of
//! the path. What stands around the lines of a part, and how the main program calls it, is the dialect's.

use std::io::{BufRead, Write};
use std::path::Path;

use turnpath_files::FileError;

use crate::amount::{Amount, TextSize};
use crate::compression::{Compression, text_name};
use crate::layout::Layout;
use crate::part_name::{PartLines, PartName};
use crate::program_error::ProgramError;
use crate::program_format::{end_of_part_mark, part_mark, parts_mark};
use crate::text_file::TextFile;

/// Why a program could not be divided into parts.
#[derive(Debug, thiserror::Error)]
pub enum PartsError {
    /// A part could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// There would be too many, or the dialect has no call.
    #[error(transparent)]
    Program(#[from] ProgramError),
}

/// How large the files of a program may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartLimits {
    /// The size at which a part ends. A line that is larger makes a larger part.
    pub part: Amount,
    /// The largest file that the controller takes; `None` for any.
    pub memory: Option<Amount>,
}

impl PartLimits {
    /// The largest part whose lines are as long as those of a text of this size, with `around` around them.
    pub fn largest_part(&self, lines: TextSize, around: TextSize) -> TextSize {
        let scaled = |room: u64, of: u64, by: u64| {
            let scaled = room as f64 * of as f64 / by.max(1) as f64;
            scaled.ceil() as u64
        };
        match self.part {
            Amount::Bytes(bytes) => TextSize {
                bytes,
                blocks: around.blocks
                    + scaled(
                        bytes.saturating_sub(around.bytes),
                        lines.blocks,
                        lines.bytes,
                    )
                    .max(1),
            },
            Amount::Blocks(blocks) => {
                let room = blocks.saturating_sub(around.blocks).max(1);
                TextSize {
                    bytes: around.bytes + scaled(room, lines.bytes, lines.blocks),
                    blocks,
                }
            }
        }
    }

    /// Refuses a file of this size that the controller does not take.
    ///
    /// # Errors
    /// When it is larger than the memory.
    pub fn refuse_large(&self, file: &str, size: TextSize) -> Result<(), ProgramError> {
        match self.memory.filter(|most| !most.holds(size)) {
            None => Ok(()),
            Some(most) => Err(ProgramError::Large {
                file: file.to_owned(),
                size: most.said(size),
                most: most.to_string(),
            }),
        }
    }
}

/// The lines of a path, on their way into parts.
pub(crate) struct Cutter<'a> {
    layout: &'a Layout,
    /// The name of the main program's text.
    program: &'a str,
    /// How its file and those of its parts are compressed.
    compression: Compression,
    limits: PartLimits,
    /// The lines that call the parts so far.
    calls: String,
    number: u32,
}

impl<'a> Cutter<'a> {
    /// Cuts the lines of the program whose file is `file` into parts of this size at the most.
    pub(crate) fn new(layout: &'a Layout, file: &'a str, limits: PartLimits) -> Self {
        Self {
            layout,
            program: text_name(file),
            compression: Compression::of_file(Path::new(file)),
            limits,
            calls: String::new(),
            number: 0,
        }
    }

    /// Writes the lines into the parts whose files `begin` begins by their names. Gives the files, and the
    /// lines with which the main program calls them.
    pub(crate) fn cut<W: Write>(
        mut self,
        lines: &mut dyn BufRead,
        begin: &mut dyn FnMut(&str) -> Result<W, FileError>,
    ) -> Result<(Vec<W>, Vec<u8>), PartsError> {
        let mut parts = Vec::new();
        let mut line = Vec::new();
        let failed = |error| FileError::of(Path::new(self.program))(error);
        lines.read_until(b'\n', &mut line).map_err(failed)?;
        while !line.is_empty() {
            let (name, around) = self.next()?;
            let file = self.compression.file_of(&name.file);
            let failed = |error| FileError::of(Path::new(&file))(error);
            let mut part = TextFile::begin(self.compression, begin(&file)?).map_err(failed)?;
            let [before, behind] = frame(self.layout, self.program, &name, &around);
            part.write_all(before.as_bytes()).map_err(failed)?;
            let mut size = TextSize::of(before.as_bytes()).and(TextSize::of(behind.as_bytes()));
            let mut is_first = true;
            while !line.is_empty() {
                let larger = size.and(TextSize::of(&line));
                if !is_first && !self.limits.part.holds(larger) {
                    break;
                }
                size = larger;
                is_first = false;
                part.write_all(&line).map_err(failed)?;
                line.clear();
                lines.read_until(b'\n', &mut line).map_err(failed)?;
            }
            part.write_all(behind.as_bytes()).map_err(failed)?;
            self.limits.refuse_large(&name.file, size)?;
            parts.push(part.whole().map_err(failed)?);
            self.calls.push_str(&around.call);
            self.calls.push('\n');
        }
        let comment = self.layout.post.comment;
        let calls = format!("{comment} {}\n{}", parts_mark(self.number), self.calls);
        Ok((parts, calls.into_bytes()))
    }

    /// The next part, and what stands around its lines.
    fn next(&mut self) -> Result<(PartName, PartLines), ProgramError> {
        self.number += 1;
        let numbers = &self.layout.format.part_numbers;
        let most = numbers.most();
        if self.number > most {
            return Err(ProgramError::ManyParts { most });
        }
        let name = PartName::of(self.program, self.number, numbers);
        let lines = self.layout.post.dialect.part_lines(&name);
        Ok((name, lines.ok_or(ProgramError::NoCalls)?))
    }
}

/// What a part has before and behind its lines.
fn frame(layout: &Layout, program: &str, name: &PartName, around: &PartLines) -> [String; 2] {
    let comment = layout.post.comment;
    let program = crate::template::plain_text(program);
    let number = name.number;
    [
        format!(
            "{comment} part {number} of {program}: to be called by it\n{}{comment} {}\n",
            around.begin,
            part_mark(number)
        ),
        format!("{comment} {}\n{}", end_of_part_mark(number), around.end),
    ]
}

impl Layout {
    /// The size of what stands around the lines of the last of `parts` parts of the program `file`, and that of
    /// the lines that call them all. `None` where the dialect has no calls.
    pub fn size_around_parts(&self, file: &str, parts: u32) -> Option<[TextSize; 2]> {
        let program = text_name(file);
        let name = PartName::of(program, parts.max(1), &self.format.part_numbers);
        let lines = self.post.dialect.part_lines(&name)?;
        let around = frame(self, program, &name, &lines).concat();
        let call = TextSize::of(format!("{}\n", lines.call).as_bytes());
        let calls = TextSize {
            bytes: call.bytes * u64::from(parts),
            blocks: call.blocks * u64::from(parts),
        };
        let mark = format!("{} {}\n", self.post.comment, parts_mark(parts));
        let calls = calls.and(TextSize::of(mark.as_bytes()));
        Some([TextSize::of(around.as_bytes()), calls])
    }
}
