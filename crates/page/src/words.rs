//! Numbers as a person reads them on a page.

/// Digits of a figure.
const DIGITS: i32 = 4;
/// From here on, and below the reciprocal, a power of ten reads better.
const LONG: f64 = 1e7;

/// A number with four digits, or all of a longer whole number.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "no number".to_owned();
    }
    let size = value.abs();
    if !(1.0 / LONG..LONG).contains(&size) {
        return format!("{value:.3e}");
    }
    let above = format!("{size:e}");
    let power: i32 = above
        .split_once('e')
        .and_then(|(_, power)| power.parse().ok())
        .unwrap_or(0);
    let decimals = usize::try_from(DIGITS - 1 - power).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// A length of nanometres to micrometres, given in mm.
pub fn small_length(mm: f64) -> String {
    match (mm * 1e6).abs() {
        nm if nm < 1e4 => format!("{} nm", number(mm * 1e6)),
        nm if nm < 1e6 => format!("{} µm", number(mm * 1e3)),
        _ => format!("{} mm", number(mm)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_whole_ones_all() {
        let written = [0.0, 1.23456, 12.3456, 12345.6, -0.012_346, 3e-9, 2e9].map(number);
        let expected = [
            "0", "1.235", "12.35", "12346", "-0.01235", "3.000e-9", "2.000e9",
        ];
        assert_eq!(written, expected);
        assert_eq!(small_length(24.5e-6), "24.50 nm");
        assert_eq!(small_length(2.5), "2.500 mm");
    }
}
