//! Writes a program: first the path, then the header and the footer around it.

use std::io::{self, Write};

use turnpath_files::{Draft, FileError, Scratch};

use crate::layout::Lines;
use crate::program_format::END_MARK;

/// Writes a program to a file or to memory. The header reports what is known only at the end, so the
/// body waits until then: in a file without a name, or in memory.
///
/// ```
/// use turnpath_post::{Lines, ProgramWriter};
///
/// let mut writer = ProgramWriter::in_memory(";");
/// let text = b"; -- cutting --\n".to_vec();
/// writer.append(&Lines { text, points: 0 })?;
/// let program = writer.assemble_in_memory("OPEN PROG 1 CLEAR\n", "CLOSE\n");
/// assert!(program.ends_with(b"; -- end of path: 0 points --\nCLOSE\n"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct ProgramWriter<B = ProgramFileBody> {
    body: B,
    /// What begins a comment.
    comment: &'static str,
    points: u64,
}

/// The body of a program that will become a file.
#[derive(Debug)]
pub struct ProgramFileBody {
    lines: Scratch,
    /// The program, still empty.
    draft: Draft,
}

impl ProgramWriter {
    /// Begins the program that the draft will be.
    ///
    /// # Errors
    /// When no file can be created in the draft's folder.
    pub fn begin(draft: Draft, comment: &'static str) -> Result<Self, FileError> {
        match Scratch::in_folder(draft.folder()) {
            Ok(lines) => {
                let body = ProgramFileBody { lines, draft };
                Ok(Self {
                    body,
                    comment,
                    points: 0,
                })
            }
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }

    /// The complete program as a file that still lacks its name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn assemble(self, header: &str, footer: &str) -> Result<Draft, FileError> {
        let end = self.end(footer);
        let ProgramFileBody { lines, mut draft } = self.body;
        let write = || -> io::Result<()> {
            let mut body = lines.into_reader()?;
            draft.write_all(header.as_bytes())?;
            io::copy(&mut body, &mut draft)?;
            draft.write_all(end.as_bytes())
        };
        match write() {
            Ok(()) => Ok(draft),
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }
}

impl ProgramWriter<Vec<u8>> {
    /// Begins a program in memory.
    pub fn in_memory(comment: &'static str) -> Self {
        Self {
            body: Vec::new(),
            comment,
            points: 0,
        }
    }

    /// The complete program.
    pub fn assemble_in_memory(self, header: &str, footer: &str) -> Vec<u8> {
        let end = self.end(footer);
        [header.as_bytes(), &self.body, end.as_bytes()].concat()
    }
}

impl<B: Write> ProgramWriter<B> {
    /// Appends lines.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, lines: &Lines) -> io::Result<()> {
        self.points += lines.points as u64;
        self.body.write_all(&lines.text)
    }
}

impl<B> ProgramWriter<B> {
    /// The control points so far, with those of divided segments.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// The lines after the path.
    fn end(&self, footer: &str) -> String {
        let (comment, points) = (self.comment, self.points);
        format!("{comment} {END_MARK}: {points} points --\n{footer}")
    }
}

impl Write for ProgramFileBody {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.lines.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.lines.flush()
    }
}
