//! Figures and texts as a cell of the table shows them.

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::text::grouped;

use super::column::Form;

/// Where there is no figure.
pub const NONE: &str = "–";
/// From here on counts are shown in millions.
const MANY: f64 = 1e7;

/// A figure in its form.
pub fn written(number: f64, form: Form) -> String {
    match form {
        Form::Count if number < MANY => grouped(number as u64),
        Form::Count => format!("{}M", four_digits(number / 1e6)),
        Form::Bytes => four_digits(number / 1e3),
        Form::Real | Form::Clock => four_digits(number),
    }
}

/// Four digits where they fit into six columns, else a power of ten.
fn four_digits(number: f64) -> String {
    match rounded(number).abs() {
        0.0 => "0".to_owned(),
        v if !v.is_finite() => NONE.to_owned(),
        v if v < 1e-6 => format!("{number:.0e}"),
        v if !(0.01..1e5).contains(&v) => format!("{number:.1e}"),
        v if v < 0.1 => format!("{number:.4}"),
        v if v < 10.0 => format!("{number:.3}"),
        v if v < 100.0 => format!("{number:.2}"),
        v if v < 1000.0 => format!("{number:.1}"),
        v => grouped(v.round() as u64),
    }
}

/// To four digits, or to a whole number: 9.9996 is 10.00, and not 10.000.
fn rounded(number: f64) -> f64 {
    if number.abs() >= 1000.0 {
        return number.round();
    }
    format!("{number:.3e}").parse().unwrap_or(number)
}

/// "×1.23"; nothing where there is no ratio.
pub fn ratio_of(number: f64, first: f64) -> String {
    match number / first {
        ratio if !ratio.is_finite() => String::new(),
        0.0 => "×0".to_owned(),
        ratio if !(0.01..1e4).contains(&ratio) => format!("×{ratio:.0e}"),
        ratio if ratio < 10.0 => format!("×{ratio:.2}"),
        ratio if ratio < 100.0 => format!("×{ratio:.1}"),
        ratio => format!("×{ratio:.0}"),
    }
}

/// The parts joined by `between`, in lines of at most `width` columns.
pub fn wrapped(parts: &[&str], between: &str, width: usize) -> String {
    let mut text = String::new();
    let mut taken = 0;
    for part in parts {
        let more = between.width() + part.width();
        if taken > 0 && taken + more <= width {
            text += between;
            taken += more;
        } else {
            text += if taken > 0 { "\n" } else { "" };
            taken = part.width();
        }
        text += part;
    }
    text
}

/// The text in exactly `width` columns.
pub fn padded(text: &str, width: usize) -> String {
    let text = cut(text, width);
    let missing = width.saturating_sub(text.width());
    text + &" ".repeat(missing)
}

/// The text in at most `width` columns; the end of a longer one is left out.
pub fn cut(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let mut left = width.saturating_sub(1);
    let fits = |c: &char| {
        let fitting = left.checked_sub(c.width().unwrap_or(0));
        left = fitting.unwrap_or(0);
        fitting.is_some()
    };
    let mut start: String = text.chars().take_while(fits).collect();
    start.push('…');
    start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_four_digits_and_ratios_three() {
        let figures = [
            0.0, 1.2e-7, 0.012345, 0.5, 3.2123, 42.4242, 999.94, 12_345.6, 1.2e9,
        ];
        let said = figures.map(four_digits);
        let expected = [
            "0", "1e-7", "0.0123", "0.500", "3.212", "42.42", "999.9", "12,346", "1.2e9",
        ];
        assert_eq!(said, expected);
        let carried = [0.009_999_96, 0.099_999, 9.9996, 99.996, 999.96, 99_999.6];
        let expected = ["0.0100", "0.100", "10.00", "100.0", "1,000", "1.0e5"];
        assert_eq!(carried.map(four_digits), expected);
        let ratios = [1.0, 0.123, 12.34, 567.8, 0.0].map(|ratio| ratio_of(ratio, 1.0));
        assert_eq!(ratios, ["×1.00", "×0.12", "×12.3", "×568", "×0"]);
        assert_eq!(ratio_of(1.0, 0.0), "");
    }

    #[test]
    fn parts_go_on_the_next_line_where_they_do_not_fit() {
        let parts = ["one", "two", "three"];
        assert_eq!(wrapped(&parts, "  ", 15), "one  two  three");
        assert_eq!(wrapped(&parts, "  ", 14), "one  two\nthree");
        assert_eq!(wrapped(&parts, "  ", 2), "one\ntwo\nthree");
        assert_eq!(wrapped(&[], " ", 9), "");
    }

    #[test]
    fn a_text_is_cut_by_what_it_takes_on_the_terminal() {
        assert_eq!(cut("equal-arc", 9), "equal-arc");
        assert_eq!(cut("equal-arc", 6), "equal…");
        assert_eq!(cut("度度度", 4), "度…");
        assert_eq!(padded("度度度", 4), "度… ");
    }
}
