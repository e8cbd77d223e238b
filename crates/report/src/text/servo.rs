//! The lines on the servos.

use crate::servo::ServoReport;
use crate::unit;

use super::numbers::{against, line, path_place, small_length};

/// The lines on the servos.
pub fn servo(servo: &ServoReport, tolerance: Option<f64>, holds: Option<bool>) -> String {
    let (error, lag) = (&servo.predicted_error, &servo.following_error);
    let (max, rms) = (small_length(error.max), small_length(error.rms));
    let at = path_place(&error.at);
    let predicted = format!("{max:>12} predicted, {rms} rms; the largest at {at}");
    let judged = match tolerance.zip(holds) {
        Some((tolerance, holds)) => line("", against(error.max, tolerance, holds)),
        None => String::new(),
    };
    let (x, z) = (small_length(lag.x.max), small_length(lag.z.max));
    let c = lag.c.max * unit::arcsec::PER;
    let follows = format!("follows to {x} in X, {z} in Z, {c:.2} arcsec in C");
    line("servo", predicted) + &judged + &line("", follows)
}
