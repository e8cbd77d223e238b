//! Writes fixed-point numbers as decimal text.

use std::io::Write;

/// Appends `units` · 10^−`decimals` without trailing zeros.
pub(crate) fn push(text: &mut Vec<u8>, units: impl Into<i128>, decimals: u32) {
    let units: i128 = units.into();
    let (size, one) = (units.unsigned_abs(), 10u128.pow(decimals));
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
            push(&mut written, i64::from(units), decimals);
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }
}
