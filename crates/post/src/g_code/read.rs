//! Reads the moves. This follows the words of G code, and shares nothing with the writer.

use crate::axes::NAMES;
use crate::fixed_point::number;
use crate::travel::{Places, TravelModes};

/// Words that move nothing: positions, feeds per minute, exact stops, and stops of the program.
const WITHOUT_MOVE: [&str; 6] = ["G94", "G9", "G60", "G61", "M0", "M00"];

/// The positions that a line gives.
pub(crate) fn read_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let mut places: Places = [None; 3];
    for word in code.split_whitespace() {
        let axis = NAMES.iter().position(|name| word.starts_with(name));
        match axis {
            Some(axis) => {
                let name = NAMES[axis];
                let place = number(name, word.get(1..).unwrap_or_default())?;
                if places[axis].replace(place).is_some() {
                    return Err(format!("{name} appears twice on this line"));
                }
            }
            None if word == "G90" => modes.absolute = true,
            None if matches!(word, "G0" | "G00" | "G1" | "G01") => {}
            None if WITHOUT_MOVE.contains(&word) || is_feed(word) => {}
            None => {
                let shown: String = word.chars().take(40).collect();
                return Err(format!(
                    "`{shown}` is not a word of an approach or a retreat"
                ));
            }
        }
    }
    if !modes.absolute && places.iter().any(Option::is_some) {
        return Err("a move before `G90`".to_owned());
    }
    Ok(places)
}

fn is_feed(word: &str) -> bool {
    word.strip_prefix('F')
        .is_some_and(|feed| number("F", feed).is_ok_and(|feed| feed > 0))
}
