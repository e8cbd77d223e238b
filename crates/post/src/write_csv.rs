//! Writes `toolpath.csv`.

use std::io::{self, Write};
use std::path::Path;

use turnpath_core::toolpath::{PathBlock, Section};
use turnpath_files::{Draft, FileError};

use crate::row::{HEADER, Row};

/// About how many bytes a row has.
const ROW_BYTES: usize = 140;

/// Writes `toolpath.csv` to a file or to memory.
///
/// ```
/// use turnpath_core::toolpath::{PathBlock, Section};
/// use turnpath_post::PathWriter;
///
/// let mut writer = PathWriter::in_memory();
/// writer.append(&PathWriter::rows(Section::Cutting, &PathBlock::default()))?;
/// assert!(writer.into_bytes().starts_with(b"time_s,c_deg,"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct PathWriter<W = Draft> {
    output: W,
}

impl PathWriter {
    /// Begins the file with its first line.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(mut output: Draft) -> Result<Self, FileError> {
        match output.write_all(first_line().as_bytes()) {
            Ok(()) => Ok(Self { output }),
            Err(error) => Err(FileError {
                path: output.path().to_owned(),
                error,
            }),
        }
    }

    /// Control points as rows. This needs no file, so several blocks can be formatted in parallel.
    pub fn rows(section: Section, points: &PathBlock) -> Vec<u8> {
        let end = format!("{}\n", section as u8);
        let mut rows = Vec::with_capacity(ROW_BYTES * points.len());
        let mut digits = zmij::Buffer::new();
        for point in points.points() {
            for number in Row::new(&point, section).numbers() {
                put(number, &mut digits, &mut rows);
                rows.push(b',');
            }
            rows.extend_from_slice(end.as_bytes());
        }
        rows
    }

    /// Everything written so far, as a file that can be read under a temporary name.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn readable(&mut self) -> Result<&Path, FileError> {
        self.output.readable()
    }

    /// The complete file, still without its name.
    pub fn whole(self) -> Draft {
        self.output
    }
}

impl PathWriter<Vec<u8>> {
    /// Begins in memory, with the first line.
    pub fn in_memory() -> Self {
        let output = first_line().into_bytes();
        Self { output }
    }

    /// The bytes of the whole file.
    pub fn into_bytes(self) -> Vec<u8> {
        self.output
    }
}

impl<W: Write> PathWriter<W> {
    /// Appends rows.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, rows: &[u8]) -> io::Result<()> {
        self.output.write_all(rows)
    }
}

/// From here on numbers have an exponent above zero.
const WITH_EXPONENT: f64 = 1e16;

/// Appends a number. The exponents of huge ones have no plus sign in this file.
fn put(number: f64, digits: &mut zmij::Buffer, row: &mut Vec<u8>) {
    let text = digits.format(number);
    if number.abs() < WITH_EXPONENT {
        row.extend_from_slice(text.as_bytes());
    } else {
        row.extend(text.bytes().filter(|byte| *byte != b'+'));
    }
}

fn first_line() -> String {
    format!("{}\n", HEADER.join(","))
}

#[cfg(test)]
mod tests {
    use turnpath_core::DEG;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    /// Numbers of every size, and numbers that are none.
    fn hard_numbers() -> Vec<f64> {
        let mut numbers = vec![0.0, -0.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, 0.1 + 0.2];
        numbers.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
        for power in -320..309 {
            let one: f64 = format!("1e{power}").parse().unwrap();
            numbers.extend([one, -one, 1.5 * one, one / 3.0]);
        }
        numbers.extend((1..2047_u64).map(|exponent| f64::from_bits(exponent << 52)));
        // Bits of a linear congruential generator.
        let mut bits = 1_u64;
        numbers.extend((0..20_000).map(|_| {
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        }));
        numbers
    }

    #[test]
    fn rows_are_those_of_the_crate_csv() {
        let mut points = PathBlock::default();
        for number in hard_numbers() {
            points.push(ControlPoint {
                t: number,
                c: number * DEG,
                x: -number,
                vz: number,
                ..ControlPoint::default()
            });
        }
        let mut writer = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
        for point in points.points() {
            writer
                .serialize(Row::new(&point, Section::LeadOut))
                .unwrap();
        }
        let wanted = String::from_utf8(writer.into_inner().unwrap()).unwrap();
        let found = String::from_utf8(PathWriter::rows(Section::LeadOut, &points)).unwrap();
        for (found, wanted) in found.lines().zip(wanted.lines()) {
            assert_eq!(found, wanted);
        }
        assert_eq!(found.len(), wanted.len());
    }
}
