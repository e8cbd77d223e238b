//! Lengths of steps in time.

use std::f64::consts::TAU;

use crate::{Path, SpindleLaw};

/// Measures a step by its time. The unit is the time in which the spindle makes a radian at the
/// reference, so that lengths are angles where the speed is constant.
#[derive(Clone, Copy)]
pub struct Clock<'a> {
    /// `None` where the speed is constant.
    spindle: Option<&'a SpindleLaw>,
    /// The speed at the reference, rad/s.
    reference: f64,
}

impl<'a> Clock<'a> {
    /// The clock of a path, with its reference at `n` revolutions.
    pub fn new(path: &Path<'a>, n: f64) -> Self {
        Self {
            spindle: Some(path.spindle).filter(|spindle| !spindle.is_constant()),
            reference: path.spindle.speed_at(n),
        }
    }

    /// The spindle law; `None` where the speed is constant.
    pub fn spindle(&self) -> Option<&'a SpindleLaw> {
        self.spindle
    }

    /// The length of a step.
    pub fn length(&self, from: f64, to: f64) -> f64 {
        match self.spindle {
            None => TAU * (to - from),
            Some(spindle) => self.reference * (spindle.time_at(to) - spindle.time_at(from)),
        }
    }

    /// The end of a step of this length, in revolutions.
    pub fn end(&self, from: f64, length: f64) -> f64 {
        match self.spindle {
            None => from + length / TAU,
            Some(spindle) => {
                let guess = from + length / TAU * self.speed(from);
                spindle.revolutions_at(spindle.time_at(from) + length / self.reference, guess)
            }
        }
    }

    /// The speed at `n` revolutions over that at the reference: how many radians a length of 1 is.
    pub fn speed(&self, n: f64) -> f64 {
        match self.spindle {
            None => 1.0,
            Some(spindle) => spindle.speed_at(n) / self.reference,
        }
    }
}
