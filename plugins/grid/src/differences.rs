//! Third differences of the numbers of a sheet.

/// Kinds of third differences: along x, along y, and two mixed ones.
pub const KINDS: usize = 4;

/// Numbers on the side of the largest difference.
const SIDE: usize = 4;

/// How far a number reaches in the sum of squares.
pub const REACH: usize = SIDE - 1;

/// A kind of third differences.
#[derive(Debug, Clone)]
pub struct Difference {
    /// Factors along x and along y; the difference is the sum over all products.
    pub along: [Vec<f64>; 2],
    /// What its square counts.
    pub weight: f64,
}

/// All third differences of a sheet.
pub struct Differences {
    /// Columns of the sheet.
    pub columns: usize,
    /// Rows of the sheet.
    pub rows: usize,
    /// The kinds of differences.
    pub kinds: [Difference; KINDS],
}

impl Differences {
    /// Those of a sheet of this size. `ratio` is the pitch along x over that along y.
    pub fn new(columns: usize, rows: usize, ratio: f64) -> Self {
        let factors = |order: usize| match order {
            0 => vec![1.0],
            1 => vec![-1.0, 1.0],
            2 => vec![1.0, -2.0, 1.0],
            _ => vec![-1.0, 3.0, -3.0, 1.0],
        };
        // Differences along x are those over longer steps, if the pitch along x is the larger one.
        let kinds = [3, 2, 1, 0].map(|order: usize| Difference {
            along: [factors(order), factors(3 - order)],
            weight: [1.0, 3.0, 3.0, 1.0][order] * (0..order).fold(1.0, |w, _| w / (ratio * ratio)),
        });
        Self {
            columns,
            rows,
            kinds,
        }
    }

    /// What a number counts in its own force.
    pub fn stiffness(&self, place: usize) -> f64 {
        let (row, column) = (place / self.columns, place % self.columns);
        let squares = |at: usize, count: usize, along: &[f64]| -> f64 {
            starts(at, count, along)
                .map(|(_, factor)| factor * factor)
                .sum()
        };
        let of = |one: &Difference| {
            let [of_x, of_y] = &one.along;
            one.weight * squares(column, self.columns, of_x) * squares(row, self.rows, of_y)
        };
        self.kinds.iter().map(of).sum()
    }
}

/// Where the differences begin that lie within the sheet and contain a number, and the number's
/// factor in each.
pub fn starts(at: usize, count: usize, along: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    let starts = along
        .iter()
        .enumerate()
        .filter_map(move |(number, factor)| {
            let start = at.checked_sub(number)?;
            Some((start, *factor))
        });
    let length = along.len();
    starts.filter(move |(start, _)| start + length <= count)
}
