//! Figures as a person reads them at a glance.

use turnpath_recipe::Recipe;

use crate::summary::{Measured, NM_PER_MM};

/// Column at which values begin.
const LABEL: usize = 16;
/// Seconds in a minute.
const MINUTE: f64 = 60.0;

/// A line of a summary: a label and what it is about.
pub fn line(label: &str, text: impl std::fmt::Display) -> String {
    format!("  {label:<LABEL$}{text}\n")
}

/// A whole number with its thousands apart.
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

/// A time as people say it.
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

/// Bytes as people say them.
pub fn bytes(count: f64) -> String {
    match count {
        c if c < 1e3 => format!("{c:.0} B"),
        c if c < 1e6 => format!("{:.1} kB", c / 1e3),
        c if c < 1e9 => format!("{:.1} MB", c / 1e6),
        c => format!("{:.2} GB", c / 1e9),
    }
}

/// Nanometres, with a digit where it tells something.
pub fn nanometres(nm: f64) -> String {
    match nm {
        v if !v.is_finite() => "no number".to_owned(),
        v if v > 0.0 && v < 0.01 => format!("{v:.1e} nm"),
        v if v < 1e4 => format!("{v:.2} nm"),
        v if v < 1e6 => format!("{:.2} um", v / 1e3),
        v => millimetres(v / 1e6, 3),
    }
}

/// Lengths from which digits in full tell less than a power of ten, mm.
const LONG: f64 = 1e6;

/// Millimetres with so many decimals, whatever a file or a recipe made of them.
pub fn millimetres(mm: f64, decimals: usize) -> String {
    match mm {
        v if !v.is_finite() => "no number".to_owned(),
        v if v.abs() < LONG => format!("{:.decimals$} mm", unsigned_zero(v, decimals)),
        v => format!("{v:.decimals$e} mm"),
    }
}

/// The value without the sign of what rounds to nothing.
fn unsigned_zero(value: f64, decimals: usize) -> f64 {
    let half = (0..decimals).fold(0.5, |step, _| 0.1 * step);
    if value.abs() < half { 0.0 } else { value }
}

/// A nose radius: three decimals, or more where they would tell less than four digits.
pub fn nose_radius(mm: f64) -> String {
    let decimals = [1.0, 0.1, 1e-2, 1e-3].iter().filter(|step| mm < **step);
    millimetres(mm, 3 + decimals.count())
}

/// A figure in nm against its tolerance in mm.
pub fn against(value: f64, tolerance: f64, holds: bool) -> String {
    let (value, limit) = (nanometres(value), nanometres(tolerance * NM_PER_MM));
    let verdict = if holds { "holds" } else { "EXCEEDED" };
    format!("{value:>12} of {limit:<11} {verdict}")
}

/// The lines on what was measured, each error against its tolerance, motion against limits.
pub fn measured(measured: &Measured, recipe: &Recipe) -> String {
    let tolerance = &recipe.tolerance;
    let (error, residual) = (&measured.interpolation_error_nm, &measured.residual_nm);
    let within = &measured.within;
    let mut text = line(
        "interpolation",
        against(error.max, tolerance.interpolation, within.interpolation),
    );
    text += &line(
        "",
        format!(
            "{:>12} rms; the largest at C = {:.2} deg, X = {}",
            nanometres(error.rms),
            error.at.c_deg,
            millimetres(error.at.x_mm, 4)
        ),
    );
    text += &line(
        "residual",
        match residual.max {
            Some(max) => against(max, tolerance.residual, within.residual),
            None => format!("not measured: {}", residual.left_out),
        },
    );
    text += &measured.surface_error.lines();
    text += &measured.coverage_nm.lines(recipe, within.coverage);
    text += &measured.axis_crossing_um.line();
    if let Some(machine) = &measured.machine {
        text += &machine.lines();
    }
    text + &measured.highest_spindle.line()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_people_say_them() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(duration(12.34), "12.3 s");
        assert_eq!(duration(329.6), "5 min 30 s");
        assert_eq!(duration(7322.0), "2 h 02 min 02 s");
        assert_eq!(bytes(1234.0), "1.2 kB");
        assert_eq!(nanometres(99.876), "99.88 nm");
        assert_eq!(nanometres(0.000123), "1.2e-4 nm");
        assert_eq!(nanometres(67_000.0), "67.00 um");
        assert_eq!(nanometres(f64::NAN), "no number");
        assert_eq!(nanometres(1e300), "1.000e294 mm");
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
            against(99.9, 1e-4, true),
            "    99.90 nm of 100.00 nm   holds"
        );
        let wide = against(1e12, 123_456.789, false);
        assert!(wide.ends_with(" of 123456.789 mm EXCEEDED"), "{wide}");
    }
}
