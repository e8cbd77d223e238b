//! The largest values of quantities over a ring of the part, and their positions.
//!
//! The search evaluates a polar grid. It then refines several of the grid's highest points at once
//! by a compass search, each with its own step. One candidate would not be enough: a crest between
//! the points of the grid may look lower on the grid than a lesser crest that runs through them.
//! The search can still miss what is narrower than the grid's spacing.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use crate::{RadialRange, Result, Scalar};

/// Angles of the grid. A wave with 36 periods on a revolution still gets 10 points a period.
const ANGLES: usize = 360;
/// Steps of the grid along the radius.
pub const RADII: usize = 256;
/// Rows of the grid that are measured together. A batch of so many points is long enough for a measure that
/// goes through several threads, and stays in the cache.
const ROWS: usize = 8;
/// How many of the grid's highest points the search refines. A lattice of equal hollows has many
/// points that look alike.
const CANDIDATES: usize = 24;
/// How many of these may lie on one radius. A surface of revolution has its crest at every angle.
const ON_ONE_RADIUS: usize = 8;
/// Most rounds of refinement. A round halves the step of a candidate that has no higher neighbour.
const ROUNDS: usize = 40;
/// A candidate whose step is this part of a grid step is a maximum. At a tip the value is then right to some
/// 1e-10 of the rise over a grid step. Near a flat maximum it is right much sooner.
const FINEST: f64 = 1.0 / (1_u64 << 34) as f64;
/// A candidate whose next step is this part of a grid step may be given up. So it has been compared with
/// places half a grid step and a quarter away.
const HOPELESS_FROM: f64 = 0.125;
/// A candidate is given up if the highest one lies above it by more than this many times the fall to its
/// lowest neighbour. Where a quantity is concave, it rises within a step by no more than it falls.
const HOPELESS: f64 = 4.0;

/// The eight neighbours of a point, in steps of the grid.
const NEIGHBOURS: [(f64, f64); 8] = [
    (-1.0, -1.0),
    (-1.0, 0.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 1.0),
    (1.0, -1.0),
    (1.0, 0.0),
    (1.0, 1.0),
];

/// The largest value of a quantity on the part, and its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// C angle, rad.
    pub theta: f64,
    /// Radius, mm.
    pub rho: f64,
}

impl Extreme {
    /// The position as (x, y), mm.
    pub fn position(&self) -> Vector2<f64> {
        let (s, c) = Scalar::sin_cos(self.theta);
        Vector2::new(self.rho * c, self.rho * s)
    }
}

/// Measures K quantities at each (θ, ρ) of a batch. All slices have one length. A batch has several rows of
/// the grid, and its error is that of the whole batch. The measure itself must report a point without a value,
/// since NaN is never the largest value.
pub type Measure<'a, const K: usize> =
    dyn FnMut(&[f64], &[f64], &mut [[f64; K]]) -> Result<()> + 'a;

/// The largest value of each of K quantities within `region`.
///
/// # Errors
/// The errors of `measure`.
///
/// ```
/// use turnpath_core::{RadialRange, extreme};
/// let region = RadialRange { inner: 0.0, outer: 2.0 };
/// let [highest] = extreme::largest(region, &mut |_theta, rho, out| {
///     for (out, rho) in out.iter_mut().zip(rho) {
///         *out = [rho * (3.0 - rho)];
///     }
///     Ok(())
/// })?;
/// assert!((highest.value - 2.25).abs() < 1e-15);
/// assert!((highest.rho - 1.5).abs() < 1e-7);
/// # turnpath_core::Result::Ok(())
/// ```
pub fn largest<const K: usize>(
    region: RadialRange,
    measure: &mut Measure<'_, K>,
) -> Result<[Extreme; K]> {
    largest_on(RADII, region, measure)
}

/// As [`largest`], on a grid of so many steps along the radius.
pub(crate) fn largest_on<const K: usize>(
    radii: usize,
    region: RadialRange,
    measure: &mut Measure<'_, K>,
) -> Result<[Extreme; K]> {
    let grid = Grid::new(region, radii);
    let columns = grid.evaluate(measure)?;
    let mut found = [Extreme {
        value: f64::NEG_INFINITY,
        theta: 0.0,
        rho: region.inner,
    }; K];
    for (which, (found, column)) in found.iter_mut().zip(&columns).enumerate() {
        let candidates = grid.highest(column);
        let closed_in = grid.refine(candidates, which, measure)?;
        let highest = closed_in.into_iter().max_by(by_value);
        *found = highest.unwrap_or(*found);
    }
    Ok(found)
}

fn by_value(one: &Extreme, other: &Extreme) -> std::cmp::Ordering {
    one.value.total_cmp(&other.value)
}

struct Grid {
    region: RadialRange,
    radii: usize,
    theta_step: f64,
    rho_step: f64,
}

impl Grid {
    fn new(region: RadialRange, radii: usize) -> Self {
        Self {
            region,
            radii,
            theta_step: TAU / ANGLES as f64,
            rho_step: (region.outer - region.inner) / radii as f64,
        }
    }

    fn theta(&self, j: usize) -> f64 {
        j as f64 * self.theta_step
    }

    fn rho(&self, i: usize) -> f64 {
        self.region.inner + i as f64 * self.rho_step
    }

    /// Evaluates all points of the grid: a column for each quantity, with one radius after the other.
    fn evaluate<const K: usize>(&self, measure: &mut Measure<'_, K>) -> Result<[Vec<f64>; K]> {
        let of_row = (0..ANGLES).map(|j| self.theta(j));
        let theta: Vec<f64> = of_row.cycle().take(ROWS * ANGLES).collect();
        let mut columns = std::array::from_fn(|_| Vec::with_capacity((self.radii + 1) * ANGLES));
        let mut rho = Vec::with_capacity(theta.len());
        let mut values = vec![[f64::NAN; K]; theta.len()];
        for first in (0..=self.radii).step_by(ROWS) {
            let rows = first..(first + ROWS).min(self.radii + 1);
            rho.clear();
            rho.extend(rows.flat_map(|i| [self.rho(i); ANGLES]));
            let values = &mut values[..rho.len()];
            values.fill([f64::NAN; K]);
            measure(&theta[..rho.len()], &rho, values)?;
            for (which, column) in columns.iter_mut().enumerate() {
                column.extend(values.iter().map(|values| values[which]));
            }
        }
        Ok(columns)
    }

    /// The highest points of the grid among those that are no lower than their four neighbours.
    fn highest(&self, column: &[f64]) -> Vec<Extreme> {
        let mut found = Vec::new();
        let row = |i: usize| &column[i * ANGLES..][..ANGLES];
        for i in 0..=self.radii {
            let beside = [row(i.saturating_sub(1)), row((i + 1).min(self.radii))];
            let is_peak = peaks(row(i), beside);
            let on_row = row(i).iter().zip(is_peak).enumerate();
            let on_row = on_row.filter(|(_, (_, is_peak))| *is_peak);
            let mut on_row: Vec<_> = on_row
                .map(|(j, (value, _))| Extreme {
                    value: *value,
                    theta: self.theta(j),
                    rho: self.rho(i),
                })
                .collect();
            keep_highest(&mut on_row, ON_ONE_RADIUS);
            found.append(&mut on_row);
        }
        keep_highest(&mut found, CANDIDATES);
        found
    }

    /// Runs a compass search from each peak of the grid. A candidate moves to the best of its eight
    /// neighbours. If none is better, its step is halved. The search of a candidate ends at the finest step,
    /// or where it can no longer become the highest.
    fn refine<const K: usize>(
        &self,
        peaks: Vec<Extreme>,
        which: usize,
        measure: &mut Measure<'_, K>,
    ) -> Result<Vec<Extreme>> {
        let mut candidates: Vec<Candidate> = peaks.into_iter().map(Candidate::new).collect();
        let mut values = vec![[f64::NAN; K]; candidates.len() * NEIGHBOURS.len()];
        for _ in 0..ROUNDS {
            let (theta, rho) = self.neighbours(&candidates);
            if theta.is_empty() {
                break;
            }
            let values = &mut values[..theta.len()];
            measure(&theta, &rho, values)?;
            let tried = theta.iter().zip(&rho).zip(&*values);
            let tried: Vec<Extreme> = tried
                .map(|((&theta, &rho), values)| Extreme {
                    value: values[which],
                    theta,
                    rho,
                })
                .collect();
            let searched = candidates.iter_mut().filter(|one| one.is_open);
            for (candidate, around) in searched.zip(tried.chunks(NEIGHBOURS.len())) {
                candidate.step_to_best(around);
            }
            let values = candidates.iter().map(|candidate| candidate.at.value);
            let highest = values.fold(f64::NEG_INFINITY, f64::max);
            for candidate in &mut candidates {
                candidate.is_open &= !candidate.is_settled(highest);
            }
        }
        Ok(candidates.iter().map(|candidate| candidate.at).collect())
    }

    /// θ and ρ of the eight neighbours of each candidate that is still searched, at its own step.
    fn neighbours(&self, candidates: &[Candidate]) -> (Vec<f64>, Vec<f64>) {
        let searched = candidates.iter().filter(|candidate| candidate.is_open);
        let around = searched.flat_map(|candidate| {
            NEIGHBOURS.iter().map(move |(turn, out)| {
                let theta = candidate.at.theta + turn * candidate.step * self.theta_step;
                let rho = candidate.at.rho + out * candidate.step * self.rho_step;
                (theta, rho.clamp(self.region.inner, self.region.outer))
            })
        });
        around.unzip()
    }
}

/// A peak of the grid while the search closes in on it.
struct Candidate {
    at: Extreme,
    /// The distance of the neighbours, in steps of the grid.
    step: f64,
    /// How far the lowest neighbour lies below, if no neighbour lies higher.
    fall: f64,
    /// Whether it is still searched.
    is_open: bool,
}

impl Candidate {
    fn new(at: Extreme) -> Self {
        Self {
            at,
            step: 0.5,
            fall: f64::INFINITY,
            is_open: true,
        }
    }

    /// Moves to the best of the neighbours, or halves the step.
    fn step_to_best(&mut self, around: &[Extreme]) {
        let better = around.iter().filter(|tried| tried.value > self.at.value);
        if let Some(better) = better.max_by(|one, other| by_value(one, other)) {
            self.at = *better;
            self.fall = f64::INFINITY;
        } else {
            let values = around.iter().map(|tried| tried.value);
            self.fall = self.at.value - values.fold(f64::INFINITY, f64::min);
            self.step *= 0.5;
        }
    }

    /// Whether it is a maximum, or cannot become the highest one.
    fn is_settled(&self, highest: f64) -> bool {
        let is_hopeless =
            self.step <= HOPELESS_FROM && highest - self.at.value > HOPELESS * self.fall;
        self.step <= FINEST || is_hopeless
    }
}

/// Which points of a row are no lower than their neighbours on the row and on the two rows beside it. The
/// row closes on itself.
fn peaks(row: &[f64], [inside, outside]: [&[f64]; 2]) -> [bool; ANGLES] {
    let mut around = [f64::NAN; ANGLES + 2];
    around[1..=ANGLES].copy_from_slice(row);
    (around[0], around[ANGLES + 1]) = (row[ANGLES - 1], row[0]);
    // Without a way out of the loop it goes through vector registers.
    std::array::from_fn(|j| {
        let value = around[j + 1];
        (value >= around[j])
            & (value >= around[j + 2])
            & (value >= inside[j])
            & (value >= outside[j])
    })
}

fn keep_highest(found: &mut Vec<Extreme>, count: usize) {
    found.sort_by(|one, other| by_value(other, one));
    found.truncate(count);
}

#[cfg(test)]
mod tests {
    use super::*;

    const DISC: RadialRange = RadialRange {
        inner: 0.0,
        outer: 2.5,
    };

    fn one(value: impl Fn(f64, f64) -> f64) -> Extreme {
        let [found] = largest(DISC, &mut |theta, rho, out| {
            for ((out, theta), rho) in out.iter_mut().zip(theta).zip(rho) {
                *out = [value(*theta, *rho)];
            }
            Ok(())
        })
        .unwrap();
        found
    }

    /// A Gaussian peak of this height at (θ, ρ), `wide` mm wide.
    fn peak(height: f64, wide: f64, at: (f64, f64)) -> impl Fn(f64, f64) -> f64 {
        move |theta, rho| {
            let (sin, cos) = Scalar::sin_cos(theta);
            let (at_sin, at_cos) = Scalar::sin_cos(at.0);
            let (x, y) = (rho * cos - at.1 * at_cos, rho * sin - at.1 * at_sin);
            height * Scalar::exp(-(x * x + y * y) / (wide * wide))
        }
    }

    /// Narrow peaks between the points of the grid look lower there than a lower peak on a point.
    #[test]
    fn the_highest_peak_is_found_wherever_it_lies_between_the_points_of_the_grid() {
        let (theta_step, rho_step) = (TAU / 360.0, 2.5 / 256.0);
        for (turn, out) in [(0.5, 0.5), (0.5, 0.0), (0.3, 0.6), (0.1, 0.9)] {
            let at = ((40.0 + turn) * theta_step, (100.0 + out) * rho_step);
            let narrow = peak(1.0, 0.02, at);
            let on_grid = peak(0.97, 0.02, (90.0 * theta_step, 128.0 * rho_step));
            let found = one(|theta, rho| narrow(theta, rho).max(on_grid(theta, rho)));
            assert!((found.value - 1.0).abs() < 1e-12, "{found:?}");
        }
    }

    /// A crest that runs all around, a hundredth lower than a peak elsewhere.
    #[test]
    fn a_crest_on_all_angles_does_not_hide_a_peak() {
        let peak = peak(1.0, 0.03, (1.234, 1.2345));
        let found = one(|theta, rho| peak(theta, rho).max(0.99 - (rho - 2.0) * (rho - 2.0)));
        assert!((found.value - 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn each_quantity_has_its_own_position() {
        let [out, turned] = largest(DISC, &mut |theta, rho, out| {
            for ((out, theta), rho) in out.iter_mut().zip(theta).zip(rho) {
                *out = [*rho, Scalar::cos(theta - 0.123)];
            }
            Ok(())
        })
        .unwrap();
        assert_eq!((out.value, out.rho), (2.5, 2.5));
        assert!((turned.value - 1.0).abs() < 1e-15 && (turned.theta - 0.123).abs() < 1e-7);
    }
}
