//! The lines on the servos.

use crate::servo::ServoReport;
use crate::unit;

use super::numbers::{line, path_place, small_length};

/// The lines on the servos.
pub fn servo(servo: &ServoReport) -> String {
    let (error, lag) = (&servo.predicted_error, &servo.following_error);
    let (max, rms) = (small_length(error.max), small_length(error.rms));
    let at = path_place(&error.at);
    let predicted = format!("{max:>12} predicted, {rms} rms; the largest at {at}");
    let (x, z) = (small_length(lag.x.max), small_length(lag.z.max));
    let c = lag.c.max * unit::arcsec::PER;
    let follows = format!("follows to {x} in X, {z} in Z, {c:.2} arcsec in C");
    line("servo", predicted) + &line("", follows)
}
