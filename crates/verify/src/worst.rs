//! The largest error of a segment, from the errors at its instants.

use turnpath_core::registers::{Loop, in_widest};

use crate::instants::{BATCH, INSTANTS, InstantBatch};

/// The largest error of one segment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    /// Signed error, played − true, mm.
    pub error: f64,
    /// Its position in the segment, 0 to 1.
    pub at: f64,
}

impl Worst {
    /// The largest of the errors at each segment's instants, and of the parabola through it and its
    /// neighbours. The first error that is NaN outweighs all.
    pub fn of_batch(instants: &InstantBatch) -> impl Iterator<Item = Self> {
        let largest = in_widest(LargestInstants(instants));
        let segments = largest.instant.into_iter().zip(largest.error).enumerate();
        segments.map(|(segment, (instant, error))| {
            let (rise, shift) = match instants.around(segment, instant as usize) {
                Some([before, top, after]) => beyond_sample(before, top, after),
                None => (0.0, 0.0),
            };
            Self {
                error: error + rise,
                at: (instant + shift) / INSTANTS as f64,
            }
        })
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

/// The loop that finds the instant with the largest error of each segment.
struct LargestInstants<'a>(&'a InstantBatch);

/// The largest error of each segment at its instants, and the number of the instant.
struct LargestErrors {
    error: [f64; BATCH],
    instant: [f64; BATCH],
}

impl Loop for LargestInstants<'_> {
    type Output = LargestErrors;

    #[inline(always)]
    fn call(self) -> LargestErrors {
        let (mut largest, mut at) = ([0.0_f64; BATCH], [0.0; BATCH]);
        for (instant, errors) in self.0.each_instant().enumerate() {
            for ((error, largest), at) in errors.iter().zip(&mut largest).zip(&mut at) {
                let is_larger =
                    (error.abs() > largest.abs()) | (error.is_nan() & !largest.is_nan());
                *largest = if is_larger { *error } else { *largest };
                *at = if is_larger { instant as f64 } else { *at };
            }
        }
        LargestErrors {
            error: largest,
            instant: at,
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
