//! Writes fixed-point numbers as decimal text.

use std::io::Write;

/// Most decimals of a short number: one and its decimals fit into 64 bits.
const MOST_SHORT: u32 = 18;

/// Appends `units` · 10^−`decimals` without trailing zeros.
pub(crate) fn push(text: &mut Vec<u8>, units: impl Into<i128>, decimals: u32) {
    let units: i128 = units.into();
    if units < 0 {
        text.push(b'-');
    }
    let size = units.unsigned_abs();
    match u64::try_from(size) {
        Ok(size) if decimals <= MOST_SHORT => push_short(text, size, 10u64.pow(decimals)),
        _ => push_long(text, size, decimals),
    }
}

/// The same of numbers that fit into 64 bits: nearly all.
fn push_short(text: &mut Vec<u8>, size: u64, one: u64) {
    let mut digits = itoa::Buffer::new();
    text.extend_from_slice(digits.format(size / one).as_bytes());
    let fraction = size % one;
    if fraction > 0 {
        text.push(b'.');
        // The digit before them keeps the zeros at their beginning.
        let with_one = digits.format(one + fraction).as_bytes();
        text.extend_from_slice(with_one.get(1..).unwrap_or_default());
        drop_zeros(text);
    }
}

fn push_long(text: &mut Vec<u8>, size: u128, decimals: u32) {
    let one = 10u128.pow(decimals);
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
            push(&mut written, i64::from(units), decimals);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }

    /// A number of 64 bits has the same digits on both ways, whatever its size.
    #[test]
    fn short_and_long_numbers_are_written_alike() {
        for decimals in 0..=18 {
            let one = 10u64.pow(decimals);
            for size in [0, 1, 9, one - 1, one, one + 1, 7 * one / 10, u64::MAX - one] {
                let (mut short, mut long) = (Vec::new(), Vec::new());
                push_short(&mut short, size, one);
                push_long(&mut long, size.into(), decimals);
                assert_eq!(short, long, "{size} {decimals}");
            }
        }
    }
}
