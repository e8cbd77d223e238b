//! How much Z may accelerate: little more than on a path whose nodes all lie on the locus.
//!
//! A cubic with exact ends accelerates there by L²φ⁗/12 more than the locus: by 1.63 √(εφ⁗) where the
//! tolerance decides. With its ends ε off the locus it does so by 2.31 √(εφ⁗), and other states make it
//! more. Where waves are hardly higher than the tolerance, that is much of the acceleration that they
//! ask for themselves.

use turnpath_plugin::prelude::*;

use crate::grid::{Sample, on_locus_step};

/// By how much Z may accelerate, over what it does on a path with all nodes on the locus. Less would
/// cost points; more shakes Z.
const OVER_LOCUS: f64 = 1.02;

/// What the steps of a span may err by.
#[derive(Debug, Clone, Copy)]
pub struct Allowed<'a> {
    /// Z, mm.
    pub z: f64,
    /// ∂Z/∂X at each place; empty where X's own error does not matter.
    pub slope: &'a [f64],
    /// One over what X may, 1/mm, at each place; empty where X's own error does not matter.
    pub x_weight: &'a [f64],
    /// The largest step, rad.
    pub max_step: f64,
}

/// The largest acceleration of Z that a step of the span may have, mm over the square of the table's
/// time.
pub fn largest(samples: &[Sample], allowed: Allowed<'_>, spindle: Option<&SpindleLaw>) -> f64 {
    let of_sample = |(k, sample): (usize, &Sample)| {
        let fourth = 24.0 * sample.z[4].abs();
        let x_weight = allowed.x_weight.get(k).copied().unwrap_or_default();
        let slope = allowed.slope.get(k).copied().unwrap_or_default();
        let beside_x = 24.0 * (sample.z[4] - slope * sample.x[4]).abs();
        let step = on_locus_step(allowed.z, fourth.max(beside_x))
            .min(on_locus_step(1.0, 24.0 * sample.x[4].abs() * x_weight))
            .min(allowed.max_step);
        let in_angle = 2.0 * sample.z[2].abs() + step * step * fourth / 12.0;
        match spindle {
            Some(spindle) => {
                let speed = spindle.speed_at(sample.n);
                let change = Pace::after(spindle, sample.n).change();
                speed * speed * (in_angle + sample.z[1].abs() * change)
            }
            None => in_angle,
        }
    };
    let largest = samples.iter().enumerate().map(of_sample);
    OVER_LOCUS * largest.fold(0.0, f64::max)
}
