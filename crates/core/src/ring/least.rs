//! The smallest value of a quantity over all angles at one radius: rings of angles, then a refined
//! search.

use std::f64::consts::TAU;

use crate::{Result, Scalar, StrategyError};

/// Number of angles of a ring.
const ANGLES: usize = 180;
/// Offset of each ring's angles, in steps of a ring. The rings halve each other's gaps.
const RINGS: [f64; 8] = [0.0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875];
/// The search ends with a ring that lowers the smallest value by less than this part of it.
const SETTLED: f64 = 1e-6;
/// How many of a ring's lowest points the search refines.
const CANDIDATES: usize = 3;
/// Rounds of refinement, from 2° to about 0.03°, before a parabola gives the rest.
const ROUNDS: usize = 8;

/// A quantity at each (θ, ρ) of a batch.
pub type Measure<'a> = dyn Fn(&[f64], &[f64], &mut [f64]) -> Result<()> + 'a;

/// The smallest value of `measure` over all angles at `rho`.
///
/// # Errors
/// If `measure` gives NaN somewhere on the ring.
pub fn least_over_angles(measure: &Measure<'_>, rho: f64) -> Result<f64> {
    let found = search_at(measure, &[rho])?;
    Ok(found.into_iter().fold(f64::INFINITY, f64::min))
}

/// The same at each of some radii. Their searches ask together, which costs less than one after the other.
///
/// # Errors
/// The error of the first radius that has one.
pub fn least_over_angles_at(measure: &Measure<'_>, radii: &[f64]) -> Result<Vec<f64>> {
    // An error of several radii does not say whose it is.
    search_at(measure, radii).or_else(|_| {
        let each = radii.iter().map(|rho| least_over_angles(measure, *rho));
        each.collect()
    })
}

fn search_at(measure: &Measure<'_>, radii: &[f64]) -> Result<Vec<f64>> {
    let mut search = Search::new(measure);
    let mut least = vec![f64::INFINITY; radii.len()];
    let mut open: Vec<usize> = (0..radii.len()).collect();
    for (ring, offset) in RINGS.iter().enumerate() {
        let rings: Vec<f64> = open.iter().map(|i| radii[*i]).collect();
        let mut found = search.rings(&rings, *offset)?.into_iter();
        open.retain(|i| {
            let found = found.next().unwrap_or(f64::INFINITY);
            let gain = least[*i] - found;
            least[*i] = least[*i].min(found);
            // The gain is not a number where all values are infinite so far: the search goes on.
            let has_settled = ring > 0 && gain <= SETTLED * least[*i].abs();
            !has_settled
        });
        if open.is_empty() {
            break;
        }
    }
    Ok(least)
}

/// A point on a ring that the search refines.
#[derive(Clone, Copy)]
struct Candidate {
    radius: f64,
    theta: f64,
    value: f64,
    scale: f64,
}

struct Search<'a> {
    measure: &'a Measure<'a>,
    theta: Vec<f64>,
    rho: Vec<f64>,
    value: Vec<f64>,
}

impl<'a> Search<'a> {
    fn new(measure: &'a Measure<'a>) -> Self {
        Self {
            measure,
            theta: Vec::with_capacity(ANGLES),
            rho: Vec::with_capacity(ANGLES),
            value: Vec::with_capacity(ANGLES),
        }
    }

    /// Measures at these places. The values are in their order.
    fn evaluate(&mut self, places: impl Iterator<Item = (f64, f64)>) -> Result<()> {
        self.theta.clear();
        self.rho.clear();
        for (theta, rho) in places {
            self.theta.push(theta);
            self.rho.push(rho);
        }
        self.value.clear();
        self.value.resize(self.theta.len(), f64::NAN);
        (self.measure)(&self.theta, &self.rho, &mut self.value)?;
        match self.value.iter().position(|value| value.is_nan()) {
            None => Ok(()),
            Some(at) => Err(no_value(self.theta[at], self.rho[at])),
        }
    }

    /// The smallest value that a search from one ring of angles finds at each radius.
    fn rings(&mut self, radii: &[f64], offset: f64) -> Result<Vec<f64>> {
        let step = TAU / ANGLES as f64;
        let (mut candidates, mut ends) = (Vec::new(), Vec::new());
        for radius in radii {
            let angles = (0..ANGLES).map(|j| (j as f64 + offset) * step);
            self.evaluate(angles.map(|theta| (theta, *radius)))?;
            candidates.extend(self.lowest(*radius, 0.5 * step));
            ends.push(candidates.len());
        }
        for _ in 0..ROUNDS {
            self.refine(&mut candidates)?;
        }
        self.evaluate_around(&candidates)?;
        let mut lowest = candidates
            .iter()
            .zip(self.value.chunks(2))
            .map(|(candidate, sides)| vertex(candidate.value, sides));
        let mut first = 0;
        let of_radius = ends.into_iter().map(|end| {
            let count = end - first;
            first = end;
            lowest.by_ref().take(count).fold(f64::INFINITY, f64::min)
        });
        Ok(of_radius.collect())
    }

    /// The lowest points of the ring that was measured last.
    fn lowest(&self, radius: f64, scale: f64) -> Vec<Candidate> {
        let value = |j: usize| self.value[j % ANGLES];
        let mut found: Vec<Candidate> = (0..ANGLES)
            .filter(|j| value(*j) <= value(j + 1) && value(*j) <= value(j + ANGLES - 1))
            .map(|j| Candidate {
                radius,
                theta: self.theta[j],
                value: value(j),
                scale,
            })
            .collect();
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        found.truncate(CANDIDATES);
        found
    }

    /// Measures one step to either side of each candidate.
    fn evaluate_around(&mut self, candidates: &[Candidate]) -> Result<()> {
        let around = candidates.iter().flat_map(|candidate| {
            let Candidate {
                theta,
                scale,
                radius,
                ..
            } = candidate;
            [(theta - scale, *radius), (theta + scale, *radius)]
        });
        self.evaluate(around)
    }

    /// Moves each candidate to a lower neighbour. If there is none, halves the candidate's step.
    fn refine(&mut self, candidates: &mut [Candidate]) -> Result<()> {
        self.evaluate_around(candidates)?;
        let neighbours = self.theta.chunks(2).zip(self.value.chunks(2));
        for (candidate, (theta, value)) in candidates.iter_mut().zip(neighbours) {
            let lower = if value[0] <= value[1] { 0 } else { 1 };
            if value[lower] < candidate.value {
                (candidate.theta, candidate.value) = (theta[lower], value[lower]);
            } else {
                candidate.scale *= 0.5;
            }
        }
        Ok(())
    }
}

/// The lowest value of the parabola through a value and those to either side, if it lies between
/// them.
fn vertex(value: f64, sides: &[f64]) -> f64 {
    let [before, after] = sides else {
        return value;
    };
    let (bend, tilt) = (before - 2.0 * value + after, after - before);
    if *before >= value && *after >= value && bend > 0.0 {
        value - tilt * tilt / (8.0 * bend)
    } else {
        value.min(*before).min(*after)
    }
}

fn no_value(theta: f64, rho: f64) -> StrategyError {
    let (sin, cos) = Scalar::sin_cos(theta);
    StrategyError::failed(format!(
        "no feed can be found at x = {:.4} mm, y = {:.4} mm: the surface or the tool centre has \
         no value there; choose a smaller aperture",
        rho * cos,
        rho * sin
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least(value: impl Fn(f64) -> f64) -> Result<f64> {
        let measure = |theta: &[f64], _: &[f64], out: &mut [f64]| {
            for (out, theta) in out.iter_mut().zip(theta) {
                *out = value(*theta);
            }
            Ok(())
        };
        least_over_angles(&measure, 1.0)
    }

    #[test]
    fn the_search_finds_a_minimum_between_the_angles_of_a_ring() {
        for waves in [1.0, 2.0, 7.0, 36.0, 90.0, 180.0, 251.0] {
            let found = least(|theta| 3.0 + Scalar::cos(waves * theta + 0.123)).unwrap();
            assert!((found - 2.0).abs() < 1e-6, "{waves} waves: {found}");
        }
    }

    #[test]
    fn radii_side_by_side_have_the_values_of_each_alone() {
        let waves = |theta: f64, rho: f64| rho + Scalar::cos((3.0 + rho).floor() * theta + rho);
        let measure = |theta: &[f64], rho: &[f64], out: &mut [f64]| {
            for ((out, theta), rho) in out.iter_mut().zip(theta).zip(rho) {
                *out = waves(*theta, *rho);
            }
            Ok(())
        };
        let radii: Vec<f64> = (0..60).map(|i| 3.7 * f64::from(i)).collect();
        let alone = radii.iter().map(|rho| least_over_angles(&measure, *rho));
        let alone: Vec<f64> = alone.collect::<Result<_>>().unwrap();
        assert_eq!(least_over_angles_at(&measure, &radii).unwrap(), alone);
    }

    #[test]
    fn a_value_among_infinite_ones_is_found_by_a_later_ring() {
        let place = 40.25 * TAU / ANGLES as f64;
        let value = |theta: f64| match (theta - place).abs() < 1e-3 {
            true => 7.0,
            false => f64::INFINITY,
        };
        assert_eq!(least(value).unwrap(), 7.0);
    }

    #[test]
    fn a_value_that_is_not_a_number_is_an_error_that_names_the_position() {
        let error = least(|theta| if theta > 6.2 { f64::NAN } else { 1.0 }).unwrap_err();
        assert!(error.to_string().contains("x = 0.99"), "{error}");
    }
}
