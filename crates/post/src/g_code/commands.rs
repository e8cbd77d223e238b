//! The commands of headers and footers.

use crate::post::{Command, behind_number, commands_of};

/// The commands of a template, of which these words are harmless. A second `%` ends the program.
pub(crate) fn commands(template: &str, harmless: &[&str]) -> Vec<Command> {
    let is_harmless = |code: &str| {
        let code = behind_number(code).to_ascii_uppercase();
        code.split_whitespace().all(|word| harmless.contains(&word))
    };
    let mut commands = commands_of(template, &[";"], is_harmless);
    let is_end = |command: &&mut Command| behind_number(&command.text).trim() == "%";
    let ends = commands.iter_mut().filter(is_end);
    ends.skip(1).for_each(|command| command.harmless = false);
    commands
}

/// Whether a command has an M with one of these numbers, which end a program. Blanks stand anywhere in
/// RS274, and zeros before a number.
pub(crate) fn ends_program(command: &str, ends: &[u32]) -> bool {
    let code: String = command.split_whitespace().collect();
    let code = code.to_ascii_uppercase();
    let mut words = code.split('M').skip(1);
    words.any(|word| {
        let end = word.find(|c: char| !c.is_ascii_digit());
        let (number, _) = word.split_at(end.unwrap_or(word.len()));
        number.parse().is_ok_and(|number| ends.contains(&number))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_program_are_known() {
        for command in ["M2", "m02", "G21 M30", "G90M2", "M 3 0"] {
            assert!(ends_program(command, &[2, 30]), "{command}");
        }
        for command in ["G54", "M3", "M20", "M300", "G2", "%", "M"] {
            assert!(!ends_program(command, &[2, 30]), "{command}");
        }
    }

    #[test]
    fn a_second_percent_sign_is_not_harmless() {
        let told = commands("%\nG21\n%\n", &["%", "G21"]);
        let harmless: Vec<bool> = told.iter().map(|one| one.harmless).collect();
        assert_eq!(harmless, [true, true, false]);
    }
}
