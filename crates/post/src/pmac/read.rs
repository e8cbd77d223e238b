//! Reads the lines of a PVT path.

use turnpath_core::toolpath::ControlPoint;

use super::clock::Clock;
use super::scan::{Axis, Word, split_comment, words};
use crate::axes::{Axes, AxisWords, NAMES, steps_of};
use crate::fixed_point::ONE;
use crate::post::Grammar;
use crate::program_format::ProgramFormat;

/// The lines of a PVT program, in their order.
pub(super) struct PvtGrammar {
    clock: Clock,
    longest: i64,
    axes: Axes,
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
            absolute: [None; 3],
            time: None,
        }
    }

    /// A time in steps, from 10⁻¹² ms.
    fn steps(&self, time: i128) -> Result<i64, String> {
        steps_of(time, self.clock.steps_per_ms, self.longest).ok_or_else(|| {
            let ms = time as f64 / ONE as f64;
            let range = self.clock.range;
            format!("a segment cannot take {ms} ms, only {range}")
        })
    }
}

impl Grammar for PvtGrammar {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        split_comment(line)
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        let mut line: AxisWords = [None; 3];
        for word in words(code)? {
            let moved = line.iter().any(Option::is_some);
            match word {
                Word::Move(axis, position, velocity) => {
                    add_move(&mut line, axis, position, velocity)?
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
        if line.iter().all(Option::is_none) {
            return Ok(());
        }
        let time = self.time.ok_or("a move without a `PVT` time before it")?;
        let [Some(c), Some(x), Some(z)] = self.absolute else {
            return Err("a move before `ABS` or `INC`".to_owned());
        };
        points.push(self.axes.go_to(&line, [c, x, z], time)?);
        Ok(())
    }
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
