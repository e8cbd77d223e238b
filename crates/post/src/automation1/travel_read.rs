//! Reads the calls before and after a path. This follows AeroScript's grammar as far as they need it, and
//! shares nothing with the writer.

use crate::axes::NAMES;
use crate::fixed_point::number;
use crate::travel::{Places, TravelModes};

/// The positions that a call gives.
pub(super) fn read_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = code.trim();
    let none = [None; 3];
    match code {
        "" | "ProgramPause()" => return Ok(none),
        "SetupTaskTargetMode(TargetMode.Absolute)" => {
            modes.absolute = true;
            return Ok(none);
        }
        "SetupTaskTimeUnits(TimeUnits.Seconds)" | "SetupTaskWaitMode(WaitMode.MotionDone)" => {
            return Ok(none);
        }
        _ => {}
    }
    let call = code.split_once('(').and_then(|(name, rest)| {
        let arguments = rest.strip_suffix(')')?;
        let (axis, rest) = arguments.trim_start().strip_prefix('[')?.split_once(']')?;
        let (place, rest) = rest.split_once('[')?.1.split_once(']')?;
        Some((name.trim(), axis.trim(), place.trim(), rest.trim()))
    });
    let Some(("MoveRapid" | "MoveLinear", axis, place, rest)) = call else {
        let shown: String = code.chars().take(40).collect();
        return Err(format!(
            "`{shown}` is not a call of an approach or a retreat"
        ));
    };
    if let Some(speed) = rest.strip_prefix(',') {
        number("the speed", speed.trim())?;
    } else if !rest.is_empty() {
        return Err("a comma is missing before the speed".to_owned());
    }
    let k = NAMES.iter().position(|name| *name == axis);
    let k = k.ok_or_else(|| format!("`{axis}` is not one axis of the path"))?;
    if !modes.absolute {
        return Err("a move before `SetupTaskTargetMode(TargetMode.Absolute)`".to_owned());
    }
    let mut places = none;
    places[k] = Some(number(axis, place)?);
    Ok(places)
}
