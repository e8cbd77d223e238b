//! The machine's limits, for a cell whose speed is constant and for one whose speed changes.

use turnpath_plugin::prelude::*;

use crate::law::Motion;
use crate::motion::{CellMotion, Derivatives};

/// What a machine allows; infinite where no limit is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    x: [f64; 3],
    z: [f64; 3],
    /// C: rad/s, rad/s², rad/s³.
    pub c: [f64; 3],
}

impl Limits {
    /// The limits of a machine.
    pub fn of(machine: &Machine) -> Self {
        let known = |limits: &AxisLimits| {
            [limits.velocity, limits.acceleration, limits.jerk]
                .map(|limit| limit.unwrap_or(f64::INFINITY))
        };
        Self {
            x: known(&machine.x),
            z: known(&machine.z),
            c: known(&machine.c),
        }
    }

    /// The largest constant speed of a cell, rad/s.
    pub fn steady_speed(&self, cell: &CellMotion) -> f64 {
        let of_axis = |limits: &[f64; 3], motion: &Derivatives| {
            let speeds = (0..3).map(|k| root(limits[k] / motion[k], k));
            speeds.fold(f64::INFINITY, smaller)
        };
        let (x, z) = (of_axis(&self.x, &cell.x), of_axis(&self.z, &cell.z));
        x.min(z).min(self.c[0])
    }

    /// By which factor X and Z could be faster in a cell: 1 or less is beyond a limit or on it.
    ///
    /// The largest amounts of all derivatives are taken together, wherever in the cell they are.
    pub fn factor_of_axes(&self, cell: &CellMotion, motion: &Motion) -> f64 {
        let Motion {
            speed,
            acceleration,
            jerk,
        } = *motion;
        let of_axis = |limits: &[f64; 3], p: &Derivatives| {
            let amounts = [
                p[0] * speed,
                p[1] * speed * speed + p[0] * acceleration,
                p[2] * speed * speed * speed + 3.0 * p[1] * speed * acceleration + p[0] * jerk,
            ];
            factor(limits, &amounts)
        };
        of_axis(&self.x, &cell.x).min(of_axis(&self.z, &cell.z))
    }

    /// By which factor C could be faster with this motion.
    pub fn factor_of_c(&self, motion: &Motion) -> f64 {
        let Motion {
            speed,
            acceleration,
            jerk,
        } = *motion;
        factor(&self.c, &[speed, acceleration, jerk])
    }
}

/// The least factor by which a whole motion with these amounts could be faster. The n-th derivative
/// grows with the n-th power. Where no limit is reached it is above 1, and says no more than that.
fn factor(limits: &[f64; 3], amounts: &[f64; 3]) -> f64 {
    let factors = (0..3).map(|k| {
        let ratio = limits[k] / amounts[k];
        if ratio < 1.0 {
            root(ratio, k)
        } else {
            ratio.min(2.0)
        }
    });
    factors.fold(f64::INFINITY, smaller)
}

/// The root of order k + 1.
fn root(value: f64, k: usize) -> f64 {
    match k {
        0 => value,
        1 => value.sqrt(),
        _ => Scalar::powf(value, 1.0 / 3.0),
    }
}

/// The smaller of both; a quotient of two zeros or two infinities does not count.
fn smaller(least: f64, other: f64) -> f64 {
    if other < least { other } else { least }
}
