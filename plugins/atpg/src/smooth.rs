//! A smooth feed that never exceeds F: F is eroded first, and then averaged.
//!
//! F₁(ρ) = min of F over |s| ≤ h + f_max, and F₂ = F₁ * W with W(s) ∝ (1 − (s/h)²)⁴. An average of
//! F₁ over |s| ≤ h is at most the largest F₁ there, and each F₁ there is at most every F within
//! f_max of ρ. So F₂(ρ) ≤ F wherever the tool is during the turn before and the turn after. F is
//! even at the axis and constant beyond the rim.
//!
//! F₁ comes from the table's floors and is constant in each cell, so the average is exact: F₂ is a
//! sum of steps Φ, where Φ is the integral of W. It has four continuous derivatives.

use std::collections::VecDeque;

use turnpath_plugin::ring::{FLOORS, FeedTable};

/// The smooth feed stays below its proven bound by this part. The margin is for the polynomial
/// pieces, whose rate follows the feed to half of it. It costs a ten-thousandth more revolutions.
pub const MARGIN: f64 = 1e-4;

/// F₂, with its derivative.
#[derive(Debug, Clone)]
pub struct SmoothFeed {
    origin: f64,
    step: f64,
    cells: Vec<f64>,
    window: f64,
}

impl SmoothFeed {
    /// Erodes and averages the table's floors over `window` = h, mm.
    pub fn new(table: &FeedTable, window: f64) -> Self {
        let step = table.step / FLOORS as f64;
        let (origin, floor) = if table.even {
            let mirrored = table.floor.iter().rev().chain(&table.floor);
            (
                -step * table.floor.len() as f64,
                mirrored.copied().collect(),
            )
        } else {
            (table.from, table.floor.clone())
        };
        let reach = ((window + table.largest()) / step).ceil();
        let reach = if reach < floor.len() as f64 {
            reach as usize
        } else {
            floor.len()
        };
        let mut cells = eroded(&floor, reach);
        cells.iter_mut().for_each(|feed| *feed *= 1.0 - MARGIN);
        Self {
            origin,
            step,
            cells,
            window,
        }
    }

    /// Half width h of the average, mm.
    pub fn window(&self) -> f64 {
        self.window
    }

    /// A length over which F₂ is as good as a polynomial of low degree, mm.
    pub fn scale(&self) -> f64 {
        0.125 * self.window
    }

    /// F₂ and dF₂/dρ at `rho`.
    pub fn at(&self, rho: f64) -> (f64, f64) {
        let place = (rho - self.window - self.origin) / self.step;
        let first = (place.max(0.0) as usize).min(self.cells.len().saturating_sub(1));
        let Some(inside) = self.cells.get(first..) else {
            return (f64::NAN, f64::NAN);
        };
        let mut value = inside.first().copied().unwrap_or(f64::NAN);
        let mut rate = 0.0;
        for (i, pair) in inside.windows(2).enumerate() {
            let border = self.origin + (first + i + 1) as f64 * self.step;
            let s = (rho - border) / self.window;
            if s <= -1.0 {
                break;
            }
            let jump = pair[1] - pair[0];
            value += jump * share(s);
            rate += jump * weight(s) / self.window;
        }
        (value, rate)
    }
}

/// W(s) = 315/256 (1 − s²)⁴ within ±1; its integral is 1.
fn weight(s: f64) -> f64 {
    let rest = (1.0 - s * s).max(0.0);
    let squared = rest * rest;
    315.0 / 256.0 * squared * squared
}

/// Φ(s), the integral of W up to s.
fn share(s: f64) -> f64 {
    if s >= 1.0 {
        return 1.0;
    }
    let q = s * s;
    let odd = 1.0 + q * (-4.0 / 3.0 + q * (6.0 / 5.0 + q * (-4.0 / 7.0 + q / 9.0)));
    0.5 + 315.0 / 256.0 * s * odd
}

/// The least of each value and its `reach` neighbours to either side.
fn eroded(values: &[f64], reach: usize) -> Vec<f64> {
    let mut least: VecDeque<usize> = VecDeque::new();
    let mut out = Vec::with_capacity(values.len());
    let mut next = 0;
    for at in 0..values.len() {
        while next < values.len() && next <= at.saturating_add(reach) {
            while least
                .back()
                .is_some_and(|last| values[*last] >= values[next])
            {
                least.pop_back();
            }
            least.push_back(next);
            next += 1;
        }
        while least.front().is_some_and(|first| first + reach < at) {
            least.pop_front();
        }
        out.push(least.front().map_or(f64::NAN, |first| values[*first]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table whose floors go up and down. Of its feeds only the largest one matters.
    fn table(even: bool) -> FeedTable {
        let floor: Vec<f64> = (0..200 * FLOORS)
            .map(|i| {
                0.02 + 0.001 * ((i / FLOORS * 37) % 11) as f64 + 1e-4 / FLOORS as f64 * i as f64
            })
            .collect();
        FeedTable {
            from: if even { 0.0 } else { 1.0 },
            step: 0.01,
            feed: vec![floor.iter().copied().fold(0.0, f64::max)],
            floor,
            even,
        }
    }

    #[test]
    fn erosion_is_the_least_of_the_neighbours() {
        let values = [5.0, 3.0, 4.0, 9.0, 8.0, 7.0, 1.0, 6.0];
        for reach in [0, 1, 3, 20] {
            for (i, found) in eroded(&values, reach).iter().enumerate() {
                let around = &values[i.saturating_sub(reach)..(i + reach + 1).min(8)];
                let least = around.iter().copied().fold(f64::INFINITY, f64::min);
                assert_eq!(*found, least);
            }
        }
    }

    #[test]
    fn the_smooth_feed_stays_below_every_floor_within_a_feed() {
        for even in [true, false] {
            let table = table(even);
            let smooth = SmoothFeed::new(&table, 0.05);
            for i in 0..4000 {
                let rho = table.from + 2.0 * f64::from(i) / 4000.0;
                let cell = |rho: f64| {
                    (((rho - table.from).abs() / table.step * FLOORS as f64) as usize)
                        .min(table.floor.len() - 1)
                };
                let (from, to) = (
                    (rho - table.largest()).max(table.from),
                    rho + table.largest(),
                );
                let least = (cell(from)..=cell(to))
                    .map(|cell| table.floor[cell])
                    .fold(f64::INFINITY, f64::min);
                assert!(smooth.at(rho).0 <= least, "{rho}");
            }
        }
    }

    #[test]
    fn the_rate_is_that_of_the_value_and_zero_at_the_axis() {
        let smooth = SmoothFeed::new(&table(true), 0.05);
        assert!(smooth.at(0.0).1.abs() < 1e-15);
        for i in 1..200 {
            let (rho, t) = (f64::from(i) * 0.01003, 1e-6);
            let difference = (smooth.at(rho + t).0 - smooth.at(rho - t).0) / (2.0 * t);
            assert!((difference - smooth.at(rho).1).abs() < 1e-8);
        }
    }

    #[test]
    fn a_window_wider_than_the_range_averages_all_of_it() {
        let smooth = SmoothFeed::new(&table(false), 100.0);
        let (value, rate) = smooth.at(2.0);
        assert!((value - 0.02 * (1.0 - MARGIN)).abs() < 1e-4 && rate.abs() < 1e-4);
    }
}
