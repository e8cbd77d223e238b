//! A path and its programs in memory.

use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_pipeline::{DraftSink, Sink};
use turnpath_post::{Lines, ProgramWriter};

use crate::posts::NotCarried;
use crate::program::Program;
use crate::toolpath::ToolPath;

/// Keeps a path as columns, and its programs as text.
pub struct MemorySink<'a> {
    programs: &'a [Program],
    /// A writer for each program.
    pub writers: Vec<ProgramWriter<Vec<u8>>>,
    /// The path so far.
    pub toolpath: ToolPath,
}

/// A block with its program lines.
pub struct MemoryBlock {
    section: Section,
    points: PathBlock,
    lines: Vec<Lines>,
}

impl<'a> MemorySink<'a> {
    /// Nothing yet.
    pub fn new(programs: &'a [Program]) -> Self {
        Self {
            programs,
            writers: programs.iter().map(begin).collect(),
            toolpath: ToolPath::default(),
        }
    }
}

fn begin(program: &Program) -> ProgramWriter<Vec<u8>> {
    ProgramWriter::in_memory(program.layout)
}

impl Sink for MemorySink<'_> {
    type Block = MemoryBlock;
    type Error = NotCarried;

    fn encode(&self, block: &SectionBlock<'_>) -> Result<MemoryBlock, NotCarried> {
        let lines = self.programs.iter().map(|program| program.lines(block));
        Ok(MemoryBlock {
            section: block.section,
            points: block.points.clone(),
            lines: lines.collect::<Result<_, _>>()?,
        })
    }

    fn take(&mut self, _: usize, block: MemoryBlock) -> Result<(), NotCarried> {
        self.toolpath.append(block.section, &block.points);
        for (writer, lines) in self.writers.iter_mut().zip(&block.lines) {
            // Memory takes all that it is given.
            let _ = writer.append(lines);
        }
        Ok(())
    }
}

impl DraftSink for MemorySink<'_> {
    fn drop_draft(&mut self) {
        *self = Self::new(self.programs);
    }
}
