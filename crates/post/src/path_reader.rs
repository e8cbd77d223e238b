//! What the readers of all files have in common: points one after the other, and blocks of them.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};

use crate::ReadError;

/// How far a reader is.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counted {
    last: Option<(ControlPoint, Section)>,
    count: u64,
    cutting: u64,
}

impl Counted {
    /// One more point was read.
    pub(crate) fn see(&mut self, point: ControlPoint, section: Section) {
        self.last = Some((point, section));
        self.count += 1;
        self.cutting += u64::from(section == Section::Cutting);
    }

    /// The last point.
    pub(crate) fn last(&self) -> Option<&(ControlPoint, Section)> {
        self.last.as_ref()
    }

    /// Points read so far.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Points of the cutting section so far.
    pub fn cutting(&self) -> u64 {
        self.cutting
    }
}

/// A path that is read from a file.
pub trait ReadPath {
    /// The next control point; `None` at the end.
    ///
    /// # Errors
    /// When the file cannot be read, or is not what it should be.
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError>;

    /// How far it is.
    fn counted(&self) -> &Counted;

    /// The next control points of the cutting section, about `most` of them. A block begins with
    /// the point that the one before ended with. `None` at the end.
    ///
    /// # Errors
    /// As [`ReadPath::next_point`].
    fn next_block(&mut self, most: usize) -> Result<Option<PathBlock>, ReadError> {
        let mut block = PathBlock::default();
        if let Some((last, Section::Cutting)) = self.counted().last() {
            block.push(*last);
        }
        let begun = block.len();
        while block.len() < most + begun {
            match self.next_point()? {
                Some((point, Section::Cutting)) => block.push(point),
                Some(_) => {}
                None => break,
            }
        }
        Ok((block.len() > begun).then_some(block))
    }
}
