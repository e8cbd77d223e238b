//! Numbers as a person reads them at a glance.

use turnpath_core::{Derivative, Limit, Quantity};

use crate::place::PathPlace;
use crate::unit;

/// Column at which values begin.
pub const LABEL: usize = 16;
/// Seconds in a minute.
const MINUTE: f64 = 60.0;

/// A line of a report: a label and its text.
pub fn line(label: &str, text: impl std::fmt::Display) -> String {
    format!("  {label:<LABEL$}{text}\n")
}

/// A whole number with its thousands grouped.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A time in s, min and h.
pub fn duration(seconds: f64) -> String {
    if seconds < MINUTE {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    match hours {
        0 => format!("{minutes} min {seconds:02} s"),
        _ => format!("{hours} h {minutes:02} min {seconds:02} s"),
    }
}

/// A count of bytes, in the unit that fits.
pub fn bytes(count: f64) -> String {
    match count {
        c if c < 1e3 => format!("{c:.0} B"),
        c if c < 1e6 => format!("{:.1} kB", c / 1e3),
        c if c < 1e9 => format!("{:.1} MB", c / 1e6),
        c => format!("{:.2} GB", c / 1e9),
    }
}

/// A small length, given in mm: in nm, or in a larger unit where nm would be long.
pub fn small_length(mm: f64) -> String {
    match mm * unit::nm::PER {
        v if !v.is_finite() => "no number".to_owned(),
        v if v > 0.0 && v < 0.01 => format!("{v:.1e} nm"),
        v if v < 1e4 => format!("{v:.2} nm"),
        v if v < 1e6 => format!("{:.2} um", v / 1e3),
        v => millimetres(v / 1e6, 3),
    }
}

/// The same with its sign.
pub fn signed_length(mm: f64) -> String {
    let sign = if mm < 0.0 { "-" } else { "" };
    format!("{sign}{}", small_length(mm.abs()))
}

/// Lengths from which a power of ten reads better than all digits, mm.
const LONG: f64 = 1e6;

/// Millimetres with so many decimals, however large.
pub fn millimetres(mm: f64, decimals: usize) -> String {
    match mm {
        v if !v.is_finite() => "no number".to_owned(),
        v if v.abs() < LONG => format!("{:.decimals$} mm", unsigned_zero(v, decimals)),
        v => format!("{v:.decimals$e} mm"),
    }
}

/// The value, without its sign where it rounds to zero.
fn unsigned_zero(value: f64, decimals: usize) -> f64 {
    let half = (0..decimals).fold(0.5, |step, _| 0.1 * step);
    if value.abs() < half { 0.0 } else { value }
}

/// A nose radius: three decimals, or more where three would give fewer than four digits.
pub fn nose_radius(mm: f64) -> String {
    let decimals = [1.0, 0.1, 1e-2, 1e-3].iter().filter(|step| mm < **step);
    millimetres(mm, 3 + decimals.count())
}

/// A figure in mm against its tolerance in mm.
pub fn against(value: f64, tolerance: f64, holds: bool) -> String {
    let (value, limit) = (small_length(value), small_length(tolerance));
    let verdict = if holds { "holds" } else { "EXCEEDED" };
    format!("{value:>12} of {limit:<11} {verdict}")
}

/// The same where there may be no tolerance, and then no verdict.
pub fn against_any(value: f64, tolerance: Option<f64>, holds: Option<bool>) -> String {
    match tolerance.zip(holds) {
        Some((tolerance, holds)) => against(value, tolerance, holds),
        None => format!("{:>12}", small_length(value)),
    }
}

/// "C = 4253.65 deg, X = 2.8198 mm".
pub fn path_place(place: &PathPlace) -> String {
    let c = place.c * unit::deg::PER;
    format!("C = {c:.2} deg, X = {}", millimetres(place.x, 4))
}

/// "X acceleration".
pub fn limit_name(axis: turnpath_core::Axis, derivative: Derivative) -> String {
    format!("{} {}", axis.letter(), derivative.name())
}

/// An amount of what a limit is of, with its unit.
pub fn limit_amount(limit: &Limit, amount: f64) -> String {
    let (per, unit) = match limit.derivative.quantity(limit.axis) {
        Quantity::RotationSpeed => (unit::rpm::PER, "rpm"),
        Quantity::AngularAcceleration => (1.0, "rad/s²"),
        Quantity::AngularJerk => (1.0, "rad/s³"),
        Quantity::Acceleration if amount >= METRE => (METRE.recip(), "m/s²"),
        Quantity::Acceleration => (1.0, "mm/s²"),
        Quantity::Jerk if amount >= METRE => (METRE.recip(), "m/s³"),
        Quantity::Jerk => (1.0, "mm/s³"),
        _ => (1.0, "mm/s"),
    };
    format!("{} {unit}", significant(amount * per))
}

/// A metre in mm.
const METRE: f64 = 1e3;

/// A number with four significant digits.
pub fn significant(value: f64) -> String {
    match value {
        v if !v.is_finite() => "no number".to_owned(),
        0.0 => "0".to_owned(),
        v if !(1e-3..1e6).contains(&v) => format!("{v:.3e}"),
        v if v >= 1e3 => format!("{v:.0}"),
        v if v >= 1e2 => format!("{v:.1}"),
        v if v >= 1e1 => format!("{v:.2}"),
        v if v >= 1.0 => format!("{v:.3}"),
        v => format!("{v:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_unit_and_the_digits_that_fit() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(duration(12.34), "12.3 s");
        assert_eq!(duration(329.6), "5 min 30 s");
        assert_eq!(duration(7322.0), "2 h 02 min 02 s");
        assert_eq!(bytes(1234.0), "1.2 kB");
        assert_eq!(small_length(99.876e-6), "99.88 nm");
        assert_eq!(small_length(0.000123e-6), "1.2e-4 nm");
        assert_eq!(small_length(0.067), "67.00 um");
        assert_eq!(small_length(f64::NAN), "no number");
        assert_eq!(small_length(1e294), "1.000e294 mm");
        assert_eq!(millimetres(2.49733, 4), "2.4973 mm");
        assert_eq!(millimetres(-0.0049, 2), "0.00 mm");
        assert_eq!(millimetres(-0.0051, 2), "-0.01 mm");
        assert_eq!(nose_radius(6.25), "6.250 mm");
        assert_eq!(nose_radius(0.0123456), "0.01235 mm");
        assert_eq!(millimetres(-1e300, 4), "-1.0000e300 mm");
    }

    #[test]
    fn a_wide_limit_stays_apart_from_the_verdict() {
        assert_eq!(
            against(99.9e-6, 1e-4, true),
            "    99.90 nm of 100.00 nm   holds"
        );
        let wide = against(1e6, 123_456.789, false);
        assert!(wide.ends_with(" of 123456.789 mm EXCEEDED"), "{wide}");
    }

    #[test]
    fn numbers_keep_four_digits() {
        let shown = [0.0, 0.01234, 1.23456, 123.456, 12345.6, 1.5e7].map(significant);
        let expected = ["0", "0.0123", "1.235", "123.5", "12346", "1.500e7"];
        assert_eq!(shown, expected);
    }
}
