//! Rows of a path, and in which columns two of them differ.

use turnpath_core::toolpath::{ControlPoint, Section};

/// A row of a path: a control point and the section to which it belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathRow {
    /// The control point.
    pub point: ControlPoint,
    /// Its section.
    pub section: Section,
}

impl PathRow {
    /// C, X and Z.
    pub(super) fn place(&self) -> [f64; 3] {
        [self.point.c, self.point.x, self.point.z]
    }
}

/// A column in which rows may differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// The time since the row before.
    Time,
    /// C.
    C,
    /// X.
    X,
    /// Z.
    Z,
    /// dC/dt.
    Vc,
    /// dX/dt.
    Vx,
    /// dZ/dt.
    Vz,
    /// The section.
    Section,
}

/// By how much two numbers may differ and still be the same: half a last digit of the file, besides
/// the rounding of doubles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HalfDigits {
    /// Of times, s.
    pub time: f64,
    /// Of X and Z, mm.
    pub position: f64,
    /// Of C, rad.
    pub angle: f64,
    /// Of their velocities, mm/s.
    pub velocity: f64,
    /// Of that of C, rad/s.
    pub angular_velocity: f64,
}

/// Rounding of doubles, as a part of the number: a file in degrees turns C into degrees and back.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Whether two numbers are the same, to half a digit and rounding.
fn is_same(one: f64, other: f64, half_digit: f64) -> bool {
    (one - other).abs() <= half_digit + ROUNDING * one.abs().max(other.abs())
}

impl HalfDigits {
    /// Whether the shifts of two times are the same; `at` is the larger of the times, s.
    pub fn same_shift(&self, one: f64, other: f64, at: f64) -> bool {
        (one - other).abs() <= 2.0 * (self.time + ROUNDING * at.abs())
    }

    /// Those of C, X and Z.
    pub(super) fn of_place(&self) -> [f64; 3] {
        [self.angle, self.position, self.position]
    }

    /// Whether the way from one row to the next has the same digits in a file and in the recipe's path.
    pub fn same_way(&self, file: [&PathRow; 2], remade: [&PathRow; 2]) -> bool {
        let half_digits = self.of_place();
        let [[from, to], [other_from, other_to]] =
            [file, remade].map(|rows| rows.map(PathRow::place));
        (0..half_digits.len()).all(|axis| {
            let digit = 2.0 * half_digits[axis];
            let way = |from: f64, to: f64| match digit > 0.0 {
                true => (to / digit).round() - (from / digit).round(),
                false => to - from,
            };
            way(from[axis], to[axis]) == way(other_from[axis], other_to[axis])
        })
    }

    /// The columns, the time excepted, in which two rows differ.
    pub fn differing(&self, file: &PathRow, remade: &PathRow) -> Vec<Column> {
        let (f, r) = (&file.point, &remade.point);
        let numbers = [
            (Column::C, f.c, r.c, self.angle),
            (Column::X, f.x, r.x, self.position),
            (Column::Z, f.z, r.z, self.position),
            (Column::Vc, f.vc, r.vc, self.angular_velocity),
            (Column::Vx, f.vx, r.vx, self.velocity),
            (Column::Vz, f.vz, r.vz, self.velocity),
        ];
        let differ = numbers
            .into_iter()
            .filter(|(_, one, other, half)| !is_same(*one, *other, *half));
        let mut columns: Vec<Column> = differ.map(|(column, ..)| column).collect();
        if file.section != remade.section {
            columns.push(Column::Section);
        }
        columns
    }
}
