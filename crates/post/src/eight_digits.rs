//! Eight decimal digits of a number side by side.

/// Digits that are made together: all before a number's point, or a piece of those behind it.
pub(crate) const PIECE: usize = 8;
/// A piece of zeros.
pub(crate) const ZEROS: u64 = u64::from_ne_bytes([b'0'; PIECE]);

/// The digits of a number below 10⁸, the first one in the lowest byte. Groups of four, two and one
/// digits are halved side by side: the quotients by 100 and by 10 are products with their reciprocals,
/// exact for numbers so small. For larger numbers the answer has no meaning.
#[inline(always)]
pub(crate) fn eight_digits(number: u64) -> u64 {
    let fours = (number / 10_000) | ((number % 10_000) << 32);
    let hundreds = (fours.wrapping_mul(10_486) >> 20) & 0x0000_007f_0000_007f;
    let twos = hundreds | (fours.wrapping_sub(100 * hundreds) << 16);
    let tens = (twos.wrapping_mul(103) >> 10) & 0x000f_000f_000f_000f;
    let ones = tens | (twos.wrapping_sub(10 * tens) << 8);
    ones | 0x3030_3030_3030_3030
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_digits_are_those_of_every_group() {
        let groups =
            (0..10_000).flat_map(|four| [four, 10_000 * four, 10_000 * four + 9_999 - four]);
        for number in groups {
            let digits = eight_digits(number).to_le_bytes();
            assert_eq!(format!("{number:08}").as_bytes(), digits);
        }
    }
}
