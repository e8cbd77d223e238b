//! The time of the places of a span, where the spindle changes its speed.

use turnpath_plugin::prelude::*;

/// The spindle law of one span. It finds the piece of the law from the number of a place, without a search
/// through all pieces.
pub struct Clock {
    law: SpindleLaw,
    /// Time at the span's start, s.
    start: f64,
    /// For each place of the table, the number of the piece of the law there.
    pieces: Vec<usize>,
}

impl Clock {
    /// The clock for these places, which are in order.
    pub fn new(spindle: &SpindleLaw, places: &[f64]) -> Self {
        let [start, end] = [places.first(), places.last()].map(|n| n.copied().unwrap_or_default());
        let law = spindle.window(start, end);
        let number = |n: &f64| {
            let pieces = law.as_time().pieces();
            let next = pieces.partition_point(|piece| piece.start <= *n);
            next.saturating_sub(1)
        };
        Self {
            start: spindle.time_at(start),
            pieces: places.iter().map(number).collect(),
            law,
        }
    }

    /// The time of place `low` and of each behind it, s, and the speed, rad/s: at `n` revolutions, which lie
    /// between that place and the next one.
    pub fn at(&self, n: f64, low: usize) -> (f64, f64) {
        let pieces = self.law.as_time().pieces();
        let mut number = self.pieces.get(low).copied().unwrap_or_default();
        while pieces.get(number + 1).is_some_and(|next| next.start <= n) {
            number += 1;
        }
        match pieces.get(number).filter(|piece| piece.start < n) {
            Some(piece) => (piece.value(n) - self.start, TAU / piece.rate(n)),
            // Before all pieces, and at a knot, where both sides count.
            None => (self.law.time_at(n) - self.start, self.law.speed_at(n)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_speeds_are_those_of_the_whole_law_to_the_last_bit() {
        let mut time = PiecewisePolynomial::new();
        for k in 0..40 {
            let k = f64::from(k);
            time.push(
                0.25,
                [0.03 * k, 0.12 + 0.001 * k, -0.002, 0.0003, 0.0, 0.01],
            );
        }
        let spindle = SpindleLaw::from_time(time);
        let places: Vec<f64> = (0..=90).map(|k| 3.0 + 0.05 * f64::from(k)).collect();
        let clock = Clock::new(&spindle, &places);
        for (low, pair) in places.windows(2).enumerate() {
            for part in [0.0, 0.01, 0.3, 0.5, 0.99] {
                let n = pair[0] + part * (pair[1] - pair[0]);
                let whole = (
                    spindle.time_at(n) - spindle.time_at(3.0),
                    spindle.speed_at(n),
                );
                assert_eq!(clock.at(n, low), whole, "{n}");
            }
        }
        assert_eq!(clock.at(3.25, 4).1, spindle.speed_at(3.25));
    }
}
