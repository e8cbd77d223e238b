//! Decimal numbers as digits and an exponent. They are scaled exactly before they become doubles.

/// A decimal number, `± digits · 10^exponent`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Decimal {
    negative: bool,
    digits: String,
    exponent: i64,
}

/// A larger exponent only means "zero" or "infinite".
const EXPONENT_LIMIT: i64 = 1_000_000_000_000;
/// Significant digits of a written number: enough for any tolerance, and too few to show rounding.
const WRITTEN_DIGITS: usize = 12;

impl Decimal {
    /// Reads the number at the start of `text`, and also returns the rest of the text.
    pub(crate) fn take(text: &str) -> Option<(Self, &str)> {
        let (negative, rest) = take_sign(text);
        let (whole, rest) = take_digits(rest);
        let (fraction, rest) = match rest.strip_prefix('.') {
            Some(after) => take_digits(after),
            None => ("", rest),
        };
        if whole.is_empty() && fraction.is_empty() {
            return None;
        }
        let (power, rest) = take_exponent(rest);
        let places = i64::try_from(fraction.len()).ok()?;
        let digits = format!("{whole}{fraction}");
        Some((
            Self {
                negative,
                digits,
                exponent: power - places,
            },
            rest,
        ))
    }

    /// The number times 10^places.
    pub(crate) fn shifted(&self, places: i64) -> Self {
        Self {
            exponent: self.exponent + places,
            ..self.clone()
        }
    }

    /// The number times a small whole factor, exact.
    pub(crate) fn times(&self, factor: u32) -> Self {
        let mut carry = 0;
        let mut reversed = String::new();
        for digit in self.digits.bytes().rev() {
            let product = u32::from(digit - b'0') * factor + carry;
            reversed.push(digit_char(product % 10));
            carry = product / 10;
        }
        while carry > 0 {
            reversed.push(digit_char(carry % 10));
            carry /= 10;
        }
        Self {
            digits: reversed.chars().rev().collect(),
            ..self.clone()
        }
    }

    /// The nearest double.
    pub(crate) fn to_f64(&self) -> f64 {
        let sign = if self.negative { "-" } else { "" };
        let text = format!("{sign}{}e{}", self.digits, self.exponent);
        text.parse().unwrap_or(f64::NAN)
    }

    /// A double, rounded to 12 significant digits; `None` if it is not finite.
    pub(crate) fn rounded(value: f64) -> Option<Self> {
        let text = format!("{value:.*e}", WRITTEN_DIGITS - 1);
        Self::take(&text).map(|(decimal, _)| decimal.trimmed())
    }

    fn zero() -> Self {
        Self {
            negative: false,
            digits: "0".into(),
            exponent: 0,
        }
    }

    fn trimmed(self) -> Self {
        let kept = self.digits.trim_end_matches('0').len();
        if kept == 0 {
            return Self::zero();
        }
        let dropped = self.digits.len() - kept;
        let exponent = self.exponent + i64::try_from(dropped).unwrap_or(0);
        Self {
            digits: self.digits[..kept].trim_start_matches('0').into(),
            exponent,
            ..self
        }
    }
}

impl std::fmt::Display for Decimal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.digits.len();
        let point = self.exponent + i64::try_from(count).unwrap_or(0);
        if self.negative {
            f.write_str("-")?;
        }
        match usize::try_from(point) {
            Ok(point) if point <= 15 && point >= count => {
                write!(f, "{}{}", self.digits, "0".repeat(point - count))
            }
            Ok(point) if point > 0 && point < count => {
                write!(f, "{}.{}", &self.digits[..point], &self.digits[point..])
            }
            _ if (-6..=0).contains(&point) => {
                let zeros = usize::try_from(-point).unwrap_or(0);
                write!(f, "0.{}{}", "0".repeat(zeros), self.digits)
            }
            _ => {
                let (first, others) = self.digits.split_at(1);
                let dot = if others.is_empty() { "" } else { "." };
                write!(f, "{first}{dot}{others}e{}", point - 1)
            }
        }
    }
}

fn take_sign(text: &str) -> (bool, &str) {
    match text.strip_prefix(['-', '\u{2212}']) {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    }
}

fn take_digits(text: &str) -> (&str, &str) {
    let end = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    text.split_at(end)
}

fn take_exponent(text: &str) -> (i64, &str) {
    let Some(after) = text.strip_prefix(['e', 'E']) else {
        return (0, text);
    };
    let (negative, after) = take_sign(after);
    let (digits, rest) = take_digits(after);
    if digits.is_empty() {
        return (0, text);
    }
    let size = digits.parse().unwrap_or(EXPONENT_LIMIT).min(EXPONENT_LIMIT);
    (if negative { -size } else { size }, rest)
}

fn digit_char(digit: u32) -> char {
    char::from_digit(digit, 10).unwrap_or('0')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Decimal {
        Decimal::take(text).unwrap().0
    }

    #[test]
    fn numbers_end_where_the_unit_begins() {
        assert_eq!(Decimal::take("1e-3 mm").unwrap().1, " mm");
        assert_eq!(Decimal::take("5e mm").unwrap().1, "e mm");
        assert_eq!(Decimal::take("5.mm").unwrap().1, "mm");
        assert_eq!(Decimal::take(".mm"), None);
    }

    #[test]
    fn scaling_is_exact() {
        assert_eq!(read("0.1").shifted(-3).to_f64(), 1e-4);
        assert_eq!(
            read("123456789.5").times(254).shifted(-1).to_f64(),
            3_135_802_453.3
        );
        assert_eq!(read("1e99999999999999999999").to_f64(), f64::INFINITY);
        assert_eq!(read("1e-99999999999999999999").to_f64(), 0.0);
    }

    #[test]
    fn layout_is_plain_in_the_middle_and_scientific_at_the_ends() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (100.0, "100"),
            (0.001, "0.001"),
            (1e-9, "1e-9"),
            (1.25e20, "1.25e20"),
            (0.1 + 0.2, "0.3"),
        ] {
            assert_eq!(Decimal::rounded(value).unwrap().to_string(), text);
        }
    }
}
