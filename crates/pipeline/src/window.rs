//! The nodes that a velocity solver sees of a block and its neighbours.

use std::ops::Range;

use crate::columns::Columns;
use crate::plan::Plan;

/// The nodes of a block, on the locus.
#[derive(Default)]
pub struct NodeBlock {
    /// Which sampler segment each segment of the block is a part of.
    pub owner: Vec<u32>,
    /// How many nodes the sampler placed, the path's last point included.
    pub placed: usize,
    /// The nodes. A neighbour of the blocks that are made has only the nodes next to them here; its other fields
    /// are those of the whole block.
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
    /// The number of the block.
    pub index: usize,
    /// As [`NodeBlock`] has them.
    pub owner: Vec<u32>,
    /// As [`NodeBlock`] has it.
    pub placed: usize,
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
    /// The nodes of the blocks up to number `end`, each with the joint with the next block and with no
    /// other neighbour. They stay where they are in memory.
    pub fn into_windows(self, plan: &Plan<'_>, end: usize) -> Vec<Window> {
        let is_rest = self.first + self.blocks.len() == plan.blocks();
        let first_nodes = self.blocks.iter().map(|block| block.columns.node(0));
        let first_nodes: Vec<Option<[f64; 9]>> = first_nodes.collect();
        let mut behind: usize = self.blocks.iter().map(|block| block.columns.len()).sum();
        let mut is_first = self.first == 0;
        let blocks = self.blocks.into_iter().enumerate();
        let window = |(at, block): (usize, NodeBlock)| {
            let NodeBlock {
                owner,
                placed,
                mut columns,
            } = block;
            let own = 0..columns.len();
            behind -= own.end;
            let joint = first_nodes[at + 1..].iter().flatten().next();
            joint.into_iter().for_each(|node| columns.push(*node));
            let at_start = is_first;
            is_first &= own.is_empty();
            Window {
                index: self.first + at,
                owner,
                placed,
                columns,
                own,
                at_start,
                at_end: is_rest && behind <= 1,
            }
        };
        blocks.take(end - self.first).map(window).collect()
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
        let (owner, placed) = rest
            .first()
            .map_or((Vec::new(), 0), |block| (block.owner.clone(), block.placed));
        Window {
            index,
            owner,
            placed,
            columns,
            own: own.start - window.start..own.end - window.start,
            at_start: self.first == 0 && window.start == 0,
            at_end: self.first + self.blocks.len() == plan.blocks() && window.end == all,
        }
    }
}
