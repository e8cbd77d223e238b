//! Reads the moves. This follows the words of G code, and shares nothing with the writer.

use super::groups::Groups;
use super::words::numbered;
use crate::axes::NAMES;
use crate::fixed_point::number;
use crate::travel::{Motion, Places, Speed, TravelModes, speed_of};

/// The stop of a program, which all of these controllers have.
const STOP: &str = "M0";

/// The positions that a line gives. The program must have said the words of `needed` before an axis moves; those
/// of `allowed` move nothing, and no move needs them.
pub(crate) fn read_travel(
    code: &str,
    (needed, allowed): (&[&'static str], &[&str]),
    modes: &mut TravelModes,
) -> Result<Places, String> {
    let mut places: Places = [None; 3];
    let (mut motion, mut speed) = (None, None);
    let mut groups = Groups::default();
    for word in code.split_whitespace() {
        if let Some(axis) = NAMES.iter().position(|name| word.starts_with(name)) {
            let name = NAMES[axis];
            let place = number(name, word.get(1..).unwrap_or_default())?;
            refuse_twice(name, places[axis].replace(place).is_some())?;
            continue;
        }
        if let Some(feed) = word.strip_prefix('F') {
            let feed = Speed::Feed(speed_of("F", feed)?);
            refuse_twice("F", speed.replace(feed).is_some())?;
            continue;
        }
        if is_line_number(word) {
            continue;
        }
        let word = numbered(word);
        if let Some(Ok(number)) = word.strip_prefix('G').map(str::parse) {
            groups.take(number)?;
        }
        let of_motion = match word.as_str() {
            "G0" => Some(Motion::Rapid),
            "G1" => Some(Motion::Fed),
            _ => None,
        };
        if of_motion.is_some() {
            motion = of_motion;
        } else if let Some(known) = needed.iter().find(|known| **known == word) {
            modes.say(known);
        } else if word != STOP && !allowed.contains(&word.as_str()) {
            let shown: String = word.chars().take(40).collect();
            return Err(format!(
                "`{shown}` is not a word of an approach or a retreat"
            ));
        }
    }
    modes.motion = motion.or(modes.motion);
    modes.speed = speed.or(modes.speed);
    if places.iter().any(Option::is_some) {
        modes.need(needed)?;
    }
    Ok(places)
}

/// Whether a word is the number of its line, which does nothing.
fn is_line_number(word: &str) -> bool {
    let digits = word.strip_prefix('N').unwrap_or_default();
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

fn refuse_twice(name: &str, twice: bool) -> Result<(), String> {
    match twice {
        true => Err(format!("{name} appears twice on this line")),
        false => Ok(()),
    }
}
