//! Writes `toolpath.npz`: an array for each column, as numpy's `load` opens them.
//!
//! A zip file without compression has a `.npy` for each array: a magic number, a version, the length of
//! a header, the header as a literal of Python, and the numbers. Format: numpy, `numpy.lib.format`,
//! version 1.0. The length of an array stands before its numbers, so each column waits in a file without
//! a name until the path is complete. Memory does not grow with the path.

use std::io::{self, Write};

use turnpath_files::{Draft, FileError, Scratch};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::columns::{Columns, WriteColumns};
use crate::row::HEADER;

/// What a `.npy` of version 1.0 begins with.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// The numbers of a `.npy` begin at a multiple of this.
const ALIGNMENT: usize = 64;

/// Writes the file.
pub(crate) struct NpzWriter {
    draft: Draft,
    /// A column each, in the order of [`HEADER`].
    columns: Vec<Scratch>,
    rows: u64,
}

impl NpzWriter {
    /// Begins the file that the draft will be.
    pub(crate) fn begin(draft: Draft) -> Result<Self, FileError> {
        let scratch = |_: &&str| Scratch::in_folder(draft.folder());
        let columns: io::Result<Vec<Scratch>> = HEADER.iter().map(scratch).collect();
        let columns = columns.map_err(FileError::of(draft.path()))?;
        Ok(Self {
            draft,
            columns,
            rows: 0,
        })
    }
}

impl WriteColumns for NpzWriter {
    fn append(&mut self, columns: &Columns) -> io::Result<()> {
        let (numbers, sections) = (&columns.numbers, &columns.sections);
        for (scratch, column) in self.columns.iter_mut().zip(numbers) {
            let bytes: Vec<u8> = column.iter().flat_map(|v| v.to_le_bytes()).collect();
            scratch.write_all(&bytes)?;
        }
        if let Some(last) = self.columns.last_mut() {
            last.write_all(sections)?;
        }
        self.rows += sections.len() as u64;
        Ok(())
    }

    fn whole(self: Box<Self>) -> Result<Draft, FileError> {
        let Self {
            draft,
            columns,
            rows,
        } = *self;
        let path = draft.path().to_owned();
        let write = || -> io::Result<Draft> {
            let mut archive = ZipWriter::new_stream(draft);
            let stored = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .large_file(true);
            for (name, column) in HEADER.into_iter().zip(columns) {
                let kind = if name == "section" { "|u1" } else { "<f8" };
                archive.start_file(format!("{name}.npy"), stored)?;
                archive.write_all(&npy_header(kind, rows))?;
                io::copy(&mut column.into_reader()?, &mut archive)?;
            }
            Ok(archive.finish()?.into_inner())
        };
        write().map_err(FileError::of(&path))
    }
}

/// What stands before the numbers of an array.
fn npy_header(kind: &str, rows: u64) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows},), }}");
    let before = MAGIC.len() + size_of::<u16>();
    while !(before + header.len() + 1).is_multiple_of(ALIGNMENT) {
        header.push(' ');
    }
    header.push('\n');
    let length = (header.len() as u16).to_le_bytes();
    [MAGIC, &length, header.as_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_an_array_begin_where_numpy_expects_them() {
        for rows in [0, 7, u64::MAX] {
            let header = npy_header("<f8", rows);
            assert_eq!(header.len() % ALIGNMENT, 0);
            assert_eq!(
                usize::from(header[8]) + 256 * usize::from(header[9]) + 10,
                header.len()
            );
            assert_eq!(header.last(), Some(&b'\n'));
        }
    }
}
