//! The lines of a control point as nearly all of them are written: `PVT` and a time on a line of its own, where
//! it changes, and a line with position and velocity of C, X and Z, a blank between them.
//!
//! [`Scanner`](super::scan::Scanner) reads any line. What is read here has the same meaning there.

use crate::axes::AxisWords;
use crate::fixed_point::LeadingDecimal;

/// The words of a control point. Numbers are in 10⁻¹² of the program's unit.
pub(super) struct PlainWords {
    /// The time of the segment, ms, if a line gives it.
    pub(super) time: Option<i128>,
    /// The words of C, X and Z.
    pub(super) axes: AxisWords,
    /// The bytes of the lines, with their ends.
    pub(super) bytes: usize,
    /// How many lines they are.
    pub(super) lines: usize,
}

impl PlainWords {
    /// The words with which a text begins; `None` if it begins otherwise, or ends within them.
    #[inline(always)]
    pub(super) fn of(text: &[u8]) -> Option<Self> {
        let mut rest = text;
        let time = match take(&mut rest, b"PVT") {
            Some(()) => {
                let time = number(&mut rest)?;
                take(&mut rest, b"\n")?;
                Some(time)
            }
            None => None,
        };
        take(&mut rest, b"C")?;
        let c = position_and_velocity(&mut rest)?;
        take(&mut rest, b" X")?;
        let x = position_and_velocity(&mut rest)?;
        take(&mut rest, b" Z")?;
        let z = position_and_velocity(&mut rest)?;
        take(&mut rest, b"\n")?;
        Some(Self {
            time,
            axes: [Some(c), Some(x), Some(z)],
            bytes: text.len() - rest.len(),
            lines: 1 + usize::from(time.is_some()),
        })
    }
}

/// Takes these bytes, if they are the next.
#[inline(always)]
fn take(rest: &mut &[u8], bytes: &[u8]) -> Option<()> {
    *rest = rest.strip_prefix(bytes)?;
    Some(())
}

#[inline(always)]
fn position_and_velocity(rest: &mut &[u8]) -> Option<(i128, Option<i128>)> {
    let position = number(rest)?;
    take(rest, b":")?;
    Some((position, Some(number(rest)?)))
}

#[inline(always)]
fn number(rest: &mut &[u8]) -> Option<i128> {
    let negative = take(rest, b"-").is_some();
    let decimal = LeadingDecimal::of(rest)?;
    let size = decimal.size(rest)?;
    *rest = rest.get(decimal.length..)?;
    Some(if negative { -size } else { size })
}
