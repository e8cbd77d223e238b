//! Reads the lines before and after a path. This follows the manual's description of motion programs,
//! and shares nothing with the writer.

use super::scan::{Axis, Scanner};
use crate::fixed_point::ONE;
use crate::travel::{Motion, Places, Speed, TravelModes};

/// The word that makes numbers positions.
const POSITIONS: &str = "ABS";

/// The positions that a line gives.
pub(super) fn read_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let mut places: Places = [None; 3];
    let mut scanner = Scanner::new(code);
    while let Some(start) = scanner.rest_unless_empty() {
        let letters = scanner.letters().to_ascii_uppercase();
        let axis = match letters.as_str() {
            "C" => Axis::C,
            "X" => Axis::X,
            "Z" => Axis::Z,
            "ABS" => {
                if scanner.axes()? == [true; 3] {
                    modes.say(POSITIONS);
                }
                continue;
            }
            "RAPID" | "RPD" => {
                modes.motion = Some(Motion::Rapid);
                continue;
            }
            "LINEAR" | "LIN" => {
                modes.motion = Some(Motion::Fed);
                continue;
            }
            "STOP" => continue,
            "TM" => {
                let ms = scanner.number(&letters)? as f64 / ONE as f64;
                modes.speed = Some(Speed::Milliseconds(ms));
                continue;
            }
            "DWELL" => {
                scanner.number(&letters)?;
                modes.blends = false;
                continue;
            }
            "N" => {
                scanner.number(&letters)?;
                continue;
            }
            _ => {
                let word: String = start.split_whitespace().take(1).collect();
                let shown: String = word.chars().take(40).collect();
                return Err(format!(
                    "`{shown}` is not a word of an approach or a retreat"
                ));
            }
        };
        let place = scanner.number(&letters)?;
        if places[axis as usize].replace(place).is_some() {
            return Err(format!("{letters} appears twice on this line"));
        }
    }
    if places.iter().any(Option::is_some) {
        modes.need(&[POSITIONS])?;
        // A rapid move is never blended with another.
        modes.blends = modes.motion == Some(Motion::Fed);
    }
    Ok(places)
}
