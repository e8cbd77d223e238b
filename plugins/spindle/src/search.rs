//! The fastest of several smooth schedules, all within the limits.

use turnpath_plugin::prelude::*;

use crate::grid::Grid;
use crate::law::{Law, Motion};
use crate::limits::Limits;
use crate::motion::CellMotion;
use crate::smooth::Smoother;

/// Parts of C's largest acceleration with which a schedule changes its speed. The jerk that the mean
/// leaves decides which is best.
const ACCELERATIONS: [f64; 7] = [0.1, 0.15, 0.22, 0.32, 0.46, 0.68, 1.0];
/// Turns on either side over which the time of a turn is averaged.
const REACHES: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// While the best schedule has the largest of the reaches or the smallest of the accelerations, twice
/// the one and half the other are tried, so often at the most. A spindle that may hardly change its
/// speed needs many turns for it.
const MOST_EXTENSIONS: usize = 10;
/// How often a schedule is lowered where it is beyond a limit.
const ROUNDS: usize = 4;
/// How many of the first schedules are lowered in this way: the fastest ones.
const FINALISTS: usize = 4;
/// A schedule is taken if it saves this part of the time at a constant speed. Below it the speed
/// would change by next to nothing, and rounding would stand against C's limits.
const WORTH: f64 = 1e-3;
/// The spindle stays below its largest speed by this part, for rounding.
const ROUNDING: f64 = 1e-11;
/// A cell counts as within its limits up to this part of its speed.
const WITHIN: f64 = 1e-5;

/// What a schedule must keep to.
pub struct Conditions<'a> {
    /// The cells of the path.
    pub grid: Grid,
    /// What each cell asks of X and Z.
    pub cells: &'a [CellMotion],
    /// What the machine allows.
    pub limits: Limits,
    /// The largest speed of each cell, rad/s: that at which the axes as played keep to the limits, or
    /// less.
    pub bounds: Vec<f64>,
    /// The largest speed of all, rad/s.
    pub speed: f64,
}

/// A schedule, and the factor by which it must be faster (above 1: or may be) to reach the limits.
struct Schedule {
    law: Law,
    factor: f64,
    /// How long the path takes at that factor, s.
    time: f64,
    smoother: Smoother,
    /// The largest speeds from which the schedule is made, rad/s.
    speeds: Vec<f64>,
}

impl Conditions<'_> {
    /// The fastest schedule that is nowhere faster than `speeds`, rad/s. It is never slower than the
    /// slowest of them all the way.
    pub fn fastest(&self, speeds: Vec<f64>) -> SpindleLaw {
        let least = speeds.iter().copied().fold(self.speed, f64::min);
        if least >= self.speed {
            return SpindleLaw::constant(self.speed);
        }
        let mut first = Vec::new();
        for smoother in self.smoothers() {
            first.extend(self.finalist(smoother, &speeds, &first));
        }
        self.extend(&mut first, &speeds);
        first.sort_by(|one, other| one.time.total_cmp(&other.time));
        first.truncate(FINALISTS);
        let finished = first.into_iter().map(|schedule| self.lowered(schedule));
        let fastest = finished.min_by(|one, other| one.time.total_cmp(&other.time));
        let constant = TAU * self.grid.end / least;
        match fastest.filter(|schedule| schedule.time < (1.0 - WORTH) * constant) {
            Some(schedule) => schedule.law.into_spindle(schedule.factor),
            None => SpindleLaw::constant(least),
        }
    }

    /// Adds schedules with larger reaches and smaller accelerations, as long as they are the fastest.
    fn extend(&self, schedules: &mut Vec<Schedule>, speeds: &[f64]) {
        let accelerations = self.smoothers().map(|smoother| smoother.acceleration);
        let least = accelerations.fold(f64::INFINITY, f64::min);
        let largest = REACHES.into_iter().fold(0.0, f64::max);
        for _ in 0..MOST_EXTENSIONS {
            let fastest = schedules.iter().min_by(|a, b| a.time.total_cmp(&b.time));
            let Some(Schedule { smoother, time, .. }) = fastest else {
                return;
            };
            let (
                Smoother {
                    acceleration,
                    reach,
                },
                time,
            ) = (*smoother, *time);
            let mut more = Vec::new();
            if reach >= largest && 2.0 * reach <= self.grid.end {
                more.push(Smoother {
                    acceleration,
                    reach: 2.0 * reach,
                });
            }
            if acceleration <= least && acceleration.is_finite() {
                more.push(Smoother {
                    acceleration: 0.5 * acceleration,
                    reach,
                });
            }
            let mut is_faster = false;
            for smoother in more {
                let schedule = self.finalist(smoother, speeds, schedules);
                is_faster |= schedule.as_ref().is_some_and(|found| found.time < time);
                schedules.extend(schedule);
            }
            if !is_faster {
                return;
            }
        }
    }

    fn smoothers(&self) -> impl Iterator<Item = Smoother> {
        let largest = self.limits.c[1];
        let accelerations = ACCELERATIONS.map(|part| part * largest);
        // Without a limit all of them are the same.
        let count = if largest.is_finite() {
            accelerations.len()
        } else {
            1
        };
        let accelerations = accelerations.into_iter().take(count);
        accelerations.flat_map(|acceleration| {
            REACHES.map(|reach| Smoother {
                acceleration,
                reach,
            })
        })
    }

    /// The schedule of these speeds; `None` if it is slower than [`FINALISTS`] others.
    fn finalist(
        &self,
        smoother: Smoother,
        speeds: &[f64],
        others: &[Schedule],
    ) -> Option<Schedule> {
        let mut times: Vec<f64> = others.iter().map(|other| other.time).collect();
        times.sort_by(f64::total_cmp);
        let most = times.get(FINALISTS - 1).copied().unwrap_or(f64::INFINITY);
        let found = self.schedule(smoother, speeds.to_vec(), most)?;
        Some(found.0)
    }

    /// The schedule of these speeds, and for each cell the speed that it should have had; infinite
    /// where the cell is within its limits. `None` if the path takes more time than `most`, s; so never
    /// where `most` is infinite.
    fn schedule(
        &self,
        smoother: Smoother,
        speeds: Vec<f64>,
        most: f64,
    ) -> Option<(Schedule, Vec<f64>)> {
        let law = Law::new(&self.grid, &smoother.apply(&self.grid, &speeds));
        let time = law.time();
        let mut factor: f64 = 1.0;
        let mut asked = Vec::with_capacity(speeds.len());
        let cells = self.cells.iter().zip(&self.bounds);
        for ((cell, bound), motion) in cells.zip(law.motions()) {
            let of_path = self.limits.factor_of_axes(cell, &motion);
            let of_axes = of_path.min(bound / motion.speed);
            let of_c = self.limits.factor_of_c(&motion).min(self.of_speed(&motion));
            factor = factor.min(of_axes).min(of_c);
            if time / factor > most {
                return None;
            }
            asked.push(match of_axes < 1.0 - WITHIN {
                true => of_axes * motion.speed,
                false => f64::INFINITY,
            });
        }
        let schedule = Schedule {
            time: time / factor,
            law,
            factor,
            smoother,
            speeds,
        };
        Some((schedule, asked))
    }

    fn of_speed(&self, motion: &Motion) -> f64 {
        let factor = self.speed / motion.speed;
        if factor < 1.0 + ROUNDING {
            factor - ROUNDING
        } else {
            factor
        }
    }

    /// The best that a schedule becomes if it is lowered where it is beyond a limit, and not
    /// everywhere.
    fn lowered(&self, schedule: Schedule) -> Schedule {
        let mut best = schedule;
        let (smoother, mut speeds) = (best.smoother, best.speeds.clone());
        for _ in 0..ROUNDS {
            let every = self.schedule(smoother, speeds.clone(), f64::INFINITY);
            let Some((now, asked)) = every else {
                break;
            };
            if now.time < best.time {
                best = now;
            }
            if asked.iter().all(|asked| asked.is_infinite()) {
                break;
            }
            for (speed, asked) in speeds.iter_mut().zip(asked) {
                *speed = speed.min(asked);
            }
        }
        best
    }
}
