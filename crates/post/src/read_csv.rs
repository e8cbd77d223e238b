//! Reads `toolpath.csv`, and says at which line something is wrong.

use std::fs::File;
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::{ControlPoint, Section};

use crate::path_reader::{Counted, ReadPath};
use crate::row::{HEADER, Row};
use crate::short_lines::ShortLines;

/// Most degrees that C may turn between two rows: beyond, rows are missing.
const LARGEST_TURN_DEG: f64 = 360.0;
/// Largest C: half a year at 10⁴ rpm, and still known to a ten-thousandth of a degree.
/// Far beyond, sections of a turn could no longer be told apart.
const LARGEST_C_DEG: f64 = 1e12;
/// Largest time, s: three hundred thousand years.
const LATEST: f64 = 1e13;

/// Why a tool path could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// A line is not what it should be.
    #[error("{}, line {line}: {what}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// What is wrong.
        what: String,
    },
}

impl ReadError {
    /// The same of a file that goes by another name.
    pub fn named(mut self, name: &Path) -> Self {
        let (Self::File { path, .. } | Self::Line { path, .. }) = &mut self;
        *path = name.to_owned();
        self
    }
}

/// `toolpath.csv`, read block by block.
pub struct PathReader {
    rows: csv::Reader<ShortLines>,
    path: PathBuf,
    counted: Counted,
}

impl PathReader {
    /// Opens a file and checks its first line.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, ReadError> {
        let path = path.into();
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) => return Err(ReadError::File { path, error }),
        };
        // Numbers need no quotes, and one that does not end would take in all the lines behind it.
        let mut rows = csv::ReaderBuilder::new()
            .quoting(false)
            .trim(csv::Trim::All)
            .from_reader(ShortLines::of(file));
        let header = rows.headers().map_err(|error| of_csv(&path, &error))?;
        if !header.iter().eq(HEADER) {
            let what = format!(
                "this is not the header of a tool path, `{}`",
                HEADER.join(",")
            );
            return Err(ReadError::Line {
                path,
                line: 1,
                what,
            });
        }
        let counted = Counted::default();
        Ok(Self {
            rows,
            path,
            counted,
        })
    }
}

impl ReadPath for PathReader {
    fn counted(&self) -> &Counted {
        &self.counted
    }

    fn counted_mut(&mut self) -> &mut Counted {
        &mut self.counted
    }

    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut record = csv::StringRecord::new();
        let read = self.rows.read_record(&mut record);
        if !read.map_err(|error| of_csv(&self.path, &error))? {
            return Ok(None);
        }
        let line = record.position().map_or(0, csv::Position::line);
        let row: Row = record
            .deserialize(None)
            .map_err(|error| of_csv_at(&self.path, line, &error))?;
        let wrong = |what: String| ReadError::Line {
            path: self.path.clone(),
            line,
            what,
        };
        let section = row
            .section()
            .ok_or_else(|| wrong("the section must be 0, 1 or 2".to_owned()))?;
        let point = row.point();
        check(self.counted.last(), &point, section).map_err(wrong)?;
        self.counted.see(point, section);
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
    check_turn(last, point, section)
}

/// Each a number, and the time not beyond what any machine takes.
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
        return Err(format!(
            "time_s is {t:e} s, beyond all that a machine takes"
        ));
    }
    Ok(())
}

/// C must be an angle that a double can tell from its neighbours. While it cuts it must grow, and not
/// by more than rows that are missing would make it.
pub(crate) fn check_turn(
    last: Option<&(ControlPoint, Section)>,
    point: &ControlPoint,
    section: Section,
) -> Result<(), String> {
    let turn = last.map(|(last, _)| (point.c - last.c) / turnpath_core::DEG);
    let grows = |turn: f64| turn > 0.0 && turn <= LARGEST_TURN_DEG;
    if let Some(turn) = turn.filter(|turn| section == Section::Cutting && !grows(*turn)) {
        return Err(format!(
            "C turns by {turn:?} deg from the point before; it must grow, by 360 deg at the most"
        ));
    }
    let c = point.c / turnpath_core::DEG;
    if c.abs() > LARGEST_C_DEG {
        return Err(format!(
            "C = {c:e} deg is more than {LARGEST_C_DEG:e} deg, which no path turns"
        ));
    }
    Ok(())
}

fn of_csv(path: &Path, error: &csv::Error) -> ReadError {
    let line = error.position().map_or(1, csv::Position::line);
    of_csv_at(path, line, error)
}

fn of_csv_at(path: &Path, line: u64, error: &csv::Error) -> ReadError {
    let path = path.to_owned();
    let what = match error.kind() {
        csv::ErrorKind::Io(error) => {
            let error = std::io::Error::new(error.kind(), error.to_string());
            return ReadError::File { path, error };
        }
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => {
            let are = if *len == 1 {
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
        csv::ErrorKind::Utf8 { .. } => "this is no UTF-8 text".to_owned(),
        _ => error.to_string(),
    };
    ReadError::Line { path, line, what }
}
