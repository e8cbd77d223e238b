//! The proof that a whole program of one file is read as the text whose path was measured.
//!
//! A reader gives no line before the first mark to its grammar, and reads nothing behind the end mark. So behind
//! a header of whole lines without a mark it is in the state in which it began, and from there on the same bytes
//! give it the same points. What is left to prove is that the file has these bytes, as it is read.

use std::io::{self, BufReader, Cursor, Read, Write};
use std::path::Path;

use turnpath_files::Draft;

use crate::compression::Compression;
use crate::layout::{Layout, open_file};
use crate::read_error::ReadError;
use crate::text_file::{self, file_bytes};

/// Size of the pieces that are compared, bytes.
const BUFFER: usize = 1 << 18;

/// A program of one file that still lacks its name.
#[derive(Debug)]
pub struct WholeProgram<T> {
    pub(crate) file: Draft,
    pub(crate) header: String,
    /// The text whose path was measured, from its beginning; `None` where the file has it as it is. It was
    /// then compared as it was copied, and the file is compared with what was written to it when it gets
    /// its name.
    pub(crate) text: Option<T>,
    pub(crate) footer: String,
    pub(crate) layout: Layout,
}

impl<T: Read> WholeProgram<T> {
    /// The file, as soon as it is proven that it is read as the text whose path was measured.
    ///
    /// # Errors
    /// When the file cannot be read or holds anything else, or when header or footer change what is read.
    pub fn prove(mut self) -> Result<Draft, ReadError> {
        let name = self.file.path().to_owned();
        let around = [self.header.as_str(), &self.footer];
        check_around(&self.layout, &name, around)?;
        let Some(text) = self.text else {
            return Ok(self.file);
        };
        let place = self.file.readable().map_err(|error| ReadError::File {
            path: error.path,
            error: error.error,
        })?;
        let file = open_file(Compression::of_file(&name), place);
        compare(&name, (file, text), around)?;
        Ok(self.file)
    }
}

/// The file `name` of a program in memory, with the same proof.
pub(crate) fn prove_in_memory(
    layout: &Layout,
    name: &str,
    text: &[u8],
    [header, footer]: [&str; 2],
) -> Result<Vec<u8>, ReadError> {
    let path = Path::new(name);
    let program = [header.as_bytes(), text, footer.as_bytes()].concat();
    let bytes = file_bytes(name, program).map_err(ReadError::of(path))?;
    let file = text_file::open(Compression::of_file(path), Cursor::new(bytes.clone()));
    check_around(layout, path, [header, footer])?;
    compare(path, (file, text), [header, footer])?;
    Ok(bytes)
}

/// Refuses a header or a footer that changes what is read.
fn check_around(
    layout: &Layout,
    name: &Path,
    [header, footer]: [&str; 2],
) -> Result<(), ReadError> {
    layout.read(header.as_bytes(), name).pass_header()?;
    layout.read(footer.as_bytes(), name).pass_footer()
}

/// Compares the program `name`, which `file` reads, with the text between header and footer.
fn compare(
    name: &Path,
    (file, text): (io::Result<impl Read>, impl Read),
    [header, footer]: [&str; 2],
) -> Result<(), ReadError> {
    let expected = header.as_bytes().chain(text).chain(footer.as_bytes());
    let compared = file.and_then(|file| refuse_other_bytes(file, expected));
    compared.map_err(ReadError::of(name))
}

/// Refuses lines whose sum is not that of the lines that were measured.
pub(crate) fn refuse_other_lines(measured: u128, copied: u128) -> io::Result<()> {
    match measured == copied {
        true => Ok(()),
        false => Err(other_bytes()),
    }
}

/// Reads a file to its end, and refuses it unless it has these bytes and no others.
fn refuse_other_bytes(file: impl Read, expected: impl Read) -> io::Result<()> {
    let mut expected = BufReader::with_capacity(BUFFER, expected);
    let mut compared = ComparedFile {
        file,
        found: Vec::new(),
    };
    io::copy(&mut expected, &mut compared)?;
    compared.found.clear();
    let mut rest = compared.file.take(1);
    match rest.read_to_end(&mut compared.found)? {
        0 => Ok(()),
        _ => Err(other_bytes()),
    }
}

/// A file that is read beside the bytes that it must have.
struct ComparedFile<F> {
    file: F,
    found: Vec<u8>,
}

impl<F: Read> Write for ComparedFile<F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.found.resize(bytes.len(), 0);
        match self.file.read_exact(&mut self.found) {
            Ok(()) if self.found == bytes => Ok(bytes.len()),
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => Err(error),
            _ => Err(other_bytes()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn other_bytes() -> io::Error {
    let what = "it does not hold the lines that were measured, between its header and its footer";
    io::Error::new(io::ErrorKind::InvalidData, what)
}
