//! What the readers of all files have in common: points one after the other, and blocks of them.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};

use crate::ReadError;

/// How far a reader is.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counted {
    last: Option<(ControlPoint, Section)>,
    /// The segment that was read and belongs to the next block.
    kept: Option<Between>,
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

/// What lies between two neighbouring points.
#[derive(Debug, Clone, Copy)]
struct Between {
    from: ControlPoint,
    to: ControlPoint,
    section: Section,
}

impl Between {
    /// Only what lies between two cutting points is cut: the lead-in goes on to the first of
    /// them, the lead-out begins at the last.
    fn new(from: (ControlPoint, Section), to: (ControlPoint, Section)) -> Self {
        let section = match to.1 {
            Section::LeadOut => Section::LeadOut,
            Section::LeadIn | Section::Cutting => from.1,
        };
        Self {
            from: from.0,
            to: to.0,
            section,
        }
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

    /// The same, to be changed.
    fn counted_mut(&mut self) -> &mut Counted;

    /// The next segments of one section, `most` of them or fewer, as the control points that they
    /// lie between, and the section: a block begins with the point that the one before ended with.
    /// What joins a lead to the cut belongs to the lead. `None` at the end.
    ///
    /// # Errors
    /// As [`ReadPath::next_point`].
    fn next_block(&mut self, most: usize) -> Result<Option<(Section, PathBlock)>, ReadError> {
        let mut block = PathBlock::default();
        let mut section = None;
        while block.len() <= most {
            let Some(between) = next_between(self)? else {
                break;
            };
            if section.is_some_and(|section| section != between.section) {
                self.counted_mut().kept = Some(between);
                break;
            }
            if section.replace(between.section).is_none() {
                block.push(between.from);
            }
            block.push(between.to);
        }
        Ok(section.map(|section| (section, block)))
    }
}

/// The next segment: that which was kept, or one to the next point.
fn next_between<R: ReadPath + ?Sized>(reader: &mut R) -> Result<Option<Between>, ReadError> {
    if let Some(kept) = reader.counted_mut().kept.take() {
        return Ok(Some(kept));
    }
    loop {
        let from = reader.counted().last().copied();
        let Some(to) = reader.next_point()? else {
            return Ok(None);
        };
        if let Some(from) = from {
            return Ok(Some(Between::new(from, to)));
        }
    }
}
