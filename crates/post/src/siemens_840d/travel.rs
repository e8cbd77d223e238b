//! Reads what stands around a path: the moves before and after it, and the calls of its parts.

use crate::g_code;
use crate::travel::{Places, TravelModes};

use super::read::without_number;

/// What F refers to: the axis that moves.
const FEED_AXES: &str = "FGROUP()";
/// The words that a program must have said before an axis moves. `G710` makes lengths and feeds metric; `G71`
/// leaves feeds in the unit of the machine's basic system.
const NEEDED: &[&str] = &["G90", "G94", "G710", "G60"];
/// An exact stop in its block alone.
const ALLOWED: &[&str] = &["G9"];

/// The positions that a line gives.
pub(super) fn read(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = code.to_ascii_uppercase();
    let mut rest = Vec::new();
    for word in without_number(&code)?.split_whitespace() {
        match word {
            FEED_AXES => modes.say(FEED_AXES),
            word => rest.push(word),
        }
    }
    let places = g_code::read_travel(&rest.join(" "), (NEEDED, ALLOWED), modes)?;
    match places == Places::default() {
        true => Ok(places),
        false => modes.need(&[FEED_AXES]).map(|()| places),
    }
}

/// The file of `EXTCALL("file")`.
pub(super) fn called_part(code: &str) -> Option<String> {
    let code = code.trim();
    let word = code
        .get(..7)
        .filter(|word| word.eq_ignore_ascii_case("EXTCALL"))?;
    let rest = code.get(word.len()..)?.trim_start();
    let name = rest.strip_prefix("(\"")?.strip_suffix("\")")?;
    Some(name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed_point::ONE;

    #[test]
    fn no_axis_moves_before_lengths_and_feeds_are_metric() {
        let mut modes = TravelModes::default();
        assert!(read("G90 G94 G60 FGROUP()", &mut modes).is_ok());
        let said = read("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G710`");
        read("N10 g710", &mut modes).unwrap();
        let places = read("n20 g0 z6.5", &mut modes).unwrap();
        assert_eq!(places, [None, None, Some(ONE * 13 / 2)]);
        for wrong in ["G70", "G71", "G700", "G61"] {
            assert!(read(wrong, &mut TravelModes::default()).is_err(), "{wrong}");
        }
        assert!(read("G9 X2.5", &mut modes).is_ok());
    }
}
