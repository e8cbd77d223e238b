//! What the posts for Beckhoff TwinCAT CNC share: the moves before and after a path, the parts of a program,
//! and the commands of templates.
//!
//! Facts on the language: Beckhoff, TF5200 Programming manual, "Exact stop (G60/G360/G359)" (206301707),
//! "Polynomial contouring (G61/G261/G260)" (206307595), "Determining acceleration/deceleration
//! (G08/G09/G900/G901)" (206238219), "Block-specific comments", "Global sub-routines", and the tables "Meaning of G
//! functions" and "Meaning of other M functions" of its system parameters.

use crate::g_code::{self, TravelWords};
use crate::part_name::{PartLines, PartName};
use crate::post::Command;

/// Numbers are mm, X is a radius, no tool is compensated, and each line ends at rest: `G360`, which the path's
/// first line takes back.
pub(crate) const TRAVEL: TravelWords = TravelWords {
    text: " G40 G52 G71 G360",
    needed: &["G90", "G94", "G40", "G52", "G71", "G360"],
    // An exact stop at the end of its block. `G61` is none here: it rounds the corner by polynomials. `G9` ends a
    // block at the speed of the next one.
    allowed: &["G60"],
    numbers_have_blanks: false,
};
/// Words that move nothing and set nothing but what the path sets itself, and the ends of programs.
const HARMLESS: &[&str] = &[
    "G40", "G52", "G71", "G90", "G93", "G359", "M2", "M02", "M17", "M29", "M30",
];
/// Numbers of words with M that end a program or a part of one.
const ENDS: &[u32] = &[2, 17, 29, 30];

/// How the main program calls a part.
pub(crate) fn part_lines(part: &PartName) -> PartLines {
    PartLines {
        call: format!("L {}", part.file),
        begin: String::new(),
        end: "M17\n".to_owned(),
    }
}

/// A reader finds nothing before the lines of a part, and the end of a subroutine behind them.
pub(crate) fn part_frame() -> [Vec<String>; 2] {
    [Vec::new(), vec!["M17".to_owned()]]
}

/// The file of the part that a line calls.
pub(crate) fn called_part(code: &str) -> Option<String> {
    // The blank is a part of the call.
    let code = code.trim();
    let name = code.strip_prefix("L ").or(code.strip_prefix("l "))?;
    Some(name.trim().to_owned())
}

/// The commands of a template.
pub(crate) fn commands(template: &str) -> Vec<Command> {
    g_code::commands(template, HARMLESS)
}

/// Whether a command ends the program in which it stands.
pub(crate) fn ends_program(command: &str) -> bool {
    g_code::ends_program(command, ENDS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::travel::TravelModes;

    #[test]
    fn twincat_does_not_move_before_it_knows_that_numbers_are_mm() {
        let mut modes = TravelModes::default();
        assert!(TRAVEL.read("G90 G94 G40 G52 G360", &mut modes).is_ok());
        let said = TRAVEL.read("G0 Z6.5", &mut modes).unwrap_err();
        assert_eq!(said, "a move before `G71`");
        assert!(TRAVEL.read("G71", &mut modes).is_ok());
        assert!(TRAVEL.read("G0 Z6.5", &mut modes).is_ok());
        assert!(TRAVEL.read("G21", &mut modes).is_err());
    }

    /// An exact stop of other controllers rounds a corner on this one.
    #[test]
    fn twincat_stops_by_g60_and_not_by_g61_or_g9() {
        for (word, is_read) in [("G60", true), ("G61", false), ("G9", false), ("G09", false)] {
            let mut modes = TravelModes::default();
            TRAVEL.read("G90 G94 G40 G52 G71 G360", &mut modes).unwrap();
            let read = TRAVEL.read(&format!("G0 {word} Z6.5"), &mut modes);
            assert_eq!(read.is_ok(), is_read, "{word}: {read:?}");
        }
    }

    #[test]
    fn a_call_has_a_capital_letter_or_a_small_one() {
        for code in ["L a-part-1.cnc", " l a-part-1.cnc "] {
            assert_eq!(called_part(code).as_deref(), Some("a-part-1.cnc"));
        }
        assert_eq!(called_part("La-part-1.cnc"), None);
    }

    #[test]
    fn a_subroutine_ends_with_m17_and_m29_too() {
        for command in ["M2", "M17", "m 29", "G90 M30"] {
            assert!(ends_program(command), "{command}");
        }
        assert!(!ends_program("M3"));
    }
}
