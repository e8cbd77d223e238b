//! Reads `toolpath.csv`. An error names the line.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::{ControlPoint, Section};

use crate::ordinary_file;
use crate::path_reader::{ReadCount, ReadPath};
use crate::read_error::ReadError;
use crate::row::{HEADER, Row};
use crate::short_lines::ShortLines;
use crate::turn::{check_turn, check_velocities};

/// Largest time, s: three hundred thousand years.
const LATEST: f64 = 1e13;

/// Reads `toolpath.csv` block by block, from a file or from any other [`Read`].
pub struct PathReader<R = File> {
    rows: csv::Reader<ShortLines<R>>,
    path: PathBuf,
    read_count: ReadCount,
}

impl PathReader {
    /// Opens a file and checks its first line.
    ///
    /// # Errors
    /// When the file cannot be read or begins with another line.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, ReadError> {
        let path = path.into();
        match ordinary_file::open(&path) {
            Ok(file) => Self::from_reader(file, path),
            Err(error) => Err(ReadError::File { path, error }),
        }
    }
}

impl<R: Read> PathReader<R> {
    /// Reads from `reader`, for example from bytes in memory, and checks the first line. Errors
    /// name `path`.
    ///
    /// # Errors
    /// When the reader fails or begins with another line.
    pub fn from_reader(reader: R, path: impl Into<PathBuf>) -> Result<Self, ReadError> {
        let path = path.into();
        // Numbers need no quotes. A quote without an end would swallow all lines after it.
        let mut rows = csv::ReaderBuilder::new()
            .quoting(false)
            .trim(csv::Trim::All)
            .from_reader(ShortLines::new(reader));
        let header = match rows.headers() {
            Ok(header) => header,
            Err(error) => return Err(from_csv(&path, error)),
        };
        if !header.iter().eq(HEADER) {
            let what = format!(
                "this is not the header of a tool path, `{}`; a program is read as one where its name \
                 ends as its post has it, `.pmc` for example",
                HEADER.join(",")
            );
            return Err(ReadError::Line {
                path,
                line: 1,
                what,
            });
        }
        Ok(Self {
            rows,
            path,
            read_count: ReadCount::default(),
        })
    }
}

impl<R: Read> ReadPath for PathReader<R> {
    fn read_count(&self) -> &ReadCount {
        &self.read_count
    }

    fn read_count_mut(&mut self) -> &mut ReadCount {
        &mut self.read_count
    }

    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut record = csv::StringRecord::new();
        let read = self.rows.read_record(&mut record);
        if !read.map_err(|error| from_csv(&self.path, error))? {
            return Ok(None);
        }
        let line = record.position().map_or(0, csv::Position::line);
        let row: Row = record
            .deserialize(None)
            .map_err(|error| from_csv_at(&self.path, line, error))?;
        let wrong = |what: String| ReadError::Line {
            path: self.path.clone(),
            line,
            what,
        };
        let section = row
            .section()
            .ok_or_else(|| wrong("the section must be 0, 1 or 2".to_owned()))?;
        let point = row.point();
        check(self.read_count.last(), &point, section).map_err(wrong)?;
        self.read_count.add(point, section);
        Ok(Some((point, section)))
    }
}

fn check(
    last: Option<&(ControlPoint, Section)>,
    point: &ControlPoint,
    section: Section,
) -> Result<(), String> {
    check_numbers(point)?;
    if last.is_some_and(|(_, last_section)| section < *last_section) {
        return Err("the sections must come in the order 0, 1, 2".to_owned());
    }
    if let Some((before, _)) = last.filter(|(before, _)| point.t <= before.t) {
        return Err(format!(
            "the time {:?} s is not after {:?} s",
            point.t, before.t
        ));
    }
    check_velocities(point)?;
    check_turn(last, point, section)
}

/// Checks that each value is a finite number, and that the time is not absurdly large.
fn check_numbers(point: &ControlPoint) -> Result<(), String> {
    let &ControlPoint {
        t,
        c,
        x,
        z,
        vc,
        vx,
        vz,
    } = point;
    for (name, value) in HEADER.iter().zip([t, c, x, z, vc, vx, vz]) {
        if !value.is_finite() {
            return Err(format!("{name} is not a finite number"));
        }
    }
    if t.abs() > LATEST {
        return Err(format!("time_s is {t:e} s, longer than any machine runs"));
    }
    Ok(())
}

fn from_csv(path: &Path, error: csv::Error) -> ReadError {
    let line = error.position().map_or(1, csv::Position::line);
    from_csv_at(path, line, error)
}

fn from_csv_at(path: &Path, line: u64, error: csv::Error) -> ReadError {
    let path = path.to_owned();
    let text = error.to_string();
    let what = match error.into_kind() {
        csv::ErrorKind::Io(error) => return ReadError::File { path, error },
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => {
            let are = if len == 1 {
                "is 1 value"
            } else {
                &format!("are {len} values")
            };
            format!("there {are}, not {expected_len}")
        }
        csv::ErrorKind::Deserialize { err, .. } => {
            let column = err.field().and_then(|field| HEADER.get(field as usize));
            format!("{}: {}", column.unwrap_or(&"row"), err.kind())
        }
        csv::ErrorKind::Utf8 { .. } => {
            "this is not UTF-8 text; of compressed files, programs with `.zst` behind their ending are read"
                .to_owned()
        }
        _ => text,
    };
    ReadError::Line { path, line, what }
}
