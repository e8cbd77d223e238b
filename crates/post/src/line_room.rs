//! Room for a line at the end of a text: numbers go into it without a look at the text's memory each time.

use crate::decimal::{POWERS, QUARTER, ZEROS_OF_QUARTER, eight_digits};

/// Bytes of the room: more than any line of a control point has.
const ROOM: usize = 256;
/// Most decimals of numbers whose fraction is written in one piece, and in two.
const ONE_PIECE: u32 = QUARTER as u32;
const TWO_PIECES: u32 = 2 * ONE_PIECE;

/// A line in the making.
pub(crate) struct LineRoom<'a> {
    bytes: &'a mut [u8; ROOM],
    end: usize,
}

/// Appends a line. Where `write` gives up, the text is as it was, and the answer is no: the line then has to be
/// written in another way.
#[inline]
pub(crate) fn push_line(
    text: &mut Vec<u8>,
    write: impl FnOnce(&mut LineRoom<'_>) -> Option<()>,
) -> bool {
    let start = text.len();
    text.extend_from_slice(&[0; ROOM]);
    let end = text.last_chunk_mut().and_then(|bytes| {
        let mut room = LineRoom { bytes, end: 0 };
        write(&mut room)?;
        Some(room.end)
    });
    text.truncate(start + end.unwrap_or(0));
    end.is_some()
}

impl LineRoom<'_> {
    /// Appends some bytes. `None` where the line is too long.
    #[inline(always)]
    pub(crate) fn word(&mut self, bytes: &[u8]) -> Option<()> {
        bytes.iter().try_for_each(|byte| self.byte(*byte))
    }

    #[inline(always)]
    fn byte(&mut self, byte: u8) -> Option<()> {
        *self.bytes.get_mut(self.end)? = byte;
        self.end += 1;
        Some(())
    }

    /// Appends `units` · 10^−`decimals` without trailing zeros. `None` where the line is too long, and for numbers
    /// that have more digits before the point, or more decimals, than nearly all have.
    #[inline(always)]
    pub(crate) fn number(&mut self, units: i64, decimals: u32) -> Option<()> {
        let size = units.unsigned_abs();
        if units < 0 {
            self.byte(b'-')?;
        }
        if decimals <= ONE_PIECE {
            // A division by a constant is a product.
            let [whole, fraction] = match decimals {
                7 => parts_of::<7>(size),
                6 => parts_of::<6>(size),
                8 => parts_of::<8>(size),
                5 => parts_of::<5>(size),
                _ => {
                    let one = *POWERS.get(decimals as usize)?;
                    let scale = POWERS.get((ONE_PIECE - decimals) as usize)?;
                    [size / one, size % one * scale]
                }
            };
            self.whole(whole)?;
            self.fraction(fraction)
        } else {
            let scale = *POWERS.get(TWO_PIECES.checked_sub(decimals)? as usize)?;
            let one = *POWERS.get(decimals as usize)?;
            let fraction = size % one * scale;
            self.whole(size / one)?;
            match (fraction / POWERS[QUARTER], fraction % POWERS[QUARTER]) {
                (upper, 0) => self.fraction(upper),
                (upper, lower) => {
                    self.byte(b'.')?;
                    self.eight(eight_digits(upper), QUARTER)?;
                    self.without_zeros_behind(lower)
                }
            }
        }
    }

    /// Appends a whole number of no more than eight digits.
    #[inline(always)]
    fn whole(&mut self, number: u64) -> Option<()> {
        if number < 10 {
            return self.byte(b'0' + number as u8);
        }
        if number >= POWERS[QUARTER] {
            return None;
        }
        let digits = eight_digits(number);
        let zeros = (digits ^ ZEROS_OF_QUARTER).trailing_zeros() as usize / 8;
        self.eight(digits >> (8 * zeros), QUARTER - zeros)
    }

    /// Appends a point and eight decimals, or nothing where they are zeros.
    #[inline(always)]
    fn fraction(&mut self, number: u64) -> Option<()> {
        if number == 0 {
            return Some(());
        }
        self.byte(b'.')?;
        self.without_zeros_behind(number)
    }

    /// Appends eight digits without the zeros behind them; not all of them may be zeros.
    #[inline(always)]
    fn without_zeros_behind(&mut self, number: u64) -> Option<()> {
        let digits = eight_digits(number);
        let zeros = (digits ^ ZEROS_OF_QUARTER).leading_zeros() as usize / 8;
        self.eight(digits, QUARTER - zeros)
    }

    /// Appends the first of eight digits. All of them are copied, which is faster.
    #[inline(always)]
    fn eight(&mut self, digits: u64, count: usize) -> Option<()> {
        let place = self.bytes.get_mut(self.end..self.end + QUARTER)?;
        place.copy_from_slice(&digits.to_le_bytes());
        self.end += count;
        Some(())
    }
}

/// What stands before the point, and behind it in eight places.
#[inline(always)]
fn parts_of<const DECIMALS: usize>(size: u64) -> [u64; 2] {
    let one = const { POWERS[DECIMALS] };
    let scale = const { POWERS[QUARTER - DECIMALS] };
    [size / one, size % one * scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decimal::push;

    /// Each number that goes into the room has the digits that any number is written with.
    #[test]
    fn numbers_have_the_digits_of_the_plain_way() {
        let mut state = 1_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state as i64
        };
        let mut short = 0;
        for decimals in 0..=20 {
            let ones = (0..19).map(|k| 10_i64.pow(k));
            let near = ones.flat_map(|one| [one - 1, one, one + 1, 7 * (one / 10)]);
            let others = (0..2000).map(|k| next() >> (k % 64));
            for units in near.chain(others).chain([0, i64::MIN, i64::MAX]) {
                for units in [units, units.wrapping_neg()] {
                    let (mut room, mut plain) = (b"X".to_vec(), b"X".to_vec());
                    if push_line(&mut room, |line| line.number(units, decimals)) {
                        push(&mut plain, units, decimals);
                        short += 1;
                    }
                    assert_eq!(room, plain, "{units} {decimals}");
                }
            }
        }
        assert!(short > 20_000, "{short}");
    }

    #[test]
    fn a_line_without_room_leaves_the_text_as_it_was() {
        let mut text = b"before".to_vec();
        let numbers = |line: &mut LineRoom<'_>, count: usize| {
            (0..count).try_for_each(|_| line.number(-1_234_567_891, 7))
        };
        assert!(!push_line(&mut text, |line| numbers(line, 30)));
        assert_eq!(text, b"before");
        assert!(push_line(&mut text, |line| numbers(line, 2)));
        assert_eq!(text, b"before-123.4567891-123.4567891");
    }
}
