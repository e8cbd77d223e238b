//! Grids: the cells of a map.

use std::f64::consts::TAU;

use turnpath_core::{Part, Scalar};

/// Cells in rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grid {
    /// `count` × `count` cells over the square around the part. Rows run from the largest y down,
    /// and the cells of a row from the smallest x up. The point of a cell is its centre.
    Cartesian {
        /// Cells per side.
        count: usize,
        /// Half of the side, mm.
        half: f64,
    },
    /// One row for each ring, from the inside out, with angles from 0 on. A ring lies in the middle
    /// of its share of the radius.
    Polar {
        /// Number of rings.
        rings: usize,
        /// Number of angles of each ring.
        angles: usize,
        /// Inner radius of the first share, mm.
        inner: f64,
        /// Outer radius of the last share, mm.
        outer: f64,
    },
}

/// The point of a cell: (x, y), mm.
pub type GridPoint = (f64, f64);

impl Grid {
    /// Cells over the square around a part.
    pub fn cartesian(part: &Part, count: usize) -> Self {
        let half = part.aperture_radius;
        Self::Cartesian { count, half }
    }

    /// Rings over a part.
    pub fn polar(part: &Part, rings: usize, angles: usize) -> Self {
        Self::Polar {
            rings,
            angles,
            inner: part.inner_radius,
            outer: part.aperture_radius,
        }
    }

    /// One ring.
    pub fn circle(radius: f64, angles: usize) -> Self {
        Self::Polar {
            rings: 1,
            angles,
            inner: radius,
            outer: radius,
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::Cartesian { count, .. } => *count,
            Self::Polar { rings, .. } => *rings,
        }
    }

    /// Number of cells in a row.
    pub fn columns(&self) -> usize {
        match self {
            Self::Cartesian { count, .. } => *count,
            Self::Polar { angles, .. } => *angles,
        }
    }

    /// The angle of a column of a polar grid, rad.
    pub fn angle(&self, column: usize) -> f64 {
        TAU * column as f64 / self.columns() as f64
    }

    /// The point of a cell.
    pub fn point(&self, row: usize, column: usize) -> GridPoint {
        match *self {
            Self::Cartesian { count, half } => {
                let of = |index: usize| half * ((2 * index + 1) as f64 / count as f64 - 1.0);
                (of(column), of(count - 1 - row))
            }
            Self::Polar {
                rings,
                inner,
                outer,
                ..
            } => {
                let share = (row as f64 + 0.5) / rings as f64;
                let rho = inner + share * (outer - inner);
                let (sin, cos) = Scalar::sin_cos(self.angle(column));
                (rho * cos, rho * sin)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_run_from_the_top_and_columns_from_the_left() {
        let grid = Grid::Cartesian {
            count: 4,
            half: 2.0,
        };
        assert_eq!(grid.point(0, 0), (-1.5, 1.5));
        assert_eq!(grid.point(3, 2), (0.5, -1.5));
    }

    #[test]
    fn rings_lie_in_the_middle_of_their_shares() {
        let grid = Grid::Polar {
            rings: 2,
            angles: 4,
            inner: 1.0,
            outer: 3.0,
        };
        assert_eq!(grid.point(0, 0), (1.5, 0.0));
        let (x, y) = grid.point(1, 1);
        assert!(x.abs() < 1e-15 && (y - 2.5).abs() < 1e-15);
        assert_eq!(Grid::circle(2.0, 8).point(0, 0), (2.0, 0.0));
    }
}
