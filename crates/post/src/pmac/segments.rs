//! Writes segments in a row, whose digits are found in columns.

use super::clock::Clock;
use super::write::{ENTRY_MS, push_segment};
use crate::digit_segments::DigitSegments;
use crate::digits::AXES;
use crate::line_room::{LineRoom, OF_POINT, push_in_room};
use crate::number_columns::{AT_ONCE, NumberColumn};
use crate::program_format::ProgramFormat;

/// The lines that [`push_segment`] writes for each of the segments.
pub(super) fn push_segments(
    text: &mut Vec<u8>,
    clock: Clock,
    format: &ProgramFormat,
    segments: &DigitSegments<'_>,
) {
    let mut columns = AxisColumns::EMPTY;
    for first in (0..segments.count()).step_by(AT_ONCE) {
        let last = segments.count().min(first + AT_ONCE);
        let is_short = columns.find(format, segments, first)
            && push_in_room::<{ AT_ONCE * OF_POINT }>(text, |lines| {
                (first..last).try_for_each(|index| {
                    write_time(lines, clock, segments, index)?;
                    columns.write(lines, index - first)
                })
            });
        if !is_short {
            let each = (first..last).filter_map(|index| segments.segment(index));
            each.for_each(|segment| push_segment(text, clock, format, &segment));
        }
    }
}

/// The line of a segment's time, where it changes.
#[inline(always)]
fn write_time(
    lines: &mut LineRoom<'_>,
    clock: Clock,
    segments: &DigitSegments<'_>,
    index: usize,
) -> Option<()> {
    let steps = segments.steps(index)?;
    let entry = ENTRY_MS * clock.steps_per_ms;
    if steps == segments.steps_before(index).unwrap_or(entry) {
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
    fn find(&mut self, format: &ProgramFormat, segments: &DigitSegments<'_>, first: usize) -> bool {
        let said = segments.said_positions(format, first);
        let found = said.is_some_and(|said| {
            let columns = self.positions.iter_mut().zip(&said);
            all_short(columns, format.position_decimals)
        });
        // Behind the last segment stand velocities of others, or none with a meaning. They can make the answer a no.
        let velocities = segments.ends().velocities().map(|column| {
            let rest = column.get(first..).unwrap_or_default();
            rest.first_chunk::<AT_ONCE>()
        });
        let [Some(c), Some(x), Some(z)] = velocities else {
            return false;
        };
        let columns = self.velocities.iter_mut().zip([c, x, z]);
        found && all_short(columns, format.velocity_decimals)
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

/// Finds the digits of these columns, up to the first one with a number that is not short.
fn all_short<'a>(
    mut columns: impl Iterator<Item = (&'a mut NumberColumn, &'a [i64; AT_ONCE])>,
    decimals: u32,
) -> bool {
    columns.all(|(column, units)| column.find(units, decimals))
}

#[cfg(test)]
mod tests {
    use turnpath_core::Params;
    use turnpath_core::toolpath::{ControlPoint, PathBlock};

    use super::super::TURBO_CLOCK;
    use super::*;
    use crate::digit_columns::DigitColumns;
    use crate::posts::post_named;

    /// Points on steps of time, some of them alike; one number may be long.
    fn points(count: i64, long: Option<usize>) -> PathBlock {
        let mut points = PathBlock::default();
        for k in 0..count {
            let steps = 12_288 * k + [0, 0, 1, 0, 5][k as usize % 5];
            let unit = 1e-7 * (k * k * 7919 - 40 * k) as f64;
            points.push(ControlPoint {
                t: steps as f64 / 4_096_000.0,
                c: 0.017 * k as f64,
                x: 12.5 - unit,
                z: unit,
                vc: 5.0,
                vx: -0.1,
                vz: if k % 3 == 0 { 0.0 } else { -30.0 * unit },
            });
        }
        if let Some(long) = long {
            points.x[long] = 1.1e8;
        }
        points
    }

    /// The text of segments together, and that of each alone.
    fn texts(format: &ProgramFormat, points: &PathBlock) -> [String; 2] {
        let mut columns = DigitColumns::new(format, points).unwrap();
        let before = columns.find(format, points, 0..1).unwrap().at(0).unwrap();
        let ends = columns.find(format, points, 1..points.len()).unwrap();
        let before = (before, points.len().is_multiple_of(2).then_some(12_288));
        let segments = DigitSegments::new(format, before, (ends, points.len() - 1)).unwrap();
        let (mut together, mut alone) = (b"before".to_vec(), b"before".to_vec());
        push_segments(&mut together, TURBO_CLOCK, format, &segments);
        for segment in segments.segments() {
            push_segment(&mut alone, TURBO_CLOCK, format, &segment);
        }
        [together, alone].map(|text| String::from_utf8(text).unwrap())
    }

    #[test]
    fn segments_together_have_the_lines_that_each_has_alone() {
        let post = post_named("pmac-pvt").unwrap();
        let plain = post.format(&Params::new(), 0.25, 1e-4);
        let formats = [
            plain,
            ProgramFormat {
                c_wrapped: true,
                ..plain
            },
            ProgramFormat {
                incremental: true,
                ..plain
            },
            ProgramFormat {
                velocity_decimals: 9,
                ..plain
            },
        ];
        for format in formats {
            for count in [2, 33, 34, 101, 250] {
                for long in [None, Some(1), Some(count as usize - 1)] {
                    let [together, alone] = texts(&format, &points(count, long));
                    assert_eq!(together, alone, "{count} {long:?}");
                }
            }
        }
    }
}
