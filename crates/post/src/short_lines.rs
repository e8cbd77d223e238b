//! A reader that refuses a line without end, so that a file that is no table does not fill the memory.

use std::io::{self, Read};

/// Longest line that is read, bytes: far longer than any line of a tool path.
const LONGEST_LINE: usize = 1 << 16;

/// Reads from another reader as long as its lines are short.
pub(crate) struct ShortLines<R> {
    reader: R,
    /// Bytes since the end of the last line.
    since_line_end: usize,
}

impl<R> ShortLines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self {
            reader,
            since_line_end: 0,
        }
    }
}

impl<R: Read> Read for ShortLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(buffer)?;
        let bytes = buffer.get(..read).unwrap_or_default();
        self.since_line_end = match bytes.iter().rposition(|byte| *byte == b'\n') {
            Some(end) => read - end - 1,
            None => self.since_line_end + read,
        };
        if self.since_line_end > LONGEST_LINE {
            return Err(io::Error::other(
                "a line is longer than any line of a tool path",
            ));
        }
        Ok(read)
    }
}
