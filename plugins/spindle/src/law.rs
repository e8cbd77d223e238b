//! t(N) in pieces of half a turn, and the spindle's motion on them.

use turnpath_plugin::prelude::*;

use crate::grid::{CELLS_OF_PIECE, Grid};
use crate::smooth::TurnTimes;

/// Speeds that differ by less than this part are one speed.
const SAME: f64 = 1e-12;
/// Boole's rule over the five borders of a piece.
const BOOLE: [f64; CELLS_OF_PIECE + 1] = [
    7.0 / 90.0,
    32.0 / 90.0,
    12.0 / 90.0,
    32.0 / 90.0,
    7.0 / 90.0,
];
/// Where in a cell the motion is looked at beside its start.
const LATER_PLACES: [f64; 2] = [0.5, 1.0];

/// The largest amounts of the spindle's motion in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// rad/s. No place in the cell is faster.
    pub speed: f64,
    /// rad/s².
    pub acceleration: f64,
    /// rad/s³.
    pub jerk: f64,
}

/// t(N) of a schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// The coefficients of each piece against N since its start. t begins at 0 in each.
    pieces: Vec<[f64; 6]>,
    length: f64,
    /// The path's end, in revolutions.
    end: f64,
}

impl Law {
    /// The law with these times of a turn at the cells' borders.
    pub fn new(grid: &Grid, times: &TurnTimes) -> Self {
        let length = CELLS_OF_PIECE as f64 * grid.step();
        let borders = (0..grid.cells).step_by(CELLS_OF_PIECE);
        let pieces = borders.map(|from| {
            let to = from + CELLS_OF_PIECE;
            let rates = &times.rate[from..=to];
            let mean: f64 = BOOLE.iter().zip(rates).map(|(w, rate)| w * rate).sum();
            let end = |border: usize, t: f64| [t, times.rate[border], times.second[border]];
            quintic(end(from, 0.0), end(to, mean * length), length)
        });
        Self {
            pieces: pieces.collect(),
            length,
            end: grid.end,
        }
    }

    /// How long the path takes, s.
    pub fn time(&self) -> f64 {
        self.pieces
            .iter()
            .map(|piece| value(piece, self.length))
            .sum()
    }

    /// The motion of the spindle in every cell.
    pub fn motions(&self) -> impl Iterator<Item = Motion> + '_ {
        let cells = self
            .pieces
            .iter()
            .flat_map(|piece| (0..CELLS_OF_PIECE).map(move |cell| (piece, cell as f64)));
        let step = self.length / CELLS_OF_PIECE as f64;
        cells.map(move |(coefficients, cell)| motion(coefficients, cell * step, step))
    }

    /// The law with the whole motion faster by `factor`.
    pub fn into_spindle(self, factor: f64) -> SpindleLaw {
        if let Some(rate) = self.constant_rate() {
            return SpindleLaw::constant(factor * TAU / rate);
        }
        let (mut t, count) = (0.0, self.pieces.len() as f64);
        let pieces = self.pieces.iter().enumerate().map(|(i, piece)| {
            let mut coefficients = piece.map(|c| c / factor);
            coefficients[0] = t;
            t += value(piece, self.length) / factor;
            Piece {
                start: self.end * (i as f64 / count),
                coefficients,
            }
        });
        let pieces = pieces.collect();
        SpindleLaw::from_time(PiecewisePolynomial::from_pieces(pieces, self.end))
    }

    /// The time of a turn, if it is the same everywhere, s.
    fn constant_rate(&self) -> Option<f64> {
        let first = self.pieces.first()?[1];
        let same = |piece: &[f64; 6]| {
            let flat = |c: &f64| c.abs() <= SAME * first;
            (piece[1] - first).abs() <= SAME * first && piece[2..].iter().all(flat)
        };
        self.pieces.iter().all(same).then_some(first)
    }
}

fn value(coefficients: &[f64; 6], s: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// The motion of the spindle over `step` revolutions from `start` on.
fn motion(coefficients: &[f64; 6], start: f64, step: f64) -> Motion {
    let piece = Piece {
        start: 0.0,
        coefficients: *coefficients,
    };
    let at_start = piece.shifted(start);
    let mut motion = Motion {
        speed: TAU / least_rate(&at_start, step),
        ..Motion::default()
    };
    let others = LATER_PLACES.map(|place| piece.shifted(start + place * step));
    for [_, rate, second, third, ..] in [at_start].into_iter().chain(others) {
        let (second, third) = (2.0 * second, 6.0 * third);
        let turning = rate.recip();
        let cube = turning * turning * turning;
        let acceleration = TAU * second * cube;
        let jerk = TAU * (3.0 * second * second - rate * third) * cube * turning * turning;
        motion.acceleration = motion.acceleration.max(acceleration.abs());
        motion.jerk = motion.jerk.max(jerk.abs());
    }
    motion
}

/// A lower bound of dt/dN over the first `step` revolutions of a polynomial: the least of its
/// coefficients after Bernstein.
fn least_rate(coefficients: &[f64; 6], step: f64) -> f64 {
    let mut power = [0.0; 5];
    let mut scale = 1.0;
    for (k, power) in power.iter_mut().enumerate() {
        *power = (k + 1) as f64 * coefficients[k + 1] * scale;
        scale *= step;
    }
    // binomial(j, i)/binomial(4, i)
    const SHARES: [[f64; 5]; 5] = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.25, 0.0, 0.0, 0.0],
        [1.0, 0.5, 1.0 / 6.0, 0.0, 0.0],
        [1.0, 0.75, 0.5, 0.25, 0.0],
        [1.0, 1.0, 1.0, 1.0, 1.0],
    ];
    let bernstein =
        SHARES.map(|shares| -> f64 { shares.iter().zip(power).map(|(share, c)| share * c).sum() });
    bernstein.into_iter().fold(f64::INFINITY, f64::min)
}
