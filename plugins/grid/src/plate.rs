//! The sum of squares of third differences over a sheet, and the numbers for which it is least.
//!
//! The equations are solved by conjugate gradients. The solution need not be exact: what counts is that
//! the sheet is smooth. All sums run in one order, so the same map gives the same bytes.

use std::ops::Range;

use turnpath_plugin::registers::{Loop, in_widest};

use crate::differences::{Differences, REACH};
use crate::group::put;
use crate::plate_edge::{EdgeStrips, runs};

/// Most steps of the gradients at each resolution. The coarse sheets leave only short waves to the
/// finer ones, and these need few.
const STEPS: usize = 60;

/// Sheets with no more unknown numbers than this take more steps.
pub const SMALL: usize = 2048;

/// Most steps for a small sheet.
const STEPS_OF_SMALL: usize = 2000;

/// The share of the first residual at which the search ends.
const SMALLEST_RESIDUAL: f64 = 1e-9;

/// What the numbers of a row count in a force, from the farthest one before on.
type Factors = [f64; 2 * REACH + 1];

/// The sum of squares of third differences over a sheet.
pub struct Plate {
    /// What the sum is made of.
    pub differences: Differences,
    /// Where all differences lie within the sheet: what each neighbour counts in a force, by rows.
    neighbours: [Factors; 2 * REACH + 1],
}

impl Plate {
    /// The sums of a sheet of this size. `ratio` is the pitch along x over that along y.
    pub fn new(columns: usize, rows: usize, ratio: f64) -> Self {
        let differences = Differences::new(columns, rows, ratio);
        let mut neighbours = [[0.0; 2 * REACH + 1]; 2 * REACH + 1];
        for difference in &differences.kinds {
            let [of_x, of_y] = difference.along.each_ref().map(|along| squared(along));
            for (line, y) in neighbours.iter_mut().zip(of_y) {
                for (factor, x) in line.iter_mut().zip(of_x) {
                    *factor += difference.weight * x * y;
                }
            }
        }
        Self {
            differences,
            neighbours,
        }
    }

    /// Half the derivatives of the sum by some numbers.
    #[cfg(test)]
    pub fn forces_of(&self, values: &[f64], places: &[usize]) -> Vec<f64> {
        let mut forces = vec![f64::NAN; values.len()];
        self.put_forces(values, &mut Asked::of(self, places), &mut forces);
        places.iter().map(|place| forces[*place]).collect()
    }

    /// Puts half the derivatives of the sum by the numbers that are asked for into their places.
    fn put_forces(&self, values: &[f64], asked: &mut Asked, forces: &mut [f64]) {
        in_widest(PutForces {
            plate: self,
            values,
            asked,
            forces,
        });
    }

    /// Half the derivatives by `W` neighbours of a row, where all differences lie within the sheet.
    #[inline(always)]
    fn force_inside<const W: usize>(&self, values: &[f64], place: usize) -> [f64; W] {
        let columns = self.differences.columns;
        let corner = place - REACH * (columns + 1);
        let line = |number: usize| &values[corner + number * columns..];
        let [a, b, c, d, e, f, g] = &self.neighbours;
        let mut forces = [0.0; W];
        // Towards the corners the factors are zero.
        add_line::<W, 3>(&mut forces, a, line(0));
        add_line::<W, 2>(&mut forces, b, line(1));
        add_line::<W, 1>(&mut forces, c, line(2));
        add_line::<W, 0>(&mut forces, d, line(3));
        add_line::<W, 1>(&mut forces, e, line(4));
        add_line::<W, 2>(&mut forces, f, line(5));
        add_line::<W, 3>(&mut forces, g, line(6));
        forces
    }

    /// Conjugate gradients on the unknown numbers, each scaled by its stiffness.
    pub fn relax(&self, values: &mut [f64], unknown: &[usize]) {
        let steps = match unknown.len() <= SMALL {
            true => STEPS_OF_SMALL,
            false => STEPS,
        };
        let mut asked = Asked::of(self, unknown);
        let runs = runs(unknown.iter().copied());
        let [mut forces, mut residual, mut over, mut direction] =
            [(); 4].map(|()| vec![0.0; values.len()]);
        self.put_forces(values, &mut asked, &mut forces);
        for place in unknown {
            residual[*place] = -forces[*place];
            over[*place] = 1.0 / self.differences.stiffness(*place);
            direction[*place] = residual[*place] * over[*place];
        }
        let mut now = sum_over(&runs, |place| {
            residual[place] * residual[place] * over[place]
        });
        let last = now * SMALLEST_RESIDUAL * SMALLEST_RESIDUAL;
        for _ in 0..steps {
            if now <= last || now == 0.0 {
                return;
            }
            self.put_forces(&direction, &mut asked, &mut forces);
            let mut work = 0.0;
            for run in &runs {
                for (direction, force) in direction[run.clone()].iter().zip(&forces[run.clone()]) {
                    work += direction * force;
                }
            }
            if work <= 0.0 {
                return;
            }
            let step = now / work;
            let before = now;
            now = 0.0;
            for run in &runs {
                let numbers = values[run.clone()]
                    .iter_mut()
                    .zip(&mut residual[run.clone()]);
                let moves = direction[run.clone()].iter().zip(&forces[run.clone()]);
                for (((value, residual), (direction, force)), over) in
                    numbers.zip(moves).zip(&over[run.clone()])
                {
                    *value += step * direction;
                    *residual -= step * force;
                    now += *residual * *residual * over;
                }
            }
            let kept = now / before;
            for run in &runs {
                let scaled = residual[run.clone()].iter().zip(&over[run.clone()]);
                for (direction, (residual, over)) in direction[run.clone()].iter_mut().zip(scaled) {
                    *direction = residual * over + kept * *direction;
                }
            }
        }
    }
}

/// Adds to `W` forces what a row of numbers counts in them. The first and the last `SKIP` factors are zero.
#[inline(always)]
fn add_line<const W: usize, const SKIP: usize>(
    forces: &mut [f64; W],
    factors: &Factors,
    line: &[f64],
) {
    let line = &line[..factors.len() - SKIP + W - 1];
    for column in SKIP..factors.len() - SKIP {
        for (force, value) in forces.iter_mut().zip(&line[column..column + W]) {
            *force += factors[column] * value;
        }
    }
}

/// The sum of terms of places, in their order.
fn sum_over(runs: &[Range<usize>], term: impl Fn(usize) -> f64) -> f64 {
    let terms = runs.iter().cloned().flatten().map(term);
    terms.fold(0.0, |sum, term| sum + term)
}

/// Numbers of which forces are asked.
struct Asked {
    /// Neighbours in a row. All differences that contain them lie within the sheet.
    inside: Vec<Range<usize>>,
    /// The others.
    at_edge: EdgeStrips,
}

impl Asked {
    /// Some numbers, in the order of their places.
    fn of(plate: &Plate, places: &[usize]) -> Self {
        let Differences { columns, rows, .. } = plate.differences;
        let is_inner = |at: usize, count: usize| at >= REACH && at + REACH < count;
        let is_inside =
            |place: &usize| is_inner(place / columns, rows) && is_inner(place % columns, columns);
        let (inside, at_edge) = places
            .iter()
            .partition::<Vec<usize>, _>(|place| is_inside(place));
        Self {
            // Between two rows lie places at the edge, so a run ends with its row.
            inside: runs(inside),
            at_edge: EdgeStrips::of(&plate.differences, &at_edge),
        }
    }
}

/// The loop that puts the forces of some numbers into their places.
struct PutForces<'a> {
    plate: &'a Plate,
    values: &'a [f64],
    asked: &'a mut Asked,
    forces: &'a mut [f64],
}

/// Neighbours whose forces are calculated together.
const TOGETHER: usize = 8;

impl Loop for PutForces<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            plate,
            values,
            asked,
            forces,
        } = self;
        for run in &asked.inside {
            let starts = run.clone().step_by(TOGETHER);
            for (group, place) in forces[run.clone()].chunks_mut(TOGETHER).zip(starts) {
                // A group may have numbers behind its run, which are not taken, but none behind the sheet.
                let last = place + REACH * (plate.differences.columns + 1);
                if last + TOGETHER <= values.len() {
                    let together = plate.force_inside::<TOGETHER>(values, place);
                    put(&together, group);
                    continue;
                }
                for (force, place) in group.iter_mut().zip(place..) {
                    [*force] = plate.force_inside::<1>(values, place);
                }
            }
        }
        asked.at_edge.put(values, forces);
    }
}

/// The factors of neighbours, from the farthest one before on, in the derivative of a square.
fn squared(along: &[f64]) -> Factors {
    let mut factors = [0.0; 2 * REACH + 1];
    for (i, one) in along.iter().enumerate() {
        for (j, other) in along.iter().enumerate() {
            factors[REACH + j - i] += one * other;
        }
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Sheet;

    /// The sum of squares by its definition: first differences, three times.
    fn energy(sheet: &Sheet, ratio: f64) -> f64 {
        let along_x = |sheet: &Sheet| {
            let mut less = Sheet::of(sheet.columns.saturating_sub(1), sheet.rows, 0.0);
            if less.columns == 0 {
                return less;
            }
            for (line, of_less) in sheet.lines().zip(less.lines_mut()) {
                for (pair, place) in line.windows(2).zip(of_less) {
                    *place = (pair[1] - pair[0]) / ratio;
                }
            }
            less
        };
        let along_y = |sheet: &Sheet| {
            let mut less = Sheet::of(sheet.columns, sheet.rows.saturating_sub(1), 0.0);
            for (place, difference) in less.values.iter_mut().enumerate() {
                *difference = sheet.values[place + sheet.columns] - sheet.values[place];
            }
            less
        };
        let squares = |sheet: Sheet| -> f64 { sheet.values.iter().map(|v| v * v).sum() };
        squares(along_x(&along_x(&along_x(sheet))))
            + 3.0 * squares(along_x(&along_x(&along_y(sheet))))
            + 3.0 * squares(along_x(&along_y(&along_y(sheet))))
            + squares(along_y(&along_y(&along_y(sheet))))
    }

    #[test]
    fn forces_and_stiffness_are_derivatives_of_the_sum() {
        let ratio = 1.25;
        // Rows with groups of eight numbers inside, sheets with few numbers inside or none.
        let shapes = (1..=12).flat_map(|columns| (1..=12).map(move |rows| (columns, rows)));
        for (columns, rows) in shapes.chain([(25, 9), (5, 30), (30, 5)]) {
            let bent = Sheet::of_values(columns, rows, |u, v| (u * 1.3 + v * v * 0.7) % 1.0);
            let plate = Plate::new(columns, rows, ratio);
            let all: Vec<usize> = (0..bent.values.len()).collect();
            let forces = plate.forces_of(&bent.values, &all);
            for (place, found) in forces.iter().enumerate() {
                let moved = |by: f64| {
                    let mut moved = bent.clone();
                    moved.values[place] += by;
                    energy(&moved, ratio)
                };
                let force = (moved(1.0) - moved(-1.0)) / 4.0;
                assert!((found - force).abs() < 1e-9, "{place}: {found} {force}");
                let stiffness = (moved(1.0) + moved(-1.0) - 2.0 * moved(0.0)) / 2.0;
                let found = plate.differences.stiffness(place);
                let far = (found - stiffness).abs();
                assert!(far < 1e-9, "{place}: {found} {stiffness}");
            }
            // The force of a number does not depend on which others are asked for.
            let some: Vec<usize> = all.into_iter().filter(|place| place % 5 != 2).collect();
            for (place, force) in some.iter().zip(plate.forces_of(&bent.values, &some)) {
                assert_eq!(force.to_bits(), forces[*place].to_bits(), "{place}");
            }
        }
    }
}
