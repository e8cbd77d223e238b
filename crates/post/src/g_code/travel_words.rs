//! The moves before and after a path on controllers that must be told more than `G90` and `G94` first: a
//! program begins with what the last one left.

use super::words::{refuse_broken_numbers, spaced};
use super::{read, write};
use crate::program_format::ProgramFormat;
use crate::travel::{Places, Travel, TravelModes};

/// What every controller of G code must have been told: positions, and feeds per minute.
const NEEDED: &[&str] = &["G90", "G94"];

/// What the first of a controller's moves says besides `G90` and `G94`, and how a reader knows it.
pub(crate) struct TravelWords {
    /// The words as they are written.
    pub(crate) text: &'static str,
    /// The words that a program must have said before an axis moves, `G90` and `G94` among them.
    pub(crate) needed: &'static [&'static str],
    /// Other words of exact stops, by the controller's manual.
    pub(crate) allowed: &'static [&'static str],
    /// Whether blanks may stand within numbers.
    pub(crate) numbers_have_blanks: bool,
}

impl TravelWords {
    /// Writes a statement.
    pub(crate) fn push(&self, text: &mut Vec<u8>, format: &ProgramFormat, travel: Travel) {
        write::push_travel(text, format, self.text, travel);
    }

    /// Reads a line.
    pub(crate) fn read(&self, code: &str, modes: &mut TravelModes) -> Result<Places, String> {
        if !self.numbers_have_blanks {
            refuse_broken_numbers(code)?;
        }
        read::read_travel(&spaced(code)?, (self.needed, self.allowed), modes)
    }
}

/// Reads a line of a controller that has no such words, or of which they are not known.
pub(crate) fn read_spaced_travel(code: &str, modes: &mut TravelModes) -> Result<Places, String> {
    refuse_broken_numbers(code)?;
    read::read_travel(&spaced(code)?, (NEEDED, &[]), modes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed_point::ONE;

    #[test]
    fn words_stand_with_and_without_spaces_and_comments() {
        for code in ["G0 Z6.5", "g0z6.5", "G0 (up) Z6.5", "(up)G0Z6.5"] {
            let mut modes = TravelModes::default();
            read_spaced_travel("G90 G94", &mut modes).unwrap();
            let places = read_spaced_travel(code, &mut modes).unwrap();
            assert_eq!(places, [None, None, Some(ONE * 13 / 2)], "{code}");
        }
        for code in ["G0 (up Z6.5", "G0 Z6 .5", "G0 Z6.0 5", "G0 Z6. (up) 5"] {
            assert!(
                read_spaced_travel(code, &mut TravelModes::default()).is_err(),
                "{code}"
            );
        }
    }
}
