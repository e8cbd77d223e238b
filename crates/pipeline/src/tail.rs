//! The end of the path so far: what the next block of the path follows.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};

/// What comes before a block of the path.
pub struct BlockContext {
    /// The last two points before it, as far as there are any.
    before: Vec<ControlPoint>,
    opens_section: bool,
}

impl BlockContext {
    /// These points in this context.
    pub fn block<'a>(&'a self, section: Section, points: &'a PathBlock) -> SectionBlock<'a> {
        SectionBlock {
            section,
            opens_section: self.opens_section,
            before: &self.before,
            points,
        }
    }
}

/// The last two points of the path so far, and its last section.
#[derive(Default)]
pub struct PathTail {
    points: Vec<ControlPoint>,
    section: Option<Section>,
}

impl PathTail {
    /// Adds the first `own` of these points to the path, and gives what comes before them.
    pub fn extend(&mut self, section: Section, points: &PathBlock, own: usize) -> BlockContext {
        let before = self.points.clone();
        let last = (own.saturating_sub(2)..own).filter_map(|index| points.get(index));
        self.points.extend(last);
        self.points.drain(..self.points.len().saturating_sub(2));
        let opens_section = self.section.replace(section) != Some(section);
        BlockContext {
            before,
            opens_section,
        }
    }

    /// The last two points so far.
    pub fn last_two(&self) -> Option<[ControlPoint; 2]> {
        self.points.as_slice().try_into().ok()
    }
}
