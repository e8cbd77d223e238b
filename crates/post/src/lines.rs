//! The lines of a text, each as a piece of one large buffer.

use std::io::{self, Read};
use std::ops::Range;

use memchr::memchr;

/// Size of the buffer, bytes: far more than the longest line.
const BUFFER: usize = 1 << 18;

/// Gives lines one by one.
pub(crate) struct LineReader<R> {
    source: R,
    buffer: Vec<u8>,
    /// What was read from the source and not given yet.
    unread: Range<usize>,
}

impl<R: Read> LineReader<R> {
    pub(crate) fn new(source: R) -> Self {
        Self {
            source,
            buffer: vec![0; BUFFER],
            unread: 0..0,
        }
    }

    /// Where the next line is in the buffer, with its end; at the end of the text what is left, and then
    /// `None`. A line of more than `longest` bytes comes in pieces, each of which is at least that long.
    pub(crate) fn next_line(&mut self, longest: usize) -> io::Result<Option<Range<usize>>> {
        loop {
            let unread = &self.buffer[self.unread.clone()];
            if let Some(at) = memchr(b'\n', unread) {
                return Ok(Some(self.give(at + 1)));
            }
            let rest = unread.len();
            if rest >= longest || self.read_on()? == 0 {
                return Ok((rest > 0).then(|| self.give(rest)));
            }
        }
    }

    /// What was read from the source and not given yet: whole lines and the beginning of one.
    pub(crate) fn unread(&self) -> &[u8] {
        self.buffer.get(self.unread.clone()).unwrap_or_default()
    }

    /// Takes so many bytes of what is unread as given.
    pub(crate) fn pass(&mut self, bytes: usize) {
        self.give(bytes.min(self.unread.len()));
    }

    /// The buffer, which must be given back before the next line. So a line can be read while its reader
    /// changes.
    pub(crate) fn lend(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.buffer)
    }

    /// Takes the buffer back.
    pub(crate) fn take_back(&mut self, buffer: Vec<u8>) {
        self.buffer = buffer;
    }

    /// Reads the text to its end, or to `most` bytes; gives how many there were.
    pub(crate) fn pass_rest(&mut self, most: u64) -> io::Result<u64> {
        let known = self.give(self.unread.len()).len() as u64;
        let mut rest = (&mut self.source).take(most.saturating_sub(known));
        Ok(known + io::copy(&mut rest, &mut io::sink())?)
    }

    fn give(&mut self, count: usize) -> Range<usize> {
        let given = self.unread.start..self.unread.start + count;
        self.unread.start = given.end;
        given
    }

    /// Reads more from the source behind what is unread; gives how many bytes.
    fn read_on(&mut self) -> io::Result<usize> {
        self.buffer.copy_within(self.unread.clone(), 0);
        self.unread = 0..self.unread.len();
        loop {
            match self.source.read(&mut self.buffer[self.unread.end..]) {
                Ok(count) => {
                    self.unread.end += count;
                    return Ok(count);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives a few bytes at a time, and is interrupted between them.
    struct Trickle<'a>(&'a [u8], usize, bool);

    impl Read for Trickle<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.2 = !self.2;
            match self.2 {
                true => Err(io::ErrorKind::Interrupted.into()),
                false => (&mut self.0).take(self.1 as u64).read(buffer),
            }
        }
    }

    #[test]
    fn lines_are_whole_however_the_text_comes() {
        let long = vec![b'x'; BUFFER - 7];
        let text = [b"a\n\nbc\r\n", long.as_slice(), b"\nlast"].concat();
        let expected: Vec<&[u8]> = text.split_inclusive(|byte| *byte == b'\n').collect();
        for step in [1, 5, 1000, BUFFER, 3 * BUFFER] {
            let mut lines = LineReader::new(Trickle(&text, step, false));
            for line in &expected {
                let found = lines.next_line(BUFFER).unwrap().unwrap();
                let buffer = lines.lend();
                assert_eq!(&buffer[found], *line);
                lines.take_back(buffer);
            }
            assert!(lines.next_line(BUFFER).unwrap().is_none());
        }
    }

    #[test]
    fn a_line_that_is_too_long_comes_in_pieces_that_show_it() {
        let text = vec![b'x'; 3 * BUFFER];
        let mut lines = LineReader::new(text.as_slice());
        assert!(lines.next_line(BUFFER / 4).unwrap().unwrap().len() >= BUFFER / 4);
    }

    #[test]
    fn the_rest_is_counted_up_to_a_limit() {
        let text = b"line\nrest of it\n";
        for (most, count) in [(100, 11), (11, 11), (8, 11)] {
            let mut lines = LineReader::new(text.as_slice());
            lines.next_line(BUFFER).unwrap();
            assert_eq!(lines.pass_rest(most).unwrap(), count);
        }
        let mut lines = LineReader::new(text.as_slice());
        assert_eq!(lines.pass_rest(8).unwrap(), 8);
    }
}
