//! Writes a program: first the path, then the header and the footer around it.

use std::io::{self, BufReader, Cursor, Read, Write};
use std::path::Path;

use turnpath_files::{Draft, FileError, Scratch, ScratchReader};

use crate::amount::TextSize;
use crate::compression::{Compression, text_name};
use crate::layout::{Layout, Lines};
use crate::parts::{Cutter, PartLimits, PartsError};
use crate::read_error::ReadError;
use crate::text_file::{TextFile, file_bytes};
use crate::travel::Extent;
use crate::whole_program::{WholeProgram, prove_in_memory, refuse_other_lines};

/// Writes a program to a file or to memory. The header reports what is known only when the path was
/// measured on its own text, so the path waits until then: in a file without a name, or in memory.
///
/// ```
/// use turnpath_core::Params;
/// use turnpath_post::{Layout, Lines, ProgramWriter, post_named};
///
/// let post = post_named("pmac-pvt").ok_or("no such post")?;
/// let format = post.format(&Params::new(), 0.0, 1e-4);
/// let mut writer = ProgramWriter::in_memory(Layout { post, format });
/// let text = b"; -- cutting --\n".to_vec();
/// writer.append(&Lines { text, ..Lines::default() })?;
/// let path = writer.close();
/// assert!(path.text().ends_with(b"; -- end of path: 0 points --\n"));
/// let program = path.assemble(["OPEN PROG 1 CLEAR\n", "CLOSE\n"], "part.pmc")?;
/// assert!(program.starts_with(b"OPEN PROG 1 CLEAR\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct ProgramWriter<B = ProgramFileBody> {
    body: B,
    layout: Layout,
    points: u64,
    extent: Option<Extent>,
    /// The size of the lines so far.
    size: TextSize,
}

/// The body of a program that will become a file.
#[derive(Debug)]
pub struct ProgramFileBody {
    lines: Scratch,
    /// The program, still empty.
    draft: Draft,
}

/// A whole path of a program with its approach and its end mark, which still lacks header and footer.
#[derive(Debug)]
pub struct ProgramPath {
    lines: ScratchReader,
    draft: Draft,
    /// The approach, which stands before the first line.
    approach: Vec<u8>,
    /// What stands behind the last line, which is at the end of `lines` too.
    end: Vec<u8>,
    layout: Layout,
    /// The size of the lines without the end.
    size: TextSize,
    points: u64,
    extent: Option<Extent>,
}

/// The same in memory.
#[derive(Debug)]
pub struct ProgramPathInMemory {
    text: Vec<u8>,
    approach: Vec<u8>,
    end: Vec<u8>,
    layout: Layout,
    size: TextSize,
    points: u64,
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

    /// Ends the path.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn close(self) -> Result<ProgramPath, FileError> {
        let (points, extent, size) = (self.points, self.extent, self.size);
        let end = self.layout.end(points, extent.as_ref());
        let approach = self.layout.approach(extent.as_ref());
        let ProgramFileBody { mut lines, draft } = self.body;
        let mut write = || lines.write_all(&end);
        match write().and_then(|()| lines.into_reader()) {
            Ok(lines) => Ok(ProgramPath {
                lines,
                draft,
                approach,
                end,
                layout: self.layout,
                size,
                points,
                extent,
            }),
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }
}

impl ProgramPath {
    /// The control points, with those of divided segments.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Lets another thread read the program's file back while it is written.
    pub fn read_while_written(&mut self) {
        self.draft.read_while_written();
    }

    /// From where to where the path goes; `None` without points.
    pub fn extent(&self) -> Option<Extent> {
        self.extent
    }

    /// The path that the whole program will have.
    pub fn file(&self) -> &Path {
        self.draft.path()
    }

    /// The path's text from its beginning: approach, lines and end mark.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn text(&mut self) -> Result<impl Read + Send, FileError> {
        match self.lines.rewind() {
            Ok(()) => Ok(self.approach.as_slice().chain(&mut self.lines)),
            Err(error) => Err(FileError::of(self.draft.path())(error)),
        }
    }

    /// The size of the complete program as one file.
    pub fn size(&self, header: &str, footer: &str) -> TextSize {
        let around = [
            header.as_bytes(),
            &self.approach,
            &self.end,
            footer.as_bytes(),
        ];
        let sizes = around.map(TextSize::of).into_iter();
        sizes.fold(self.size, TextSize::and)
    }

    /// The complete program as a main program and the parts that it calls, as files that still lack their
    /// names. What the name `file` of the main program ends with says how they are compressed. `begin`
    /// begins the file of a part by its name.
    ///
    /// # Errors
    /// When a file cannot be written, or when there would be too many.
    pub fn assemble_parts(
        mut self,
        [header, footer]: [&str; 2],
        (file, limits): (&str, PartLimits),
        begin: &mut dyn FnMut(&str) -> Result<Draft, FileError>,
    ) -> Result<(Draft, Vec<Draft>), PartsError> {
        let rewound = self.lines.rewind();
        rewound.map_err(FileError::of(self.draft.path()))?;
        let lines = Read::take(&mut self.lines, self.size.bytes);
        let cutter = Cutter::new(&self.layout, file, limits);
        let (parts, calls) = cutter.cut(&mut BufReader::new(lines), begin)?;
        let main = [
            header.as_bytes(),
            &self.approach,
            &calls,
            &self.end,
            footer.as_bytes(),
        ];
        limits.refuse_large(text_name(file), TextSize::of(&main.concat()))?;
        let main = written(self.draft, |text| text.write_all(&main.concat()))?;
        Ok((main, parts))
    }

    /// The complete program as one file that still lacks its name. What its name ends with says whether it
    /// is compressed.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn assemble(
        self,
        [header, footer]: [&str; 2],
    ) -> Result<WholeProgram<impl Read>, FileError> {
        let Self {
            mut lines,
            draft,
            approach,
            layout,
            ..
        } = self;
        let is_text = Compression::of_file(draft.path()) == Compression::None;
        let mut lines_to_compare = None;
        let file = written(draft, |text| {
            let measured = lines.sum_to_end()?;
            text.write_all(header.as_bytes())?;
            text.write_all(&approach)?;
            if is_text {
                refuse_other_lines(measured, lines.move_to(text)?)?;
            } else {
                lines.rewind()?;
                io::copy(&mut lines, text)?;
                lines.rewind()?;
                lines_to_compare = Some(lines);
            }
            text.write_all(footer.as_bytes())
        })?;
        Ok(WholeProgram {
            file,
            header: header.to_owned(),
            text: lines_to_compare.map(|lines| Cursor::new(approach).chain(lines)),
            footer: footer.to_owned(),
            layout,
        })
    }
}

/// A file with the text that `write` writes.
fn written(
    draft: Draft,
    write: impl FnOnce(&mut TextFile<Draft>) -> io::Result<()>,
) -> Result<Draft, FileError> {
    let path = draft.path().to_owned();
    let text = TextFile::begin(Compression::of_file(&path), draft);
    let file = text.and_then(|mut text| {
        write(&mut text)?;
        text.whole()
    });
    file.map_err(FileError::of(&path))
}

impl ProgramWriter<Vec<u8>> {
    /// Begins a program in memory.
    pub fn in_memory(layout: Layout) -> Self {
        Self::new(Vec::new(), layout)
    }

    /// Ends the path.
    pub fn close(self) -> ProgramPathInMemory {
        let end = self.layout.end(self.points, self.extent.as_ref());
        let approach = self.layout.approach(self.extent.as_ref());
        ProgramPathInMemory {
            text: [approach.as_slice(), &self.body, &end].concat(),
            approach,
            end,
            layout: self.layout,
            size: self.size,
            points: self.points,
        }
    }
}

impl ProgramPathInMemory {
    /// The control points, with those of divided segments.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// The path's text: approach, lines and end mark.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// The size of the complete program as one file.
    pub fn size(&self, header: &str, footer: &str) -> TextSize {
        let around = [
            header.as_bytes(),
            &self.approach,
            &self.end,
            footer.as_bytes(),
        ];
        let sizes = around.map(TextSize::of).into_iter();
        sizes.fold(self.size, TextSize::and)
    }

    /// The complete program as a main program and the parts that it calls, with the names of their
    /// files. What the name `file` of the main program ends with says how they are compressed.
    ///
    /// # Errors
    /// When there would be too many parts.
    pub fn assemble_parts(
        self,
        [header, footer]: [&str; 2],
        (file, limits): (&str, PartLimits),
    ) -> Result<Vec<(String, Vec<u8>)>, PartsError> {
        let mut names = Vec::new();
        let end = self.text.len().saturating_sub(self.end.len());
        let mut lines = self.text.get(self.approach.len()..end).unwrap_or_default();
        let cutter = Cutter::new(&self.layout, file, limits);
        let (parts, calls) = cutter.cut(&mut lines, &mut |name| {
            names.push(name.to_owned());
            Ok(Vec::new())
        })?;
        let main = [
            header.as_bytes(),
            &self.approach,
            &calls,
            &self.end,
            footer.as_bytes(),
        ];
        let main = main.concat();
        limits.refuse_large(text_name(file), TextSize::of(&main))?;
        let main = file_bytes(file, main);
        let main = main.map_err(FileError::of(Path::new(file)))?;
        let files = [(file.to_owned(), main)].into_iter();
        Ok(files.chain(names.into_iter().zip(parts)).collect())
    }

    /// The complete program as one file of this name. What it ends with says whether it is compressed. It is
    /// proven that the file is read as its text.
    ///
    /// # Errors
    /// When header or footer change what is read, or this build writes no files that are compressed so.
    pub fn assemble(self, around: [&str; 2], file: &str) -> Result<Vec<u8>, ReadError> {
        prove_in_memory(&self.layout, file, &self.text, around)
    }
}

impl<B: Write> ProgramWriter<B> {
    /// Appends lines.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, lines: &Lines) -> io::Result<()> {
        self.points += lines.points as u64;
        self.size = self.size.and(TextSize::of(&lines.text));
        self.extent = match (self.extent, lines.extent) {
            (Some(before), Some(next)) => Some(before.and(next)),
            (before, next) => before.or(next),
        };
        self.body.write_all(&lines.text)
    }
}

impl<B> ProgramWriter<B> {
    fn new(body: B, layout: Layout) -> Self {
        Self {
            body,
            layout,
            points: 0,
            extent: None,
            size: TextSize::default(),
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
