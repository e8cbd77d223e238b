//! Which blocks of a path repeat the nodes and the halvings of which blocks of a sample.

/// The blocks of a sample, and those whose nodes and halvings are repeated.
#[derive(Debug)]
pub struct RepeatedBlocks {
    /// The blocks of the sample, in order. Each has its own nodes.
    chosen: Vec<usize>,
    /// The blocks whose nodes are repeated, in order.
    repeated: Vec<usize>,
    /// The blocks whose halvings are repeated, in order.
    halved: Vec<usize>,
}

impl RepeatedBlocks {
    /// Repeats blocks of a sample of a path of so many blocks. In place of the first and of the last one it is
    /// the block beside it: every sampler begins afresh in the first block, and the last one may be shorter than
    /// the others.
    pub fn of(chosen: &[usize], blocks: usize) -> Self {
        let most = blocks.saturating_sub(2).max(1);
        let beside = chosen.iter().map(|of| (*of).clamp(1, most));
        let mut repeated: Vec<usize> = beside.filter(|of| *of < blocks).collect();
        repeated.dedup();
        let halved = chosen.iter().filter(|of| **of + 1 < blocks).copied();
        Self {
            chosen: chosen.to_vec(),
            repeated,
            halved: halved.collect(),
        }
    }

    /// The blocks whose nodes are repeated.
    pub fn repeated(&self) -> &[usize] {
        &self.repeated
    }

    /// The block whose nodes a block has: a block of the sample its own, and another one those of the nearest
    /// block that is repeated.
    pub fn source(&self, index: usize) -> usize {
        if self.chosen.binary_search(&index).is_ok() {
            return index;
        }
        nearest(&self.repeated, index).unwrap_or(index)
    }

    /// The block whose segments are halved as often as those of a block: itself, if it is of the sample, else
    /// the nearest one of the sample, but not the path's last one.
    pub fn halved_as(&self, index: usize) -> usize {
        if self.chosen.binary_search(&index).is_ok() {
            return index;
        }
        nearest(&self.halved, index).unwrap_or(index)
    }
}

/// Of some blocks in order the nearest one.
fn nearest(blocks: &[usize], index: usize) -> Option<usize> {
    let behind = blocks.partition_point(|of| *of < index);
    let beside = blocks[behind.saturating_sub(1)..].iter().take(2);
    beside.min_by_key(|of| of.abs_diff(index)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_has_the_nodes_of_the_nearest_one_that_is_repeated() {
        let blocks = RepeatedBlocks::of(&[0, 4, 8], 9);
        let sources: Vec<usize> = (0..9).map(|index| blocks.source(index)).collect();
        assert_eq!(sources, [0, 1, 1, 4, 4, 4, 7, 7, 8]);
        let halved: Vec<usize> = (0..9).map(|index| blocks.halved_as(index)).collect();
        assert_eq!(halved, [0, 0, 0, 4, 4, 4, 4, 4, 8]);
    }

    #[test]
    fn no_other_block_has_the_nodes_of_the_first_or_of_the_last() {
        for count in 1..40_usize {
            let chosen: Vec<usize> = (0..count)
                .filter(|k| k % 5 == 0 || k + 1 == count)
                .collect();
            let blocks = RepeatedBlocks::of(&chosen, count);
            for index in 0..count {
                let source = blocks.source(index);
                match chosen.contains(&index) {
                    true => assert_eq!(source, index),
                    false => assert!(
                        (1..count - 1).contains(&source),
                        "{count} {index}: {source}"
                    ),
                }
            }
        }
    }
}
