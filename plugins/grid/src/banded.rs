//! Systems of linear equations whose matrix is a band.

/// Most places between the diagonal and an entry, to either side.
pub const REACH: usize = 6;

/// Entries of a row: exchanging rows adds as many to the right as there are below the diagonal.
const WIDTH: usize = 3 * REACH + 1;

/// A band matrix, factored with exchanges of rows.
#[derive(Debug, Clone)]
pub struct Band {
    /// `rows[i][REACH + j − i]` is the entry of the upper factor at (i, j).
    rows: Vec<[f64; WIDTH]>,
    /// For each column the row that it was exchanged with, and the shares of the rows below.
    steps: Vec<(usize, [f64; REACH])>,
}

impl Band {
    /// Factors the matrix whose row i has `entries[i]` from column `first[i]` on. All entries lie
    /// within [`REACH`] of the diagonal.
    pub fn new(entries: &[(usize, Vec<f64>)]) -> Self {
        let mut rows = vec![[0.0; WIDTH]; entries.len()];
        for (i, (first, entries)) in entries.iter().enumerate() {
            for (j, entry) in (*first..).zip(entries) {
                rows[i][REACH + j - i] = *entry;
            }
        }
        let count = rows.len();
        let mut steps = Vec::with_capacity(count);
        for i in 0..count {
            let below = i..count.min(i + REACH + 1);
            let size = |row: usize, rows: &[[f64; WIDTH]]| rows[row][REACH + i - row].abs();
            let mut pivot = i;
            for row in below.clone() {
                if size(row, &rows) > size(pivot, &rows) {
                    pivot = row;
                }
            }
            exchange(&mut rows, i, pivot);
            let mut shares = [0.0; REACH];
            for row in below.skip(1) {
                let shift = row - i;
                let share = rows[row][REACH - shift] / rows[i][REACH];
                shares[shift - 1] = share;
                for column in REACH..WIDTH {
                    let upper = rows[i][column];
                    if let Some(entry) = rows[row].get_mut(column - shift) {
                        *entry -= share * upper;
                    }
                }
            }
            steps.push((pivot, shares));
        }
        Self { rows, steps }
    }

    /// Solves the system for many right sides at once: column by column of `sides`, which has rows of
    /// `columns` numbers. The solutions take their place.
    pub fn solve(&self, sides: &mut [f64], columns: usize) {
        let count = self.rows.len();
        for (i, (pivot, shares)) in self.steps.iter().enumerate() {
            if *pivot != i {
                let (upper, lower) = sides.split_at_mut(pivot * columns);
                upper[i * columns..(i + 1) * columns].swap_with_slice(&mut lower[..columns]);
            }
            let (known, below) = sides.split_at_mut((i + 1) * columns);
            let known = &known[i * columns..];
            for (line, share) in below.chunks_exact_mut(columns).zip(shares) {
                subtract(line, *share, known);
            }
        }
        for i in (0..count).rev() {
            let (line, below) = sides[i * columns..].split_at_mut(columns);
            let entries = &self.rows[i][REACH..];
            for (known, entry) in below.chunks_exact(columns).zip(&entries[1..]) {
                subtract(line, *entry, known);
            }
            let over = 1.0 / entries[0];
            for value in line {
                *value *= over;
            }
        }
    }
}

fn subtract(from: &mut [f64], share: f64, what: &[f64]) {
    if share != 0.0 {
        for (from, what) in from.iter_mut().zip(what) {
            *from -= share * what;
        }
    }
}

/// Exchanges two rows of a band. Their entries count from their own diagonals.
fn exchange(rows: &mut [[f64; WIDTH]], i: usize, pivot: usize) {
    if i == pivot {
        return;
    }
    let shift = pivot - i;
    let (upper, lower) = (rows[i], rows[pivot]);
    rows[i] = std::array::from_fn(|k| k.checked_sub(shift).map_or(0.0, |k| lower[k]));
    rows[pivot] = std::array::from_fn(|k| upper.get(k + shift).copied().unwrap_or(0.0));
    // What lies left of the pivot's column is eliminated already.
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that needs exchanges: zeros on its diagonal.
    #[test]
    fn the_solution_fulfils_the_equations() {
        let count = 40;
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 0.0,
            apart if apart <= REACH => ((i * 7 + j * 13) % 11) as f64 - 4.5 + 1.0 / apart as f64,
            _ => 0.0,
        };
        let rows: Vec<(usize, Vec<f64>)> = (0..count)
            .map(|i: usize| {
                let columns = i.saturating_sub(REACH)..count.min(i + REACH + 1);
                (columns.start, columns.map(|j| entry(i, j)).collect())
            })
            .collect();
        let wanted: Vec<f64> = (0..count * 3)
            .map(|k| (k as f64 * 0.37).fract() - 0.4)
            .collect();
        let mut sides = vec![0.0; count * 3];
        for i in 0..count {
            for j in 0..count {
                for k in 0..3 {
                    sides[i * 3 + k] += entry(i, j) * wanted[j * 3 + k];
                }
            }
        }
        Band::new(&rows).solve(&mut sides, 3);
        for (found, wanted) in sides.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-10, "{found} {wanted}");
        }
    }
}
