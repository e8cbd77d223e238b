//! Where a map has data: the cells around its points.

use turnpath_maps::Map;

/// The cells around the points of a map that have a height, as runs of columns in each row.
#[derive(Debug, Clone)]
pub struct Cells {
    pitch: [f64; 2],
    left: f64,
    bottom: f64,
    /// First and last column of each run, row by row.
    runs: Vec<Vec<[u32; 2]>>,
}

impl Cells {
    /// The cells of a map.
    pub fn of(map: &Map) -> Self {
        let rows = map.heights().chunks_exact(map.columns());
        Self {
            pitch: [map.pitch_x(), map.pitch_y()],
            left: map.x(0),
            bottom: map.y(0),
            runs: rows.map(runs).collect(),
        }
    }

    /// How far a place lies beyond the cells, mm; 0 within them.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        let (column, row) = (
            (x - self.left) / self.pitch[0],
            (y - self.bottom) / self.pitch[1],
        );
        if !(column.is_finite() && row.is_finite()) {
            return f64::NAN;
        }
        let last = self.runs.len().saturating_sub(1);
        let start = (row.round().max(0.0) as usize).min(last);
        let mut least = f64::INFINITY;
        // From the nearest row on, upwards and downwards: rows only get farther away.
        let mut look = |number: usize| -> bool {
            let dy = ((number as f64 - row).abs() - 0.5).max(0.0) * self.pitch[1];
            if dy * dy >= least {
                return false;
            }
            if let Some(dx) = self.runs.get(number).and_then(|runs| along(runs, column)) {
                let dx = dx * self.pitch[0];
                least = least.min(dx * dx + dy * dy);
            }
            true
        };
        for number in start..=last {
            if !look(number) {
                break;
            }
        }
        for number in (0..start).rev() {
            if !look(number) {
                break;
            }
        }
        least.sqrt()
    }
}

fn runs(line: &[f64]) -> Vec<[u32; 2]> {
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for (column, _) in (0..).zip(line).filter(|(_, height)| !height.is_nan()) {
        match runs.last_mut() {
            Some([_, last]) if *last + 1 == column => *last = column,
            _ => runs.push([column, column]),
        }
    }
    runs
}

/// How far a place in a row lies from its nearest run, in columns; `None` in a row without one.
fn along(runs: &[[u32; 2]], column: f64) -> Option<f64> {
    let after = runs.partition_point(|[first, _]| f64::from(*first) - 0.5 <= column);
    let to_left = after.checked_sub(1).and_then(|run| runs.get(run));
    let to_left = to_left.map(|[_, last]| (column - f64::from(*last) - 0.5).max(0.0));
    let to_right = runs
        .get(after)
        .map(|[first, _]| f64::from(*first) - 0.5 - column);
    match (to_left, to_right) {
        (Some(left), Some(right)) => Some(left.min(right)),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against all cells, one by one.
    #[test]
    fn the_distance_is_that_of_the_nearest_cell() {
        let (columns, rows) = (12, 9);
        let heights = (0..columns * rows).map(|i| match (i * 7) % 5 < 2 && i % 12 > 2 {
            true => 1.0,
            false => f64::NAN,
        });
        let map = Map::new(columns, rows, 0.5, 0.3, heights.collect()).unwrap();
        let cells = Cells::of(&map);
        for i in 0..400 {
            let (x, y) = (
                -5.0 + 0.5 * (i % 20) as f64,
                -3.0 + 0.3 * (i / 20) as f64 + 0.07,
            );
            let mut least = f64::INFINITY;
            for row in 0..rows {
                for column in (0..columns).filter(|column| !map.height(*column, row).is_nan()) {
                    let dx = ((x - map.x(column)).abs() - 0.25).max(0.0);
                    let dy = ((y - map.y(row)).abs() - 0.15).max(0.0);
                    least = least.min((dx * dx + dy * dy).sqrt());
                }
            }
            let found = cells.distance(x, y);
            assert!((found - least).abs() < 1e-12, "{x} {y}: {found} {least}");
        }
        assert!(cells.distance(f64::NAN, 0.0).is_nan());
        assert!(cells.distance(1e300, 0.0) >= 1e299);
    }
}
