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

/// Most parts of a program. A controller that knows programs by numbers has them from 101 to 999.
pub(crate) const MOST_PARTS: u32 = 899;

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

/// The lines of a path, on their way into parts.
pub(crate) struct Cutter<'a> {
    layout: &'a Layout,
    /// The name of the main program's text.
    program: &'a str,
    /// How its file and those of its parts are compressed.
    compression: Compression,
    most: Amount,
    /// The lines that call the parts so far.
    calls: String,
    number: u32,
}

impl<'a> Cutter<'a> {
    /// Cuts the lines of the program whose file is `file` into parts of this size at the most.
    pub(crate) fn new(layout: &'a Layout, file: &'a str, most: Amount) -> Self {
        Self {
            layout,
            program: text_name(file),
            compression: Compression::of_file(Path::new(file)),
            most,
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
            let [before, behind] = self.frame(&name, &around);
            part.write_all(before.as_bytes()).map_err(failed)?;
            let mut size = TextSize::of(before.as_bytes()).and(TextSize::of(behind.as_bytes()));
            let mut is_first = true;
            while !line.is_empty() {
                size = size.and(TextSize::of(&line));
                if !is_first && !self.most.holds(size) {
                    break;
                }
                is_first = false;
                part.write_all(&line).map_err(failed)?;
                line.clear();
                lines.read_until(b'\n', &mut line).map_err(failed)?;
            }
            part.write_all(behind.as_bytes()).map_err(failed)?;
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
        if self.number > MOST_PARTS {
            return Err(ProgramError::ManyParts { most: MOST_PARTS });
        }
        let name = PartName::of(self.program, self.number);
        let lines = self.layout.post.dialect.part_lines(&name);
        Ok((name, lines.ok_or(ProgramError::NoCalls)?))
    }

    /// What a part has before and behind its lines.
    fn frame(&self, name: &PartName, around: &PartLines) -> [String; 2] {
        let comment = self.layout.post.comment;
        let program = crate::template::plain_text(self.program);
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
}
