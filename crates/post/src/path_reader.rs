//! The common part of the readers of all files: they give points one by one, or in blocks.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};

use crate::read_error::ReadError;

/// How many points a reader has read.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReadCount {
    last: Option<(ControlPoint, Section)>,
    /// A segment that was read and belongs to the next block.
    pending: Option<ReadSegment>,
    points: u64,
    cutting_points: u64,
}

impl ReadCount {
    /// Counts one more point.
    pub(crate) fn add(&mut self, point: ControlPoint, section: Section) {
        self.last = Some((point, section));
        self.points += 1;
        self.cutting_points += u64::from(section == Section::Cutting);
    }

    /// The last point that was read, and its section.
    pub fn last(&self) -> Option<&(ControlPoint, Section)> {
        self.last.as_ref()
    }

    /// Points read so far, of all sections.
    pub fn points(&self) -> u64 {
        self.points
    }

    /// Points of the cutting section read so far.
    pub fn cutting_points(&self) -> u64 {
        self.cutting_points
    }
}

/// Most points for which a block has room from the beginning: a caller may ask for more than there are.
const MOST_ROOM: usize = 1 << 15;

/// The segment between two neighbouring points, and its section.
#[derive(Debug, Clone, Copy)]
struct ReadSegment {
    from: ControlPoint,
    to: ControlPoint,
    section: Section,
}

impl ReadSegment {
    /// A segment belongs to the cutting section only if both its points do: the lead-in reaches to
    /// the first cutting point, and the lead-out begins at the last.
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

/// A path that is read point by point, from a file or from memory.
pub trait ReadPath {
    /// The next control point; `None` at the end.
    ///
    /// # Errors
    /// When the file cannot be read or is damaged.
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError>;

    /// How many points were read so far.
    fn read_count(&self) -> &ReadCount;

    /// The same count, mutable.
    fn read_count_mut(&mut self) -> &mut ReadCount;

    /// The parts that a main program has called so far: the names of their files, which lie beside its own.
    fn parts(&self) -> &[String] {
        &[]
    }

    /// The next segments of one section, at most `most` of them: the section, and the control points
    /// of the segments. A block begins with the last point of the previous block. The segment
    /// between a lead and the cutting section belongs to the lead. `None` at the end.
    ///
    /// # Errors
    /// As [`ReadPath::next_point`].
    fn next_block(&mut self, most: usize) -> Result<Option<(Section, PathBlock)>, ReadError> {
        let Some(first) = next_segment(self)? else {
            return Ok(None);
        };
        let section = first.section;
        let mut block = PathBlock::with_capacity(most.saturating_add(1).min(MOST_ROOM));
        block.push(first.from);
        block.push(first.to);
        while block.len() <= most {
            let last = self.read_count().last().copied();
            let Some(next) = self.next_point()? else {
                break;
            };
            // Nearly all points are within the section, and need no segment.
            let across = last.filter(|last| [last.1, next.1] != [section; 2]);
            let segment = across.map(|last| ReadSegment::new(last, next));
            if let Some(segment) = segment.filter(|segment| segment.section != section) {
                self.read_count_mut().pending = Some(segment);
                break;
            }
            block.push(next.0);
        }
        Ok(Some((section, block)))
    }
}

/// The next segment: the pending one, or else the one to the next point.
fn next_segment<R: ReadPath + ?Sized>(reader: &mut R) -> Result<Option<ReadSegment>, ReadError> {
    if let Some(pending) = reader.read_count_mut().pending.take() {
        return Ok(Some(pending));
    }
    loop {
        let from = reader.read_count().last().copied();
        let Some(to) = reader.next_point()? else {
            return Ok(None);
        };
        if let Some(from) = from {
            return Ok(Some(ReadSegment::new(from, to)));
        }
    }
}
