//! The cells into which a path is divided.

use turnpath_plugin::law_limits::STEADY_REVOLUTIONS;

/// Cells of a piece of t(N).
pub const CELLS_OF_PIECE: usize = 4;
/// Pieces of t(N) on a turn, at the least.
const PIECES_OF_TURN: f64 = 2.0;

/// A path in cells of equal length, an eighth of a turn or a little less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// The path's end, in revolutions.
    pub end: f64,
    /// How many cells there are: a whole number of pieces.
    pub cells: usize,
}

impl Grid {
    /// The grid of a path of so many revolutions.
    pub fn new(end: f64) -> Self {
        let pieces = (PIECES_OF_TURN * end).ceil().max(1.0);
        Self {
            end,
            cells: CELLS_OF_PIECE * pieces as usize,
        }
    }

    /// The length of a cell, in revolutions.
    pub fn step(&self) -> f64 {
        self.end / self.cells as f64
    }

    /// How many cells these revolutions take, at least one.
    pub fn cells_in(&self, revolutions: f64) -> usize {
        ((revolutions / self.step()).round() as usize).max(1)
    }

    /// How many cells at either end must have one speed, so that a mean over `reach` cells on either
    /// side is constant where leads join.
    pub fn steady(&self, reach: usize) -> usize {
        let pieces = (STEADY_REVOLUTIONS / (CELLS_OF_PIECE as f64 * self.step())).ceil() as usize;
        (CELLS_OF_PIECE * pieces + reach).min(self.cells)
    }

    /// The halves of a turn, counted from 0, that a cell touches.
    pub fn halves(&self, cell: usize) -> std::ops::RangeInclusive<usize> {
        let half = |cell: usize| PIECES_OF_TURN * self.step() * cell as f64;
        let last = (half(cell + 1).ceil() as usize).saturating_sub(1);
        half(cell).floor() as usize..=last
    }
}
