//! Reads what stands around a path: the moves before and after it, and the calls of its parts.

use crate::g_code;
use crate::travel::{Places, TravelModes};

use super::read::without_number;

/// Words that move nothing, besides those of all G code: what F refers to.
const WITHOUT_MOVE: &str = "FGROUP()";

/// The positions that a line gives. Lengths must be metric before an axis moves.
pub(super) fn read(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    let code = code.to_ascii_uppercase();
    let mut rest = Vec::new();
    for word in without_number(&code)?.split_whitespace() {
        match word {
            "G71" | "G710" => modes.metric = true,
            WITHOUT_MOVE => {}
            word => rest.push(word),
        }
    }
    let places = g_code::read_travel(&rest.join(" "), modes)?;
    match !modes.metric && places.iter().any(Option::is_some) {
        true => Err("a move before `G71` or `G710`".to_owned()),
        false => Ok(places),
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
    fn no_axis_moves_before_lengths_are_metric() {
        let mut modes = TravelModes::default();
        assert!(read("G90 G94 G60 FGROUP()", &mut modes).is_ok());
        let said = read("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G71` or `G710`");
        for metric in ["G71", "N10 g710"] {
            let mut modes = TravelModes::default();
            read("G90 G94", &mut modes).unwrap();
            read(metric, &mut modes).unwrap();
            let places = read("n20 g0 z6.5", &mut modes).unwrap();
            assert_eq!(places, [None, None, Some(ONE * 13 / 2)], "{metric}");
        }
        assert!(read("G70", &mut TravelModes::default()).is_err());
    }
}
