//! Heights on a regular grid.

use crate::error::{MapError, MapProblem};
use crate::limits::{LARGEST_LENGTH, LEAST_PITCH, LEAST_POINTS, MOST_POINTS};

/// Heights on a regular grid, in mm. Columns lie along x, rows along y. Column 0 has the least x,
/// row 0 the least y. A height that is NaN is a hole.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    columns: usize,
    rows: usize,
    pitch_x: f64,
    pitch_y: f64,
    left: f64,
    bottom: f64,
    heights: Vec<f64>,
}

/// How many points a map has, checked before anything is made for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Size {
    /// The size of a map whose file may have so many points.
    pub(crate) fn new(columns: usize, rows: usize) -> Result<Self, MapProblem> {
        if columns < LEAST_POINTS || rows < LEAST_POINTS {
            return Err(MapProblem::TooFew { columns, rows });
        }
        match columns.checked_mul(rows) {
            Some(points) if points <= MOST_POINTS => Ok(Self { columns, rows }),
            _ => Err(MapProblem::TooMany { columns, rows }),
        }
    }

    pub(crate) fn points(self) -> usize {
        self.columns * self.rows
    }
}

impl Map {
    /// A map around the origin. `heights` has the rows from the bottom.
    pub(crate) fn around_origin(size: Size, pitch: [f64; 2], heights: Vec<f64>) -> Self {
        let mut map = Self {
            columns: size.columns,
            rows: size.rows,
            pitch_x: pitch[0],
            pitch_y: pitch[1],
            left: 0.0,
            bottom: 0.0,
            heights,
        };
        map.centre();
        map
    }

    /// A map from its heights, for tests and for maps that come from no file: `heights` has the
    /// rows from the bottom, each from the left, in mm. The middle lies at the origin.
    ///
    /// # Errors
    /// When the size is too small or too large, or does not fit the heights, or a pitch is
    /// none.
    pub fn new(
        columns: usize,
        rows: usize,
        pitch_x: f64,
        pitch_y: f64,
        heights: Vec<f64>,
    ) -> Result<Self, MapError> {
        let size = Size::new(columns, rows).map_err(MapError::of_file)?;
        if heights.len() != size.points() {
            let (found, wanted) = (heights.len(), size.points());
            return Err(MapError::of_file(MapProblem::TooShort { found, wanted }));
        }
        for pitch in [pitch_x, pitch_y] {
            check_pitch(pitch).map_err(MapError::of_file)?;
        }
        Ok(Self::around_origin(size, [pitch_x, pitch_y], heights))
    }

    /// Points along x.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Points along y.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Distance of neighbouring columns, mm.
    pub fn pitch_x(&self) -> f64 {
        self.pitch_x
    }

    /// Distance of neighbouring rows, mm.
    pub fn pitch_y(&self) -> f64 {
        self.pitch_y
    }

    /// x of a column, mm.
    pub fn x(&self, column: usize) -> f64 {
        self.left + self.pitch_x * column as f64
    }

    /// y of a row, mm.
    pub fn y(&self, row: usize) -> f64 {
        self.bottom + self.pitch_y * row as f64
    }

    /// The height at a point, mm; NaN in a hole and outside of the map.
    pub fn height(&self, column: usize, row: usize) -> f64 {
        let inside = column < self.columns && row < self.rows;
        let height = inside.then(|| self.heights.get(row * self.columns + column));
        height.flatten().copied().unwrap_or(f64::NAN)
    }

    /// All heights, row by row from the bottom, mm; NaN in holes.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The same, without the map.
    pub fn into_heights(self) -> Vec<f64> {
        self.heights
    }

    /// How many points have a height.
    pub fn valid(&self) -> usize {
        self.heights
            .iter()
            .filter(|height| !height.is_nan())
            .count()
    }

    /// Mirrors the map at the y axis: x becomes −x.
    pub fn flip_x(&mut self) {
        for row in self.heights.chunks_exact_mut(self.columns) {
            row.reverse();
        }
        self.left = -(self.left + self.pitch_x * (self.columns - 1) as f64);
    }

    /// Mirrors the map at the x axis: y becomes −y.
    pub fn flip_y(&mut self) {
        turn_rows(self.columns, &mut self.heights);
        self.bottom = -(self.bottom + self.pitch_y * (self.rows - 1) as f64);
    }

    /// Puts the middle of the map at the origin.
    pub(crate) fn centre(&mut self) {
        self.left = -0.5 * self.pitch_x * (self.columns - 1) as f64;
        self.bottom = -0.5 * self.pitch_y * (self.rows - 1) as f64;
    }

    /// Moves the map.
    pub(crate) fn shift(&mut self, x: f64, y: f64) {
        self.left += x;
        self.bottom += y;
    }
}

/// A pitch that a grid may have, mm.
pub(crate) fn check_pitch(pitch: f64) -> Result<f64, MapProblem> {
    match (LEAST_PITCH..=LARGEST_LENGTH).contains(&pitch) {
        true => Ok(pitch),
        false => Err(MapProblem::Pitch { pitch }),
    }
}

/// A height or a coordinate that a map may have, mm.
pub(crate) fn check_length(length: f64) -> Result<f64, MapProblem> {
    match length.abs() <= LARGEST_LENGTH {
        true => Ok(length),
        false => Err(MapProblem::Length { length }),
    }
}

/// Puts the rows into the opposite order.
pub(crate) fn turn_rows(columns: usize, heights: &mut [f64]) {
    let mut rows = heights.chunks_exact_mut(columns);
    while let (Some(first), Some(last)) = (rows.next(), rows.next_back()) {
        first.swap_with_slice(last);
    }
}
