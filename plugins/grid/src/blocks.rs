//! Means of blocks of points, for a filter that needs fewer points than a map has.

use crate::sheet::Sheet;

/// Blocks in a cutoff, at least. More take more time. Fewer would let the blocks themselves filter:
/// with 12 of them a wave as long as the cutoff loses one hundredth by the mean over a block.
const BLOCKS: f64 = 12.0;

/// How many points of a map along one axis go into a block.
pub fn block(cutoff: f64, pitch: f64) -> usize {
    ((cutoff / pitch / BLOCKS) as usize).max(1)
}

/// What a block's numbers stand for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Middle {
    /// The share of the block's points that have a number.
    pub share: f64,
    /// How far the middle of those points lies from that of the block, in widths of a block.
    pub x: f64,
    /// The same along the other axis, in heights of a block.
    pub y: f64,
}

/// A block all of whose points have a number.
const WHOLE: Middle = Middle {
    share: 1.0,
    x: 0.0,
    y: 0.0,
};

/// Means of blocks of numbers. Blocks without any number are holes.
pub struct Blocks {
    /// The mean of each block; NaN in a hole.
    pub means: Sheet,
    /// Empty where a block is a single point.
    middles: Vec<Middle>,
}

impl Blocks {
    /// The means of blocks of `wide` × `high` numbers. What remains at the edges is left out on both
    /// sides alike.
    pub fn of(sheet: &Sheet, wide: usize, high: usize) -> Self {
        if (wide, high) == (1, 1) {
            return Self {
                means: sheet.clone(),
                middles: Vec::new(),
            };
        }
        let (columns, rows) = (sheet.columns / wide, sheet.rows / high);
        let (left, top) = ((sheet.columns % wide) / 2, (sheet.rows % high) / 2);
        let mut means = Sheet::of(columns, rows, 0.0);
        // Sums over the points that have a number: of ones, and of their places in the block.
        let mut sums = vec![[0_usize; 3]; columns * rows];
        let lines = sheet.lines().skip(top).take(rows * high).enumerate();
        for (number, line) in lines {
            let (first, down) = (number / high * columns, number % high);
            let blocks = line[left..].chunks_exact(wide).zip(first..);
            for (block, place) in blocks.take(columns) {
                for (right, value) in block.iter().enumerate().filter(|(_, v)| !v.is_nan()) {
                    means.values[place] += value;
                    for (sum, term) in sums[place].iter_mut().zip([1, right, down]) {
                        *sum += term;
                    }
                }
            }
        }
        let middle = |[count, right, down]: [usize; 3]| {
            let off = |sum: usize, side: usize| {
                let mean = sum as f64 / count.max(1) as f64;
                (mean - 0.5 * (side as f64 - 1.0)) / side as f64
            };
            match count == wide * high {
                true => WHOLE,
                false => Middle {
                    share: count as f64 / (wide * high) as f64,
                    x: off(right, wide),
                    y: off(down, high),
                },
            }
        };
        for (mean, [count, ..]) in means.values.iter_mut().zip(&sums) {
            *mean = match count {
                0 => f64::NAN,
                count => *mean / *count as f64,
            };
        }
        let middles = sums.into_iter().map(middle).collect();
        Self { means, middles }
    }

    /// What the mean at a place stands for, unless the place is a hole.
    pub fn middle(&self, place: usize) -> Middle {
        self.middles.get(place).copied().unwrap_or(WHOLE)
    }

    /// Whether all points of a block have a number.
    pub fn is_whole(&self, place: usize) -> bool {
        !self.means.values[place].is_nan() && self.middle(place) == WHOLE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_have_the_means_and_lie_in_the_middle() {
        let mut fine = Sheet::of(11, 7, 0.0);
        for (row, line) in fine.lines_mut().enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = column as f64 + 10.0 * row as f64;
            }
        }
        // Columns 1 to 3 and rows 0 to 1 make the first block, of which 13 is left.
        for place in [1, 2, 3, 11 + 1, 11 + 2] {
            fine.values[place] = f64::NAN;
        }
        fine.values[4] = f64::NAN;
        for place in [7, 8, 9, 11 + 7, 11 + 8, 11 + 9] {
            fine.values[place] = f64::NAN;
        }
        let blocks = Blocks::of(&fine, 3, 2);
        let means = &blocks.means;
        assert_eq!((means.columns, means.rows), (3, 3));
        assert!((means.values[0] - 13.0).abs() < 1e-12);
        let only = blocks.middle(0);
        let off = [only.share - 1.0 / 6.0, only.x - 1.0 / 3.0, only.y - 0.25];
        assert!(off.iter().all(|off| off.abs() < 1e-12), "{only:?}");
        // 5, 6, 14, 15, 16 of 4, 5, 6, 14, 15, 16.
        assert!((means.values[1] - 56.0 / 5.0).abs() < 1e-12);
        assert!(means.values[2].is_nan());
        assert!((means.values[3] - 27.0).abs() < 1e-12);
        assert_eq!(
            [0, 1, 2, 3].map(|place| blocks.is_whole(place)),
            [false, false, false, true]
        );
        assert_eq!((block(1.0, 0.1), block(2.5, 0.1)), (1, 2));
    }
}
