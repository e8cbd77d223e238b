//! Decimal text as whole numbers, for the readers of programs.

use crate::powers_of_ten::POWERS_OF_TEN;

/// Decimals of the numbers here.
pub(crate) const PLACES: u32 = 12;
/// 10⁻¹² of a unit.
pub(crate) const ONE: i128 = 10i128.pow(PLACES);
/// The same in 64 bits.
pub(crate) const SHORT_ONE: u64 = 10u64.pow(PLACES);
/// Most digits before the point: with them all sums fit into 128 bits by far.
const MOST_DIGITS: usize = 15;
/// Digits of any number that fits into 64 bits.
const SHORT_DIGITS: usize = 19;
/// The decimal number without a sign with which a text begins.
pub(crate) struct LeadingDecimal {
    /// All digits as one number, if they are no more than [`SHORT_DIGITS`].
    digits: u64,
    /// Digits before the point, and behind it.
    whole: usize,
    fraction: usize,
    /// The bytes of the number, with its point.
    pub(crate) length: usize,
}

impl LeadingDecimal {
    /// The number; `None` if the text begins with another one or with none.
    #[inline(always)]
    pub(crate) fn of(text: &[u8]) -> Option<Self> {
        let (mut digits, mut at) = (0, 0);
        take_digits(text, &mut at, &mut digits);
        let whole = at;
        let mut fraction = 0;
        if text.get(at) == Some(&b'.') {
            at += 1;
            take_digits(text, &mut at, &mut digits);
            fraction = at - whole - 1;
        }
        (whole + fraction > 0).then_some(Self {
            digits,
            whole,
            fraction,
            length: at,
        })
    }

    /// The number in 10⁻¹², rounded; `None` if it has too many digits before the point. `text` is the one that
    /// begins with it.
    #[inline(always)]
    pub(crate) fn size(&self, text: &[u8]) -> Option<i128> {
        let is_short = self.whole <= MOST_DIGITS && self.whole + self.fraction <= SHORT_DIGITS;
        let power = (PLACES as usize).checked_sub(self.fraction);
        match power.and_then(|power| POWERS_OF_TEN.get(power)) {
            Some(power) if is_short => Some(i128::from(self.digits) * i128::from(*power)),
            _ => long_decimal(text.get(..self.length).unwrap_or_default(), self.whole),
        }
    }
}

/// Goes on over digits, and appends them to a sum. One of more than [`SHORT_DIGITS`] is of no use.
#[inline(always)]
fn take_digits(text: &[u8], at: &mut usize, sum: &mut u64) {
    while let Some(eight) = text.get(*at..).and_then(<[u8]>::first_chunk) {
        let (count, number) = leading_digits(u64::from_le_bytes(*eight));
        *sum = sum.wrapping_mul(POWERS_OF_TEN[count]).wrapping_add(number);
        *at += count;
        if count < EIGHT {
            return;
        }
    }
    while let Some(digit) = text.get(*at).filter(|byte| byte.is_ascii_digit()) {
        *sum = sum.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
        *at += 1;
    }
}

/// Characters that are read together.
const EIGHT: usize = 8;
/// The same byte in each of eight.
const fn eight_times(byte: u8) -> u64 {
    u64::from_ne_bytes([byte; EIGHT])
}

/// Every second pair of eight digits.
const EVEN_PAIRS: u64 = 0x0000_00ff_0000_00ff;
/// What the first and the third pair count for in the upper half of a sum, and what the others do.
const FIRST_PAIRS: u64 = 100 + (1_000_000 << 32);
const OTHER_PAIRS: u64 = 1 + (10_000 << 32);

/// How many digits eight characters begin with, the first one in the lowest byte, and the number of these digits.
#[inline(always)]
fn leading_digits(characters: u64) -> (usize, u64) {
    // A digit is now 0 to 9, and anything else is more. A sum beyond a byte changes only what is behind.
    let values = characters ^ eight_times(b'0');
    let others = (values.wrapping_add(eight_times(0x7f - 9)) | values) & eight_times(0x80);
    let count = others.trailing_zeros() as usize / 8;
    if count == 0 {
        return (0, 0);
    }
    // The digits move up to the end, behind zeros. Then ones and tens become pairs, pairs become fours, and these
    // become one number, in the upper half of a product.
    let digits = values << (8 * (EIGHT - count));
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8);
    let first = (pairs & EVEN_PAIRS).wrapping_mul(FIRST_PAIRS);
    let others = ((pairs >> 16) & EVEN_PAIRS).wrapping_mul(OTHER_PAIRS);
    (count, first.wrapping_add(others) >> 32)
}

/// A number of any length with so many digits before the point. Apart, so that short numbers do not go
/// through it too.
#[cold]
#[inline(never)]
fn long_decimal(text: &[u8], whole: usize) -> Option<i128> {
    let (whole, fraction) = text.split_at(whole);
    fixed(whole, fraction.strip_prefix(b".").unwrap_or(fraction))
}

/// The number of these digits before and after the point in 10⁻¹², rounded; `None` if it has too
/// many digits before the point.
fn fixed(whole: &[u8], fraction: &[u8]) -> Option<i128> {
    let zeros = whole.iter().take_while(|digit| **digit == b'0');
    let whole = whole.get(zeros.count()..).unwrap_or_default();
    if whole.len() > MOST_DIGITS {
        return None;
    }
    let count = fraction.len().min(PLACES as usize);
    let (kept, cut) = fraction.split_at(count);
    let scaled = digits_of(kept) * POWERS_OF_TEN[PLACES as usize - count];
    let up = cut.first().is_some_and(|digit| *digit >= b'5');
    let part = scaled + u64::from(up);
    Some(i128::from(digits_of(whole)) * ONE + i128::from(part))
}

/// The number of at most eighteen digits.
fn digits_of(digits: &[u8]) -> u64 {
    let value = |sum: u64, digit: &u8| sum * 10 + u64::from(*digit - b'0');
    digits.iter().fold(0, value)
}

/// The double nearest to a number, in the number's own unit. Short numbers need no call for that.
pub(crate) fn to_f64(value: i128) -> f64 {
    match i64::try_from(value) {
        Ok(short) => short as f64,
        Err(_) => long_to_f64(value),
    }
}

/// Apart, so that short numbers do not go through it too.
#[cold]
#[inline(never)]
fn long_to_f64(value: i128) -> f64 {
    value as f64
}

/// A decimal number with or without a sign in 10⁻¹²; `what` names it in the message.
pub(crate) fn number(what: &str, text: &str) -> Result<i128, String> {
    let (negative, size) = match text.split_at_checked(1) {
        Some(("-", size)) => (true, size),
        Some(("+", size)) => (false, size),
        _ => (false, text),
    };
    let decimal = LeadingDecimal::of(size.as_bytes()).filter(|found| found.length == size.len());
    let decimal = decimal.ok_or_else(|| format!("{what} has no number"))?;
    let size = decimal.size(size.as_bytes());
    let size = size.ok_or_else(|| format!("{what} has too many digits"))?;
    Ok(if negative { -size } else { size })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// All bytes behind all counts of digits.
    #[test]
    fn digits_end_at_the_first_byte_that_is_none() {
        for count in 0..=EIGHT {
            for byte in 0..=u8::MAX {
                for behind in [0, b'0', b'9', u8::MAX] {
                    let mut text = *b"98765432";
                    text[count..].fill(behind);
                    if let Some(first) = text.get_mut(count) {
                        *first = byte;
                    }
                    let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
                    let number = std::str::from_utf8(&text[..digits]).unwrap();
                    let number = number.parse().unwrap_or(0);
                    assert_eq!(leading_digits(u64::from_le_bytes(text)), (digits, number));
                }
            }
        }
    }

    proptest! {
        /// Short numbers and long ones, with zeros before them, are the same by both ways.
        #[test]
        fn a_number_of_any_length_is_that_of_its_digits(
            whole in "0{0,9}[0-9]{0,17}",
            fraction in proptest::option::of("[0-9]{0,16}"),
            behind in "|:|X|-1|\\.5| 7",
        ) {
            let point = if fraction.is_some() { "." } else { "" };
            let fraction = fraction.unwrap_or_default();
            let text = format!("{whole}{point}{fraction}{behind}");
            let found = LeadingDecimal::of(text.as_bytes());
            if point.is_empty() && behind == ".5" {
                prop_assert!(found.is_some_and(|found| found.length == whole.len() + 2));
            } else if whole.len() + fraction.len() == 0 {
                prop_assert!(found.is_none());
            } else {
                let found = found.unwrap();
                prop_assert_eq!(found.length, text.len() - behind.len());
                prop_assert_eq!(found.size(text.as_bytes()), fixed(whole.as_bytes(), fraction.as_bytes()));
            }
        }
    }
}
