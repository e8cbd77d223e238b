//! Numbers on a grid, as the steps hand them on.

/// Numbers on a grid. Columns lie along x, rows along y; rows follow one another.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    pub columns: usize,
    pub rows: usize,
    pub values: Vec<f64>,
}

impl Sheet {
    /// A sheet of the same number everywhere.
    pub fn of(columns: usize, rows: usize, value: f64) -> Self {
        Self {
            columns,
            rows,
            values: vec![value; columns * rows],
        }
    }

    /// A sheet whose numbers follow from column and row.
    #[cfg(test)]
    pub fn of_values(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Self {
        let values = (0..columns * rows).map(|k| value((k % columns) as f64, (k / columns) as f64));
        Self {
            columns,
            rows,
            values: values.collect(),
        }
    }

    /// The rows.
    pub fn lines(&self) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        self.values.chunks_exact(self.columns)
    }

    /// The rows, to be changed.
    pub fn lines_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.columns)
    }

    /// The sheet with rows for columns.
    pub fn transposed(&self) -> Self {
        /// Numbers on the side of a block: two blocks fit into the first cache.
        const BLOCK: usize = 32;
        let mut turned = Self::of(self.rows, self.columns, 0.0);
        for top in (0..self.rows).step_by(BLOCK) {
            for left in (0..self.columns).step_by(BLOCK) {
                for row in top..self.rows.min(top + BLOCK) {
                    for column in left..self.columns.min(left + BLOCK) {
                        turned.values[column * self.rows + row] =
                            self.values[row * self.columns + column];
                    }
                }
            }
        }
        turned
    }

    /// The sheet in the middle of a larger one that has `margin` numbers more on each side, which
    /// are NaN.
    pub fn with_margin(&self, margin: usize) -> Self {
        let (columns, rows) = (self.columns + 2 * margin, self.rows + 2 * margin);
        let mut wide = Self::of(columns, rows, f64::NAN);
        for (line, of_wide) in self.lines().zip(wide.lines_mut().skip(margin)) {
            of_wide[margin..margin + self.columns].copy_from_slice(line);
        }
        wide
    }

    /// What [`Self::with_margin`] has put a margin around.
    pub fn without_margin(&self, margin: usize) -> Self {
        let (columns, rows) = (self.columns - 2 * margin, self.rows - 2 * margin);
        let lines = self.lines().skip(margin).take(rows);
        Self {
            columns,
            rows,
            values: lines
                .flat_map(|line| &line[margin..margin + columns])
                .copied()
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns_and_back() {
        let mut sheet = Sheet::of(67, 33, 0.0);
        for (i, value) in sheet.values.iter_mut().enumerate() {
            *value = i as f64;
        }
        let turned = sheet.transposed();
        assert_eq!((turned.columns, turned.rows), (33, 67));
        assert_eq!(turned.values[66 * 33 + 2], sheet.values[2 * 67 + 66]);
        assert_eq!(turned.transposed(), sheet);
    }

    #[test]
    fn a_margin_surrounds_a_sheet() {
        let wide = Sheet::of(2, 3, 1.0).with_margin(2);
        assert_eq!((wide.columns, wide.rows), (6, 7));
        let numbers = wide.values.iter().filter(|value| **value == 1.0).count();
        assert_eq!(wide.without_margin(2), Sheet::of(2, 3, 1.0));
        assert_eq!(
            (numbers, wide.values[2 * 6 + 2], wide.values[4 * 6 + 3]),
            (6, 1.0, 1.0)
        );
    }
}
