//! A smooth speed below the speeds that the cells allow.

use std::f64::consts::TAU;

use crate::grid::Grid;

/// Borders whose means are taken side by side: so many that compilers make vector instructions of them, and
/// few enough that they stay in cache.
const TOGETHER: usize = 1024;

/// Makes a speed smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoother {
    /// The largest acceleration of the spindle before the mean is taken, rad/s².
    pub acceleration: f64,
    /// The mean is taken over so many turns on either side.
    pub reach: f64,
}

/// The time of a turn at the cells' borders, and how fast it changes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TurnTimes {
    /// dt/dN, s.
    pub rate: Vec<f64>,
    /// d²t/dN², s.
    pub second: Vec<f64>,
}

impl Smoother {
    /// The smooth time of a turn for the largest speed of each cell, rad/s.
    pub fn apply(&self, grid: &Grid, speeds: &[f64]) -> TurnTimes {
        let reach = grid.cells_in(self.reach);
        // The mean looks at a whole reach, and half of it is enough where the speed changes slowly;
        // what that lets through, the check of the limits finds.
        let mut lowest = least_around(speeds, grid.cells_in(0.5 * (1.0 + self.reach)));
        let steady = grid.steady(reach);
        level(&mut lowest, steady);
        let mut squares: Vec<f64> = lowest.iter().map(|speed| speed * speed).collect();
        let climb = 2.0 * self.acceleration * TAU * grid.step();
        slow_down(&mut squares, climb, steady);
        let turn_times: Vec<f64> = squares.iter().map(|square| TAU / square.sqrt()).collect();
        mean(&turn_times, reach, grid.step())
    }
}

/// The least speed within `reach` cells on either side.
fn least_around(speeds: &[f64], reach: usize) -> Vec<f64> {
    // Of the cells in the window, those that no later cell is slower than, in order.
    let mut waiting = std::collections::VecDeque::new();
    let mut least = Vec::with_capacity(speeds.len());
    let mut next = 0;
    for cell in 0..speeds.len() {
        while next < (cell + reach + 1).min(speeds.len()) {
            while waiting
                .back()
                .is_some_and(|i: &usize| speeds[*i] >= speeds[next])
            {
                waiting.pop_back();
            }
            waiting.push_back(next);
            next += 1;
        }
        while waiting.front().is_some_and(|i| i + reach < cell) {
            waiting.pop_front();
        }
        least.push(waiting.front().map_or(f64::NAN, |i| speeds[*i]));
    }
    least
}

/// Gives the first and the last `steady` cells one speed each.
fn level(speeds: &mut [f64], steady: usize) {
    let count = speeds.len();
    for range in [0..steady, count - steady..count] {
        let least = speeds[range.clone()]
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        speeds[range].fill(least);
    }
}

/// Lowers squares of speeds until they climb by no more than `climb` from cell to cell, forwards
/// and backwards, and not at all within the first and the last `steady` cells.
fn slow_down(squares: &mut [f64], climb: f64, steady: usize) {
    let count = squares.len();
    let between = |i: usize| match i < steady || i > count - steady {
        true => 0.0,
        false => climb,
    };
    for i in 1..count {
        squares[i] = squares[i].min(squares[i - 1] + between(i));
    }
    for i in (1..count).rev() {
        squares[i - 1] = squares[i - 1].min(squares[i] + between(i));
    }
}

/// The mean of the cells' values over `reach` cells on either side of each border, with the weight
/// (1 − s²)⁴, and its rate. Beyond the ends the first and the last value continue.
fn mean(values: &[f64], reach: usize, step: f64) -> TurnTimes {
    let weights: Vec<[f64; 2]> = (0..reach).map(|d| weight(d, reach)).collect();
    let sum: f64 = weights.iter().map(|[weight, _]| 2.0 * weight).sum();
    let beyond = |end: Option<&f64>| vec![end.copied().unwrap_or(f64::NAN); reach];
    let values = [&beyond(values.first()), values, &beyond(values.last())].concat();
    let borders = values.len() + 1 - 2 * reach;
    let (mut rate, mut second) = (vec![0.0; borders], vec![0.0; borders]);
    let pieces = rate.chunks_mut(TOGETHER).zip(second.chunks_mut(TOGETHER));
    for (piece, (totals, changes)) in pieces.enumerate() {
        let values = &values[piece * TOGETHER..];
        for (d, [weight, slope]) in weights.iter().enumerate() {
            let cells = values[reach - 1 - d..].iter().zip(&values[reach + d..]);
            for ((total, change), (before, after)) in
                totals.iter_mut().zip(&mut *changes).zip(cells)
            {
                *total += weight * (before + after);
                *change += slope * (after - before);
            }
        }
    }
    rate.iter_mut().for_each(|total| *total /= sum);
    let scale = sum * reach as f64 * step;
    second.iter_mut().for_each(|change| *change /= scale);
    TurnTimes { rate, second }
}

/// The weight of the cell whose middle lies `d` and a half cells from a border, and how fast it
/// grows with the border's way towards the cell.
fn weight(d: usize, reach: usize) -> [f64; 2] {
    let s = (d as f64 + 0.5) / reach as f64;
    let base = 1.0 - s * s;
    let cube = base * base * base;
    [cube * base, 8.0 * s * cube]
}
