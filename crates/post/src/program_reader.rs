//! Reads a motion program back into control points, whatever its dialect. An error names the line.

use std::collections::VecDeque;
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use turnpath_core::tally::LINES_READ;
use turnpath_core::toolpath::{ControlPoint, Section, SegmentShape};

use crate::compression::{Compression, text_name};
use crate::depth_check::DepthCheck;
use crate::forward_rates::ForwardRates;
use crate::lines::{LineReader, refuse_control_characters, refuse_other_blanks};
use crate::part_calls::{OpenPart, PartCalls};
use crate::part_name::PartName;
use crate::path_mark::PathMark;
use crate::path_reader::{ReadCount, ReadPath};
use crate::post::{Grammar, Post};
use crate::program_format::{END_MARK, ProgramFormat, mark};
use crate::read_error::ReadError;
use crate::travel_check::TravelCheck;
use crate::turn::{check_turn, check_velocities};

/// Longest line that is read, bytes: far longer than any line of a program, so that a file that is no
/// program does not fill the memory.
const LONGEST_LINE: usize = 1 << 16;
/// Most text without a point of the path, bytes: far more than any header or footer, so that a small file
/// that decompresses to very much is not read for hours.
const MOST_WITHOUT_POINT: u64 = 1 << 23;

/// Reads a program's path point by point, from a file or from any other [`Read`].
pub struct ProgramReader<R = File> {
    lines: LineReader<R>,
    path: PathBuf,
    post: &'static Post,
    format: ProgramFormat,
    grammar: Box<dyn Grammar>,
    line: u64,
    /// Lines of all files that were read.
    lines_read: usize,
    place: Place,
    section: Option<Section>,
    /// The moves before and after the path.
    travel: TravelCheck,
    /// The loop around it.
    depths: DepthCheck,
    /// The points that the end mark says, after it was read.
    said_points: Option<u64>,
    /// The points that are found on the line that is read: their memory is used again.
    found: Vec<ControlPoint>,
    /// Points that were read and not given yet.
    waiting: VecDeque<(ControlPoint, Section)>,
    /// The last point that was read from a line.
    last: Option<(ControlPoint, Section)>,
    /// Points that were read from lines.
    found_points: u64,
    /// Bytes that were read since the last point.
    bytes_without_point: u64,
    /// What gives points their velocities, where the program has none.
    rates: Option<ForwardRates>,
    /// The section of the point that the grammar holds back until it has read the line behind it.
    held: Option<Section>,
    parts: PartCalls<R>,
    read_count: ReadCount,
}

/// Where in a program the reader is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Header,
    Depths,
    Approach,
    Path,
    Retreat,
    EndOfDepths,
    Footer,
}

impl<R: Read> ProgramReader<R> {
    pub(crate) fn new(
        reader: R,
        path: PathBuf,
        post: &'static Post,
        format: &ProgramFormat,
    ) -> Self {
        let has_rates = post.shape == SegmentShape::Linear;
        Self {
            lines: LineReader::new(reader),
            path,
            post,
            format: *format,
            grammar: post.dialect.grammar(format),
            line: 0,
            lines_read: 0,
            place: Place::Header,
            section: None,
            travel: TravelCheck::default(),
            depths: DepthCheck::new(post.dialect),
            said_points: None,
            found: Vec::new(),
            waiting: VecDeque::new(),
            last: None,
            found_points: 0,
            bytes_without_point: 0,
            rates: has_rates.then(ForwardRates::default),
            held: None,
            parts: PartCalls::default(),
            read_count: ReadCount::default(),
        }
    }

    /// The same with the parts that the program may call.
    pub(crate) fn with_parts(self, open: OpenPart<R>) -> Self {
        Self {
            parts: PartCalls::new(open),
            ..self
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
            what: self.parts.or_part_alone(what),
        }
    }

    /// Where the next line is in the buffer of the lines; `None` at the end of the file.
    fn next_line(&mut self) -> Result<Option<Range<usize>>, ReadError> {
        let line = self.lines.next_line(LONGEST_LINE);
        let Some(line) = line.map_err(|error| ReadError::of(&self.path)(error))? else {
            return Ok(None);
        };
        self.line += 1;
        self.lines_read += 1;
        if line.len() >= LONGEST_LINE {
            return Err(self.wrong("this line is longer than any line of a program".to_owned()));
        }
        self.bytes_without_point += line.len() as u64;
        if self.bytes_without_point > MOST_WITHOUT_POINT {
            return Err(self.much_without_point());
        }
        Ok(Some(line))
    }

    /// Reads lines to the end of their text. None of them is a mark of the path, and each has its end: so they
    /// leave the reader as it was.
    pub(crate) fn pass_header(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.next_line()? {
            let buffer = self.lines.lend();
            let passed = self.pass_header_line(&buffer[line]);
            self.lines.take_back(buffer);
            passed.map_err(|what| self.wrong(what))?;
        }
        Ok(())
    }

    fn pass_header_line(&mut self, line: &[u8]) -> Result<(), String> {
        refuse_control_characters(line)?;
        let (_, comment) = self.grammar.split_comment(line);
        let is_mark = comment.map_or(Ok(false), |comment| self.read_comment(comment));
        if is_mark? {
            return Err("a mark of the path stands in the header".to_owned());
        }
        match line.ends_with(b"\n") {
            true => Ok(()),
            false => Err("the header ends within a line".to_owned()),
        }
    }

    /// Reads on to the end of the file: a compressed one shows only there whether it is whole.
    pub(crate) fn pass_footer(&mut self) -> Result<(), ReadError> {
        let bytes = self.lines.pass_rest(MOST_WITHOUT_POINT);
        let bytes = bytes.map_err(|error| ReadError::of(&self.path)(error))?;
        match bytes < MOST_WITHOUT_POINT {
            true => Ok(()),
            false => Err(self.much_without_point()),
        }
    }

    fn much_without_point(&self) -> ReadError {
        let mib = MOST_WITHOUT_POINT >> 20;
        self.wrong(format!(
            "this is no program: there is no point of a path in {mib} MiB of text"
        ))
    }

    /// The error of a file that ends too early.
    fn incomplete(&self) -> ReadError {
        let comment = self.post.comment;
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

    /// Reads a comment, which may be a mark; says whether it is one.
    fn read_comment(&mut self, said: &[u8]) -> Result<bool, String> {
        let text = String::from_utf8_lossy(said).trim().to_ascii_lowercase();
        if !text.starts_with("--") {
            return Ok(false);
        }
        if self.parts.take_mark(&text)? {
            return Ok(true);
        }
        if self.parts.is_outside() {
            return Ok(false);
        }
        let is_before = matches!(self.place, Place::Header | Place::Approach);
        if is_before && self.parts.begin(&text) {
            self.place = Place::Path;
            return Ok(true);
        }
        match PathMark::of(&text) {
            Some(mark) => self.take_mark(mark, &text).map(|()| true),
            None => Ok(false),
        }
    }

    /// Goes on to what a mark begins, or ends the path.
    fn take_mark(&mut self, mark: PathMark, text: &str) -> Result<(), String> {
        match (mark, self.place) {
            (PathMark::Section(section), _) => self.begin_section(section, text),
            (PathMark::End { points }, _) => self.end_path(points),
            (PathMark::Depths, Place::Header) => {
                self.place = Place::Depths;
                self.depths.begin()
            }
            (PathMark::Approach, Place::Header | Place::Depths) => {
                self.place = Place::Approach;
                self.travel.begin_approach();
                Ok(())
            }
            (PathMark::Retreat, Place::Path) => {
                self.place = Place::Retreat;
                self.travel.begin_retreat(self.line)?;
                self.take_held_points();
                Ok(())
            }
            (PathMark::EndOfDepths, Place::Retreat) => {
                self.place = Place::EndOfDepths;
                self.depths.end()
            }
            _ => {
                let comment = self.post.comment;
                Err(format!(
                    "`{comment} {text}` is out of order: it is depths, approach, path, retreat, end of depths"
                ))
            }
        }
    }

    fn begin_section(&mut self, section: Section, text: &str) -> Result<(), String> {
        let is_late = matches!(self.place, Place::Retreat | Place::EndOfDepths);
        if is_late || self.section.is_some_and(|last| section <= last) {
            return Err(format!(
                "`{} {text}` is out of order: the sections are lead-in, cutting, lead-out",
                self.post.comment
            ));
        }
        self.section = Some(section);
        self.place = Place::Path;
        if section == Section::LeadIn {
            self.travel.begin_lead_in();
        }
        Ok(())
    }

    /// Ends the path, which has so many points as its end mark says. Before the first section there is none to end.
    fn end_path(&mut self, points: Option<u64>) -> Result<(), String> {
        if self.parts.caller.is_some() {
            return Err("the path ends within a part: the main program ends it".to_owned());
        }
        if self.section.is_none() {
            return Ok(());
        }
        self.said_points = Some(points.ok_or("the end mark must give the number of points")?);
        if self.place == Place::Path {
            self.take_held_points();
        }
        self.travel
            .check_retreat(self.section == Some(Section::LeadOut))?;
        self.place = Place::Footer;
        self.depths.finish(&self.format)
    }

    /// Takes the points that the grammar holds back until it knows the line behind them.
    fn take_held_points(&mut self) {
        let held = self.grammar.finish();
        self.wait(held);
    }

    /// Reads a line of the path.
    fn read_code(&mut self, code: &[u8]) -> Result<(), String> {
        let code = std::str::from_utf8(code).map_err(|_| "this is not text".to_owned())?;
        refuse_other_blanks(code)?;
        if matches!(self.place, Place::Depths | Place::EndOfDepths) {
            return self.depths.read(code.trim());
        }
        if matches!(self.place, Place::Approach | Place::Retreat) {
            let modes = &mut self.travel.modes;
            let places = self.post.dialect.read_travel(code.trim(), modes)?;
            return self.travel.go_to(&places, self.line, &self.format);
        }
        let mut points = std::mem::take(&mut self.found);
        points.clear();
        let read = self.grammar.read(code, &mut points);
        if read.is_ok() {
            self.wait(points.drain(..));
        }
        self.found = points;
        read?;
        if self.grammar.holds_point() {
            self.held = self.held.or(self.section);
        }
        Ok(())
    }

    /// Takes points. The first of them may have been held back since a line of an earlier section.
    fn wait(&mut self, points: impl IntoIterator<Item = ControlPoint>) {
        for point in points {
            self.bytes_without_point = 0;
            if let Some(section) = self.held.take().or(self.section) {
                self.waiting.push_back((point, section));
            }
        }
    }

    /// Checks the moves around the whole path.
    fn check_heights(&mut self) -> Result<bool, ReadError> {
        match self.travel.finish() {
            Ok(()) => Ok(false),
            Err((line, what)) => {
                self.line = line;
                Err(self.wrong(what))
            }
        }
    }

    /// Reads the next line; `false` at the end of the path.
    fn read_on(&mut self) -> Result<bool, ReadError> {
        if let Some(said) = self.said_points {
            let count = self.found_points;
            LINES_READ.add(std::mem::take(&mut self.lines_read));
            self.pass_footer()?;
            self.parts.finish().map_err(|what| self.wrong(what))?;
            return match said == count {
                true => self.check_heights(),
                false => Err(self.wrong(format!(
                    "the path has {count} points, but its end mark says {said}"
                ))),
            };
        }
        let Some(line) = self.next_line()? else {
            return self.end_file();
        };
        let buffer = self.lines.lend();
        let read = self.read_line(&buffer[line]);
        self.lines.take_back(buffer);
        if let Some(part) = read.map_err(|what| self.wrong(what))? {
            self.call(&part)?;
        }
        Ok(true)
    }

    /// Reads a line; gives the file of the part that it calls, if it calls one.
    fn read_line(&mut self, line: &[u8]) -> Result<Option<String>, String> {
        refuse_control_characters(line)?;
        let (code, comment) = self.grammar.split_comment(line);
        if let Some(comment) = comment
            && self.read_comment(comment)?
            && !code.trim_ascii().is_empty()
        {
            let what = "code stands before a mark of the path: a mark has a line of its own";
            return Err(what.to_owned());
        }
        if self.parts.is_outside() {
            return self.parts.take_outside(code).map(|()| None);
        }
        if let Some(name) = self.called_part(code) {
            return Ok(Some(name));
        }
        // The lines before the path belong to the header, and those after it to the footer.
        if !matches!(self.place, Place::Header | Place::Footer) {
            self.read_code(code)?;
        }
        Ok(None)
    }
}

impl<R: Read> ProgramReader<R> {
    /// The file of the part that a line of the main program calls.
    fn called_part(&self, code: &[u8]) -> Option<String> {
        if self.place != Place::Path || !self.parts.may_be_called() {
            return None;
        }
        let code = std::str::from_utf8(code).ok()?;
        let own = self.path.file_name().unwrap_or_default().to_string_lossy();
        let main = (text_name(&own), &self.format.part_numbers);
        self.post.dialect.called_part(code, main)
    }

    /// Goes on with the lines of a part. Its file is compressed as that of the main program is.
    fn call(&mut self, name: &str) -> Result<(), ReadError> {
        let name = Compression::of_file(&self.path).file_of(name);
        let path = self.path.with_file_name(&name);
        let part = self.parts.open(&name);
        let part = part.map_err(|error| ReadError::File {
            path: path.clone(),
            error,
        })?;
        let main = std::mem::replace(&mut self.lines, LineReader::new(part));
        let own = std::mem::replace(&mut self.path, path);
        let numbers = &self.format.part_numbers;
        let part = PartName::of_file(text_name(&name), self.parts.number(), numbers);
        self.parts.expect(self.post.dialect.part_frame(&part));
        self.parts.caller = Some((main, own, self.line));
        self.line = 0;
        Ok(())
    }

    /// Goes back to the main program at the end of a part.
    fn end_file(&mut self) -> Result<bool, ReadError> {
        if self.parts.caller.is_none() {
            return Err(self.incomplete());
        }
        self.parts.finish_part().map_err(|what| self.wrong(what))?;
        if let Some((lines, path, line)) = self.parts.caller.take() {
            (self.lines, self.path, self.line) = (lines, path, line);
        }
        Ok(true)
    }
}

impl<R: Read> ProgramReader<R> {
    /// The point of the next lines, if they are written as nearly all lines of a path are.
    fn next_plain(&mut self) -> Option<(ControlPoint, Section)> {
        let is_path = self.place == Place::Path && !self.parts.is_outside();
        let section = self
            .section
            .filter(|_| is_path && self.waiting.is_empty())?;
        let unread = self.lines.unread();
        let near = unread.get(..LONGEST_LINE - 1).unwrap_or(unread);
        let plain = self.grammar.read_plain(near)?;
        self.lines.pass(plain.bytes);
        self.line += plain.lines as u64;
        self.lines_read += plain.lines;
        self.bytes_without_point = 0;
        Some((plain.point, section))
    }

    /// The next point with the velocities that its line says.
    fn next_found(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut next = self.next_plain();
        while next.is_none() {
            next = self.waiting.pop_front();
            if next.is_none() && !self.read_on()? {
                return Ok(None);
            }
        }
        let Some((point, section)) = next else {
            return Ok(None);
        };
        let checked = check_velocities(&point)
            .and_then(|()| check_turn(self.last.as_ref(), &point, section))
            .and_then(|()| self.travel.pass(&point, &self.format));
        checked.map_err(|what| self.wrong(what))?;
        self.last = Some((point, section));
        self.found_points += 1;
        Ok(self.last)
    }

    /// The next point with its velocities.
    fn next_with_rates(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        loop {
            let found = self.next_found()?;
            let Some(rates) = &mut self.rates else {
                return Ok(found);
            };
            let Some(found) = found else {
                return Ok(rates.finish());
            };
            if let Some(before) = rates.push(found) {
                return Ok(Some(before));
            }
        }
    }
}

impl<R: Read> ReadPath for ProgramReader<R> {
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let next = self.next_with_rates()?;
        if let Some((point, section)) = next {
            self.read_count.add(point, section);
        }
        Ok(next)
    }

    fn read_count(&self) -> &ReadCount {
        &self.read_count
    }

    fn read_count_mut(&mut self) -> &mut ReadCount {
        &mut self.read_count
    }

    fn parts(&self) -> &[String] {
        self.parts.files()
    }
}
