//! The nodes that a velocity solver sees of a block and its neighbours.

use std::ops::Range;

use crate::columns::Columns;
use crate::plan::Plan;

/// The nodes of a block, on the locus.
#[derive(Default)]
pub struct NodeBlock {
    /// Which sampler segment each node's segment is a part of.
    pub owner: Vec<u32>,
    /// How many nodes the sampler placed, the path's last point included.
    pub sampled: usize,
    /// The nodes.
    pub columns: Columns,
}

/// Neighbouring blocks of nodes, from block number `first` on.
pub struct NodeRow {
    /// The number of the first block.
    pub first: usize,
    /// The blocks.
    pub blocks: Vec<NodeBlock>,
}

/// The nodes that a velocity solver gets for one block.
pub struct Window {
    /// All nodes.
    pub columns: Columns,
    /// Which of them are the block's own.
    pub own: Range<usize>,
    /// Whether the first node is the path's first.
    pub at_start: bool,
    /// Whether the last node is the path's last.
    pub at_end: bool,
}

impl NodeRow {
    /// The block of that number, if the row has it.
    pub fn get(&self, index: usize) -> Option<&NodeBlock> {
        self.blocks.get(index.checked_sub(self.first)?)
    }

    /// The nodes of a block, with `overlap` nodes of its neighbours on either side, and with the
    /// joint with the next block.
    pub fn window(&self, plan: &Plan<'_>, index: usize, overlap: usize) -> Window {
        let length = |block: &NodeBlock| block.columns.len();
        let (before, rest) = self.blocks.split_at(index - self.first);
        let skipped: usize = before.iter().map(length).sum();
        let all: usize = skipped + rest.iter().map(length).sum::<usize>();
        let own = skipped..skipped + rest.first().map_or(0, length);
        let window = own.start.saturating_sub(overlap)..(own.end + overlap + 1).min(all);
        let mut columns = Columns::default();
        let mut start = 0;
        for block in &self.blocks {
            let end = start + length(block);
            let (from, to) = (window.start.max(start), window.end.min(end));
            if from < to {
                columns.append(&block.columns, from - start..to - start);
            }
            start = end;
        }
        Window {
            columns,
            own: own.start - window.start..own.end - window.start,
            at_start: self.first == 0 && window.start == 0,
            at_end: self.first + self.blocks.len() == plan.blocks() && window.end == all,
        }
    }
}
