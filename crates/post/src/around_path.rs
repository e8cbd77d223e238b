//! What stands in a program before its path and behind it: the lines that no reader of paths judges.

use std::io::Read;
use std::path::Path;

use turnpath_core::toolpath::Section;

use crate::compression::Compression;
use crate::layout::{Layout, open_file};
use crate::lines::LineReader;
use crate::program_format::{APPROACH_MARK, DEPTHS_MARK, END_MARK, mark, says_parts};
use crate::read_error::ReadError;

/// Longest piece of a line, bytes: a longer line is taken in pieces.
const LONGEST_PIECE: usize = 1 << 16;

/// Header and footer of a program, as its file has them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AroundPath {
    /// The lines before the first mark of the path.
    pub header: String,
    /// The lines behind its end mark.
    pub footer: String,
    /// How many lines of the file stand before the footer.
    pub before_footer: u64,
}

/// Where the reader is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Header,
    Path,
    Footer,
}

impl Layout {
    /// Header and footer of the program in the file at `path`, which was read as one.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn around_path(&self, path: &Path) -> Result<AroundPath, ReadError> {
        let file = open_file(Compression::of_file(path), path).map_err(ReadError::of(path))?;
        self.around_path_in(file, path)
    }

    /// The same from any text.
    pub(crate) fn around_path_in(
        &self,
        text: impl Read,
        path: &Path,
    ) -> Result<AroundPath, ReadError> {
        let grammar = self.post.dialect.grammar(&self.format);
        let mut lines = LineReader::new(text);
        let (mut around, mut place) = (AroundPath::default(), Place::Header);
        while let Some(line) = lines
            .next_line(LONGEST_PIECE)
            .map_err(ReadError::of(path))?
        {
            let buffer = lines.lend();
            let text = buffer.get(line).unwrap_or_default();
            around.before_footer += u64::from(place != Place::Footer);
            let (_, comment) = grammar.split_comment(text);
            let next = comment.and_then(|comment| place.behind(comment));
            match (next, place) {
                (Some(next), _) => place = next,
                (None, Place::Header) => around.header += &String::from_utf8_lossy(text),
                (None, Place::Footer) => around.footer += &String::from_utf8_lossy(text),
                (None, Place::Path) => {}
            }
            lines.take_back(buffer);
        }
        Ok(around)
    }
}

impl Place {
    /// Where the reader is behind a comment that is a mark; `None` for any other comment.
    fn behind(self, comment: &[u8]) -> Option<Self> {
        let text = String::from_utf8_lossy(comment).trim().to_ascii_lowercase();
        match self {
            Self::Header => is_first_mark(&text).then_some(Self::Path),
            Self::Path => text.starts_with(END_MARK).then_some(Self::Footer),
            Self::Footer => None,
        }
    }
}

/// Whether a program may begin its path with this mark.
fn is_first_mark(text: &str) -> bool {
    let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut].map(mark);
    let around = [DEPTHS_MARK, APPROACH_MARK];
    sections.contains(&text) || around.contains(&text) || says_parts(text).is_some()
}
