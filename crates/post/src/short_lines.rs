//! A file that is given up where a line does not end: what is no table does not fill the memory.

use std::fs::File;
use std::io::{self, Read};

/// Longest line that is read, bytes: far beyond any of a tool path.
const LONGEST_LINE: usize = 1 << 16;

/// Reads a file as long as its lines end.
pub(crate) struct ShortLines {
    file: File,
    /// Bytes since the last line's end.
    open: usize,
}

impl ShortLines {
    pub(crate) fn of(file: File) -> Self {
        Self { file, open: 0 }
    }
}

impl Read for ShortLines {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        let bytes = buffer.get(..read).unwrap_or_default();
        self.open = match bytes.iter().rposition(|byte| *byte == b'\n') {
            Some(end) => read - end - 1,
            None => self.open + read,
        };
        if self.open > LONGEST_LINE {
            return Err(io::Error::other("a line is longer than any of a tool path"));
        }
        Ok(read)
    }
}
