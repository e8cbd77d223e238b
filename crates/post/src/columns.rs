//! The columns of `toolpath.csv` as numbers, for files that hold columns.

use std::io;

use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_files::{Draft, FileError};

use crate::row::{NUMBERS, Row};

/// Files that hold the columns of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnFormat {
    /// Apache Parquet.
    Parquet,
    /// numpy's archive of arrays.
    Npz,
}

impl ColumnFormat {
    /// What the names of its files end with.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Parquet => "parquet",
            Self::Npz => "npz",
        }
    }

    /// Whether this build writes it.
    pub fn is_built_in(self) -> bool {
        match self {
            Self::Parquet => cfg!(feature = "parquet"),
            Self::Npz => cfg!(feature = "npz"),
        }
    }
}

/// Rows of a path, column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// The numbers of each row, in the units and the order of `toolpath.csv`.
    pub(crate) numbers: [Vec<f64>; NUMBERS],
    /// The section of each row.
    pub(crate) sections: Vec<u8>,
}

impl Columns {
    /// Those of some control points.
    pub fn of(section: Section, points: &PathBlock) -> Self {
        let mut columns = Self::default();
        for point in points.points() {
            let row = Row::new(&point, section);
            for (column, number) in columns.numbers.iter_mut().zip(row.numbers()) {
                column.push(number);
            }
        }
        columns.sections = vec![section as u8; points.len()];
        columns
    }
}

/// Writes the columns of a path into a file, as they come.
pub trait WriteColumns: Send {
    /// Appends rows.
    ///
    /// # Errors
    /// When they cannot be written.
    fn append(&mut self, columns: &Columns) -> io::Result<()>;

    /// The complete file, still without its name.
    ///
    /// # Errors
    /// When it cannot be written.
    fn whole(self: Box<Self>) -> Result<Draft, FileError>;
}
