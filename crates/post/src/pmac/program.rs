//! Writes a program: first the path, then the header and the footer around it.

use std::io::{self, Write};

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};
use turnpath_files::{Draft, FileError, Scratch};

use super::encode;
use super::error::PmacError;
use super::format::{END_MARK, PmacFormat};

/// The default header.
pub const HEADER: &str = "\
; {name}
; recipe {recipe}, SHA-256 {sha256}
; changed by --set: {changes}
; turnpath {turnpath}, post pmac-pvt: {points} points, {revolutions} revolutions, {time_s} s
; X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; velocities per {velocity_unit}: Ix90 = {ix90}
; segment times in steps of 1/4096 ms: I42 = 0
; the path begins and ends {ends}
CLOSE
OPEN PROG 1 CLEAR
";
/// The default footer.
pub const FOOTER: &str = "CLOSE\n";

/// Writes a program to a file or to memory. The header reports what is known only at the end, so the
/// body waits until then: in a file without a name, or in memory.
///
/// ```
/// use turnpath_post::PmacWriter;
///
/// let mut writer = PmacWriter::in_memory();
/// writer.append(0, b"; -- cutting --\n")?;
/// let program = writer.assemble_in_memory("OPEN PROG 1 CLEAR\n", "CLOSE\n");
/// assert!(program.ends_with(b"; -- end of path: 0 points --\nCLOSE\n"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct PmacWriter<B = PmacFileBody> {
    body: B,
    points: u64,
}

/// The body of a program that will become a file.
#[derive(Debug)]
pub struct PmacFileBody {
    lines: Scratch,
    /// The program, still empty.
    draft: Draft,
}

impl PmacWriter {
    /// Begins the program that the draft will be.
    ///
    /// # Errors
    /// When no file can be created in the draft's folder.
    pub fn begin(draft: Draft) -> Result<Self, FileError> {
        match Scratch::in_folder(draft.folder()) {
            Ok(lines) => {
                let body = PmacFileBody { lines, draft };
                Ok(Self { body, points: 0 })
            }
            Err(error) => Err(FileError::of(draft.path())(error)),
        }
    }

    /// A part of the path as program lines. This needs no file, so several parts can be formatted in
    /// parallel.
    ///
    /// # Errors
    /// When a program cannot carry the path.
    pub fn lines(format: &PmacFormat, stretch: &SectionBlock<'_>) -> Result<Vec<u8>, PmacError> {
        encode::lines(format, stretch)
    }

    /// A part of the path as a reader finds it in the program: on the controller's times, and in the
    /// program's digits. C is unwrapped, and begins [`PmacWriter::turns_left_out`] later.
    ///
    /// # Errors
    /// When a program cannot carry the path.
    pub fn carried(
        format: &PmacFormat,
        stretch: &SectionBlock<'_>,
    ) -> Result<PathBlock, PmacError> {
        encode::carried(format, stretch)
    }

    /// Whole turns of C, rad, that a program leaves out before the path's first point: not zero only
    /// if its C is wrapped.
    ///
    /// # Errors
    /// When a program cannot carry the point.
    pub fn turns_left_out(format: &PmacFormat, first: &ControlPoint) -> Result<f64, PmacError> {
        encode::turns_left_out(format, first)
    }

    /// The complete program as a file that still lacks its name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn assemble(self, header: &str, footer: &str) -> Result<Draft, FileError> {
        let end = self.end(footer);
        let PmacFileBody { lines, mut draft } = self.body;
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

    /// A rough estimate of the bytes of a program with so many points. It is made from invented points
    /// in the middle of the path, which have all digits and one common time. If every point has a time
    /// of its own, the program is larger by half.
    pub fn expected_bytes(format: &PmacFormat, radius: f64, time: f64, c: f64, points: f64) -> f64 {
        let half = |end: f64| 0.5 * end * (1.0 + 1e-7 / 3.0);
        let (speed, step) = (c / time, time / points.max(1.0));
        let point = |k: u32| {
            let t = half(time) + f64::from(k) * step;
            ControlPoint {
                t,
                c: speed * t,
                x: half(radius),
                z: half(radius),
                vc: speed,
                vx: -half(radius) / time,
                vz: half(radius) * speed,
            }
        };
        let mut block = PathBlock::default();
        block.push(point(1));
        block.push(point(2));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: false,
            before: &[point(0)],
            points: &block,
        };
        let lines = encode::lines(format, &stretch).map_or(0, |lines| lines.len());
        points * lines as f64 / 2.0
    }
}

impl PmacWriter<Vec<u8>> {
    /// Begins a program in memory.
    pub fn in_memory() -> Self {
        let body = Vec::new();
        Self { body, points: 0 }
    }

    /// The complete program.
    pub fn assemble_in_memory(self, header: &str, footer: &str) -> Vec<u8> {
        let end = self.end(footer);
        [header.as_bytes(), &self.body, end.as_bytes()].concat()
    }
}

impl<B: Write> PmacWriter<B> {
    /// Appends the lines of so many points.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, points: usize, lines: &[u8]) -> io::Result<()> {
        self.points += points as u64;
        self.body.write_all(lines)
    }
}

impl<B> PmacWriter<B> {
    /// The lines after the path.
    fn end(&self, footer: &str) -> String {
        format!("; {END_MARK}: {} points --\n{footer}", self.points)
    }
}

impl Write for PmacFileBody {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.lines.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.lines.flush()
    }
}
