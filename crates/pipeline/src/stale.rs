//! Which sampler segments are played again after others were halved: those whose points see nodes of a halved one.
//! Any other segment would play as it did, so its state stays.

use turnpath_core::Dependence;

use crate::make::Depths;
use crate::segment_state::SegmentState;

/// The blocks of a path in which segments were just halved. The states of these segments are stale already.
pub struct HalvedPath<'a> {
    /// How often each sampler segment is halved. An empty list halves none.
    pub depths: &'a [Depths],
    /// The block whose halvings each block has: its own, if it is played.
    pub sources: &'a [usize],
    /// The played blocks in which segments were halved, in order.
    pub halved: &'a [usize],
}

/// A way along the path.
#[derive(Clone, Copy)]
enum Way {
    Forward,
    Backward,
}

impl HalvedPath<'_> {
    /// Makes the states stale that depend on those that are. A block that is not played has no states.
    pub fn spread_stale(&self, states: &mut [Vec<SegmentState>], dependence: Dependence) {
        match dependence {
            // The answer depends on the block alone, but may depend on all of it.
            Dependence::Local => {
                for index in self.halved {
                    states[*index].fill(SegmentState::Stale);
                }
            }
            Dependence::Overlap(overlap) => {
                let counts = self.counts(states);
                self.spread_along(Way::Forward, states, &counts, overlap);
                self.spread_along(Way::Backward, states, &counts, overlap);
            }
            Dependence::Sequential => {
                for states in states {
                    states.fill(SegmentState::Stale);
                }
            }
        }
    }

    /// How many nodes each block has.
    fn counts(&self, states: &[Vec<SegmentState>]) -> Vec<usize> {
        let count = |source: &usize| {
            let segments = 0..states[*source].len();
            segments.map(|segment| self.parts(*source, segment)).sum()
        };
        self.sources.iter().map(count).collect()
    }

    /// The parts of a sampler segment.
    fn parts(&self, block: usize, segment: usize) -> usize {
        1 << self.depths[block].get(segment).copied().unwrap_or(0)
    }

    /// Goes along the path. Each point sees `overlap` nodes behind it.
    fn spread_along(
        &self,
        way: Way,
        states: &mut [Vec<SegmentState>],
        counts: &[usize],
        overlap: usize,
    ) {
        let mut reach = 0_usize;
        for index in way.through(states.len()) {
            let source = self.sources[index];
            if source != index {
                // Some of its segments were halved, near its borders perhaps.
                reach = match self.halved.binary_search(&source) {
                    Ok(_) => overlap,
                    Err(_) => reach.saturating_sub(counts[index]),
                };
                continue;
            }
            for segment in way.through(states[index].len()) {
                let state = &mut states[index][segment];
                if *state == SegmentState::Stale {
                    reach = overlap;
                } else if reach > 0 {
                    *state = SegmentState::Stale;
                    reach = reach.saturating_sub(self.parts(index, segment));
                }
            }
        }
    }
}

impl Way {
    /// The numbers of so many things on this way.
    fn through(self, count: usize) -> impl Iterator<Item = usize> {
        (0..count).map(move |step| match self {
            Self::Forward => step,
            Self::Backward => count - 1 - step,
        })
    }
}

#[cfg(test)]
mod tests {
    use SegmentState::{Calm, Near, Stale};

    use super::*;

    /// What becomes of two blocks that are both played.
    fn spread(
        states: [&[SegmentState]; 2],
        depths: [&[u8]; 2],
        dependence: Dependence,
    ) -> Vec<Vec<SegmentState>> {
        let mut states = states.map(<[_]>::to_vec).to_vec();
        let path = HalvedPath {
            depths: &depths.map(<[_]>::to_vec),
            sources: &[0, 1],
            halved: &[1],
        };
        path.spread_stale(&mut states, dependence);
        states
    }

    const BEFORE: [&[SegmentState]; 2] = [
        &[Near, Calm, Near, Calm, Near],
        &[Stale, Near, Calm, Near, Calm],
    ];

    #[test]
    fn segments_within_the_overlap_of_a_halved_one_are_stale() {
        let none: [&[u8]; 2] = [&[], &[]];
        assert_eq!(
            spread(BEFORE, none, Dependence::Overlap(2)),
            [
                [Near, Calm, Near, Stale, Stale],
                [Stale, Stale, Stale, Near, Calm]
            ]
        );
        let all = spread(BEFORE, none, Dependence::Overlap(64));
        assert_eq!(all.concat(), [Stale; 10]);
        // Two of the segments have parts, each of which begins with a node.
        let depths: [&[u8]; 2] = [&[0, 0, 0, 0, 1], &[1, 2, 0, 0, 0]];
        assert_eq!(
            spread(BEFORE, depths, Dependence::Overlap(4)),
            [
                [Near, Calm, Stale, Stale, Stale],
                [Stale, Stale, Calm, Near, Calm]
            ]
        );
    }

    #[test]
    fn a_local_solver_makes_its_block_stale_and_a_sequential_one_the_path() {
        let none: [&[u8]; 2] = [&[], &[]];
        let local = spread(BEFORE, none, Dependence::Local);
        assert_eq!(local, [BEFORE[0], &[Stale; 5]]);
        let all = spread(BEFORE, none, Dependence::Sequential);
        assert_eq!(all.concat(), [Stale; 10]);
    }

    /// Blocks 0, 3 and 6 are played, and 1, 2 and 4, 5 repeat what is halved in 0, 3, 3 and 6.
    #[test]
    fn a_block_that_repeats_halvings_changes_with_its_source() {
        let spread = |overlap: usize, halved: usize, states: [&[SegmentState]; 3]| {
            let [first, middle, last] = states.map(<[_]>::to_vec);
            let mut states = vec![first, vec![], vec![], middle, vec![], vec![], last];
            let path = HalvedPath {
                depths: &[(); 7].map(|()| Depths::new()),
                sources: &[0, 0, 3, 3, 3, 6, 6],
                halved: &[halved],
            };
            path.spread_stale(&mut states, Dependence::Overlap(overlap));
            states.retain(|states| !states.is_empty());
            states
        };
        // Block 2 lies at three nodes from block 0, those of block 1.
        let in_middle: [&[SegmentState]; 3] = [&[Calm; 3], &[Near, Stale, Calm], &[Calm; 3]];
        assert_eq!(
            spread(1, 3, in_middle),
            [vec![Calm; 3], vec![Stale; 3], vec![Calm; 3]]
        );
        assert_eq!(
            spread(4, 3, in_middle),
            [
                vec![Calm, Calm, Stale],
                vec![Stale; 3],
                vec![Stale, Calm, Calm]
            ]
        );
        // Block 5 repeats block 6, and lies at three nodes from block 3.
        let at_end: [&[SegmentState]; 3] = [&[Calm; 3], &[Near; 3], &[Calm, Calm, Stale]];
        assert_eq!(
            spread(5, 6, at_end),
            [vec![Calm; 3], vec![Near, Stale, Stale], vec![Stale; 3]]
        );
    }
}
