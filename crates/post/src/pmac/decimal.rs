//! Writes fixed-point numbers as decimal text.

use std::io::Write;

use super::format::QUANTA_PER_MS;

/// The most decimals that a time in whole quanta can have.
const TIME_DECIMALS: u32 = 12;
/// 10^12 / 4096, a whole number.
const TIME_STEP: i64 = 10i64.pow(TIME_DECIMALS) / QUANTA_PER_MS as i64;

/// Appends `units` · 10^−`decimals` without trailing zeros.
pub(super) fn push(text: &mut Vec<u8>, units: i64, decimals: u32) {
    let (size, one) = (units.unsigned_abs(), 10u64.pow(decimals));
    if units < 0 {
        text.push(b'-');
    }
    // Writing to memory cannot fail.
    let _ = write!(text, "{}", size / one);
    let fraction = size % one;
    if fraction > 0 {
        let _ = write!(text, ".{fraction:0width$}", width = decimals as usize);
        while text.last() == Some(&b'0') {
            text.pop();
        }
    }
}

/// Appends a time in milliseconds, exactly.
pub(super) fn push_ms(text: &mut Vec<u8>, quanta: i64) {
    push(text, quanta * TIME_STEP, TIME_DECIMALS);
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
        ] {
            let mut written = Vec::new();
            push(&mut written, units, decimals);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
        for (quanta, text) in [
            (1, "0.000244140625"),
            (12_288, "3"),
            (6145, "1.500244140625"),
        ] {
            let mut written = Vec::new();
            push_ms(&mut written, quanta);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }
}
