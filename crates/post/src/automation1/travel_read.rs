//! Reads the calls before and after a path. This follows AeroScript's grammar as far as they need it, and
//! shares nothing with the writer.

use crate::axes::NAMES;
use crate::fixed_point::number;
use crate::travel::{Motion, Places, Speed, TravelModes, speed_of};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// The calls that a program must have before it moves: units, positions, and that each move comes to rest.
const NEEDED: &[&str] = &[
    "SetupTaskDistanceUnits(DistanceUnits.Primary)",
    "SetupTaskTimeUnits(TimeUnits.Seconds)",
    "SetupTaskTargetMode(TargetMode.Absolute)",
    "SetupTaskWaitMode(WaitMode.MotionDone)",
];

/// The positions that a call gives.
pub(super) fn read_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = code.trim();
    let mut places = [None; 3];
    if code.is_empty() || code == "ProgramPause()" {
        return Ok(places);
    }
    if let Some(call) = NEEDED.iter().find(|call| **call == code) {
        modes.say(call);
        return Ok(places);
    }
    let call = code.split_once('(').and_then(|(name, rest)| {
        let arguments = rest.strip_suffix(')')?;
        let (axis, rest) = in_brackets(arguments)?;
        let (place, rest) = in_brackets(rest.trim_start().strip_prefix(',')?)?;
        Some((name.trim(), axis.trim(), place.trim(), rest.trim()))
    });
    let Some((name @ ("MoveRapid" | "MoveLinear"), axis, place, rest)) = call else {
        let shown: String = code.chars().take(40).collect();
        return Err(format!(
            "`{shown}` is not a call of an approach or a retreat"
        ));
    };
    (modes.motion, modes.speed) = match (name, rest.strip_prefix(',')) {
        ("MoveRapid", None) if rest.is_empty() => (Some(Motion::Rapid), None),
        ("MoveLinear", Some(speed)) => {
            let per_second = speed_of("the speed", speed.trim())?;
            (Some(Motion::Fed), Some(Speed::Feed(per_second * MINUTE)))
        }
        ("MoveLinear", None) if rest.is_empty() => {
            return Err("`MoveLinear` has no speed".to_owned());
        }
        ("MoveRapid", Some(_)) => {
            return Err("`MoveRapid` has a speed, which no move of the recipe has".to_owned());
        }
        _ => return Err("a comma is missing before the speed".to_owned()),
    };
    let k = NAMES.iter().position(|name| *name == axis);
    let k = k.ok_or_else(|| format!("`{axis}` is not one axis of the path"))?;
    modes.need(NEEDED)?;
    places[k] = Some(number(axis, place)?);
    Ok(places)
}

/// What stands in the brackets at the beginning of a text, and what follows them.
fn in_brackets(text: &str) -> Option<(&str, &str)> {
    text.trim_start().strip_prefix('[')?.split_once(']')
}
