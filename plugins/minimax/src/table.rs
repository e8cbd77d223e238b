//! The exact path of one span as columns: what trial steps are compared with.

use turnpath_plugin::hermite::{Bound, Jumps, pitch};
use turnpath_plugin::prelude::*;

use crate::acceleration::{self, Allowed};
use crate::clock::Clock;
use crate::grid::{Sample, sample_before};
use crate::place::Place;
use crate::room::errors_of_x;

/// The largest slope that is assumed in the test whether X's own interpolation matters.
const STEEPEST: f64 = 10.0;
/// X's own interpolation does not matter to Z if it changes Z by less than this part of the
/// tolerance.
const NEGLIGIBLE: f64 = 1e-3;
/// X's own interpolation does not matter to the cusps if it errs by less than this part of what it
/// may where cusps leave room: less than what it may always.
const NEGLIGIBLE_SHARE: f64 = 0.2;

/// The first step of the search for a place: less than the places of a natural step.
const FIRST_STEP: usize = 16;
/// A rate that jumps by no more than this part of itself is smooth: pieces of a law join to rounding.
const ROUNDING: f64 = 1e-9;

/// What the errors of steps are held to.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// The largest error of Z, mm.
    pub allowed: f64,
    /// The part of the distance between passes that X's own error may take where cusps leave room.
    pub feed_part: f64,
    /// The largest step, in revolutions.
    pub max_step: f64,
}

/// Columns that only some paths need.
#[derive(Debug, Default)]
pub struct Coupling {
    /// ∂Z/∂X at each place.
    pub slope: Vec<f64>,
    /// ∂Z/∂θ at constant X at each place, mm/rad.
    pub along: Vec<f64>,
    /// One over the error that X may have at each place, 1/mm; empty where X's own error does not
    /// matter.
    pub x_weight: Vec<f64>,
}

/// The path at every place of the grid, in order.
pub struct Table<'a> {
    path: &'a Path<'a>,
    /// The limits of every step.
    pub limits: Limits,
    /// Places, in revolutions.
    pub n: Vec<f64>,
    /// Time of each place from the span's start on: s, or at a constant speed the angle, rad.
    pub t: Vec<f64>,
    /// X of the nose centre, mm.
    pub x: Vec<f64>,
    /// Z of the nose centre, mm.
    pub z: Vec<f64>,
    /// C from the span's start on, rad.
    pub c: Vec<f64>,
    /// How the axes act on each other.
    pub coupling: Coupling,
    /// The largest acceleration of Z on a step, mm over the square of the table's time.
    pub most_acceleration: f64,
    /// Whether X's own error matters.
    pub x_matters: bool,
    /// Whether the spindle changes its speed.
    pub speed_varies: bool,
    /// The time where it does.
    clock: Option<Clock>,
    /// X and Z between each place and the next one, by the way in rad; none of X where it does not matter.
    x_between: Vec<Quintic>,
    z_between: Vec<Quintic>,
}

/// The coefficients of a quintic, the lowest first.
type Quintic = [f64; 6];

impl<'a> Table<'a> {
    /// The columns of these samples.
    pub fn new(path: &'a Path<'a>, samples: &[Sample], limits: Limits) -> Result<Self> {
        let start = samples.first().map_or(0.0, |sample| sample.n);
        let end = samples.last().map_or(0.0, |sample| sample.n);
        let speed_varies = speed_varies(path.spindle, start, end);
        let column = |of: fn(&Sample) -> f64| -> Vec<f64> { samples.iter().map(of).collect() };
        let n = column(|sample| sample.n);
        let c: Vec<f64> = n.iter().map(|n| TAU * (n - start)).collect();
        let t = match speed_varies {
            true => {
                let from = path.spindle.time_at(start);
                n.iter().map(|n| path.spindle.time_at(*n) - from).collect()
            }
            false => c.clone(),
        };
        let mut table = Self {
            path,
            limits,
            t,
            x: column(|sample| sample.x[0]),
            z: column(|sample| sample.z[0]),
            x_between: Vec::new(),
            z_between: between(samples, |sample| &sample.z),
            x_matters: x_matters(path, samples, limits)?,
            speed_varies,
            clock: speed_varies.then(|| Clock::new(path.spindle, &n)),
            coupling: Coupling::default(),
            most_acceleration: f64::INFINITY,
            n,
            c,
        };
        if table.x_matters {
            table.x_between = between(samples, |sample| &sample.x);
        }
        if table.x_matters || table.speed_varies {
            table.coupling = table.couple()?;
        }
        let allowed = Allowed {
            z: limits.allowed,
            slope: &table.coupling.slope,
            x_weight: &table.coupling.x_weight,
            max_step: TAU * limits.max_step,
        };
        let spindle = speed_varies.then_some(path.spindle);
        table.most_acceleration = acceleration::largest(samples, allowed, spindle);
        Ok(table)
    }

    fn couple(&self) -> Result<Coupling> {
        let blank = vec![f64::NAN; self.n.len()];
        let [mut x_theta, mut x_rho] = [blank.clone(), blank.clone()];
        let [mut along, mut slope] = [blank.clone(), blank];
        let theta: Vec<f64> = self.n.iter().map(|n| angle(*n)).collect();
        let rho: Vec<f64> = self.n.iter().map(|n| self.path.radius_at(*n)).collect();
        let rates = Rates {
            x_theta: &mut x_theta,
            x_rho: &mut x_rho,
            z_theta: &mut along,
            z_x: &mut slope,
        };
        self.path.locus.rates(&theta, &rho, rates)?;
        let x_weight = match self.x_matters {
            true => errors_of_x(self.path, &self.n)?
                .into_iter()
                .map(f64::recip)
                .collect(),
            false => Vec::new(),
        };
        Ok(Coupling {
            slope,
            along,
            x_weight,
        })
    }

    /// The span's end, in revolutions.
    pub fn end(&self) -> f64 {
        self.n.last().copied().unwrap_or_default()
    }

    /// A border of the span: with the rates that the host computes there.
    pub fn border(&self, n: f64) -> Result<Place> {
        let mut place = self.place(n);
        let [mut x_theta, mut x_rho, mut z_theta, mut z_x] = [[f64::NAN]; 4];
        let rates = Rates {
            x_theta: &mut x_theta,
            x_rho: &mut x_rho,
            z_theta: &mut z_theta,
            z_x: &mut z_x,
        };
        self.path
            .locus
            .rates(&[angle(n)], &[self.path.radius_at(n)], rates)?;
        let rate = self.path.law.rate(n);
        let x_rate = x_theta[0] + x_rho[0] * rate / TAU;
        place.is_kink = is_kink(self.path, n);
        if self.x_matters {
            place.x_rate = place.c_rate * x_rate;
        }
        place.z_rate = place.c_rate * (z_theta[0] + z_x[0] * x_rate);
        Ok(place)
    }

    /// The path at `n`, which lies in the span. Between two places it is the quintic through both,
    /// which at this density is the path to a billionth of the tolerance.
    pub fn place(&self, n: f64) -> Place {
        self.place_behind(n, 0)
    }

    /// The same where `n` lies at or behind the place before `next`, and not far from it.
    pub fn place_behind(&self, n: f64, next: usize) -> Place {
        let next = self.next_behind(n, next);
        let low = next.clamp(1, self.n.len() - 1) - 1;
        let at = TAU * (n - self.n[low]);
        let start = self.n[0];
        let (t, c_rate) = match &self.clock {
            Some(clock) => clock.at(n, low),
            None => (TAU * (n - start), 1.0),
        };
        let (z, z_rate) = value_and_rate(&self.z_between[low], at);
        let (x, x_rate) = match self.x_matters {
            true => value_and_rate(&self.x_between[low], at),
            false => (0.0, 0.0),
        };
        Place {
            n,
            t,
            z,
            z_rate: z_rate * c_rate,
            x,
            x_rate: x_rate * c_rate,
            c: TAU * (n - start),
            c_rate,
            is_kink: false,
            next,
        }
    }

    /// The index of the first place behind `n`, which is `least` or a larger one: in steps that double, since it
    /// is most often near.
    fn next_behind(&self, n: f64, least: usize) -> usize {
        let (mut low, mut step) = (least.min(self.n.len()), FIRST_STEP);
        while self.n.get(low + step).is_some_and(|place| *place <= n) {
            low += step;
            step *= 2;
        }
        let high = (low + step).min(self.n.len());
        low + self.n[low..high].partition_point(|place| *place <= n)
    }

    /// ∂Z/∂X and ∂Z/∂θ near place `next`, and the weight of X's error.
    pub fn coupling_near(&self, next: usize) -> [f64; 3] {
        let k = next.min(self.n.len() - 1);
        let of = |column: &[f64]| column.get(k).copied().unwrap_or_default();
        let Coupling {
            slope,
            along,
            x_weight,
        } = &self.coupling;
        [of(slope), of(along), of(x_weight)]
    }
}

/// One coordinate between each place and the next one.
fn between(samples: &[Sample], of: fn(&Sample) -> &Series) -> Vec<Quintic> {
    let end = |sample: &Sample| {
        let series = of(sample);
        [series[0], series[1], 2.0 * series[2]]
    };
    let quintic = |pair: &[Sample]| {
        let width = TAU * (pair[1].n - pair[0].n);
        quintic(end(&pair[0]), end(&pair[1]), width)
    };
    samples.windows(2).map(quintic).collect()
}

fn value_and_rate(c: &Quintic, at: f64) -> (f64, f64) {
    let value = c.iter().rev().fold(0.0, |sum, c| sum * at + c);
    let rate = (1..6).rev().fold(0.0, |sum, k| sum * at + k as f64 * c[k]);
    (value, rate)
}

/// Whether t(N) is not a straight line between two places.
fn speed_varies(spindle: &SpindleLaw, start: f64, end: f64) -> bool {
    let window = spindle.window(start, end);
    let rate = spindle.as_time().rate(start);
    let straight = |piece: &Piece| {
        piece.coefficients[1] == rate && piece.coefficients[2..].iter().all(|c| *c == 0.0)
    };
    !window.as_time().pieces().iter().all(straight)
}

/// Whether X's own error, on the largest step, can change Z or the cusps.
fn x_matters(path: &Path<'_>, samples: &[Sample], limits: Limits) -> Result<bool> {
    let [start, end] = [samples.first(), samples.last()].map(|s| s.map_or(0.0, |s| s.n));
    if is_kink(path, start) || is_kink(path, end) {
        return Ok(true);
    }
    let fourth = samples.iter().map(|sample| 24.0 * sample.x[4].abs());
    let mut bound = Bound {
        fourth: fourth.fold(0.0, f64::max),
        jumps: Jumps::default(),
    };
    let mut narrowest = f64::INFINITY;
    for n in path.law.knots(start, end).chain([start, end]) {
        narrowest = narrowest.min(pitch(path, n));
    }
    for n in path.law.knots(start, end) {
        let [before, after] = sides(path, n)?;
        bound.jumps = bound.jumps.and(jumps(&before.x, &after.x));
    }
    let error = bound.error(TAU * limits.max_step);
    Ok(error > NEGLIGIBLE * limits.allowed / STEEPEST
        || error > NEGLIGIBLE_SHARE * limits.feed_part * narrowest)
}

/// Whether the law's rate jumps at `n`, so that the rate of X there belongs to neither side.
fn is_kink(path: &Path<'_>, n: f64) -> bool {
    let [before, after] = [path.law.series_before(n)[1], path.law.series(n)[1]];
    (after - before).abs() > ROUNDING * before.abs().max(after.abs())
}

/// A knot of the law with the pieces on both of its sides.
pub fn sides(path: &Path<'_>, n: f64) -> Result<[Sample; 2]> {
    let (mut x, mut z) = ([[f64::NAN; 5]], [[f64::NAN; 5]]);
    path.series_at(&[n], &mut x, &mut z)?;
    let ([x], [z]) = (x, z);
    Ok([sample_before(path, n)?, Sample { n, x, z }])
}

/// The jumps of the derivatives of one coordinate.
pub fn jumps(before: &Series, after: &Series) -> Jumps {
    let jump = |k: usize, factorial: f64| factorial * (after[k] - before[k]).abs();
    Jumps {
        first: jump(1, 1.0),
        second: jump(2, 2.0),
        third: jump(3, 6.0),
    }
}
