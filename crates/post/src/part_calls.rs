//! The parts that a main program calls, as they are read: in their order, and each of them whole.

use std::collections::VecDeque;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use crate::lines::LineReader;
use crate::program_format::says_parts;

/// Opens a part by the name of its file.
pub(crate) type OpenPart<R> = Box<dyn Fn(&str) -> io::Result<R> + Send + Sync>;

/// What is known of the parts of a program.
pub(crate) struct PartCalls<R> {
    open: Option<OpenPart<R>>,
    /// The parts that the main program says it has.
    said: Option<u32>,
    /// The parts that it has called so far.
    called: u32,
    /// Their files.
    files: Vec<String>,
    /// The number in the mark of a part that no main program calls: the file may be that part.
    alone: Option<u32>,
    /// The main program, while a part of it is read: its lines, its file, and the line of the call.
    pub(crate) caller: Option<(LineReader<R>, PathBuf, u64)>,
    place: Place,
    /// The lines of code that are still to come before and behind those of the part, in capitals and without
    /// blanks.
    around: [VecDeque<String>; 2],
}

/// Where in the file of a part the reader is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Before,
    Within,
    Behind,
}

impl<R> Default for PartCalls<R> {
    fn default() -> Self {
        Self {
            open: None,
            said: None,
            called: 0,
            files: Vec::new(),
            alone: None,
            caller: None,
            place: Place::Before,
            around: Default::default(),
        }
    }
}

impl<R: Read> PartCalls<R> {
    pub(crate) fn new(open: OpenPart<R>) -> Self {
        Self {
            open: Some(open),
            ..Self::default()
        }
    }

    /// Takes the mark of the main program that says how many parts it has.
    pub(crate) fn begin(&mut self, mark: &str) -> bool {
        let Some(parts) = says_parts(mark) else {
            return false;
        };
        self.said = Some(parts);
        true
    }

    /// Whether a line of the main program may call a part.
    pub(crate) fn may_be_called(&self) -> bool {
        self.said.is_some() && self.caller.is_none()
    }

    /// Whether a part is read, and not its lines of the path.
    pub(crate) fn is_outside(&self) -> bool {
        self.caller.is_some() && self.place != Place::Within
    }

    /// Takes a mark of a part; `false` if it is none.
    ///
    /// # Errors
    /// When the mark is out of order.
    pub(crate) fn take_mark(&mut self, mark: &str) -> Result<bool, String> {
        let ends = mark.strip_prefix("-- end of part ");
        let begins = mark.strip_prefix("-- part ");
        let Some(rest) = ends.or(begins) else {
            return Ok(false);
        };
        let number = rest.strip_suffix(" --");
        let number = number.and_then(|number| number.parse::<u32>().ok());
        if self.caller.is_none() {
            self.alone = self.alone.or(number);
            return Ok(false);
        }
        let (from, to) = match ends {
            Some(_) => (Place::Within, Place::Behind),
            None => (Place::Before, Place::Within),
        };
        if number != Some(self.called) || self.place != from {
            return Err(format!("`{mark}` is out of order in part {}", self.called));
        }
        if to == Place::Within {
            self.refuse_missing(0)?;
        }
        self.place = to;
        Ok(true)
    }

    /// Sets the lines of code that stand before and behind those of the part that is read.
    pub(crate) fn expect(&mut self, around: [Vec<String>; 2]) {
        self.around = around.map(VecDeque::from);
    }

    /// What is wrong with a file. If it has the mark of a part that no main program calls, that may be it.
    pub(crate) fn or_part_alone(&self, what: String) -> String {
        match self.alone {
            Some(number) if self.said.is_none() => format!(
                "{what}; if this file is part {number} of a program: read the main program, which calls it"
            ),
            _ => what,
        }
    }

    /// The files of the parts that were called so far.
    pub(crate) fn files(&self) -> &[String] {
        &self.files
    }

    /// The number of the part that is read.
    pub(crate) fn number(&self) -> u32 {
        self.called
    }

    /// Takes code of a part that is no line of the path. A controller runs it too, so only what begins and ends
    /// a part may stand there.
    pub(crate) fn take_outside(&mut self, code: &[u8]) -> Result<(), String> {
        let code = String::from_utf8_lossy(code);
        let joined: String = code.split_whitespace().collect();
        if joined.is_empty() {
            return Ok(());
        }
        let [before, behind] = &mut self.around;
        let expected = match self.place {
            Place::Behind => behind,
            Place::Before | Place::Within => before,
        };
        if expected.front() == Some(&joined.to_ascii_uppercase()) {
            expected.pop_front();
            return Ok(());
        }
        let shown: String = code.trim().chars().take(40).collect();
        Err(format!(
            "`{shown}` stands outside the marks of part {}, where its controller would run it",
            self.called
        ))
    }

    /// Refuses a part that lacks a line before its own ones, or behind them.
    fn refuse_missing(&self, which: usize) -> Result<(), String> {
        let missing = self.around.get(which).and_then(VecDeque::front);
        missing.map_or(Ok(()), |line| {
            Err(format!("part {} lacks its line `{line}`", self.called))
        })
    }

    /// Opens the part that the main program calls next.
    ///
    /// # Errors
    /// When it cannot be read.
    pub(crate) fn open(&mut self, name: &str) -> io::Result<R> {
        let mut components = Path::new(name).components();
        let is_file = matches!(components.next(), Some(Component::Normal(_)));
        let invalid = |what| io::Error::new(io::ErrorKind::InvalidInput, what);
        if !is_file || components.next().is_some() {
            return Err(invalid("a part is not beside its main program"));
        }
        let open = self.open.as_ref();
        let open = open.ok_or_else(|| invalid("a program of parts is read from its folder"))?;
        let part = open(name)?;
        self.called += 1;
        self.files.push(name.to_owned());
        self.place = Place::Before;
        Ok(part)
    }

    /// Ends the part that is read, at the end of its file.
    ///
    /// # Errors
    /// When it is not whole: what is wrong.
    pub(crate) fn finish_part(&mut self) -> Result<(), String> {
        match self.place {
            Place::Behind => self.refuse_missing(1),
            Place::Before | Place::Within => Err(format!(
                "part {0} ends without its mark `-- end of part {0} --`: it is not complete",
                self.called
            )),
        }
    }

    /// Checks that all parts were called, at the end of the path.
    pub(crate) fn finish(&self) -> Result<(), String> {
        match self.said {
            Some(said) if said != self.called => Err(format!(
                "the program says {said} parts, and calls {}",
                self.called
            )),
            _ => Ok(()),
        }
    }
}
