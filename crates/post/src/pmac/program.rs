//! A program file in the making: its path first, header and footer around it at the end.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::{ControlPoint, PathBlock, SectionBlock, Section};

use super::encode;
use super::error::PmacError;
use super::format::{END_MARK, PmacFormat};
use crate::{Draft, FileError};

/// The header where none is given.
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
/// The footer where none is given.
pub const FOOTER: &str = "CLOSE\n";

/// Bytes that are gathered before they are written.
const BUFFER: usize = 1 << 18;

/// A program in the making. Its header tells what is known only at the end, so the path is kept in
/// a file without a name until then.
#[derive(Debug)]
pub struct PmacWriter {
    body: BufWriter<File>,
    path: PathBuf,
    points: u64,
}

impl PmacWriter {
    /// Begins the program that will stand at `path`, whose folder must be there.
    pub fn begin(path: impl Into<PathBuf>) -> Result<Self, FileError> {
        let path = path.into();
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        match tempfile::tempfile_in(folder) {
            Ok(file) => Ok(Self {
                body: BufWriter::with_capacity(BUFFER, file),
                path,
                points: 0,
            }),
            Err(error) => Err(FileError { path, error }),
        }
    }

    /// Where the program will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A stretch as program lines; needs no file, so that stretches can be put into lines in
    /// parallel.
    ///
    /// # Errors
    /// When a program cannot carry the path.
    pub fn lines(format: &PmacFormat, stretch: &SectionBlock<'_>) -> Result<Vec<u8>, PmacError> {
        encode::lines(format, stretch)
    }

    /// Appends the lines of so many points.
    pub fn append(&mut self, points: usize, lines: &[u8]) -> io::Result<()> {
        self.points += points as u64;
        self.body.write_all(lines)
    }

    /// The whole program, still without its name.
    pub fn assemble(self, header: &str, footer: &str) -> Result<Draft, FileError> {
        let Self { body, path, points } = self;
        let mut draft = Draft::begin(&path)?;
        let put = || -> io::Result<()> {
            let mut body = body.into_inner().map_err(io::IntoInnerError::into_error)?;
            body.rewind()?;
            draft.write_all(header.as_bytes())?;
            io::copy(&mut body, &mut draft)?;
            writeln!(draft, "; {END_MARK}: {points} points --")?;
            draft.write_all(footer.as_bytes())
        };
        match put() {
            Ok(()) => Ok(draft),
            Err(error) => Err(FileError { path, error }),
        }
    }

    /// Bytes that a program of so many points will take, roughly: from points made up half-way, with
    /// all digits and one time. A time of its own for every point adds half as much.
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
