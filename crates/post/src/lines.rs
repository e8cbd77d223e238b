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

/// Refuses what some controllers take for the end of a line or of a program, and others for a blank: control
/// characters other than tabs and the end of the line itself. A comment could hide a move behind one.
pub(crate) fn refuse_control_characters(line: &[u8]) -> Result<(), String> {
    let text = line.strip_suffix(b"\n").unwrap_or(line);
    let text = text.strip_suffix(b"\r").unwrap_or(text);
    let is_control = |byte: &&u8| byte.is_ascii_control() && **byte != b'\t';
    match text.iter().find(is_control) {
        None => Ok(()),
        Some(byte) => Err(format!(
            "the control character 0x{byte:02X} stands within this line: a controller may end the line there"
        )),
    }
}

/// Refuses blanks in code that are none to a controller, such as a no-break space.
pub(crate) fn refuse_other_blanks(code: &str) -> Result<(), String> {
    if code.is_ascii() {
        return Ok(());
    }
    let is_other = |c: &char| !c.is_ascii() && (c.is_whitespace() || c.is_control());
    match code.chars().find(is_other) {
        None => Ok(()),
        Some(c) => Err(format!(
            "the character U+{:04X} stands between the words of this line: no controller takes it for a blank",
            u32::from(c)
        )),
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
    fn only_tabs_and_line_ends_are_taken_of_the_control_characters() {
        for line in ["X1\tZ2\r\n", "X1\n", "X1\r", "; \u{e4}\n", ""] {
            assert_eq!(
                refuse_control_characters(line.as_bytes()),
                Ok(()),
                "{line:?}"
            );
        }
        for line in [
            "X1 ; ok\rZ-5\r\n",
            "X1\r\r\n",
            "X1\x0cZ2\n",
            "X1\x0b\n",
            "X1\x1a",
        ] {
            assert!(
                refuse_control_characters(line.as_bytes()).is_err(),
                "{line:?}"
            );
        }
    }

    #[test]
    fn blanks_beyond_ascii_are_refused() {
        assert_eq!(refuse_other_blanks("X1 Z2\t"), Ok(()));
        for blank in ['\u{a0}', '\u{85}', '\u{2028}', '\u{3000}'] {
            let refused = refuse_other_blanks(&format!("X1{blank}Z2"));
            assert!(refused.unwrap_err().contains("U+"));
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
