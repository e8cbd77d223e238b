//! Decimal text as whole numbers, for the readers of programs.

/// Decimals of the numbers here.
pub(crate) const PLACES: u32 = 12;
/// 10⁻¹² of a unit.
pub(crate) const ONE: i128 = 10i128.pow(PLACES);
/// Most digits before the point: with them all sums fit into 128 bits by far.
const MOST_DIGITS: usize = 15;
/// The largest whole number that fits into 64 bits with its twelve decimals, and with one up.
const LARGEST_SHORT: u64 = u64::MAX / POWERS[PLACES as usize] - 2;
/// The powers of ten up to that of [`PLACES`].
const POWERS: [u64; PLACES as usize + 1] = {
    let mut powers = [1; PLACES as usize + 1];
    let mut k = 1;
    while k < powers.len() {
        powers[k] = 10 * powers[k - 1];
        k += 1;
    }
    powers
};

/// The number of these digits before and after the point in 10⁻¹², rounded; `None` if it has too
/// many digits before the point.
pub(crate) fn fixed(whole: &str, fraction: &str) -> Option<i128> {
    let zeros = whole.bytes().take_while(|digit| *digit == b'0');
    let whole = whole.get(zeros.count()..).unwrap_or_default();
    if whole.len() > MOST_DIGITS {
        return None;
    }
    let count = fraction.len().min(PLACES as usize);
    let (kept, cut) = fraction.as_bytes().split_at(count);
    let scaled = digits_of(kept) * POWERS[PLACES as usize - count];
    let up = cut.first().is_some_and(|digit| *digit >= b'5');
    let part = scaled + u64::from(up);
    let whole = digits_of(whole.as_bytes());
    Some(match whole <= LARGEST_SHORT {
        true => i128::from(whole * POWERS[PLACES as usize] + part),
        false => i128::from(whole) * ONE + i128::from(part),
    })
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
