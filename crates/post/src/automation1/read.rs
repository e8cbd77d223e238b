//! Reads the calls of a path. This follows AeroScript's grammar as far as a path needs it, and shares
//! nothing with the writer.

use turnpath_core::toolpath::ControlPoint;

use crate::axes::{Axes, AxisWords, NAMES, steps_of, times};
use crate::fixed_point::{ONE, number};
use crate::post::Grammar;
use crate::program_format::ProgramFormat;

/// The calls of a program, in their order.
pub(super) struct AeroScript {
    steps_per_s: i64,
    longest: i64,
    axes: Axes,
    /// Whether targets are positions instead of distances; `None` until the program says so.
    absolute: Option<bool>,
    /// Whether times are in seconds, as the program must say.
    in_seconds: bool,
    /// Whether distances are in the primary units of the axes, as the program must say.
    in_primary_units: bool,
}

impl AeroScript {
    pub(super) fn new(format: &ProgramFormat) -> Self {
        Self {
            steps_per_s: format.steps_per_s,
            longest: format.longest,
            axes: Axes::new(*format),
            absolute: None,
            in_seconds: false,
            in_primary_units: false,
        }
    }

    fn go_to(&mut self, arguments: &str) -> Result<ControlPoint, String> {
        let (axes, rest) = list(arguments)?;
        let (positions, rest) = list(after_comma(rest)?)?;
        let (velocities, rest) = list(after_comma(rest)?)?;
        let time = number("the time", after_comma(rest)?.trim())?;
        let words = axis_words(&axes, &positions, &velocities)?;
        let steps = steps_of(time, self.steps_per_s, self.longest).ok_or_else(|| {
            let s = time as f64 / ONE as f64;
            let range = times(self.steps_per_s, self.longest, "s");
            format!("a segment cannot take {s} s, only {range}")
        })?;
        if !self.in_primary_units {
            let units = "SetupTaskDistanceUnits(DistanceUnits.Primary)";
            return Err(format!("a move before `{units}`"));
        }
        if !self.in_seconds {
            return Err("a move before `SetupTaskTimeUnits(TimeUnits.Seconds)`".to_owned());
        }
        let absolute = self
            .absolute
            .ok_or("a move before `SetupTaskTargetMode(…)`")?;
        self.axes.go_to(&words, [absolute; 3], steps)
    }
}

impl Grammar for AeroScript {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        match line.windows(2).position(|pair| pair == b"//") {
            Some(at) => (&line[..at], Some(&line[at + 2..])),
            None => (line, None),
        }
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        let code = code.trim();
        if code.is_empty() {
            return Ok(());
        }
        let call = code.split_once('(').and_then(|(name, rest)| {
            let arguments = rest.strip_suffix(')')?;
            Some((name.trim(), arguments.trim()))
        });
        match call {
            Some(("MovePvt", arguments)) => points.push(self.go_to(arguments)?),
            Some(("SetupTaskTargetMode", "TargetMode.Absolute")) => self.absolute = Some(true),
            Some(("SetupTaskTargetMode", "TargetMode.Incremental")) => self.absolute = Some(false),
            Some(("SetupTaskTimeUnits", "TimeUnits.Seconds")) => self.in_seconds = true,
            Some(("SetupTaskDistanceUnits", "DistanceUnits.Primary")) => {
                self.in_primary_units = true;
            }
            _ => {
                let shown: String = code.chars().take(40).collect();
                return Err(format!("`{shown}` is not a call of a PVT path"));
            }
        }
        Ok(())
    }
}

/// The items of a list in brackets at the beginning of a text, and what follows it.
fn list(text: &str) -> Result<(Vec<&str>, &str), String> {
    let inside = text.trim_start().strip_prefix('[');
    let (items, rest) = inside
        .and_then(|inside| inside.split_once(']'))
        .ok_or("`MovePvt` takes axes, positions, velocities, each in brackets, and a time")?;
    Ok((items.split(',').map(str::trim).collect(), rest))
}

fn after_comma(text: &str) -> Result<&str, String> {
    let rest = text.trim_start().strip_prefix(',');
    rest.ok_or_else(|| "a comma is missing between the arguments of `MovePvt`".to_owned())
}

/// Positions and velocities of the axes. An axis that is not named stays where it is.
fn axis_words(axes: &[&str], positions: &[&str], velocities: &[&str]) -> Result<AxisWords, String> {
    if positions.len() != axes.len() || velocities.len() != axes.len() {
        return Err("`MovePvt` needs a position and a velocity for each axis".to_owned());
    }
    let mut words: AxisWords = [None; 3];
    for ((axis, position), velocity) in axes.iter().zip(positions).zip(velocities) {
        let k = NAMES.iter().position(|name| name == axis);
        let k = k.ok_or_else(|| {
            let shown: String = axis.chars().take(40).collect();
            format!("`{shown}` is not an axis of the path")
        })?;
        if words[k].is_some() {
            return Err(format!("{axis} appears twice on this line"));
        }
        let position = number(&format!("the position of {axis}"), position.trim())?;
        let velocity = number(&format!("the velocity of {axis}"), velocity.trim())?;
        words[k] = Some((position, Some(velocity)));
    }
    Ok(words)
}
