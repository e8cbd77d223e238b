//! Room at the end of a text: numbers go into it without a look at the text's memory each time.

use crate::eight_digits::{PIECE, ZEROS, eight_digits};
use crate::number_columns::NumberDigits;
use crate::powers_of_ten::POWERS_OF_TEN;

/// Room for the lines of a control point, bytes: more than any of them needs. More room takes time to clear.
pub(crate) const OF_POINT: usize = 192;
/// Room for one number, bytes.
pub(crate) const OF_NUMBER: usize = 40;
/// Most decimals of numbers that have one piece behind the point.
const ONE_PIECE: u32 = PIECE as u32;
/// Most decimals of those that have two.
const TWO_PIECES: u32 = 2 * ONE_PIECE;
/// Most bytes of a number with eight digits before the point and eight behind it, with its sign.
const LONGEST_NUMBER: usize = 2 * PIECE + 2;
/// The last byte of eight digits.
const LAST_BYTE: u64 = 0xff << (8 * (PIECE - 1));

/// A line in the making, or a number.
pub(crate) struct LineRoom<'a> {
    bytes: &'a mut [u8],
    end: usize,
}

/// Appends what `write` writes into so many bytes. Where it gives up, the text is as it was, and the answer is no:
/// it then has to be written in another way.
#[inline]
pub(crate) fn push_in_room<const ROOM: usize>(
    text: &mut Vec<u8>,
    write: impl FnOnce(&mut LineRoom<'_>) -> Option<()>,
) -> bool {
    let start = text.len();
    text.extend_from_slice(&[0; ROOM]);
    let end = text.last_chunk_mut::<ROOM>().and_then(|bytes| {
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
    pub(crate) fn word<const LENGTH: usize>(&mut self, bytes: &[u8; LENGTH]) -> Option<()> {
        let end = self.end + LENGTH;
        self.bytes.get_mut(self.end..end)?.copy_from_slice(bytes);
        self.end = end;
        Some(())
    }

    /// Appends a number without trailing zeros. `None` where the line may be too long. Eight digits are copied on
    /// either side of the point. What comes next is written over those that the number does not have.
    #[inline(always)]
    pub(crate) fn digits(&mut self, number: NumberDigits) -> Option<()> {
        let room: &mut [u8; LONGEST_NUMBER] = self.bytes.get_mut(self.end..)?.first_chunk_mut()?;
        room[0] = b'-';
        let begin = usize::from(number.is_negative);
        // At least one digit stands before the point.
        let unsaid = ((number.whole ^ ZEROS) | LAST_BYTE).trailing_zeros() as usize / 8;
        let point = begin + PIECE - unsaid;
        let behind = PIECE - (number.fraction ^ ZEROS).leading_zeros() as usize / 8;
        let whole = (number.whole >> (8 * unsaid)).to_le_bytes();
        room[begin..begin + PIECE].copy_from_slice(&whole);
        *room.get_mut(point)? = b'.';
        let fraction = room.get_mut(point + 1..point + 1 + PIECE)?;
        fraction.copy_from_slice(&number.fraction.to_le_bytes());
        self.end += point + behind + usize::from(behind > 0);
        Some(())
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
                7 => parts_of::<7, PIECE>(size),
                6 => parts_of::<6, PIECE>(size),
                8 => parts_of::<8, PIECE>(size),
                5 => parts_of::<5, PIECE>(size),
                _ => {
                    let one = *POWERS_OF_TEN.get(decimals as usize)?;
                    let scale = POWERS_OF_TEN.get((ONE_PIECE - decimals) as usize)?;
                    [size / one, size % one * scale]
                }
            };
            self.whole(whole)?;
            self.fraction(fraction)
        } else {
            let [whole, fraction] = match decimals {
                12 => parts_of::<12, { 2 * PIECE }>(size),
                9 => parts_of::<9, { 2 * PIECE }>(size),
                _ => {
                    let one = *POWERS_OF_TEN.get(decimals as usize)?;
                    let scale = POWERS_OF_TEN.get(TWO_PIECES.checked_sub(decimals)? as usize)?;
                    [size / one, size % one * scale]
                }
            };
            self.whole(whole)?;
            match (
                fraction / POWERS_OF_TEN[PIECE],
                fraction % POWERS_OF_TEN[PIECE],
            ) {
                (upper, 0) => self.fraction(upper),
                (upper, lower) => {
                    self.byte(b'.')?;
                    self.eight(eight_digits(upper), PIECE)?;
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
        if number >= POWERS_OF_TEN[PIECE] {
            return None;
        }
        let digits = eight_digits(number);
        let zeros = (digits ^ ZEROS).trailing_zeros() as usize / 8;
        self.eight(digits >> (8 * zeros), PIECE - zeros)
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
        let zeros = (digits ^ ZEROS).leading_zeros() as usize / 8;
        self.eight(digits, PIECE - zeros)
    }

    /// Appends the first of eight digits. All of them are copied, which is faster.
    #[inline(always)]
    fn eight(&mut self, digits: u64, count: usize) -> Option<()> {
        let place = self.bytes.get_mut(self.end..self.end + PIECE)?;
        place.copy_from_slice(&digits.to_le_bytes());
        self.end += count;
        Some(())
    }
}

/// What stands before the point, and behind it in so many places.
#[inline(always)]
fn parts_of<const DECIMALS: usize, const PLACES: usize>(size: u64) -> [u64; 2] {
    let one = const { POWERS_OF_TEN[DECIMALS] };
    let scale = const { POWERS_OF_TEN[PLACES - DECIMALS] };
    [size / one, size % one * scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_room_leaves_the_text_as_it_was() {
        let mut text = b"before".to_vec();
        let numbers = |line: &mut LineRoom<'_>, count: usize| {
            (0..count).try_for_each(|_| line.number(-1_234_567_891, 7))
        };
        assert!(!push_in_room::<OF_POINT>(&mut text, |line| numbers(
            line, 30
        )));
        assert_eq!(text, b"before");
        assert!(push_in_room::<OF_POINT>(&mut text, |line| numbers(line, 2)));
        assert_eq!(text, b"before-123.4567891-123.4567891");
    }
}
