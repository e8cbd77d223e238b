//! Where the nose's next contacts are expected, from those before.
//!
//! The distance of a contact from X changes smoothly while a segment is played. So it is expected on the
//! polynomial through its values at the times before, which are evenly spaced.

use turnpath_core::registers::Loop;

use crate::search_limits::WIDTH;

/// Values before that count at the most. The polynomial through one more would be nearer to a curve, but
/// would follow the rounding of these values twice as far.
const MOST_BEFORE: usize = 4;
/// The weights of the values before in the next value, the last one first. The first list is for one known value,
/// the second for two, and so on.
const WEIGHTS: [&[f64]; MOST_BEFORE] = [
    &[1.0],
    &[2.0, -1.0],
    &[3.0, -3.0, 1.0],
    &[4.0, -6.0, 4.0, -1.0],
];

/// The loop that finds where contacts are expected.
pub(crate) struct NextContacts<'a> {
    /// The contacts of all curves at one time, then at the next one, and so on, mm.
    before: &'a [f64],
    /// X at the same times and at the next one, mm.
    x: &'a [f64],
    /// Where the contacts of the next time are expected, mm: one for each curve.
    expected: &'a mut [f64],
}

impl<'a> NextContacts<'a> {
    /// Continues the contacts of as many curves as are `expected`.
    pub fn after(before: &'a [f64], x: &'a [f64], expected: &'a mut [f64]) -> Self {
        Self {
            before,
            x,
            expected,
        }
    }
}

impl Loop for NextContacts<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            before,
            x,
            expected,
        } = self;
        let count = expected.len().min(WIDTH);
        let mut times = x.chunks_exact(count.max(1)).rev();
        let Some(next) = times.next() else { return };
        // An array of its own: the compiler sees that no other slice overlaps it.
        let mut sums = [0.0; WIDTH];
        sums[..count].copy_from_slice(next);
        let contacts = before.chunks_exact(count.max(1)).rev();
        let weights = WEIGHTS[contacts.len().clamp(1, MOST_BEFORE) - 1];
        for ((weight, contacts), x) in weights.iter().copied().zip(contacts).zip(times) {
            for i in 0..count {
                sums[i] += weight * (contacts[i] - x[i]);
            }
        }
        expected[..count].copy_from_slice(&sums[..count]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts of three curves at five times: X and a cubic of the time for each curve.
    #[test]
    fn a_cubic_goes_on_from_four_contacts() {
        let x = |time: usize, curve: usize| 10.0 + 0.25 * time as f64 - curve as f64;
        let away = |time: usize, curve: usize| {
            let t = time as f64;
            0.5 + t * (curve as f64 - 0.5 * t + 0.125 * t * t)
        };
        let columns = |of: &dyn Fn(usize, usize) -> f64, times: usize| -> Vec<f64> {
            let all = (0..times).flat_map(|time| (0..3).map(move |curve| (time, curve)));
            all.map(|(time, curve)| of(time, curve)).collect()
        };
        let contact = |time: usize, curve: usize| x(time, curve) + away(time, curve);
        let next = |times: usize| {
            let (before, x) = (columns(&contact, times), columns(&x, times + 1));
            let mut expected = [f64::NAN; 3];
            NextContacts::after(&before, &x, &mut expected).call();
            expected
        };
        for times in [4, 5] {
            assert_eq!(next(times), [0, 1, 2].map(|curve| contact(times, curve)));
        }
        assert_eq!(next(1), [0, 1, 2].map(|curve| x(1, curve) + away(0, curve)));
    }

    #[test]
    fn nothing_is_expected_behind_a_contact_that_is_none() {
        let mut expected = [0.0; 2];
        NextContacts::after(&[f64::NAN, 3.5], &[3.0, 3.0, 4.0, 4.0], &mut expected).call();
        assert!(expected[0].is_nan());
        assert_eq!(expected[1], 4.5);
    }
}
