//! The decimals of many numbers at once, in vector registers.

use turnpath_core::registers::{Loop, in_widest};

use crate::digit_columns::TO_WHOLE;
use crate::eight_digits::{PIECE, eight_digits};
use crate::powers_of_ten::POWERS_OF_TEN;

/// Numbers whose digits are found together: few, so that they stay in the nearest cache.
pub(crate) const AT_ONCE: usize = 32;
/// Numbers with more last digits are not found here.
const LARGEST: u64 = 1 << 50;

/// Numbers with up to eight digits before the point and eight behind it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NumberColumn {
    is_negative: [bool; AT_ONCE],
    /// The eight digits before the point, the first one in the lowest byte.
    whole: [u64; AT_ONCE],
    /// Those behind it.
    fraction: [u64; AT_ONCE],
}

/// A number's digits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NumberDigits {
    pub(crate) is_negative: bool,
    /// The eight digits before the point, the first one in the lowest byte.
    pub(crate) whole: u64,
    /// Those behind it.
    pub(crate) fraction: u64,
}

impl NumberColumn {
    /// A column without numbers.
    pub(crate) const EMPTY: Self = Self {
        is_negative: [false; AT_ONCE],
        whole: [0; AT_ONCE],
        fraction: [0; AT_ONCE],
    };

    /// Finds the digits of each `units` · 10^−`decimals`; says whether all of them are so short. Where they are not, or
    /// the decimals are more than eight, the column has no meaning.
    pub(crate) fn find(&mut self, units: &[i64; AT_ONCE], decimals: u32) -> bool {
        let places = (PIECE as u32).checked_sub(decimals);
        let powers = places.and_then(|places| {
            let power = |of: u32| POWERS_OF_TEN.get(of as usize).copied();
            power(decimals).zip(power(places))
        });
        let Some((one, scale)) = powers else {
            return false;
        };
        in_widest(Split {
            units,
            one: one as f64,
            scale: scale as f64,
            column: self,
        })
    }

    /// The digits of one of the numbers that were found.
    #[inline(always)]
    pub(crate) fn at(&self, index: usize) -> Option<NumberDigits> {
        Some(NumberDigits {
            is_negative: *self.is_negative.get(index)?,
            whole: *self.whole.get(index)?,
            fraction: *self.fraction.get(index)?,
        })
    }
}

/// The loop that parts numbers at their point; it says whether all of them are short.
struct Split<'a> {
    units: &'a [i64; AT_ONCE],
    /// One in last digits.
    one: f64,
    /// What makes the decimals eight.
    scale: f64,
    column: &'a mut NumberColumn,
}

impl Loop for Split<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self {
            units,
            one,
            scale,
            column,
        } = self;
        let mut fits = true;
        for (i, units) in units.iter().enumerate() {
            let size = units.unsigned_abs();
            let value = f64::from_bits(size.wrapping_add(TO_WHOLE.to_bits())) - TO_WHOLE;
            // The quotient's nearest whole number, and the one before it where that is too large.
            let nearest = (value / one + TO_WHOLE) - TO_WHOLE;
            let is_over = nearest * one > value;
            let whole = nearest - if is_over { 1.0 } else { 0.0 };
            let fraction = (value - whole * one) * scale;
            fits &= (size <= LARGEST) & (whole < POWERS_OF_TEN[PIECE] as f64);
            column.is_negative[i] = *units < 0;
            column.whole[i] = eight_digits(bits_of_whole(whole));
            column.fraction[i] = eight_digits(bits_of_whole(fraction));
        }
        fits
    }
}

/// A whole number below 2³² as an integer.
#[inline(always)]
fn bits_of_whole(value: f64) -> u64 {
    (value + TO_WHOLE).to_bits() & u64::from(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line_room::{OF_NUMBER, push_in_room};

    fn written(units: &[i64; AT_ONCE], decimals: u32) -> Option<Vec<String>> {
        let mut column = NumberColumn::EMPTY;
        let found = column.find(units, decimals);
        let text = |index: usize| {
            let mut text = Vec::new();
            let digits = column.at(index).unwrap();
            assert!(push_in_room::<OF_NUMBER>(&mut text, |line| line.digits(digits)));
            String::from_utf8(text).unwrap()
        };
        found.then(|| (0..AT_ONCE).map(text).collect())
    }

    /// Numbers at and beside powers of ten and of two, and some between them.
    fn numbers() -> Vec<i64> {
        let powers = POWERS_OF_TEN[..16].iter().map(|power| *power as i64);
        let powers = powers.chain((0..51).map(|bits| 1 << bits));
        let near =
            powers.flat_map(|power| [power - 1, power, power + 1, 9 * power, 37 * power / 10]);
        let near = near.chain((0..4000).map(|k: i64| (k * k * k * 7919 + k) << (k % 20)));
        near.flat_map(|number| [number, -number]).collect()
    }

    /// The text of a number that is short.
    fn alone(units: i64, decimals: u32) -> Option<String> {
        let mut text = Vec::new();
        let is_short = units.unsigned_abs() <= LARGEST
            && push_in_room::<OF_NUMBER>(&mut text, |line| line.number(units, decimals));
        is_short.then(|| String::from_utf8(text).unwrap())
    }

    #[test]
    fn digits_in_columns_are_those_of_each_number_alone() {
        for decimals in 0..=8 {
            let (short, long): (Vec<i64>, Vec<i64>) = numbers()
                .into_iter()
                .partition(|units| alone(*units, decimals).is_some());
            for chunk in short.chunks(AT_ONCE) {
                let mut units = [0; AT_ONCE];
                units[..chunk.len()].copy_from_slice(chunk);
                let expected = units.map(|units| alone(units, decimals).unwrap());
                assert_eq!(written(&units, decimals).unwrap(), expected, "{decimals}");
            }
            for units in long {
                let mut column = [37; AT_ONCE];
                column[11] = units;
                assert_eq!(written(&column, decimals), None, "{decimals} {units}");
            }
        }
    }

    #[test]
    fn more_than_eight_decimals_are_left_to_others() {
        assert_eq!(written(&[1; AT_ONCE], 9), None);
    }
}
