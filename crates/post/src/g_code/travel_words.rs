//! The moves before and after a path on controllers that must be told more than `G90` and `G94` first: a
//! program begins with what the last one left.

use super::words::spaced;
use super::{read, write};
use crate::fixed_point::{ONE, number};
use crate::program_format::ProgramFormat;
use crate::travel::{Places, Travel, TravelModes};

/// What the first of a controller's moves says besides `G90` and `G94`, and how a reader knows it.
pub(crate) struct TravelWords {
    /// The words as they are written.
    pub(crate) text: &'static str,
    /// The number of the word that makes numbers mm, in 10⁻¹².
    pub(crate) metric: i128,
    /// The numbers of words that move nothing.
    pub(crate) without_move: &'static [i128],
}

impl TravelWords {
    /// Writes a statement.
    pub(crate) fn push(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        write::push_travel(text, format, self.text, travel);
    }

    /// Reads a line. The program must have said that numbers are mm before an axis moves.
    pub(crate) fn read(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        let code = spaced(code)?;
        let mut rest = Vec::new();
        for word in code.split_whitespace() {
            let mode = word.strip_prefix('G').map(|text| number("G", text));
            match mode.and_then(Result::ok) {
                Some(mode) if mode == self.metric => modes.metric = true,
                Some(mode) if self.without_move.contains(&mode) => {}
                _ => rest.push(word),
            }
        }
        let places = read::read_travel(&rest.join(" "), modes)?;
        match !modes.metric && places.iter().any(Option::is_some) {
            true => Err(format!("a move before `G{}`", self.metric / ONE)),
            false => Ok(places),
        }
    }
}

/// Reads a line of a controller that has no such words.
pub(crate) fn read_spaced_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    read::read_travel(&spaced(code)?, modes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_with_and_without_spaces_and_comments() {
        for code in ["G0 Z6.5", "g0z6.5", "G0 (up) Z6.5", "(up)G0Z6.5"] {
            let mut modes = TravelModes::default();
            read_spaced_travel("G90 G94", &mut modes).unwrap();
            let places = read_spaced_travel(code, &mut modes).unwrap();
            assert_eq!(places, [None, None, Some(ONE * 13 / 2)], "{code}");
        }
        assert!(read_spaced_travel("G0 (up Z6.5", &mut TravelModes::default()).is_err());
    }
}
