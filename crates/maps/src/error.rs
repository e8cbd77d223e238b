//! Why a file is no map.

use std::borrow::Cow;
use std::fmt;

use crate::limits::{LARGEST_LENGTH, LEAST_PITCH, LEAST_POINTS, MOST_POINTS};

/// Why a file could not be read as a map, and where in the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}{problem}")]
pub struct MapError {
    /// The place.
    pub place: Place,
    /// What is wrong.
    #[source]
    pub problem: MapProblem,
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
        }
    }
}

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapProblem {
    /// Neither the name nor the first bytes tell the format.
    #[error("the format is unknown: give `format`")]
    NoFormat,
    /// A text is no text.
    #[error("this is not a text")]
    NoText,
    /// The last line has no end.
    #[error(
        "the file ends within this line, so digits may be missing: if it is whole, end the line"
    )]
    CutOff,
    /// The header does not begin as the format wants it.
    #[error("{0}")]
    Header(Cow<'static, str>),
    /// What stands there is no number, or not one that may stand there.
    #[error("`{found}` is no {wanted}")]
    NoNumber {
        /// The text, shortened.
        found: String,
        /// What should be there.
        wanted: &'static str,
    },
    /// A line has too few or too many numbers.
    #[error("the line has {found} numbers in place of {wanted}")]
    Columns {
        /// How many it has.
        found: usize,
        /// How many it should have.
        wanted: &'static str,
    },
    /// The flag for the units is not one of the format's.
    #[error("the flag of the units is {flag}: 0 is mm, 1 cm, 2 in, 3 m")]
    UnitFlag {
        /// The flag, as the file has it.
        flag: String,
    },
    /// The name of a unit is unknown.
    #[error("the unit `{name}` is unknown: m, cm, mm, um, nm and in are known; or give `{param}`")]
    UnitName {
        /// The name, as the file has it.
        name: String,
        /// The parameter that goes before it.
        param: &'static str,
    },
    /// The file does not say its unit.
    #[error("the file does not say its unit: give `{which}`")]
    NoUnit {
        /// The parameter.
        which: &'static str,
    },
    /// The format fixes the unit.
    #[error("the file itself fixes this unit: leave `{which}` out")]
    OwnUnit {
        /// The parameter.
        which: &'static str,
    },
    /// The file does not say how far its points are apart.
    #[error("the file does not say how far its points are apart: give `pitch_x` and `pitch_y`")]
    NoPitch,
    /// The distance of points is no distance.
    #[error(
        "the distance of neighbouring points is {} mm; it lies between {LEAST_PITCH:e} and {LARGEST_LENGTH:e} mm", Short(*.pitch)
    )]
    Pitch {
        /// The distance, mm.
        pitch: f64,
    },
    /// A height or a place that no part has.
    #[error("a length of {} mm is not that of a part; the largest is {LARGEST_LENGTH:e} mm", Short(*.length))]
    Length {
        /// The length, mm.
        length: f64,
    },
    /// The grid is too small.
    #[error(
        "the grid has {columns} × {rows} points; a map has {LEAST_POINTS} × {LEAST_POINTS} at the least"
    )]
    TooFew {
        /// Points along x.
        columns: usize,
        /// Points along y.
        rows: usize,
    },
    /// The grid is too large.
    #[error("the grid has {columns} × {rows} points; a map may have {MOST_POINTS}")]
    TooMany {
        /// Points along x.
        columns: usize,
        /// Points along y.
        rows: usize,
    },
    /// The file ends before all of its points.
    #[error("the file has {found} points, and its grid has {wanted}")]
    TooShort {
        /// Points in the file.
        found: usize,
        /// Points of the grid.
        wanted: usize,
    },
    /// The file goes on after all of its points.
    #[error("the file goes on after the {wanted} points of its grid")]
    TooLong {
        /// Points of the grid.
        wanted: usize,
    },
    /// The points lie on no regular grid.
    #[error("the points lie on no regular grid: {0}")]
    Uneven(Cow<'static, str>),
    /// A point is there twice.
    #[error("this place has a height already")]
    Twice,
    /// No point has a height.
    #[error("no point of the map has a height")]
    NoPoints,
}

/// A number with six digits at the most, for messages.
pub(crate) struct Short(pub(crate) f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = format!("{:.5e}", self.0);
        let short = digits.parse().unwrap_or(self.0);
        match short != 0.0 && !(1e-5..1e7).contains(&f64::abs(short)) {
            true => write!(f, "{short:e}"),
            false => write!(f, "{short}"),
        }
    }
}

impl MapError {
    pub(crate) fn of_file(problem: MapProblem) -> Self {
        let place = Place::File;
        Self { place, problem }
    }

    pub(crate) fn at_line(line: usize, problem: MapProblem) -> Self {
        let place = Place::Line(line);
        Self { place, problem }
    }

    pub(crate) fn at_byte(byte: usize, problem: MapProblem) -> Self {
        let place = Place::Byte(byte);
        Self { place, problem }
    }

    /// The same error at a place of the file, where it is one of a pitch that the file has.
    pub(crate) fn placed(self, place: Place) -> Self {
        match self.problem {
            MapProblem::Pitch { .. } => Self { place, ..self },
            _ => self,
        }
    }

    pub(crate) fn header(line: usize, message: impl Into<Cow<'static, str>>) -> Self {
        Self::at_line(line, MapProblem::Header(message.into()))
    }
}
