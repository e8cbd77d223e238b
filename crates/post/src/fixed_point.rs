//! Decimal text as whole numbers, for the readers of programs.

/// Decimals of the numbers here.
pub(crate) const PLACES: u32 = 12;
/// 10⁻¹² of a unit.
pub(crate) const ONE: i128 = 10i128.pow(PLACES);
/// Most digits before the point: with them all sums fit into 128 bits by far.
const MOST_DIGITS: usize = 15;

/// The number of these digits before and after the point in 10⁻¹², rounded; `None` if it has too
/// many digits before the point.
pub(crate) fn fixed(whole: &str, fraction: &str) -> Option<i128> {
    let whole = whole.trim_start_matches('0');
    if whole.len() > MOST_DIGITS {
        return None;
    }
    let digits = fraction.bytes().chain(std::iter::repeat(b'0'));
    let value = |sum: i128, digit: u8| sum * 10 + i128::from(digit - b'0');
    let start = whole.bytes().fold(0, value);
    let sum = digits.take(PLACES as usize).fold(start, value);
    let next = fraction.as_bytes().get(PLACES as usize);
    Some(sum + i128::from(next.is_some_and(|digit| *digit >= b'5')))
}

/// A decimal number with or without a minus in 10⁻¹²; `what` names it in the message.
pub(crate) fn number(what: &str, text: &str) -> Result<i128, String> {
    let (negative, size) = match text.strip_prefix('-') {
        Some(size) => (true, size),
        None => (false, text),
    };
    let (whole, fraction) = size.split_once('.').unwrap_or((size, ""));
    let are_digits = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
    if whole.len() + fraction.len() == 0 || !are_digits(whole) || !are_digits(fraction) {
        return Err(format!("{what} has no number"));
    }
    let size = fixed(whole, fraction).ok_or_else(|| format!("{what} has too many digits"))?;
    Ok(if negative { -size } else { size })
}
