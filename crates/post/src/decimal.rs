//! Writes fixed-point numbers as decimal text.

use std::io::Write;

use crate::line_room::{OF_NUMBER, push_in_room};

/// Appends `units` · 10^−`decimals` without trailing zeros.
pub(crate) fn push(text: &mut Vec<u8>, units: impl Into<i128>, decimals: u32) {
    let units: i128 = units.into();
    let short = i64::try_from(units).ok();
    if !push_in_room::<OF_NUMBER>(text, |line| line.number(short?, decimals)) {
        push_long(text, units, decimals);
    }
}

/// Appends a number with any count of digits.
fn push_long(text: &mut Vec<u8>, units: i128, decimals: u32) {
    if units < 0 {
        text.push(b'-');
    }
    let (size, one) = (units.unsigned_abs(), 10u128.pow(decimals));
    // Writing to memory cannot fail.
    let _ = write!(text, "{}", size / one);
    let fraction = size % one;
    if fraction > 0 {
        let _ = write!(text, ".{fraction:0width$}", width = decimals as usize);
        drop_zeros(text);
    }
}

fn drop_zeros(text: &mut Vec<u8>) {
    let zeros = text.iter().rev().take_while(|digit| **digit == b'0');
    text.truncate(text.len() - zeros.count());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (units, decimals, text) in [
            (0, 7, "0"),
            (-1, 7, "-0.0000001"),
            (12_345, 2, "123.45"),
            (-90_000_000, 7, "-9"),
            (5, 0, "5"),
            (i64::MAX, 7, "922337203685.4775807"),
            (i64::MIN, 18, "-9.223372036854775808"),
            (i64::MIN, 25, "-0.0000009223372036854775808"),
            (10_200_000, 7, "1.02"),
        ] {
            let mut written = Vec::new();
            push(&mut written, units, decimals);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }

    /// A short number has the same digits on both ways, whatever its size.
    #[test]
    fn short_and_long_numbers_are_written_alike() {
        let mut state = 1_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state as i64
        };
        let mut short = 0;
        for decimals in 0..=20 {
            let ones = (0..19).map(|k| 10_i64.pow(k));
            let near = ones.flat_map(|one| [one - 1, one, one + 1, 7 * (one / 10)]);
            let others = (0..2000).map(|k| next() >> (k % 64));
            for units in near.chain(others).chain([0, i64::MIN, i64::MAX]) {
                for units in [units, units.wrapping_neg()] {
                    let (mut room, mut plain) = (b"X".to_vec(), b"X".to_vec());
                    if push_in_room::<OF_NUMBER>(&mut room, |line| line.number(units, decimals)) {
                        push_long(&mut plain, units.into(), decimals);
                        short += 1;
                    }
                    assert_eq!(room, plain, "{units} {decimals}");
                }
            }
        }
        assert!(short > 20_000, "{short}");
    }
}
