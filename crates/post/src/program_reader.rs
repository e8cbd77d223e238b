//! Reads a motion program back into control points, whatever its dialect. An error names the line.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::{ControlPoint, Section};

use crate::path_reader::{ReadCount, ReadPath};
use crate::post::Grammar;
use crate::program_format::{END_MARK, mark};
use crate::read_error::ReadError;
use crate::turn::check_turn;

/// Longest line that is read, bytes: far longer than any line of a program, so that a file that is no
/// program does not fill the memory.
const LONGEST_LINE: u64 = 1 << 16;
/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;

/// Reads a program's path point by point, from a file or from any other [`Read`].
pub struct ProgramReader<R = File> {
    lines: BufReader<R>,
    path: PathBuf,
    grammar: Box<dyn Grammar>,
    /// What begins a comment, for messages.
    comment: &'static str,
    line: u64,
    section: Option<Section>,
    ended: bool,
    read_count: ReadCount,
}

impl<R: Read> ProgramReader<R> {
    pub(crate) fn new(
        reader: R,
        path: PathBuf,
        grammar: Box<dyn Grammar>,
        comment: &'static str,
    ) -> Self {
        Self {
            lines: BufReader::with_capacity(BUFFER, reader),
            path,
            grammar,
            comment,
            line: 0,
            section: None,
            ended: false,
            read_count: ReadCount::default(),
        }
    }

    /// Errors name this file instead of the one that is read.
    pub fn named(self, path: impl AsRef<Path>) -> Self {
        Self {
            path: path.as_ref().to_owned(),
            ..self
        }
    }

    fn wrong(&self, what: String) -> ReadError {
        ReadError::Line {
            path: self.path.clone(),
            line: self.line.max(1),
            what,
        }
    }

    /// Reads the next line into `text`; `false` at the end of the file.
    fn read_line(&mut self, text: &mut Vec<u8>) -> Result<bool, ReadError> {
        text.clear();
        let mut limited = (&mut self.lines).take(LONGEST_LINE);
        let read = limited.read_until(b'\n', text);
        let read = read.map_err(|error| ReadError::File {
            path: self.path.clone(),
            error,
        })?;
        self.line += u64::from(read > 0);
        if read as u64 == LONGEST_LINE {
            return Err(self.wrong("this line is longer than any line of a program".to_owned()));
        }
        Ok(read > 0)
    }

    /// The error of a file that ends too early.
    fn incomplete(&self) -> ReadError {
        let comment = self.comment;
        self.wrong(match self.section {
            None => format!(
                "there is no path: the line `{comment} {}` is missing",
                mark(Section::Cutting)
            ),
            Some(_) => format!(
                "the program ends without the line `{comment} {END_MARK} --`: it is not complete"
            ),
        })
    }

    /// Reads a comment, which may be a mark.
    fn read_comment(&mut self, said: &[u8]) -> Result<(), String> {
        let text = String::from_utf8_lossy(said).trim().to_ascii_lowercase();
        if !text.starts_with("--") {
            return Ok(());
        }
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        if let Some(section) = sections.into_iter().find(|section| text == mark(*section)) {
            if self.section.is_some_and(|last| section <= last) {
                return Err(format!(
                    "`{} {text}` is out of order: the sections are lead-in, cutting, lead-out",
                    self.comment
                ));
            }
            self.section = Some(section);
        } else if self.section.is_some() && text.starts_with(END_MARK) {
            self.ended = true;
            let digits: String = text.chars().filter(char::is_ascii_digit).collect();
            let points: u64 = digits
                .parse()
                .map_err(|_| "the end mark must give the number of points".to_owned())?;
            if points != self.read_count.points() {
                let count = self.read_count.points();
                return Err(format!(
                    "the path has {count} points, but its end mark says {points}"
                ));
            }
        }
        Ok(())
    }

    /// The point that a line of the path moves to, if it moves.
    fn read_code(&mut self, code: &[u8]) -> Result<Option<ControlPoint>, String> {
        let code = std::str::from_utf8(code).map_err(|_| "this is not text".to_owned())?;
        self.grammar.read(code)
    }
}

impl<R: Read> ReadPath for ProgramReader<R> {
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut text = Vec::new();
        while !self.ended {
            if !self.read_line(&mut text)? {
                return Err(self.incomplete());
            }
            let (code, comment) = self.grammar.split_comment(&text);
            if let Some(comment) = comment {
                self.read_comment(comment)
                    .map_err(|what| self.wrong(what))?;
            }
            // The lines before the path belong to the header.
            let Some(section) = self.section else {
                continue;
            };
            let point = self.read_code(code).map_err(|what| self.wrong(what))?;
            if let Some(point) = point {
                check_turn(self.read_count.last(), &point, section)
                    .map_err(|what| self.wrong(what))?;
                self.read_count.add(point, section);
                return Ok(Some((point, section)));
            }
        }
        Ok(None)
    }

    fn read_count(&self) -> &ReadCount {
        &self.read_count
    }

    fn read_count_mut(&mut self) -> &mut ReadCount {
        &mut self.read_count
    }
}
