//! What a header or a footer tells the controller besides the path.

use super::dialect::PmacDialect;
use crate::post::{Command, commands_of};

/// The first of the programs 1000 to 1003, which the controller runs as G, M, T and D codes. To fill
/// one of them changes what other programs do.
const FIRST_OF_CODES: u32 = 1000;

/// The commands of a template, line by line. Comments and empty lines are none.
///
/// These words are harmless: `OPEN PROG` with a number below 1000, `CLEAR` and `CLOSE`, which
/// say where the program goes; `ABS` and `INC`, which say what numbers mean; labels; `DWELL` and
/// `DELAY` with a number, which wait; `RETURN` and `STOP`, which end. Any other word may move an axis,
/// set a variable, or start what does.
///
/// Turbo PMAC adds to a program that is opened without `CLEAR` behind it. There such an `OPEN` is not harmless.
pub(crate) fn commands(template: &str, dialect: &PmacDialect) -> Vec<Command> {
    let mut commands = commands_of(template, &[";", "//"], is_harmless);
    if matches!(dialect, PmacDialect::Turbo) {
        let empties = |command: &Command| {
            words(&command.text)
                .first()
                .is_some_and(|word| is_clear(word))
        };
        let next_empties: Vec<bool> = commands.iter().skip(1).map(empties).collect();
        let next_empties = next_empties.into_iter().chain([false]);
        for (command, next_empties) in commands.iter_mut().zip(next_empties) {
            command.harmless &= next_empties || !opens_without_clear(&command.text);
        }
    }
    commands
}

/// The words of a command, without numbers and signs.
fn words(command: &str) -> Vec<String> {
    let code = command.to_uppercase();
    let words = code.split(|c: char| !c.is_ascii_alphabetic());
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_owned).collect()
}

fn is_clear(word: &str) -> bool {
    matches!(word, "CLEAR" | "CLR")
}

fn opens_without_clear(command: &str) -> bool {
    let words = words(command);
    let opens = words.iter().rposition(|word| word == "OPEN");
    opens.is_some_and(|at| !words[at..].iter().any(|word| is_clear(word)))
}

/// Whether a command ends the program in which it stands, or halts it.
pub(crate) fn ends_program(command: &str) -> bool {
    let code = command.to_uppercase();
    let mut words = code.split(|c: char| !c.is_ascii_alphabetic());
    words.any(|word| matches!(word, "RETURN" | "RET" | "STOP"))
}

/// Whether a program is open after a header, so that the path's lines go into it. A header of comments
/// alone opens and closes nothing.
pub(crate) fn leaves_program_open(header: &str) -> bool {
    let mut open = false;
    for command in commands(header, &PmacDialect::Power) {
        let code = command.text.to_uppercase();
        for word in code.split(|c: char| !c.is_ascii_alphabetic()) {
            match word {
                "OPEN" => open = true,
                "CLOSE" | "CLS" => open = false,
                _ => {}
            }
        }
    }
    open
}

fn is_harmless(code: &str) -> bool {
    let code = code.to_uppercase();
    let mut rest = code.as_str();
    while !rest.trim_start().is_empty() {
        match after_statement(rest.trim_start()) {
            Some(after) => rest = after,
            None => return false,
        }
    }
    true
}

/// The code after a harmless statement at its start.
fn after_statement(code: &str) -> Option<&str> {
    let (word, rest) = word(code);
    match word {
        "CLOSE" | "CLS" | "CLEAR" | "CLR" | "RETURN" | "RET" | "STOP" => Some(rest),
        "ABS" | "INC" => after_axes(rest),
        "N" | "DWELL" | "DELAY" => number(rest).map(|(_, rest)| rest),
        "OPEN" => match self::word(rest.trim_start()) {
            ("PROG" | "PROGRAM", rest) => {
                let (program, rest) = number(rest)?;
                let program: u32 = program.parse().ok()?;
                (program < FIRST_OF_CODES).then_some(rest)
            }
            _ => None,
        },
        _ => None,
    }
}

fn word(code: &str) -> (&str, &str) {
    let end = code.find(|c: char| !c.is_ascii_alphabetic());
    code.split_at(end.unwrap_or(code.len()))
}

/// Digits, and what follows them.
fn number(code: &str) -> Option<(&str, &str)> {
    let code = code.trim_start();
    let end = code.find(|c: char| !c.is_ascii_digit());
    let (digits, rest) = code.split_at(end.unwrap_or(code.len()));
    (!digits.is_empty()).then_some((digits, rest))
}

/// What follows the axes in parentheses, which need not be there.
fn after_axes(code: &str) -> Option<&str> {
    let Some(inside) = code.trim_start().strip_prefix('(') else {
        return Some(code);
    };
    let (axes, rest) = inside.split_once(')')?;
    let is_axis = |axis: &str| matches!(axis.trim().as_bytes(), [b'A'..=b'C' | b'R' | b'U'..=b'Z']);
    axes.split(',').all(is_axis).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pmac::PMAC_PVT;

    fn all_harmless(text: &str) -> bool {
        commands(text, &PmacDialect::Turbo)
            .iter()
            .all(|command| command.harmless)
    }

    #[test]
    fn words_that_only_open_read_wait_or_end_are_harmless() {
        for text in [
            "close open prog 12 clear",
            "N10 ABS (X, Z) INC",
            "DWELL 100",
            "CLOSE ; M1=1 in a comment",
            "// M1=1",
            "",
        ] {
            assert!(all_harmless(text), "{text}");
        }
    }

    /// Turbo PMAC adds to a program that is not emptied; Power PMAC empties it.
    #[test]
    fn a_program_that_is_opened_and_not_emptied_needs_trust() {
        for text in [
            "OPEN PROG 1\n",
            "CLOSE\nOPEN PROG 1\nABS\n",
            "OPEN PROG 1 ABS",
        ] {
            assert!(!all_harmless(text), "{text}");
            let of_power = commands(text, &PmacDialect::Power);
            assert!(of_power.iter().all(|command| command.harmless), "{text}");
        }
        for text in [
            "OPEN PROG 1\nCLEAR\n",
            "OPEN PROG 1CLEAR",
            "CLOSE OPEN PROG 12 clr",
        ] {
            assert!(all_harmless(text), "{text}");
        }
    }

    #[test]
    fn any_other_word_needs_trust() {
        for text in [
            "OPEN ROT",
            "M1=1",
            "I5=2",
            "P1 = 2",
            "OPEN PLC 1 CLEAR",
            "OPEN PROG 1000 CLEAR",
            "OPEN PROG {points} CLEAR",
            "CLOSE &1 B1 R",
            "ENABLE PLC 1",
            "CMD\"#1J+\"",
            "X10",
            "HOME1",
            "CALL 500",
            "DELETE GATHER",
            "$$$***",
            "ABS (X, P1)",
            "CLOSEALL",
            "{{",
            "DWELL P1",
            "CLOSE\u{b5}",
        ] {
            assert!(!all_harmless(text), "{text}");
        }
    }

    #[test]
    fn a_header_leaves_a_program_open_or_not() {
        for (header, open) in [
            (PMAC_PVT.header, true),
            ("CLOSE\nOPEN PROG 2 CLEAR\nABS", true),
            ("CLOSE", false),
            ("OPEN PROG 2 CLEAR\nCLOSE", false),
            ("; OPEN PROG 2", false),
        ] {
            assert_eq!(leaves_program_open(header), open, "{header}");
        }
    }

    #[test]
    fn a_command_is_told_with_its_line_and_without_its_comment() {
        let found = commands("; {name}\n\n  M1=1 ; coolant\nCLOSE\n", &PmacDialect::Turbo);
        let command = |line, text: &str, harmless| Command {
            line,
            text: text.to_owned(),
            harmless,
        };
        assert_eq!(
            found,
            [command(3, "M1=1", false), command(4, "CLOSE", true)]
        );
    }
}
