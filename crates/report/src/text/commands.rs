//! The controller's commands in a recipe's own header and footer.

use turnpath_core::printable_line;

use crate::program::ControllerCommand;

use super::numbers::line;

/// A line for each command.
pub fn commands(commands: &[ControllerCommand]) -> String {
    let of_command = |one: &ControllerCommand| {
        let trusted = match one.harmless {
            true => "",
            false => " (may move, set or start something)",
        };
        line(
            &one.template,
            format!("line {}: {}{trusted}", one.line, one.command),
        )
    };
    commands.iter().map(of_command).collect()
}

/// A line for each command that a file has besides those of its recipe.
pub fn commands_of_file(commands: &[ControllerCommand]) -> String {
    let of_command = |one: &ControllerCommand| {
        let (template, command) = (&one.template, printable_line(&one.command));
        let said = format!(
            "line {}: {command}, which the recipe's {template} does not have there; it may move, set, start or end something",
            one.line
        );
        line(template, said)
    };
    commands.iter().map(of_command).collect()
}

/// A line for each command that a recipe has and its file has not.
pub fn missing_commands(commands: &[ControllerCommand]) -> String {
    let of_command = |one: &ControllerCommand| {
        let (template, command) = (&one.template, printable_line(&one.command));
        let said = format!(
            "{command} is missing: line {} of the recipe's {template} has it",
            one.line
        );
        line(template, said)
    };
    commands.iter().map(of_command).collect()
}
