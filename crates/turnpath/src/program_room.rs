//! The room that programs need on the disk, by what their first blocks took.
//!
//! Before the first block nobody knows how many lines a post places for a segment, or how many points
//! refinement adds. So the room is looked at again while the path is made: often at first, and then
//! at each doubling.

use turnpath_pipeline::Estimate;

use crate::sizes::bytes_while_assembled;

/// What the cut has taken so far.
#[derive(Debug, Clone, Default)]
pub struct ProgramRoom {
    /// Control points that are expected in all.
    expected: f64,
    points: u64,
    /// Bytes of each program.
    bytes: Vec<u64>,
    blocks: u64,
}

impl ProgramRoom {
    /// A path of so many points, and its programs.
    pub fn new(expected: &Estimate, programs: usize) -> Self {
        Self {
            expected: expected.control_points,
            bytes: vec![0; programs],
            ..Self::default()
        }
    }

    /// Forgets the blocks so far.
    pub fn begin_again(&mut self) {
        (self.points, self.blocks) = (0, 0);
        self.bytes.fill(0);
    }

    /// Takes a block of the cut with the bytes of its lines in each program. Gives the bytes that are
    /// still to come, where the room is to be looked at again.
    pub fn pass(&mut self, points: usize, bytes: impl Iterator<Item = usize>) -> Option<f64> {
        self.points += points as u64;
        self.blocks += 1;
        for (sum, bytes) in self.bytes.iter_mut().zip(bytes) {
            *sum += bytes as u64;
        }
        let is_due = self.blocks.is_power_of_two() && self.points > 0;
        is_due.then(|| {
            let share = (self.expected / self.points as f64).max(1.0);
            let written: u64 = self.bytes.iter().sum();
            let projected = self.bytes.iter().map(|bytes| share * *bytes as f64);
            bytes_while_assembled(projected) - written as f64
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hundred points of 1,000 took 5 kB and 1 kB: 54 kB are to come, and the larger program counts
    /// twice while it is put together.
    #[test]
    fn the_room_follows_what_the_first_blocks_took() {
        let expected = Estimate {
            control_points: 1000.0,
            revolutions: 10.0,
            cutting_time: 1.0,
            feed_cap: None,
        };
        let mut room = ProgramRoom::new(&expected, 2);
        let first = room.pass(50, [2_500, 500].into_iter()).unwrap();
        assert_eq!(first, 57_000.0 + 50_000.0);
        let second = room.pass(50, [2_500, 500].into_iter()).unwrap();
        assert_eq!(second, 54_000.0 + 50_000.0);
        // Not at each block.
        assert_eq!(room.pass(50, [2_500, 500].into_iter()), None);
    }
}
