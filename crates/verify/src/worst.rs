//! The largest error of one segment, from the errors at its instants.

use crate::instants::INSTANTS;

/// The largest error of one segment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    /// Signed error, played − true, mm.
    pub error: f64,
    /// Its position in the segment, 0 to 1.
    pub at: f64,
}

impl Worst {
    /// The largest of the errors at a segment's instants, and of the parabola through it and its
    /// neighbours.
    pub fn of(errors: &[f64; INSTANTS]) -> Self {
        let mut worst = 0;
        for (k, error) in errors.iter().enumerate() {
            if error.is_nan() || error.abs() > errors[worst].abs() {
                worst = k;
            }
            if error.is_nan() {
                break;
            }
        }
        let (rise, shift) = match worst.checked_sub(1).and_then(|k| errors.get(k..k + 3)) {
            Some(&[before, top, after]) => beyond_sample(before, top, after),
            _ => (0.0, 0.0),
        };
        Self {
            error: errors[worst] + rise,
            at: (worst as f64 + shift) / INSTANTS as f64,
        }
    }

    /// The larger of the two; `self` if they are equal.
    pub fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.amount() > self.amount() => other,
            _ => self,
        }
    }

    /// The amount of the error, mm; infinite if the error is NaN.
    pub fn amount(&self) -> f64 {
        if self.error.is_nan() {
            f64::INFINITY
        } else {
            self.error.abs()
        }
    }
}

/// The parabola through three neighbouring samples, the middle one being the largest: how far its
/// top lies beyond the middle sample, and how many steps after it.
fn beyond_sample(before: f64, top: f64, after: f64) -> (f64, f64) {
    let (tilt, bend) = (0.5 * (after - before), 2.0 * top - before - after);
    let shift = tilt / bend;
    if shift.abs() <= 0.5 {
        (0.5 * tilt * shift, shift)
    } else {
        (0.0, 0.0)
    }
}
