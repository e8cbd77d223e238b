//! Writes fixed-point numbers as decimal text.

use std::io::Write;

/// Digits of a half of a short number: of all before its point, or of all behind it.
const HALF: usize = 16;
/// Most digits that go through 64 bits; most halves have no more.
pub(crate) const QUARTER: usize = 8;
/// The powers of ten that a half can hold.
pub(crate) const POWERS: [u64; HALF + 1] = {
    let mut powers = [1; HALF + 1];
    let mut k = 1;
    while k < powers.len() {
        powers[k] = 10 * powers[k - 1];
        k += 1;
    }
    powers
};

/// Appends `units` · 10^−`decimals` without trailing zeros.
pub(crate) fn push(text: &mut Vec<u8>, units: impl Into<i128>, decimals: u32) {
    let units: i128 = units.into();
    if units < 0 {
        text.push(b'-');
    }
    let size = units.unsigned_abs();
    match short_halves(size, decimals) {
        Some(halves) => push_short(text, halves, decimals),
        None => push_long(text, size, decimals),
    }
}

/// What stands before the point and behind it, the latter in 10⁻⁸ where it has no more decimals, and else in
/// 10⁻¹⁶; `None` if a half cannot hold it.
fn short_halves(size: u128, decimals: u32) -> Option<[u64; 2]> {
    let size = u64::try_from(size).ok()?;
    // A division by a constant is a product.
    let [whole, fraction] = match decimals {
        5 => halves::<5, QUARTER>(size),
        6 => halves::<6, QUARTER>(size),
        7 => halves::<7, QUARTER>(size),
        8 => halves::<8, QUARTER>(size),
        9 => halves::<9, HALF>(size),
        12 => halves::<12, HALF>(size),
        _ => {
            let decimals = decimals as usize;
            let places = if decimals <= QUARTER { QUARTER } else { HALF };
            let one = POWERS.get(decimals)?;
            let scale = POWERS.get(places.checked_sub(decimals)?)?;
            [size / one, size % one * scale]
        }
    };
    (whole < POWERS[HALF]).then_some([whole, fraction])
}

/// A number of so many decimals before the point, and behind it in so many places.
fn halves<const DECIMALS: usize, const PLACES: usize>(size: u64) -> [u64; 2] {
    let one = const { POWERS[DECIMALS] };
    let scale = const { POWERS[PLACES - DECIMALS] };
    [size / one, size % one * scale]
}

fn push_short(text: &mut Vec<u8>, [whole, fraction]: [u64; 2], decimals: u32) {
    if whole < 10 {
        text.push(b'0' + whole as u8);
    } else if whole < POWERS[QUARTER] {
        push_whole_digits(text, u128::from(eight_digits(whole)), QUARTER);
    } else {
        push_whole_digits(text, sixteen_digits(whole), HALF);
    }
    if fraction == 0 {
        return;
    }
    text.push(b'.');
    if decimals as usize <= QUARTER {
        push_decimals(text, u128::from(eight_digits(fraction)), QUARTER);
    } else {
        push_decimals(text, sixteen_digits(fraction), HALF);
    }
}

/// Appends so many digits without the zeros before them, and at least one digit.
fn push_whole_digits(text: &mut Vec<u8>, digits: u128, count: usize) {
    let zeros = ((digits ^ ZEROS).trailing_zeros() as usize / 8).min(count - 1);
    push_digits(text, digits >> (8 * zeros), count - zeros);
}

/// Appends so many digits without the zeros behind them.
fn push_decimals(text: &mut Vec<u8>, digits: u128, count: usize) {
    let zeros = ((digits ^ ZEROS) << (8 * (HALF - count))).leading_zeros() as usize / 8;
    push_digits(text, digits, count - zeros);
}

/// Appends the first of some digits. To copy all of them and take back the others is faster than to copy
/// some.
fn push_digits(text: &mut Vec<u8>, digits: u128, count: usize) {
    let end = text.len() + count;
    text.extend_from_slice(&digits.to_le_bytes());
    text.truncate(end);
}

/// Eight digits `0`.
pub(crate) const ZEROS_OF_QUARTER: u64 = u64::from_ne_bytes([b'0'; QUARTER]);
/// Sixteen digits `0`.
const ZEROS: u128 = u128::from_ne_bytes([b'0'; HALF]);

/// The digits of a number below 10¹⁶, the first one in the lowest byte.
fn sixteen_digits(number: u64) -> u128 {
    let (upper, lower) = (number / 100_000_000, number % 100_000_000);
    u128::from(eight_digits(upper)) | (u128::from(eight_digits(lower)) << 64)
}

/// The digits of a number below 10⁸, the first one in the lowest byte. Groups of four, two and one
/// digits are halved side by side: the quotients by 100 and by 10 are products with their reciprocals,
/// exact for numbers so small.
#[inline(always)]
pub(crate) fn eight_digits(number: u64) -> u64 {
    let fours = (number / 10_000) | ((number % 10_000) << 32);
    let hundreds = ((fours * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let twos = hundreds | ((fours - 100 * hundreds) << 16);
    let tens = ((twos * 103) >> 10) & 0x000f_000f_000f_000f;
    let ones = tens | ((twos - 10 * tens) << 8);
    ones | 0x3030_3030_3030_3030
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
            push(&mut written, units, decimals);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }

    /// A short number has the same digits on both ways, whatever its size.
    #[test]
    fn short_and_long_numbers_are_written_alike() {
        for decimals in 0..=16 {
            let one = 10u64.pow(decimals);
            for size in [
                0,
                1,
                9,
                one - 1,
                one,
                one + 1,
                7 * one / 10,
                one / 1000 * 123_456,
            ] {
                let (mut short, mut long) = (Vec::new(), Vec::new());
                let halves = short_halves(size.into(), decimals).unwrap();
                push_short(&mut short, halves, decimals);
                push_long(&mut long, size.into(), decimals);
                assert_eq!(short, long, "{size} {decimals}");
            }
        }
    }

    #[test]
    fn eight_digits_are_those_of_every_group() {
        let groups =
            (0..10_000).flat_map(|four| [four, 10_000 * four, 10_000 * four + 9_999 - four]);
        for number in groups {
            let digits = eight_digits(number).to_le_bytes();
            assert_eq!(format!("{number:08}").as_bytes(), digits);
        }
    }
}
