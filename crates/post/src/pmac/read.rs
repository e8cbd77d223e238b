//! Reads the lines of a PVT path.

use turnpath_core::toolpath::ControlPoint;

use super::clock::Clock;
use super::plain::PlainWords;
use super::scan::{Axis, Scanner, Word, split_comment};
use crate::axes::{Axes, AxisWords, NAMES, steps_of, times};
use crate::fixed_point::{ONE, PLACES, SHORT_ONE};
use crate::post::{Grammar, PlainLines};
use crate::program_format::ProgramFormat;

/// The fives of [`ONE`].
const FIVES: u64 = 5u64.pow(PLACES);
/// Most bits that the controller may hold where 64 suffice: the fives have 28.
const MOST_SHORT_BITS: u32 = 35;

/// The lines of a PVT program, in their order.
pub(super) struct PvtGrammar {
    clock: Clock,
    longest: i64,
    axes: Axes,
    /// Bits of the size of a number that the controller holds; `None`: as many as a double has.
    mantissa_bits: Option<u32>,
    /// Whether each axis has positions instead of distances. `None` until the program sets it, because
    /// a controller begins with the mode of the program before.
    absolute: [Option<bool>; 3],
    /// The time of a segment in steps.
    time: Option<i64>,
}

impl PvtGrammar {
    pub(super) fn new(clock: Clock, format: &ProgramFormat) -> Self {
        Self {
            clock,
            longest: format.longest,
            axes: Axes::new(*format),
            mantissa_bits: if format.incremental {
                None
            } else {
                format.mantissa_bits
            },
            absolute: [None; 3],
            time: None,
        }
    }

    /// A time in steps, from 10⁻¹² ms.
    fn steps(&self, time: i128) -> Result<i64, String> {
        let steps_per_ms = self.clock.steps_per_ms;
        steps_of(time, steps_per_ms, self.longest).ok_or_else(|| {
            let ms = time as f64 / ONE as f64;
            let range = times(steps_per_ms, self.longest, "ms");
            format!("a segment cannot take {ms} ms, only {range}")
        })
    }

    /// Moves the axes by the words of a line, in the time of the segment.
    #[inline]
    fn go_to(
        &mut self,
        mut words: AxisWords,
        absolute: [bool; 3],
        time: i64,
    ) -> Result<ControlPoint, String> {
        for (word, absolute) in words.iter_mut().zip(absolute) {
            if let (Some((position, _)), true, Some(bits)) = (word, absolute, self.mantissa_bits) {
                *position = held(*position, bits);
            }
        }
        self.axes.go_to(&words, absolute, time)
    }
}

impl Grammar for PvtGrammar {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        split_comment(line)
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        let mut line: AxisWords = [None; 3];
        let mut scanner = Scanner::new(code);
        let mut moved = false;
        while let Some(word) = scanner.next_word()? {
            match word {
                Word::Move(axis, position, velocity) => {
                    add_move(&mut line, axis, position, velocity)?;
                    moved = true;
                }
                _ if moved => return Err("a mode follows a move on the same line".to_owned()),
                Word::Absolute(absolute, axes) => {
                    for (mode, chosen) in self.absolute.iter_mut().zip(axes) {
                        *mode = if chosen { Some(absolute) } else { *mode };
                    }
                }
                Word::Time(ms) => self.time = Some(self.steps(ms)?),
            }
        }
        if !moved {
            return Ok(());
        }
        let time = self.time.ok_or("a move without a `PVT` time before it")?;
        let [Some(c), Some(x), Some(z)] = self.absolute else {
            return Err("a move before `ABS` or `INC`".to_owned());
        };
        points.push(self.go_to(line, [c, x, z], time)?);
        Ok(())
    }

    fn read_plain(&mut self, text: &[u8]) -> Option<PlainLines> {
        let words = PlainWords::of(text)?;
        let time = match words.time {
            Some(ms) => self.steps(ms).ok()?,
            None => self.time?,
        };
        let [Some(c), Some(x), Some(z)] = self.absolute else {
            return None;
        };
        let point = self.go_to(words.axes, [c, x, z], time).ok()?;
        self.time = Some(time);
        Some(PlainLines {
            point,
            bytes: words.bytes,
            lines: words.lines,
        })
    }
}

/// A number of 10⁻¹² as the controller holds it: its size is a whole number of less than `bits` bits
/// times a power of two.
#[inline(always)]
fn held(value: i128, bits: u32) -> i128 {
    let short = u64::try_from(value.unsigned_abs()).ok();
    match short.and_then(|size| held_short(size, bits)) {
        Some(size) if value < 0 => -i128::from(size),
        Some(size) => i128::from(size),
        None => held_long(value, bits),
    }
}

/// The size of a number as the controller holds it, in 64 bits; `None` where they may be too few.
#[inline(always)]
fn held_short(size: u64, bits: u32) -> Option<u64> {
    if size == 0 {
        return Some(0);
    }
    if bits > MOST_SHORT_BITS {
        return None;
    }
    // The quantum is 2^−fraction: as many of them as the bits can count. A one is 2¹² · 5¹².
    let (log, log_of_one) = (size.ilog2(), SHORT_ONE.ilog2());
    let fits = match log.checked_sub(log_of_one) {
        Some(more) => size < SHORT_ONE << more,
        None => size << (log_of_one - log) < SHORT_ONE,
    };
    let fraction = (bits + log_of_one + u32::from(fits)).checked_sub(log + 1)?;
    let shift = fraction.checked_sub(PLACES)?;
    let fives = ((size << shift) + FIVES / 2) / FIVES * FIVES;
    Some(match shift {
        0 => fives,
        _ => ((fives >> (shift - 1)) + 1) >> 1,
    })
}

/// A number of any length as the controller holds it. It is a function of its own, so that short numbers do not pay
/// for it.
#[cold]
#[inline(never)]
fn held_long(value: i128, bits: u32) -> i128 {
    let size = value.unsigned_abs();
    if size == 0 {
        return 0;
    }
    let one = ONE.unsigned_abs();
    let about = (bits + one.ilog2()).saturating_sub(size.ilog2());
    let fits = size << about < one << bits;
    let fraction = if fits { about } else { about.saturating_sub(1) };
    let doubled = 2 * count_of_ones(size, fraction) * one;
    let size = ((doubled >> fraction) + 1) >> 1;
    i128::try_from(size).map_or(value, |size| value.signum() * size)
}

/// `size` · 2^`fraction` in ones, rounded.
fn count_of_ones(size: u128, fraction: u32) -> u128 {
    ((size << fraction) + ONE.unsigned_abs() / 2) / ONE.unsigned_abs()
}

fn add_move(
    line: &mut AxisWords,
    axis: Axis,
    position: i128,
    velocity: Option<i128>,
) -> Result<(), String> {
    let k = match axis {
        Axis::C => 0,
        Axis::X => 1,
        Axis::Z => 2,
    };
    if line[k].is_some() {
        return Err(format!("{} appears twice on this line", NAMES[k]));
    }
    line[k] = Some((position, velocity));
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{ONE, held, held_long};

    /// 35 bits count to 3.4e10: a number from 2^15 to 2^16 has steps of 2^-19.
    #[test]
    fn a_number_has_steps_that_follow_its_size() {
        let step = ONE >> 19;
        for (value, of_one) in [(36_000 * ONE, 19), (3_600_000 * ONE, 13), (ONE / 10, 38)] {
            for off in [0, 1, 77, step / 3, -step / 3, 5 * step + 9] {
                let exact = value + off;
                let found = held(exact, 35);
                let quantum = ONE as f64 / f64::from(of_one).exp2();
                let half = 0.5 * quantum + 1.0;
                assert!(((exact - found) as f64).abs() <= half, "{exact} {found}");
                let whole = (found as f64 / quantum).round() * quantum;
                assert!((found as f64 - whole).abs() <= 0.6, "{exact} {found}");
                assert_eq!(held(-exact, 35), -found);
            }
        }
        assert_eq!((held(0, 35), held(1, 35)), (0, 1));
    }

    proptest! {
        /// Numbers of all lengths, those beside powers of two and of ten among them.
        #[test]
        fn short_numbers_are_held_as_long_ones_are(
            size in prop_oneof![
                any::<u64>(),
                (0_u32..64, any::<u64>()).prop_map(|(shift, size)| size >> shift),
                (0_u32..64, 0_u64..5).prop_map(|(shift, off)| (1 << shift) + off - 2.min(1 << shift)),
                (0_u32..20, 0_u64..5).prop_map(|(power, off)| 10_u64.pow(power) + off - 1),
            ],
            bits in 1_u32..=36,
        ) {
            for value in [i128::from(size), -i128::from(size)] {
                prop_assert_eq!(held(value, bits), held_long(value, bits));
            }
        }
    }
}
