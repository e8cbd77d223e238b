//! Writes segments in a row, whose digits are found in columns.

use super::clock::Clock;
use super::write::{ENTRY_MS, push_segment};
use crate::digits::AXES;
use crate::line_room::{LineRoom, OF_POINT, push_in_room};
use crate::number_columns::{AT_ONCE, NumberColumn};
use crate::program_format::ProgramFormat;
use crate::segment_block::SegmentBlock;

/// The lines that [`push_segment`] writes for each of the segments.
pub(super) fn push_block(
    text: &mut Vec<u8>,
    clock: Clock,
    format: &ProgramFormat,
    block: &SegmentBlock<'_>,
) {
    let mut columns = AxisColumns::EMPTY;
    for first in (0..block.count()).step_by(AT_ONCE) {
        let last = block.count().min(first + AT_ONCE);
        let is_short = columns.find(format, block, first)
            && push_in_room::<{ AT_ONCE * OF_POINT }>(text, |lines| {
                (first..last).try_for_each(|index| {
                    write_time(lines, clock, block, index)?;
                    columns.write(lines, index - first)
                })
            });
        if !is_short {
            let segments = (first..last).filter_map(|index| block.segment(index));
            segments.for_each(|segment| push_segment(text, clock, format, &segment));
        }
    }
}

/// The line of a segment's time, where it changes.
#[inline(always)]
fn write_time(
    lines: &mut LineRoom<'_>,
    clock: Clock,
    block: &SegmentBlock<'_>,
    index: usize,
) -> Option<()> {
    let steps = block.steps(index)?;
    let entry = ENTRY_MS * clock.steps_per_ms;
    if steps == block.steps_before(index).unwrap_or(entry) {
        return Some(());
    }
    let time = i128::from(steps) * i128::from(clock.step());
    lines.word(b"PVT")?;
    lines.number(time.try_into().ok()?, clock.decimals)?;
    lines.word(b"\n")
}

/// The digits of what the lines of segments say of C, X and Z.
struct AxisColumns {
    positions: [NumberColumn; 3],
    velocities: [NumberColumn; 3],
}

impl AxisColumns {
    const EMPTY: Self = Self {
        positions: [NumberColumn::EMPTY; 3],
        velocities: [NumberColumn::EMPTY; 3],
    };

    /// Finds those of segments `first` and on; says whether all numbers are short.
    fn find(&mut self, format: &ProgramFormat, block: &SegmentBlock<'_>, first: usize) -> bool {
        let mut units = [[0; AT_ONCE]; 3];
        block.said_positions(format, first, &mut units);
        let mut is_short = true;
        for (column, units) in self.positions.iter_mut().zip(&units) {
            is_short &= column.find(units, format.position_decimals);
        }
        for (column, velocities) in self.velocities.iter_mut().zip(block.ends().velocities()) {
            let velocities = velocities.get(first..).unwrap_or_default();
            let Some(velocities) = velocities.first_chunk() else {
                return false;
            };
            is_short &= column.find(velocities, format.velocity_decimals);
        }
        is_short
    }

    /// The line of one of the segments.
    #[inline(always)]
    fn write(&self, lines: &mut LineRoom<'_>, index: usize) -> Option<()> {
        for (k, axis) in AXES.into_iter().enumerate() {
            match k {
                0 => lines.word(&[axis as u8])?,
                _ => lines.word(&[b' ', axis as u8])?,
            }
            lines.digits(self.positions[k].at(index)?)?;
            lines.word(b":")?;
            lines.digits(self.velocities[k].at(index)?)?;
        }
        lines.word(b"\n")
    }
}
