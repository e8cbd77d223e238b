//! Writes a program: first the path, then the header and the footer around it.

use std::io::{self, Write};

use turnpath_files::{Draft, FileError, Scratch};

use crate::layout::{Layout, Lines};
use crate::program_format::{APPROACH_MARK, END_MARK, RETREAT_MARK};
use crate::travel::{Extent, Travel};

/// Writes a program to a file or to memory. The header reports what is known only at the end, so the
/// body waits until then: in a file without a name, or in memory.
///
/// ```
/// use turnpath_core::Params;
/// use turnpath_post::{Layout, Lines, ProgramWriter, post_named};
///
/// let post = post_named("pmac-pvt").unwrap();
/// let format = post.format(&Params::new(), 0.0);
/// let mut writer = ProgramWriter::in_memory(Layout { post, format });
/// let text = b"; -- cutting --\n".to_vec();
/// writer.append(&Lines { text, ..Lines::default() })?;
/// let program = writer.assemble_in_memory("OPEN PROG 1 CLEAR\n", "CLOSE\n");
/// assert!(program.ends_with(b"; -- end of path: 0 points --\nCLOSE\n"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct ProgramWriter<B = ProgramFileBody> {
    body: B,
    layout: Layout,
    points: u64,
    extent: Option<Extent>,
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
    pub fn begin(draft: Draft, layout: Layout) -> Result<Self, FileError> {
        match Scratch::in_folder(draft.folder()) {
            Ok(lines) => {
                let body = ProgramFileBody { lines, draft };
                Ok(Self::new(body, layout))
            }
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }

    /// The complete program as a file that still lacks its name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn assemble(self, header: &str, footer: &str) -> Result<Draft, FileError> {
        let (begin, end) = (self.begin_lines(header), self.end(footer));
        let ProgramFileBody { lines, mut draft } = self.body;
        let write = || -> io::Result<()> {
            let mut body = lines.into_reader()?;
            draft.write_all(&begin)?;
            io::copy(&mut body, &mut draft)?;
            draft.write_all(&end)
        };
        match write() {
            Ok(()) => Ok(draft),
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }
}

impl ProgramWriter<Vec<u8>> {
    /// Begins a program in memory.
    pub fn in_memory(layout: Layout) -> Self {
        Self::new(Vec::new(), layout)
    }

    /// The complete program.
    pub fn assemble_in_memory(self, header: &str, footer: &str) -> Vec<u8> {
        let (begin, end) = (self.begin_lines(header), self.end(footer));
        [begin, self.body, end].concat()
    }
}

impl<B: Write> ProgramWriter<B> {
    /// Appends lines.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, lines: &Lines) -> io::Result<()> {
        self.points += lines.points as u64;
        self.extent = match (self.extent, lines.extent) {
            (Some(before), Some(next)) => Some(before.and(next)),
            (before, next) => before.or(next),
        };
        self.body.write_all(&lines.text)
    }
}

impl<B> ProgramWriter<B> {
    /// From where to where the path so far goes; `None` without points.
    pub fn extent(&self) -> Option<Extent> {
        self.extent
    }

    /// The control points so far, with those of divided segments.
    pub fn points(&self) -> u64 {
        self.points
    }

    fn new(body: B, layout: Layout) -> Self {
        Self {
            body,
            layout,
            points: 0,
            extent: None,
        }
    }

    /// The lines before the path: the header and the approach.
    fn begin_lines(&self, header: &str) -> Vec<u8> {
        let mut text = header.as_bytes().to_vec();
        let moves = self
            .extent
            .map(|extent| extent.approach(&self.layout.format));
        self.push_travel(&mut text, APPROACH_MARK, &moves.unwrap_or_default());
        text
    }

    /// The lines after the path: the retreat, the end mark and the footer.
    fn end(&self, footer: &str) -> Vec<u8> {
        let (comment, points) = (self.layout.post.comment, self.points);
        let mut text = Vec::new();
        let moves = self
            .extent
            .map(|extent| extent.retreat(&self.layout.format));
        self.push_travel(&mut text, RETREAT_MARK, &moves.unwrap_or_default());
        let end = format!("{comment} {END_MARK}: {points} points --\n{footer}");
        text.extend_from_slice(end.as_bytes());
        text
    }

    fn push_travel(&self, text: &mut Vec<u8>, mark: &str, moves: &[Travel]) {
        if !moves.is_empty() {
            let opening = format!("{} {mark}\n", self.layout.post.comment);
            text.extend_from_slice(opening.as_bytes());
            text.extend(self.layout.travel_lines(moves));
        }
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
